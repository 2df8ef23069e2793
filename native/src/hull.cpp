// Convex hulls by insertion of points (beneath-beyond), on flat arrays without adjacency: the hulls of clusters are small.
//
// A point that sees no facet from strictly outside is in the hull. Otherwise all facets that it sees, those in whose
// plane it lies included, are taken away, and the rim of the hole is joined to it. Taking the coplanar ones away too
// keeps the vertices exactly the extreme points, and no degenerate facet can arise: an edge of the rim has a facet on
// its far side that strictly doesn't see the point, so the point is not on the edge's line.
#include "hull.h"

#include "predicates.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace partwheel {

namespace {

// The facets' planes as a structure of arrays: side(p) = x px + y py + z pz - offset is six times the volume of facet
// and p, wrong by at most `error`.
struct Planes {
    std::vector<double> x, y, z, offset, error;

    size_t size() const { return x.size(); }
    void clear() { resize(0); }
    void resize(size_t n) {
        for (auto* v : {&x, &y, &z, &offset, &error}) v->resize(n);
    }
    void move(size_t from, size_t to) {
        for (auto* v : {&x, &y, &z, &offset, &error}) (*v)[to] = (*v)[from];
    }
};

// The same five arrays wherever they are.
struct PlanesView {
    const double *x, *y, *z, *offset, *error;
    size_t size;
};

PlanesView view(const Planes& p) {
    return {p.x.data(), p.y.data(), p.z.data(), p.offset.data(), p.error.data(), p.size()};
}

PlanesView view(const Hull& hull) {
    const size_t n = hull.facets.size();
    const double* p = hull.planes.data();
    return {p, p + n, p + 2 * n, p + 3 * n, p + 4 * n, n};
}

}  // namespace

