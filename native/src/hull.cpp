// Convex hulls by insertion of points (beneath-beyond).
//
// A point that sees no facet from strictly outside is in the hull. Otherwise all facets that it sees, those in whose
// plane it lies included, are taken away, and the rim of the hole is joined to it. Taking the coplanar ones away too
// keeps the vertices exactly the extreme points, and no degenerate facet can arise: an edge of the rim has a facet on
// its far side that strictly doesn't see the point, so the point is not on the edge's line.
//
// The hulls of clusters are mostly tiny: there all facets are tested, in blocks without a branch. On a large hull a walk
// finds one facet that sees the point, and the others are its neighbours.
#include "hull.h"

#include "predicates.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace partwheel {

namespace {

// From so many facets on a walk beats testing them all.
constexpr size_t large_hull = 160;

// The facets of the hull at work, as a structure of arrays. A facet's plane: x px + y py + z pz - offset is six times the
// volume of facet and p, wrong by at most `error`. neighbours[f][k] is across the edge from corner k to corner k + 1.
struct Facets {
    std::vector<Triangle> corners, neighbours;
    std::vector<double> x, y, z, offset, error;

    size_t size() const { return corners.size(); }
    void resize(size_t n) {
        corners.resize(n);
        neighbours.resize(n);
        for (auto* v : {&x, &y, &z, &offset, &error}) v->resize(n);
    }
};

// The same arrays wherever they are.
struct FacetsView {
    const Triangle *corners, *neighbours;
    const double *x, *y, *z, *offset, *error;
    size_t size;

    double side(size_t f, const Point& p) const { return x[f] * p[0] + y[f] * p[1] + z[f] * p[2] - offset[f]; }
};

FacetsView view(const Facets& f) {
    return {f.corners.data(), f.neighbours.data(), f.x.data(),     f.y.data(),
            f.z.data(),       f.offset.data(),     f.error.data(), f.size()};
}

FacetsView view(const Hull& hull) {
    const size_t n = hull.facets.size();
    const double* p = hull.planes.data();
    return {hull.facets.data(), hull.neighbours.data(), p, p + n, p + 2 * n, p + 3 * n, p + 4 * n, n};
}

}  // namespace

class HullKernel::Impl {
public:
    explicit Impl(std::span<const Point> points) : points_(points), mark_(points.size(), 0), facet_from_(points.size(), -1) {
        double largest = 0;
        for (const Point& p : points)
            for (double c : p) largest = std::max(largest, std::fabs(c));
        // With every coordinate at most M and N the sum of the absolute products in a normal, a plane's side() is off
        // by at most 16 eps M N: 8 from the normal, 3 from each dot product, 2 from their difference.
        error_factor_ = 24 * 0x1p-53 * largest;
    }

    Hull build(std::span<const int32_t> vertices);
    Hull unite(const Hull& a, const Hull& b);
    double united_volume(const Hull& a, const Hull& b);
    std::pair<Point, Point> bounds(const Hull& hull) const;

private:
    const Point& at(int32_t v) const { return points_[static_cast<size_t>(v)]; }

    int sign_of_side(const FacetsView& facets, size_t f, const Point& p) const;
    bool classify(const FacetsView& facets, const Point& p);
    bool scan(const FacetsView& facets, const Point& p);
    bool walk(const FacetsView& facets, const Point& p);
    double six_volumes_seen(const FacetsView& facets, const Point& p) const;

    void load(const Hull& hull);
    void set_facet(size_t f, const Triangle& corners);
    void erase_facet(size_t f);
    bool insert(int32_t vertex);
    Hull unload();
    bool load_simplex(std::span<const int32_t> vertices);
    void prepare(const Hull& hull);

    std::span<const Point> points_;
    double error_factor_ = 0;

    // The hull at work. If united_ is set, it is the union of these two.
    std::pair<const Hull*, const Hull*> united_{};
    Facets facets_;
    double volume6_ = 0;

