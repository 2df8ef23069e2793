// Convex hulls by insertion of points (beneath-beyond).
//
// A point that sees no facet from strictly outside is in the hull. Otherwise all facets that it sees, those in whose
// plane it lies included, are taken away, and the rim of the hole is joined to it. Taking the coplanar ones away too
// keeps the vertices exactly the extreme points, and no degenerate facet can arise: an edge of the rim has a facet on
// its far side that strictly doesn't see the point, so the point is not on the edge's line.
#include "cluster/hull/view.h"

namespace partwheel {

HullKernel::HullKernel(std::span<const Point> points) {
    points_.reserve(points.size());
    for (const Point& p : points) points_.push_back({p});
    reserve(64);
}

void HullKernel::make_room(size_t facets) {
    const size_t room = 6 * facets + 6;
    for (auto* numbers : {&x_, &y_, &z_, &offset_, &size_}) numbers->resize(room);
    facets_.resize(room);
    seen_.resize(room + 1);
    rim_.resize(3 * room + 1);
    facet_mark_.resize(room, 0);
}

// The plane of a facet whose corners are there.
void HullKernel::make_plane(size_t f) {
    const Triangle& corners = facets_[f].corners;
    const Point& c = at(corners[2]);
    const Point u = at(corners[0]) - c, v = at(corners[1]) - c;
    const Point n = cross(u, v);
    x_[f] = n[0];
    y_[f] = n[1];
    z_[f] = n[2];
    offset_[f] = dot(n, c - origin_);
    size_[f] = std::fabs(u[1] * v[2]) + std::fabs(u[2] * v[1]) + std::fabs(u[2] * v[0]) + std::fabs(u[0] * v[2]) +
               std::fabs(u[0] * v[1]) + std::fabs(u[1] * v[0]);
}

// The planes of the facets between the rim and the vertex, two at a time, as make_plane() gives them: they go to the
// places in seen_. p is the vertex relative to the origin.
void HullKernel::make_facets(std::span<const RimEdge> rim, const Point& p, int32_t vertex) {
    const Point& c = at(vertex);
    for (size_t i = 0; i < rim.size(); i += 2) {
        const size_t j = std::min(i + 1, rim.size() - 1);
        const Point &from0 = at(rim[i].from), &to0 = at(rim[i].to), &from1 = at(rim[j].from), &to1 = at(rim[j].to);
        Two u[3], v[3];
        for (size_t k = 0; k < 3; ++k) {
            u[k] = Two{from0[k], from1[k]} - c[k];
            v[k] = Two{to0[k], to1[k]} - c[k];
        }
        const Two yz = u[1] * v[2], zy = u[2] * v[1], zx = u[2] * v[0], xz = u[0] * v[2], xy = u[0] * v[1],
                   yx = u[1] * v[0];
        const Two x = yz - zy, y = zx - xz, z = xy - yx;
        const Two size = magnitude(yz) + magnitude(zy) + magnitude(zx) + magnitude(xz) + magnitude(xy) + magnitude(yx);
        const Two offset = x * p[0] + y * p[1] + z * p[2];
        for (size_t k = 0; k < 2; ++k) {
            const size_t f = seen_[k == 0 ? i : j];
            x_[f] = x[k];
            y_[f] = y[k];
            z_[f] = z[k];
            offset_[f] = offset[k];
            size_[f] = size[k];
        }
    }
}

// Takes the vertex that was looked at last into the hull at work.
void HullKernel::attach(int32_t vertex) {
    if (rim_count_ == 0) return;
    const Point p = at(vertex) - origin_;
    reach_ = std::max(reach_, reach_of(p));

    // The new facets take the places of those that go, then gaps, then further places.
    const std::span<const RimEdge> rim(rim_.data(), rim_count_);
    size_t places = std::min(seen_count_, rim.size());
    for (; places < rim.size() && !gaps_.empty(); gaps_.pop_back()) seen_[places++] = gaps_.back();
    while (places < rim.size()) seen_[places++] = static_cast<uint32_t>(count_++);
    for (size_t i = rim.size(); i < seen_count_; ++i) {
        gaps_.push_back(seen_[i]);
        offset_[seen_[i]] = HUGE_VAL;  // no point sees it
    }
    latest_ = seen_[0];
    make_facets(rim, p, vertex);
    HullFacet* const facets = facets_.data();
    Vertex* const points = points_.data();
    for (size_t i = 0; i < rim.size(); ++i) {
        const auto [from, to, beyond] = rim[i];
        const uint32_t f = seen_[i];
        facets[f].corners = {from, to, vertex};
        facets[f].neighbours[0] = beyond;
        HullFacet& across = facets[beyond];
        const size_t k = size_t{across.corners[1] == to} + 2 * size_t{across.corners[2] == to};
        across.neighbours[k] = static_cast<int32_t>(f);
        points[from].facet_from = static_cast<int32_t>(f);
    }
    for (size_t i = 0; i < rim.size(); ++i) {
        const int32_t next = points[rim[i].to].facet_from;
        facets[seen_[i]].neighbours[1] = next;
        facets[next].neighbours[2] = static_cast<int32_t>(seen_[i]);
    }
}

// Starts with four of these points that span a tetrahedron; false if all lie in one plane.
bool HullKernel::load_simplex(std::span<const int32_t> vertices) {
    const auto first = vertices.begin(), end = vertices.end();
    if (first == end) return false;
    auto second = first, third = first, fourth = first;
    // Mostly the first four do: without asking that at once, clustering takes up to a tenth longer.
    if (vertices.size() >= 4 &&
        orientation(at(vertices[0]), at(vertices[1]), at(vertices[2]), at(vertices[3])) != 0) {
        second = first + 1;
        third = first + 2;
        fourth = first + 3;
    } else {
        const Point& a = at(*first);
        second = std::find_if(first, end, [&](int32_t v) { return at(v) != a; });
        if (second == end) return false;
        const Point& b = at(*second);
        third = std::find_if(second, end, [&](int32_t v) { return !collinear(a, b, at(v)); });
        if (third == end) return false;
        const Point& c = at(*third);
        fourth = std::find_if(first, end, [&](int32_t v) { return orientation(a, b, c, at(v)) != 0; });
        if (fourth == end) return false;
    }

    std::array<int32_t, 4> t = {*first, *second, *third, *fourth};
    if (orientation(at(t[0]), at(t[1]), at(t[2]), at(t[3])) < 0) std::swap(t[0], t[1]);
    origin_ = {};
    for (const int32_t v : t)
        for (size_t k = 0; k < 3; ++k) origin_[k] += at(v)[k] / 4;
    reach_ = 0;
    for (const int32_t v : t) reach_ = std::max(reach_, reach_of(at(v) - origin_));
    const HullFacet facets[] = {{{t[0], t[2], t[1]}, {3, 2, 1}},
                                {{t[0], t[1], t[3]}, {0, 2, 3}},
                                {{t[1], t[2], t[3]}, {0, 3, 1}},
                                {{t[2], t[0], t[3]}, {0, 1, 2}}};
    count_ = 4;
    gaps_.clear();
    latest_ = 0;
    for (size_t f = 0; f < 4; ++f) {
        facets_[f] = facets[f];
        make_plane(f);
    }
    // Once it is inside it stays there.
    centred_ = true;
    for (size_t f = 0; f < 4; ++f) centred_ &= offset_[f] > side_error * reach_ * size_[f];
    volume6_ = six_volumes(at(t[0]), at(t[1]), at(t[2]), at(t[3]));
    return true;
}

Hull HullKernel::build(std::span<const int32_t> vertices) {
    surveyed_ = nullptr;
    // Extreme points first: most others are then inside from the start.
    std::vector<int32_t>& order = vertices_;
    order.clear();
    const bool many = vertices.size() > 32;
    for (size_t i = 0; i < lattice_directions && many; ++i) {
        const Point d = lattice_direction(i);
        double least = HUGE_VAL, most = -HUGE_VAL;
        int32_t low = vertices[0], high = low;
        for (const int32_t v : vertices) {
            const double along = dot(at(v), d);
            if (along < least) low = v, least = along;
            if (along >= most) high = v, most = along;
        }
        order.push_back(low);
        order.push_back(high);
    }
    order.insert(order.end(), vertices.begin(), vertices.end());
    if (many) {  // of several tetrahedra: each vertex many times
        ++stamp_;
        std::erase_if(order, [&](int32_t v) { return marked(v) || (mark(v), false); });
    }

    if (!load_simplex(order)) {
        std::sort(order.begin(), order.end());
        order.erase(std::unique(order.begin(), order.end()), order.end());
        return allocate(order, 0);
    }
    mark_corners();
    for (const int32_t v : order)
        if (!marked(v)) {
            mark(v);
            insert(v);
        }
    std::sort(order.begin(), order.end());
    order.erase(std::unique(order.begin(), order.end()), order.end());
    return unload(order, {});
}

}  // namespace partwheel