class HullKernel::Impl {
public:
    explicit Impl(std::span<const Point> points) : points_(points), mark_(points.size(), 0) {
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
    double six_volumes_of(const Triangle& f, const Point& p) const {
        return six_volumes(at(f[0]), at(f[1]), at(f[2]), p);
    }

    bool classify(const PlanesView& planes, const Triangle* facets, const Point& p);
    double six_volumes_seen(const Triangle* facets, const Point& p) const;

    void load(const Hull& hull);
    void add_facet(const Triangle& f);
    bool insert(int32_t vertex);
    Hull unload();
    bool load_simplex(std::span<const int32_t> vertices);

    void mark_vertices(const Hull& hull);

    std::span<const Point> points_;
    double error_factor_ = 0;

    // The hull at work. If united_ is set, it is the union of these two.
    std::pair<const Hull*, const Hull*> united_{};
    std::vector<Triangle> facets_;
    Planes planes_;
    double volume6_ = 0;

    // Scratch.
    struct RimEdge {
        uint64_t key;  // of the undirected edge
        int32_t from, to;
    };
    std::vector<uint32_t> seen_;  // facets that the last point classified sees
    std::vector<RimEdge> edges_;
    std::vector<uint32_t> mark_;  // mark_[v] == stamp_: v is a vertex of the hull in question
    uint32_t stamp_ = 0;
};

// Whether p is strictly outside. If so, seen_ holds the facets that see it, strictly or in whose plane it lies.
bool HullKernel::Impl::classify(const PlanesView& planes, const Triangle* facets, const Point& p) {
    // Whole blocks of facets that surely don't see p are passed over: the loop inside has no branch.
    constexpr size_t block = 8;
    double side[block];
    seen_.clear();
    bool outside = false;
    for (size_t begin = 0; begin < planes.size; begin += block) {
        const size_t n = std::min(block, planes.size - begin);
        double highest = -1;
        for (size_t i = 0; i < n; ++i) {
            const size_t f = begin + i;
            side[i] = planes.x[f] * p[0] + planes.y[f] * p[1] + planes.z[f] * p[2] - planes.offset[f];
            highest = std::max(highest, side[i] + planes.error[f]);
        }
        if (highest < 0) continue;
        for (size_t i = 0; i < n; ++i) {
            const size_t f = begin + i;
            if (side[i] < -planes.error[f]) continue;
            int sign = 1;
            if (side[i] <= planes.error[f]) {
                sign = orientation(at(facets[f][0]), at(facets[f][1]), at(facets[f][2]), p);
                if (sign < 0) continue;
            }
            outside |= sign > 0;
            seen_.push_back(static_cast<uint32_t>(f));
        }
    }
    return outside;
}

// Six times the volume between p and the facets it sees; after classify().
double HullKernel::Impl::six_volumes_seen(const Triangle* facets, const Point& p) const {
    double sum = 0;
    for (uint32_t f : seen_) sum += six_volumes_of(facets[f], p);
    return sum;
}

void HullKernel::Impl::load(const Hull& hull) {
    united_ = {};
    facets_ = hull.facets;
    const PlanesView from = view(hull);
    planes_.x.assign(from.x, from.x + from.size);
    planes_.y.assign(from.y, from.y + from.size);
    planes_.z.assign(from.z, from.z + from.size);
    planes_.offset.assign(from.offset, from.offset + from.size);
    planes_.error.assign(from.error, from.error + from.size);
    volume6_ = 6 * hull.volume;
}

void HullKernel::Impl::add_facet(const Triangle& f) {
    const Point& a = at(f[0]);
    const Point u = at(f[1]) - a, v = at(f[2]) - a;
    const Point n = cross(u, v);
    const double size = std::fabs(u[1] * v[2]) + std::fabs(u[2] * v[1]) + std::fabs(u[2] * v[0]) +
                        std::fabs(u[0] * v[2]) + std::fabs(u[0] * v[1]) + std::fabs(u[1] * v[0]);
    facets_.push_back(f);
    planes_.x.push_back(n[0]);
    planes_.y.push_back(n[1]);
    planes_.z.push_back(n[2]);
    planes_.offset.push_back(dot(n, a));
    planes_.error.push_back(error_factor_ * size);
}

// Returns false if the vertex is in the hull already.
bool HullKernel::Impl::insert(int32_t vertex) {
    const Point& p = at(vertex);
    if (!classify(view(planes_), facets_.data(), p)) return false;
    volume6_ += six_volumes_seen(facets_.data(), p);

    edges_.clear();
    const auto add_edge = [&](int32_t from, int32_t to) {
        const auto [low, high] = std::minmax({static_cast<uint32_t>(from), static_cast<uint32_t>(to)});
        edges_.push_back({uint64_t{low} << 32 | high, from, to});
    };
    // The last facets move into the gaps.
    size_t count = facets_.size();
    for (size_t i = seen_.size(); i-- > 0;) {
        const Triangle t = facets_[seen_[i]];
        add_edge(t[0], t[1]);
        add_edge(t[1], t[2]);
        add_edge(t[2], t[0]);
        --count;
        facets_[seen_[i]] = facets_[count];
        planes_.move(count, seen_[i]);
    }
    facets_.resize(count);
    planes_.resize(count);

    // Edges inside the hole come twice, those of its rim once.
    std::sort(edges_.begin(), edges_.end(), [](const RimEdge& a, const RimEdge& b) { return a.key < b.key; });
    for (size_t e = 0; e < edges_.size(); ++e) {
        if (e + 1 < edges_.size() && edges_[e].key == edges_[e + 1].key)
            ++e;
        else
            add_facet({edges_[e].from, edges_[e].to, vertex});
    }
    return true;
}

Hull HullKernel::Impl::unload() {
    Hull hull;
    hull.facets = facets_;
    hull.planes.reserve(5 * facets_.size());
    for (const auto* v : {&planes_.x, &planes_.y, &planes_.z, &planes_.offset, &planes_.error})
        hull.planes.insert(hull.planes.end(), v->begin(), v->end());
    ++stamp_;
    for (const Triangle& f : facets_)
        for (int32_t v : f)
            if (std::exchange(mark_[static_cast<size_t>(v)], stamp_) != stamp_) hull.vertices.push_back(v);
    // Measured anew, so that rounding doesn't pile up over a long chain of unions.
    const Point& apex = at(facets_[0][0]);
    double sum = 0;
    for (const Triangle& f : facets_) sum -= six_volumes_of(f, apex);
    hull.volume = sum / 6;
    return hull;
}

// Starts with four of these points that span a tetrahedron; false if all lie in one plane.
bool HullKernel::Impl::load_simplex(std::span<const int32_t> vertices) {
    united_ = {};
    facets_.clear();
    planes_.clear();
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
    add_facet({t[0], t[2], t[1]});
    add_facet({t[0], t[1], t[3]});
    add_facet({t[1], t[2], t[3]});
    add_facet({t[2], t[0], t[3]});
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
    for (const Triangle& f : facets_)
        for (int32_t v : f) mark_[static_cast<size_t>(v)] = stamp_;
    for (int32_t v : order)
        if (std::exchange(mark_[static_cast<size_t>(v)], stamp_) != stamp_) insert(v);
    return unload();
}

void HullKernel::Impl::mark_vertices(const Hull& hull) {
    ++stamp_;
    for (int32_t v : hull.vertices) mark_[static_cast<size_t>(v)] = stamp_;
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
    mark_vertices(large);
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
    mark_vertices(large);
    const PlanesView planes = view(large);
    const Triangle* facets = large.facets.data();

    // While only one point is outside, nothing is built.
    int32_t outside = -1;
    double seen = 0;
    bool loaded = false;
    for (int32_t v : small.vertices) {
        if (mark_[static_cast<size_t>(v)] == stamp_) continue;
        if (loaded) {
            insert(v);
        } else if (classify(planes, facets, at(v))) {
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