    // Of the hull in question, at work or at rest.
    Point inside_{};              // a point inside it
    std::vector<uint32_t> mark_;  // mark_[v] == stamp_: v is one of its vertices
    uint32_t stamp_ = 0;

    // Scratch.
    struct RimEdge {
        int32_t from, to;
        int32_t beyond;  // the facet that stays
    };
    std::vector<RimEdge> rim_;
    std::vector<uint32_t> seen_;        // facets that the last point classified sees
    std::vector<uint32_t> facet_mark_;  // of facets, in the manner of mark_
    uint32_t facet_stamp_ = 0;
    std::vector<int32_t> facet_from_;   // the new facet whose rim edge starts at a vertex
};

// The exact side of a facet that p is on: 1 outside, 0 in the plane.
int HullKernel::Impl::sign_of_side(const FacetsView& facets, size_t f, const Point& p) const {
    const double side = facets.side(f, p);
    if (side > facets.error[f]) return 1;
    if (side < -facets.error[f]) return -1;
    const Triangle& t = facets.corners[f];
    return orientation(at(t[0]), at(t[1]), at(t[2]), p);
}

// Whether p is strictly outside. If so, seen_ holds the facets that see it, strictly or in whose plane it lies.
bool HullKernel::Impl::classify(const FacetsView& facets, const Point& p) {
    return (facets.size >= large_hull && walk(facets, p)) || scan(facets, p);
}

bool HullKernel::Impl::scan(const FacetsView& facets, const Point& p) {
    // Whole blocks of facets that surely don't see p are passed over: the loop inside has no branch.
    constexpr size_t block = 8;
    seen_.clear();
    bool outside = false;
    for (size_t begin = 0; begin < facets.size; begin += block) {
        const size_t end = std::min(begin + block, facets.size);
        double highest = -1;
        for (size_t f = begin; f < end; ++f) highest = std::max(highest, facets.side(f, p) + facets.error[f]);
        if (highest < 0) continue;
        for (size_t f = begin; f < end; ++f) {
            const int sign = sign_of_side(facets, f, p);
            if (sign < 0) continue;
            outside |= sign > 0;
            seen_.push_back(static_cast<uint32_t>(f));
        }
    }
    return outside;
}

// Looks for a facet that sees p by going to better and better neighbours, then for the others around it. False if it
// finds none: p may be outside all the same.
//
// Better is what the ray from inside_ to p meets later, relative to its length: that is a linear function of the facets'
// polar points, and these are the corners of a convex polytope, so that with exact numbers no facet but the best would be
// without a better neighbour. (Nearly) equally good ones, as in coplanar facets, are tried once each.
bool HullKernel::Impl::walk(const FacetsView& facets, const Point& p) {
    constexpr double equal = 1e-9;
    if (facet_mark_.size() < facets.size) facet_mark_.resize(2 * facets.size, 0);
    ++facet_stamp_;
    const auto rate = [&](size_t f) {
        const double depth = -facets.side(f, inside_);
        return depth > 0 ? facets.side(f, p) / depth : -HUGE_VAL;
    };
    size_t f = seen_.empty() || seen_[0] >= facets.size ? 0 : seen_[0];
    for (double here = rate(f); facets.side(f, p) <= facets.error[f];) {
        facet_mark_[f] = facet_stamp_;
        size_t best = f;
        double there = -HUGE_VAL;
        for (int32_t n : facets.neighbours[f]) {
            const auto g = static_cast<size_t>(n);
            if (facet_mark_[g] == facet_stamp_) continue;
            const double rated = rate(g);
            if (rated > there) {
                there = rated;
                best = g;
            }
        }
        if (!(there >= here - equal)) return false;
        f = best;
        here = there;
    }

    ++facet_stamp_;
    seen_.assign(1, static_cast<uint32_t>(f));
    facet_mark_[f] = facet_stamp_;
    for (size_t i = 0; i < seen_.size(); ++i)
        for (int32_t n : facets.neighbours[seen_[i]]) {
            const auto g = static_cast<size_t>(n);
            if (facet_mark_[g] == facet_stamp_ || sign_of_side(facets, g, p) < 0) continue;
            facet_mark_[g] = facet_stamp_;
            seen_.push_back(static_cast<uint32_t>(g));
        }
    // As scan() has them: so the result does not depend on which of the two found them.
    std::sort(seen_.begin(), seen_.end());
    return true;
}

