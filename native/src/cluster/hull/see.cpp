// Which facets of a hull a point sees.
//
// The hulls of clusters are mostly tiny: there all facets are tested, two at a time, and those that see the point are a
// set of bits. On a hull of more facets than a set has bits a walk finds one of them, the others are found from there.
// What a point sees can't be foreseen, so the inner loops don't branch on it.
#include "cluster/hull/view.h"

namespace partwheel {

namespace {

constexpr size_t none = ~size_t{0}, inside = none - 1;  // in place of a facet

constexpr size_t next_corner[3] = {1, 2, 0};

// Twice the larger of 0 and x, without a branch.
double twice_positive(double x) { return x + std::fabs(x); }

// Whether, with exact numbers, p is inside of facet f, and f better than each of its neighbours in the sense of walk():
// then it is better than all others, for only facets with no coplanar neighbour can be, and their polar points have
// just three edges; and p is inside of all.
bool surely_best(const FacetsView& h, size_t f, const Point& p) {
    constexpr double rounding = 1 + 1e-14;  // more than that of the products
    const double factor = h.error_factor(p);
    const double error = factor * h.size[f], side = h.side(f, p);
    if (!(side + error < 0 && h.offset[f] > error)) return false;
    for (const int32_t n : h.facets[f].neighbours) {
        const auto g = static_cast<size_t>(n);
        const double error_g = factor * h.size[g], side_g = h.side(g, p);
        if (!(side_g + error_g < 0 && h.offset[g] > error_g)) return false;
        if (!((side_g + error_g) * (h.offset[f] - error) < (side - error) * (h.offset[g] + error_g) * rounding))
            return false;
    }
    return true;
}

}  // namespace

// Looks for a facet that surely sees p by going to better and better neighbours; `inside` if p surely is. None if it
// finds neither.
//
// Better is what the ray from the origin to p meets later, relative to its length: that is a linear function of the
// facets' polar points, and these are the corners of a convex polytope, so that with exact numbers no facet but the
// best would be without a better neighbour. (Nearly) equally good ones, as in coplanar facets, are tried once each.
size_t HullKernel::walk(const FacetsView& h, const Point& p, size_t start) {
    constexpr double equal = 1e-9;
    const double factor = h.error_factor(p);
    ++facet_stamp_;
    const auto rate = [&](size_t f) { return h.offset[f] > 0 ? h.side(f, p) / h.offset[f] : -HUGE_VAL; };
    size_t f = start;
    for (double here = rate(f); h.side(f, p) <= h.size[f] * factor;) {
        facet_mark_[f] = facet_stamp_;
        size_t best = f;
        double there = -HUGE_VAL;
        for (const int32_t n : h.facets[f].neighbours) {
            const auto g = static_cast<size_t>(n);
            const double rated = facet_mark_[g] == facet_stamp_ ? -HUGE_VAL : rate(g);
            best = rated > there ? g : best;
            there = std::max(there, rated);
        }
        // Where the origin is outside of a facet and of all about it none is better, and none worse.
        if (best == f || !(there >= here - equal)) return h.centred && surely_best(h, f, p) ? inside : none;
        f = best;
        here = there;
    }
    return f;
}

// Some facet that the vertex is strictly outside of; none if it is in the hull. p is the vertex relative to the origin,
// start a facet near it, if one is known.
size_t HullKernel::find_seen(const FacetsView& h, const Point& p, int32_t vertex, size_t start) {
    if (const size_t f = walk(h, p, start); f != none) return f == inside ? none : f;
    const double factor = h.error_factor(p);
    bool doubtful = false;
    for (size_t f = 0; f < h.count; f += 2) {
        const Two side = h.sides(f, p), error = factor * vector_at<Two>(h.size + f);
        const auto negative = std::bit_cast<TwoBits>(side + error);
        if ((negative[0] & negative[1]) < 0) continue;
        if (side[0] > error[0]) return f;
        if (side[1] > error[1]) return f + 1;
        doubtful = true;
    }
    for (size_t f = 0; doubtful && f < h.count; ++f)
        if (h.side(f, p) >= -factor * h.size[f] && exact_side(h, f, vertex) > 0) return f;
    return none;
}

// seen_ becomes the facets that see the vertex, strictly or in whose plane it lies, f being one of them, and rim_ the
// edges around them. Returns six times the volume between them and the vertex.
double HullKernel::flood(const FacetsView& h, size_t f, const Point& p, int32_t vertex) {
    // Whatever is written past the end of seen_ or rim_ is overwritten unless it turns out to belong there.
    const double factor = h.error_factor(p);
    const uint32_t yes = facet_stamp_ + 1, no = yes + 1;
    facet_stamp_ += 2;
    uint32_t *const seen = seen_.data(), *const mark = facet_mark_.data();
    RimEdge* rim = rim_.data();
    size_t count = 1;
    seen[0] = static_cast<uint32_t>(f);
    mark[f] = yes;
    double volume = 0;
    for (size_t i = 0; i < count; ++i) {
        const HullFacet& facet = h.facets[seen[i]];
        volume += twice_positive(h.side(seen[i], p));
        for (size_t k = 0; k < 3; ++k) {
            const auto g = static_cast<uint32_t>(facet.neighbours[k]);
            const double side = h.side(g, p), error = h.size[g] * factor;
            bool sees = side > 0;
            if (std::fabs(side) <= error) [[unlikely]]
                sees = mark[g] < yes ? exact_side(h, g, vertex) >= 0 : mark[g] == yes;
            seen[count] = g;
            count += sees & (mark[g] != yes);
            mark[g] = sees ? yes : no;
            *rim = {facet.corners[k], facet.corners[next_corner[k]], facet.neighbours[k]};
            rim += !sees;
        }
    }
    seen_count_ = count;
    rim_count_ = static_cast<size_t>(rim - rim_.data());
    return volume / 2;
}

// What look() does, on a hull with at most set_bits facets.
double HullKernel::see(const Point& p, int32_t vertex) {
    const FacetsView h = view();
    const double factor = h.error_factor(p);
    uint64_t sees = 0, surely = 0;
    Two sum = {0, 0};
    for (size_t f = 0; f < h.count; f += 2) {  // a gap sees nothing
        const Two side = h.sides(f, p), error = factor * vector_at<Two>(h.size + f);
        sum += positive(side);
        sees |= uint64_t{3 ^ signs(side + error)} << f;
        surely |= uint64_t{signs(error - side)} << f;
    }
    for (uint64_t doubtful = sees & ~surely; doubtful != 0; doubtful &= doubtful - 1) {
        const auto f = static_cast<size_t>(std::countr_zero(doubtful));
        const int side = exact_side(h, f, vertex);
        if (side < 0) sees &= ~(uint64_t{1} << f);
        if (side > 0) surely |= uint64_t{1} << f;
    }
    rim_count_ = 0;
    if (surely == 0) return 0;
    uint32_t* seen = seen_.data();
    RimEdge* rim = rim_.data();
    for (uint64_t left = sees; left != 0; left &= left - 1) {
        const auto f = static_cast<uint32_t>(std::countr_zero(left));
        *seen++ = f;
        const HullFacet& facet = h.facets[f];
        for (size_t k = 0; k < 3; ++k) {
            *rim = {facet.corners[k], facet.corners[next_corner[k]], facet.neighbours[k]};
            rim += (~sees >> facet.neighbours[k]) & 1;
        }
    }
    seen_count_ = static_cast<size_t>(seen - seen_.data());
    rim_count_ = static_cast<size_t>(rim - rim_.data());
    return sum[0] + sum[1];
}

// Finds seen_ and rim_ of a vertex on the hull at work; rim_ is empty if the vertex is in the hull. Returns six times
// what the vertex adds.
double HullKernel::look(int32_t vertex) {
    reserve(count_);
    const Point p = at(vertex) - origin_;
    if (count_ <= set_bits) return see(p, vertex);
    rim_count_ = 0;
    const size_t seen = find_seen(view(), p, vertex, latest_);
    return seen == none ? 0 : flood(view(), seen, p, vertex);
}

}  // namespace partwheel
