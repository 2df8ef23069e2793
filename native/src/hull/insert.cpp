// Convex hulls by inserting points (beneath-beyond).
//
// A point is inside unless some facet is strictly visible from it. Otherwise all visible facets, including those whose
// plane contains the point, are removed, and the point is connected to their horizon. Removing the coplanar facets too
// keeps exactly the extreme points as vertices. No facet can be degenerate: the facet beyond a horizon edge is strictly
// invisible, so the point is not on the edge's line. Of many coplanar facets only those are removed for which either
// could happen, see add_coplanar_facets().
#include "hull/view.h"

#include "base/sorted.h"

namespace partwheel {
HullKernel::HullKernel(std::span<const Point> points, Progress& progress) : progress_(progress) {
    points_.reserve(points.size());
    for (const Point& p : points) points_.push_back({p});
    reserve(64);
}

void HullKernel::grow_scratch(size_t facets) {
    const size_t capacity = 6 * facets + 6;
    for (auto* numbers : {&x_, &y_, &z_, &offset_, &size_}) numbers->resize(capacity);
    facets_.resize(capacity);
    visible_.resize(capacity + 1);
    horizon_.resize(3 * capacity + 1);
    facet_mark_.resize(capacity, 0);
}

// The planes of two facets, whose corners are set.
void HullKernel::compute_planes(size_t f, size_t g) {
    const auto both = [&](size_t corner, size_t k) {
        return Double2{at(facets_[f].corners[corner])[k], at(facets_[g].corners[corner])[k]};
    };
    Double2 u[3], v[3], p[3];
    for (size_t k = 0; k < 3; ++k) {
        const Double2 c = both(2, k);
        u[k] = both(0, k) - c;
        v[k] = both(1, k) - c;
        p[k] = c - origin_[k];
    }
    const Double2 yz = u[1] * v[2], zy = u[2] * v[1], zx = u[2] * v[0], xz = u[0] * v[2], xy = u[0] * v[1], yx = u[1] * v[0];
    const Double2 x = yz - zy, y = zx - xz, z = xy - yx, offset = x * p[0] + y * p[1] + z * p[2];
    const Double2 size = magnitude(yz) + magnitude(zy) + magnitude(zx) + magnitude(xz) + magnitude(xy) + magnitude(yx);
    for (const auto& [facet, k] : {std::pair(f, 0), std::pair(g, 1)}) {
        x_[facet] = x[k];
        y_[facet] = y[k];
        z_[facet] = z[k];
        offset_[facet] = offset[k];
        size_[facet] = size[k];
    }
}

// To the mean of all corners, if that is certainly inside. A hull's first tetrahedron, which has its origin, may be
// almost flat.
void HullKernel::move_origin_inside() {
    count_visits(count_);
    const auto for_each_facet = [&](const auto& visit) {
        for (size_t f = 0; f < count_; ++f)
            if (offset_[f] < HUGE_VAL) visit(f);  // else free
    };
    Point sum{};
    for_each_facet([&](size_t f) {
        for (const int32_t v : facets_[f].corners) sum = sum + at(v);
    });
    origin_ = 1 / (3.0 * static_cast<double>(count_ - free_facets_.size())) * sum;
    radius_ = 0;
    for_each_facet([&](size_t f) {
        compute_planes(f, f);
        for (const int32_t v : facets_[f].corners) radius_ = std::max(radius_, radius_of(at(v) - origin_));
    });
    origin_is_inside_ = true;
    for_each_facet([&](size_t f) { origin_is_inside_ &= offset_[f] > side_error * radius_ * size_[f]; });
}

// Adds the vertex of the last find_visible() to the loaded hull.
void HullKernel::replace_visible_facets(int32_t vertex) {
    if (horizon_count_ == 0) return;
    radius_ = std::max(radius_, radius_of(at(vertex) - origin_));

    // New facets reuse the entries of the visible facets, then free entries, then new ones.
    const std::span<const HorizonEdge> horizon(horizon_.data(), horizon_count_);
    size_t n_entries = std::min(visible_count_, horizon.size());
    for (; n_entries < horizon.size() && !free_facets_.empty(); free_facets_.pop_back())
        visible_[n_entries++] = free_facets_.back();
    while (n_entries < horizon.size()) visible_[n_entries++] = static_cast<uint32_t>(count_++);
    for (size_t i = horizon.size(); i < visible_count_; ++i) {
        free_facets_.push_back(visible_[i]);
        offset_[visible_[i]] = HUGE_VAL;  // visible from no point
    }
    newest_facet_ = visible_[0];
    HullFacet* const facets = facets_.data();
    Vertex* const points = points_.data();
    for (size_t i = 0; i < horizon.size(); ++i) {
        const auto [from, to, beyond] = horizon[i];
        const uint32_t f = visible_[i];
        facets[f].corners = {from, to, vertex};
        facets[f].neighbors[0] = beyond;
        HullFacet& across = facets[beyond];
        const size_t k = size_t{across.corners[1] == to} + 2 * size_t{across.corners[2] == to};
        across.neighbors[k] = static_cast<int32_t>(f);
        points[from].facet_from = static_cast<int32_t>(f);
    }
    for (size_t i = 0; i < horizon.size(); ++i) {
        const int32_t next = points[horizon[i].to].facet_from;
        facets[visible_[i]].neighbors[1] = next;
        facets[next].neighbors[2] = static_cast<int32_t>(visible_[i]);
    }
    for (size_t i = 0; i < horizon.size(); i += 2)
        compute_planes(visible_[i], visible_[std::min(i + 1, horizon.size() - 1)]);
}

// Loads a tetrahedron of four of these points; false if all are coplanar.
bool HullKernel::load_simplex(std::span<const int32_t> vertices) {
    const auto first = vertices.begin(), end = vertices.end();
    if (first == end) return false;
    auto second = first, third = first, fourth = first;
    // Usually the first four work. Without this shortcut, clustering takes up to 10 % longer.
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
    radius_ = 0;
    for (const int32_t v : t) radius_ = std::max(radius_, radius_of(at(v) - origin_));
    const HullFacet facets[] = {{{t[0], t[2], t[1]}, {3, 2, 1}},
                                {{t[0], t[1], t[3]}, {0, 2, 3}},
                                {{t[1], t[2], t[3]}, {0, 3, 1}},
                                {{t[2], t[0], t[3]}, {0, 1, 2}}};
    count_ = 4;
    free_facets_.clear();
    newest_facet_ = 0;
    for (size_t f = 0; f < 4; ++f) {
        facets_[f] = facets[f];
        compute_planes(f, f);
    }
    // Once inside, the origin stays inside.
    origin_is_inside_ = true;
    for (size_t f = 0; f < 4; ++f) origin_is_inside_ &= offset_[f] > side_error * radius_ * size_[f];
    volume6_ = signed_volume6(at(t[0]), at(t[1]), at(t[2]), at(t[3]));
    return true;
}

// Sorts vertices into rounds, each of about twice as many as the one before, spread evenly over all of them and in the
// same order (a biased randomized insertion order: Amenta, Choi, Rote 2003). Points in the order of a circle would each
// see a share of all facets.
void HullKernel::spread_out(std::span<int32_t> vertices) {
    std::ranges::stable_sort(vertices, std::greater(), [](int32_t v) {
        return std::countl_zero(static_cast<uint64_t>(v) * 0x9e3779b97f4a7c15);  // 2^64 times the golden ratio
    });
}

Hull HullKernel::build(std::span<const int32_t> vertices) {
    candidates_hull_ = nullptr;
    // Insert extreme points first, so that most others are inside from the start.
    std::vector<int32_t>& order = vertices_;
    order.clear();
    const bool is_large = vertices.size() > 32;
    for (size_t i = 0; i < lattice_directions && is_large; ++i) {
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
    if (is_large) {  // the vertices of several tetrahedra, with many duplicates
        ++stamp_;
        std::erase_if(order, [&](int32_t v) { return is_marked(v) || (mark(v), false); });
    }

    if (!load_simplex(order)) {
        sort_unique(order);
        return allocate(order, 0);
    }
    mark_corners();
    bool is_spread_out = false;
    for (size_t i = 0; i < order.size(); ++i) {
        if (count_ > max_searched_facets && !std::exchange(is_spread_out, true)) spread_out(std::span(order).subspan(i));
        if (is_marked(order[i])) continue;
        mark(order[i]);
        insert(order[i]);
    }
    return unload({}, order);
}

}  // namespace partwheel