// Six times the volume between p and the facets it sees; after classify().
double HullKernel::Impl::six_volumes_seen(const FacetsView& facets, const Point& p) const {
    double sum = 0;
    for (uint32_t f : seen_) {
        const Triangle& t = facets.corners[f];
        sum += six_volumes(at(t[0]), at(t[1]), at(t[2]), p);
    }
    return sum;
}

void HullKernel::Impl::load(const Hull& hull) {
    united_ = {};
    const FacetsView from = view(hull);
    facets_.corners = hull.facets;
    facets_.neighbours = hull.neighbours;
    facets_.x.assign(from.x, from.x + from.size);
    facets_.y.assign(from.y, from.y + from.size);
    facets_.z.assign(from.z, from.z + from.size);
    facets_.offset.assign(from.offset, from.offset + from.size);
    facets_.error.assign(from.error, from.error + from.size);
    volume6_ = 6 * hull.volume;
}

void HullKernel::Impl::set_facet(size_t f, const Triangle& corners) {
    const Point& a = at(corners[0]);
    const Point u = at(corners[1]) - a, v = at(corners[2]) - a;
    const Point n = cross(u, v);
    const double size = std::fabs(u[1] * v[2]) + std::fabs(u[2] * v[1]) + std::fabs(u[2] * v[0]) +
                        std::fabs(u[0] * v[2]) + std::fabs(u[0] * v[1]) + std::fabs(u[1] * v[0]);
    facets_.corners[f] = corners;
    facets_.x[f] = n[0];
    facets_.y[f] = n[1];
    facets_.z[f] = n[2];
    facets_.offset[f] = dot(n, a);
    facets_.error[f] = error_factor_ * size;
}

// The last facet takes its place.
void HullKernel::Impl::erase_facet(size_t f) {
    const size_t last = facets_.size() - 1;
    if (f != last) {
        facets_.corners[f] = facets_.corners[last];
        facets_.neighbours[f] = facets_.neighbours[last];
        for (auto* v : {&facets_.x, &facets_.y, &facets_.z, &facets_.offset, &facets_.error}) (*v)[f] = (*v)[last];
        for (int32_t n : facets_.neighbours[f]) {
            Triangle& back = facets_.neighbours[static_cast<size_t>(n)];
            *std::find(back.begin(), back.end(), static_cast<int32_t>(last)) = static_cast<int32_t>(f);
        }
    }
    facets_.resize(last);
}

// Returns false if the vertex is in the hull already.
bool HullKernel::Impl::insert(int32_t vertex) {
    const Point& p = at(vertex);
    if (!classify(view(facets_), p)) return false;
    volume6_ += six_volumes_seen(view(facets_), p);

    if (facet_mark_.size() < facets_.size()) facet_mark_.resize(2 * facets_.size(), 0);
    ++facet_stamp_;
    for (uint32_t f : seen_) facet_mark_[f] = facet_stamp_;
    rim_.clear();
    for (uint32_t f : seen_)
        for (size_t k = 0; k < 3; ++k) {
            const int32_t beyond = facets_.neighbours[f][k];
            if (facet_mark_[static_cast<size_t>(beyond)] != facet_stamp_)
                rim_.push_back({facets_.corners[f][k], facets_.corners[f][(k + 1) % 3], beyond});
        }

    // The new facets take the places of those that go, then further ones.
    const size_t before = facets_.size();
    if (rim_.size() > seen_.size()) facets_.resize(before + rim_.size() - seen_.size());
    const auto place = [&](size_t i) { return i < seen_.size() ? size_t{seen_[i]} : before + i - seen_.size(); };
    for (size_t i = 0; i < rim_.size(); ++i) {
        const auto [from, to, beyond] = rim_[i];
        const size_t f = place(i);
        set_facet(f, {from, to, vertex});
        facets_.neighbours[f][0] = beyond;
        const Triangle& across = facets_.corners[static_cast<size_t>(beyond)];
        const auto k = static_cast<size_t>(std::find(across.begin(), across.end(), to) - across.begin());
        facets_.neighbours[static_cast<size_t>(beyond)][k] = static_cast<int32_t>(f);
        facet_from_[static_cast<size_t>(from)] = static_cast<int32_t>(f);
    }
    for (size_t i = 0; i < rim_.size(); ++i) {
        const size_t f = place(i);
        const int32_t next = facet_from_[static_cast<size_t>(rim_[i].to)];
        facets_.neighbours[f][1] = next;
        facets_.neighbours[static_cast<size_t>(next)][2] = static_cast<int32_t>(f);
    }
    for (size_t i = seen_.size(); i-- > rim_.size();) erase_facet(seen_[i]);
    return true;
}

