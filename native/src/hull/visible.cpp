// The facets of a hull that are visible from a point.
//
// Most hulls of clusters are tiny: all their facets are tested, two at a time, and the visible ones form a 64-bit
// mask. On a larger hull, a walk finds one visible facet, and the others are found from there. Visibility is
// unpredictable, so the inner loops don't branch on it.
//
// Large polygons in one plane have special rules, so that a point costs less than a visit of all their facets.
#include "hull/view.h"

namespace partwheel {

namespace {

constexpr size_t none = ~size_t{0}, inside = none - 1;  // instead of a facet

constexpr size_t next_corner[3] = {1, 2, 0};

// On a hull with more than max_searched_facets, at most this many coplanar facets are visited in a row or replaced at once.
constexpr size_t max_coplanar_facets = 256;

// 2 max(0, x), without a branch.
double twice_positive(double x) { return x + std::fabs(x); }

// True only if, in exact arithmetic, p is inside facet f and f is better than each of its neighbors, in the sense of
// walk_to_visible_facet(). Then f is better than all other facets, because only a facet without coplanar neighbors
// can be, and its polar point has just three edges. So p is inside all facets.
bool is_certainly_best(const FacetsView& h, size_t f, const Point& p) {
    constexpr double rounding = 1 + 1e-14;  // exceeds the rounding of the products
    const double factor = h.error_factor(p);
    const double error = factor * h.size[f], side = h.side(f, p);
    if (!(side + error < 0 && h.offset[f] > error)) return false;
    for (const int32_t n : h.facets[f].neighbors) {
        const auto g = static_cast<size_t>(n);
        const double error_g = factor * h.size[g], side_g = h.side(g, p);
        if (!(side_g + error_g < 0 && h.offset[g] > error_g)) return false;
        if (!((side_g + error_g) * (h.offset[f] - error) < (side - error) * (h.offset[g] + error_g) * rounding))
            return false;
    }
    return true;
}

}  // namespace

// Searches for a facet certainly visible from p by moving to better neighbors. Returns `inside` if p certainly is,
// `none` if neither is certain.
//
// A facet is better if side / offset is larger: the ray from the origin to p crosses it earlier. This is a linear
// function of the facets' polar points, the vertices of a convex polytope, so in exact arithmetic only the best facet
// has no better neighbor. (Nearly) equal ones, such as coplanar facets, are visited once each, but not many in a row on
// a large hull. f: where the walk starts, and then where it ends.
size_t HullKernel::walk_to_visible_facet(const FacetsView& h, const Point& p, size_t& f) {
    constexpr double tie_tolerance = 1e-9;
    const size_t max_ties = h.count > max_searched_facets ? max_coplanar_facets : h.count;
    const double factor = h.error_factor(p);
    ++facet_stamp_;
    const auto rate = [&](size_t facet) { return h.offset[facet] > 0 ? h.side(facet, p) / h.offset[facet] : -HUGE_VAL; };
    // The same for two facets at once; -HUGE_VAL, too, where the walk has been.
    const auto rates = [&](size_t a, size_t b) {
        const auto both = [&](const double* values) { return Double2{values[a], values[b]}; };
        const Double2 offset = both(h.offset);
        const Double2 side = both(h.x) * p[0] + both(h.y) * p[1] + both(h.z) * p[2] - offset;
        const auto is_new = [&](size_t facet) { return -int64_t{facet_mark_[facet] != facet_stamp_}; };
        const Int64x2 counts = Int64x2(offset > 0) & Int64x2{is_new(a), is_new(b)};
        constexpr Double2 lowest = {-HUGE_VAL, -HUGE_VAL};
        return std::bit_cast<Double2>((std::bit_cast<Int64x2>(side / offset) & counts) |
                                      (std::bit_cast<Int64x2>(lowest) & ~counts));
    };
    size_t ties = 0;
    for (double current_rate = rate(f); h.side(f, p) <= h.size[f] * factor;) {
        ++facet_visits_;
        facet_mark_[f] = facet_stamp_;
        const auto [n0, n1, n2] = h.facets[f].neighbors;
        const auto g0 = static_cast<size_t>(n0), g1 = static_cast<size_t>(n1), g2 = static_cast<size_t>(n2);
        const Double2 first = rates(g0, g1);
        const double third = rates(g2, g2)[0];
        const double best_of_two = std::max(first[0], first[1]), best_rate = std::max(best_of_two, third);
        size_t best = first[1] > first[0] ? g1 : g0;
        best = third > best_of_two ? g2 : best;
        best = best_rate > -HUGE_VAL ? best : f;
        // If the origin is outside a facet and all its neighbors, none of them is better or worse.
        if (best == f || !(best_rate >= current_rate - tie_tolerance))
            return h.origin_is_inside && is_certainly_best(h, f, p) ? inside : none;
        ties = best_rate > current_rate + tie_tolerance ? 0 : ties + 1;
        if (ties > max_ties) return none;
        f = best;
        current_rate = best_rate;
    }
    return f;
}

// The same by exact predicates: moves toward the facet that the ray from the origin to the vertex crosses, until it is
// there or at a visible facet.
size_t HullKernel::walk_along_ray(const FacetsView& h, int32_t vertex, size_t start) {
    ++facet_stamp_;
    for (size_t f = start; f != none;) {
        count_visits(1);
        if (exact_side(h, f, vertex) > 0) return f;
        facet_mark_[f] = facet_stamp_;
        const HullFacet& facet = h.facets[f];
        bool is_crossed = true;
        f = none;
        for (size_t k = 0; k < 3; ++k) {
            if (side_of_edge(h, facet.corners[k], facet.corners[next_corner[k]], vertex) >= 0) continue;
            is_crossed = false;
            const auto g = static_cast<size_t>(facet.neighbors[k]);
            if (facet_mark_[g] != facet_stamp_) f = g;
        }
        if (is_crossed) return inside;
    }
    return none;
}

// A facet strictly visible from the vertex, or none if the vertex is in the hull. p: the vertex relative to the origin;
// start: where the search begins.
size_t HullKernel::find_visible_facet(const FacetsView& h, const Point& p, int32_t vertex, size_t start) {
    // Points inside often follow each other, close together. The first walk can only prove that one is inside: which
    // visible facet is found, and so the order of new facets, does not depend on it.
    if (innermost_facet_ < h.count && walk_to_visible_facet(h, p, innermost_facet_) == inside) return none;
    innermost_facet_ = none;
    const size_t found = walk_to_visible_facet(h, p, start);
    if (found == inside) innermost_facet_ = start;
    if (found != none) return found == inside ? none : found;
    if (h.count > max_searched_facets && h.origin_is_inside)
        if (const size_t f = walk_along_ray(h, vertex, start); f != none) return f == inside ? none : f;
    count_visits(h.count);
    const double factor = h.error_factor(p);
    bool is_doubtful = false;
    for (size_t f = 0; f < h.count; f += 2) {
        const Double2 side = h.sides(f, p), error = factor * vector_at<Double2>(h.size + f);
        const auto negative = std::bit_cast<Int64x2>(side + error);
        if ((negative[0] & negative[1]) < 0) continue;
        if (side[0] > error[0]) return f;
        if (side[1] > error[1]) return f + 1;
        is_doubtful = true;
    }
    for (size_t f = 0; is_doubtful && f < h.count; ++f)
        if (h.side(f, p) >= -factor * h.size[f] && exact_side(h, f, vertex) > 0) return f;
    return none;
}

// Sets visible_ to the facets whose exact_side() is at least least_side, 1 or 0, starting from the visible facet f, and
// horizon_ to the edges around them. volume: six times that between them and the vertex. False if there are more than
// max_coplanar facets with a side of 0.
bool HullKernel::grow_visible_region(const FacetsView& h, size_t f, const Point& p, int32_t vertex, int least_side,
                                     size_t max_coplanar, double& volume) {
    // Entries are written past the end of visible_ and horizon_, and the end advances only if they belong there.
    const double factor = h.error_factor(p);
    const uint32_t yes = facet_stamp_ + 1, no = yes + 1;
    facet_stamp_ += 2;
    uint32_t *const visible = visible_.data(), *const mark = facet_mark_.data();
    HorizonEdge* horizon = horizon_.data();
    size_t count = 1, coplanar = 0;
    visible[0] = static_cast<uint32_t>(f);
    mark[f] = yes;
    volume = 0;
    for (size_t i = 0; i < count; ++i) {
        if (coplanar > max_coplanar) [[unlikely]]
            return false;
        const HullFacet& facet = h.facets[visible[i]];
        volume += twice_positive(h.side(visible[i], p));
        for (size_t k = 0; k < 3; ++k) {
            const auto g = static_cast<uint32_t>(facet.neighbors[k]);
            const double side = h.side(g, p), error = h.size[g] * factor;
            bool is_visible = side > 0;
            if (std::fabs(side) <= error) [[unlikely]] {
                const int exact = mark[g] < yes ? exact_side(h, g, vertex) : mark[g] == yes ? 1 : -1;
                is_visible = exact >= least_side;
                coplanar += exact == 0;
            }
            visible[count] = g;
            count += is_visible & (mark[g] != yes);
            mark[g] = is_visible ? yes : no;
            *horizon = {facet.corners[k], facet.corners[next_corner[k]], facet.neighbors[k]};
            horizon += !is_visible;
        }
    }
    visible_count_ = count;
    horizon_count_ = static_cast<size_t>(horizon - horizon_.data());
    volume /= 2;
    return true;
}

// Adds to visible_, the facets strictly visible from the vertex, those coplanar facets (planes that contain the vertex)
// that can't stay: those with a corner that is no longer extreme, which lies between two horizon edges with coplanar
// facets beyond. Returns false if all coplanar facets must be added instead, because the vertex does not see some
// horizon edge from the side of visible_.
bool HullKernel::add_coplanar_facets(const FacetsView& h, const Point& p, int32_t vertex) {
    const double factor = h.error_factor(p);
    const auto is_coplanar = [&](size_t g) {
        return std::fabs(h.side(g, p)) <= h.size[g] * factor && exact_side(h, g, vertex) == 0;
    };
    std::vector<int32_t> starts, ends, lost;
    for (const HorizonEdge& edge : std::span(horizon_).first(horizon_count_)) {
        if (!is_coplanar(static_cast<size_t>(edge.beyond))) continue;
        starts.push_back(edge.from);
        ends.push_back(edge.to);
    }
    std::ranges::sort(starts);
    std::ranges::sort(ends);
    std::ranges::set_intersection(starts, ends, std::back_inserter(lost));
    if (lost.empty()) return true;
    if (h.count <= max_searched_facets || !h.origin_is_inside) return false;

    const uint32_t yes = ++facet_stamp_;
    for (size_t i = 0; i < visible_count_; ++i) facet_mark_[visible_[i]] = yes;
    const auto for_each_neighbor = [&](const auto& visit) {
        for (size_t i = 0; i < visible_count_; ++i) {
            const HullFacet& facet = h.facets[visible_[i]];
            for (size_t k = 0; k < 3; ++k)
                if (facet_mark_[static_cast<size_t>(facet.neighbors[k])] != yes)
                    visit(HorizonEdge{facet.corners[k], facet.corners[next_corner[k]], facet.neighbors[k]});
        }
    };
    for_each_neighbor([&](const HorizonEdge& edge) {
        const auto g = static_cast<size_t>(edge.beyond);
        const auto is_lost = [&](int32_t corner) { return std::ranges::binary_search(lost, corner); };
        if (!is_coplanar(g)) return;
        if (side_of_edge(h, edge.from, edge.to, vertex) > 0 && std::ranges::none_of(h.facets[g].corners, is_lost)) return;
        visible_[visible_count_++] = static_cast<uint32_t>(g);
        facet_mark_[g] = yes;
    });
    horizon_count_ = 0;
    for_each_neighbor([&](const HorizonEdge& edge) { horizon_[horizon_count_++] = edge; });
    return true;
}

// Sets visible_ to the facets visible from the vertex, including those whose plane contains it, unless those are many
// and can stay. Starts from the visible facet f. Returns six times the volume between them and the vertex.
double HullKernel::find_visible_region(const FacetsView& h, size_t f, const Point& p, int32_t vertex) {
    constexpr size_t any = std::numeric_limits<size_t>::max();
    double volume = 0;
    if (!grow_visible_region(h, f, p, vertex, 0, max_coplanar_facets, volume)) {
        count_visits(max_coplanar_facets);
        grow_visible_region(h, f, p, vertex, 1, any, volume);
        if (!add_coplanar_facets(h, p, vertex)) grow_visible_region(h, f, p, vertex, 0, any, volume);
    }
    count_visits(visible_count_);
    return volume;
}

// find_visible() on a hull with at most max_bitset_facets facets.
double HullKernel::find_visible_in_bitset(const Point& p, int32_t vertex) {
    const FacetsView h = view();
    const double factor = h.error_factor(p);
    uint64_t is_visible = 0, is_certain = 0;
    Double2 sum = {0, 0};
    for (size_t f = 0; f < h.count; f += 2) {  // a free entry is never visible
        const Double2 side = h.sides(f, p), error = factor * vector_at<Double2>(h.size + f);
        sum += positive(side);
        is_visible |= uint64_t{3 ^ sign_mask(side + error)} << f;
        is_certain |= uint64_t{sign_mask(error - side)} << f;
    }
    for (uint64_t doubtful = is_visible & ~is_certain; doubtful != 0; doubtful &= doubtful - 1) {
        const auto f = static_cast<size_t>(std::countr_zero(doubtful));
        const int side = exact_side(h, f, vertex);
        if (side < 0) is_visible &= ~(uint64_t{1} << f);
        if (side > 0) is_certain |= uint64_t{1} << f;
    }
    horizon_count_ = 0;
    if (is_certain == 0) return 0;
    uint32_t* visible = visible_.data();
    HorizonEdge* horizon = horizon_.data();
    for (uint64_t left = is_visible; left != 0; left &= left - 1) {
        const auto f = static_cast<uint32_t>(std::countr_zero(left));
        *visible++ = f;
        const HullFacet& facet = h.facets[f];
        for (size_t k = 0; k < 3; ++k) {
            *horizon = {facet.corners[k], facet.corners[next_corner[k]], facet.neighbors[k]};
            horizon += (~is_visible >> facet.neighbors[k]) & 1;
        }
    }
    visible_count_ = static_cast<size_t>(visible - visible_.data());
    horizon_count_ = static_cast<size_t>(horizon - horizon_.data());
    return sum[0] + sum[1];
}

// Sets visible_ and horizon_ for a vertex and the loaded hull; horizon_ is empty if the vertex is in the hull.
// Returns six times the volume that the vertex adds.
double HullKernel::find_visible(int32_t vertex) {
    reserve(count_);
    if (count_ > max_searched_facets && !origin_is_inside_) [[unlikely]]
        move_origin_inside();
    const Point p = at(vertex) - origin_;
    if (count_ <= max_bitset_facets) return find_visible_in_bitset(p, vertex);
    horizon_count_ = 0;
    const size_t visible = find_visible_facet(view(), p, vertex, newest_facet_);
    return visible == none ? 0 : find_visible_region(view(), visible, p, vertex);
}

}  // namespace partwheel