Hull HullKernel::Impl::unload() {
    Hull hull;
    hull.facets = facets_.corners;
    hull.neighbours = facets_.neighbours;
    hull.planes.reserve(5 * facets_.size());
    for (const auto* v : {&facets_.x, &facets_.y, &facets_.z, &facets_.offset, &facets_.error})
        hull.planes.insert(hull.planes.end(), v->begin(), v->end());
    ++stamp_;
    for (const Triangle& f : hull.facets)
        for (int32_t v : f)
            if (std::exchange(mark_[static_cast<size_t>(v)], stamp_) != stamp_) hull.vertices.push_back(v);
    // Measured anew, so that rounding doesn't pile up over a long chain of unions.
    const Point& apex = at(hull.vertices[0]);
    double sum = 0;
    for (const Triangle& f : hull.facets) sum -= six_volumes(at(f[0]), at(f[1]), at(f[2]), apex);
    hull.volume = sum / 6;
    return hull;
}

// Starts with four of these points that span a tetrahedron; false if all lie in one plane.
bool HullKernel::Impl::load_simplex(std::span<const int32_t> vertices) {
    united_ = {};
    const auto first = vertices.begin(), end = vertices.end();
    if (first == end) return false;
    const Point& a = at(*first);
    const auto second = std::find_if(first, end, [&](int32_t v) { return at(v) != a; });
    if (second == end) return false;
    const Point& b = at(*second);
    const auto third = std::find_if(second, end, [&](int32_t v) { return !collinear(a, b, at(v)); });
    if (third == end) return false;
    const Point& c = at(*third);
    const auto fourth = std::find_if(first, end, [&](int32_t v) { return orientation(a, b, c, at(v)) != 0; });
    if (fourth == end) return false;

    std::array<int32_t, 4> t = {*first, *second, *third, *fourth};
    if (orientation(a, b, c, at(t[3])) < 0) std::swap(t[0], t[1]);
    facets_.resize(4);
    set_facet(0, {t[0], t[2], t[1]});
    set_facet(1, {t[0], t[1], t[3]});
    set_facet(2, {t[1], t[2], t[3]});
    set_facet(3, {t[2], t[0], t[3]});
    facets_.neighbours = {{3, 2, 1}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
    inside_ = {};
    for (int32_t v : t)
        for (size_t k = 0; k < 3; ++k) inside_[k] += at(v)[k] / 4;
    volume6_ = six_volumes(at(t[0]), at(t[1]), at(t[2]), at(t[3]));
    return true;
}

Hull HullKernel::Impl::build(std::span<const int32_t> vertices) {
    // Extreme points first: most others are then inside from the start.
    std::vector<int32_t> order;
    for (int direction = 0; direction < 13 && vertices.size() > 32; ++direction) {
        const int code = direction + 14;  // the 13 lattice directions of a half space, in base 3
        const Point d = {static_cast<double>(code / 9 - 1), static_cast<double>(code / 3 % 3 - 1),
                         static_cast<double>(code % 3 - 1)};
        const auto [low, high] = std::minmax_element(
            vertices.begin(), vertices.end(), [&](int32_t v, int32_t w) { return dot(at(v), d) < dot(at(w), d); });
        order.push_back(*low);
        order.push_back(*high);
    }
    order.insert(order.end(), vertices.begin(), vertices.end());

    if (!load_simplex(order)) {
        Hull flat;
        ++stamp_;
        for (int32_t v : vertices)
            if (std::exchange(mark_[static_cast<size_t>(v)], stamp_) != stamp_) flat.vertices.push_back(v);
        return flat;
    }
    ++stamp_;
    for (const Triangle& f : facets_.corners)
        for (int32_t v : f) mark_[static_cast<size_t>(v)] = stamp_;
    for (int32_t v : order)
        if (std::exchange(mark_[static_cast<size_t>(v)], stamp_) != stamp_) insert(v);
    return unload();
}

// Marks the hull's vertices and finds a point inside it.
void HullKernel::Impl::prepare(const Hull& hull) {
    ++stamp_;
    for (int32_t v : hull.vertices) mark_[static_cast<size_t>(v)] = stamp_;
    seen_.clear();
    inside_ = {};
    const auto count = static_cast<double>(hull.vertices.size());
    for (int32_t v : hull.vertices)
        for (size_t k = 0; k < 3; ++k) inside_[k] += at(v)[k] / count;
}

Hull HullKernel::Impl::unite(const Hull& a, const Hull& b) {
    if (a.facets.empty() && b.facets.empty()) {
        std::vector<int32_t> all = a.vertices;
        all.insert(all.end(), b.vertices.begin(), b.vertices.end());
        return build(all);
    }
    // Often its volume has just been asked for.
    if (std::exchange(united_, {}) == std::pair(&a, &b)) return unload();
    const Hull& large = a.facets.size() >= b.facets.size() ? a : b;
    const Hull& small = &large == &a ? b : a;
    prepare(large);
    load(large);
    bool grown = false;
    for (int32_t v : small.vertices)
        if (mark_[static_cast<size_t>(v)] != stamp_) grown |= insert(v);
    return grown ? unload() : large;
}

double HullKernel::Impl::united_volume(const Hull& a, const Hull& b) {
    if (a.facets.empty() && b.facets.empty()) return unite(a, b).volume;
    const Hull& large = a.facets.size() >= b.facets.size() ? a : b;
    const Hull& small = &large == &a ? b : a;
    prepare(large);
    const FacetsView facets = view(large);

    // While only one point is outside, nothing is built.
    int32_t outside = -1;
    double seen = 0;
    bool loaded = false;
    for (int32_t v : small.vertices) {
        if (mark_[static_cast<size_t>(v)] == stamp_) continue;
        if (loaded) {
            insert(v);
        } else if (classify(facets, at(v))) {
            if (outside < 0) {
                outside = v;
                seen = six_volumes_seen(facets, at(v));
            } else {
                load(large);
                insert(outside);
                insert(v);
                loaded = true;
            }
        }
    }
    if (!loaded) return large.volume + seen / 6;
    united_ = {&a, &b};
    return volume6_ / 6;
}

std::pair<Point, Point> HullKernel::Impl::bounds(const Hull& hull) const {
    Point low = at(hull.vertices.at(0)), high = low;
    for (int32_t v : hull.vertices)
        for (size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], at(v)[k]);
            high[k] = std::max(high[k], at(v)[k]);
        }
    return {low, high};
}

HullKernel::HullKernel(std::span<const Point> points) : impl_(std::make_unique<Impl>(points)) {}
HullKernel::~HullKernel() = default;
Hull HullKernel::build(std::span<const int32_t> vertices) { return impl_->build(vertices); }
Hull HullKernel::unite(const Hull& a, const Hull& b) { return impl_->unite(a, b); }
double HullKernel::united_volume(const Hull& a, const Hull& b) { return impl_->united_volume(a, b); }
std::pair<Point, Point> HullKernel::bounds(const Hull& hull) const { return impl_->bounds(hull); }

}  // namespace partwheel
