// Nearest points by box trees; the one-sided Hausdorff distance by branch and bound.
#include "convex/distance.h"

#include "base/adjacency.h"
#include "base/corners.h"
#include "base/morton.h"

#include <queue>

namespace partwheel::convex {

namespace {

constexpr double rounding = 1e-12;  // a point this close to a facet counts as inside

template <class Item>
std::vector<Box> boxes_of(std::span<const Point> points, std::span<const Item> items) {
    std::vector<Box> boxes;
    for (const Item& item : items) boxes.push_back(Box::around(corner_points(points, item)));
    return boxes;
}

// The items along a space-filling curve.
template <class Item>
std::vector<Item> sort_on_curve(std::span<const Point> points, std::span<const Item> items) {
    std::vector<Point> centers;
    for (const Item& item : items) centers.push_back(centroid(points, item));
    std::vector<Item> sorted;
    for (const int32_t i : order_on_curve(centers)) sorted.push_back(items[idx(i)]);
    return sorted;
}

std::vector<Triangle> surface_of(std::span<const Tetrahedron> tetrahedra) {
    std::vector<Triangle> surface;
    for (const BoundaryFacet& f : boundary_facets(tetrahedra)) surface.push_back(f.corners);
    return surface;
}

// Largest first: they raise the lower bound, which discards the small ones. Each point of a triangle is within this
// distance, longest side / sqrt(3), of a corner.
std::vector<std::pair<double, Triangle>> triangles_by_size(const TriangleMesh& surface) {
    std::vector<std::pair<double, Triangle>> by_size;
    for (const Triangle& t : surface.triangles) {
        double longest = 0;
        for (size_t k = 0; k < 3; ++k)
            longest = std::max(longest, squared(surface.vertices[idx(t[k])] - surface.vertices[idx(t[(k + 1) % 3])]));
        by_size.push_back({std::sqrt(longest / 3), t});
    }
    std::ranges::sort(by_size, std::greater{});
    return by_size;
}

// A triangle of a surface, or a part of one.
struct BoundedTriangle {
    double upper_bound;  // of the distance of its points
    std::array<Point, 3> corners;
    Point near;  // a point of the solid

    bool operator<(const BoundedTriangle& other) const {
        return std::tie(upper_bound, corners) < std::tie(other.upper_bound, other.corners);
    }
};

// Two triangles with half the longest side.
std::array<std::array<Point, 3>, 2> bisect(const std::array<Point, 3>& corners) {
    size_t k = 0;
    const auto side = [&](size_t i) { return squared(corners[(i + 1) % 3] - corners[i]); };
    for (size_t i = 1; i < 3; ++i)
        if (side(i) > side(k)) k = i;
    const Point &a = corners[k], &b = corners[(k + 1) % 3], &c = corners[(k + 2) % 3], middle = 0.5 * (a + b);
    return {{{a, middle, c}, {middle, b, c}}};
}

}  // namespace

std::vector<BoundaryFacet> boundary_facets(std::span<const Tetrahedron> tetrahedra) {
    std::vector<BoundaryFacet> outer;
    for_each_facet(tetrahedra, [&](std::span<const TetFacet> facets) {
        const auto& [middle, high, tet, corner] = facets[0];
        if (facets.size() == 1) outer.push_back({facet(tetrahedra[idx(tet)], idx(corner)), tet});
    });
    return outer;
}

SolidDistance::SolidDistance(std::span<const Point> points, std::span<const Tetrahedron> tetrahedra, Progress& progress)
    : points_(points), progress_(progress), tetrahedra_(sort_on_curve(points, tetrahedra)) {
    progress.reach(0);
    const std::vector<Triangle> surface = surface_of(tetrahedra);
    progress.reach(0);
    surface_ = sort_on_curve(points, std::span<const Triangle>(surface));
    tet_tree_ = Bvh(boxes_of(points, std::span<const Tetrahedron>(tetrahedra_)));
    progress.reach(0);
    surface_tree_ = Bvh(boxes_of(points, std::span<const Triangle>(surface_)));
}

bool SolidDistance::is_inside(const Point& p) const {
    const auto may_contain = [&](const Box& box) { return !(squared_distance(box, p) > 0); };
    return tet_tree_.any_of(may_contain, [&](size_t tetrahedron) {
        for (size_t k = 0; k < 4; ++k) {
            const Triangle t = facet(tetrahedra_[tetrahedron], k);
            const Point& a = points_[idx(t[0])];
            const Point n = cross(points_[idx(t[1])] - a, points_[idx(t[2])] - a);
            const double height = dot(p - a, n);
            if (height > 0 && height * height > rounding * rounding * squared(n)) return false;
        }
        return true;
    });
}

Point SolidDistance::nearest(const Point& p, double good_enough, const std::optional<Point>& near) const {
    const double limit = std::max(good_enough, 0.0) * std::max(good_enough, 0.0);
    Point best = near.value_or(Point{});
    double best_squared = near ? squared(p - best) : HUGE_VAL;
    const auto is_wanted = [&](double squared, size_t) { return best_squared > limit && squared < best_squared; };
    const auto squared_from = [&](const Box& box) { return squared_distance(box, p); };
    surface_tree_.nearest_first(squared_from, is_wanted, [&](size_t triangle, double) {
        const auto& [a, b, c] = surface_[triangle];
        const Point q = nearest_on_triangle(p, points_[idx(a)], points_[idx(b)], points_[idx(c)]);
        if (squared(p - q) < best_squared) best = q, best_squared = squared(p - q);
    });
    return best_squared > limit && is_inside(p) ? p : best;
}

SolidDistance::Farthest SolidDistance::farthest(const TriangleMesh& surface, double slack, double good_enough) const {
    std::priority_queue<BoundedTriangle> queue;
    double lower_bound = 0, discarded_bound = 0;  // of the result; of the discarded triangles
    Point witness = surface.vertices.empty() ? Point{} : surface.vertices[0];  // of the lower bound
    const auto threshold = [&] { return std::max(lower_bound + slack, good_enough); };
    const auto add = [&](const std::array<Point, 3>& corners, const Point& near) {
        const auto& [a, b, c] = corners;
        const Point middle = 1.0 / 3 * (a + b + c);
        const double reach = std::sqrt(std::max({squared(a - middle), squared(b - middle), squared(c - middle)}));
        const double limit = threshold();
        // The point of a triangle that is farthest from q is a corner.
        const Point q = nearest(middle, limit - reach, near);
        const double upper_bound = std::sqrt(std::max({squared(a - q), squared(b - q), squared(c - q)}));
        if (upper_bound <= limit) {
            discarded_bound = std::max(discarded_bound, upper_bound);
        } else {
            if (length(middle - q) > lower_bound) {
                lower_bound = length(middle - q);
                witness = middle;
            }
            queue.push({upper_bound, corners, q});
        }
    };
    std::vector<std::optional<Point>> near_vertex(surface.vertices.size());
    std::optional<Point> previous;  // near the last corner
    for (const auto& [reach, t] : triangles_by_size(surface)) {
        progress_.reach(0);
        if (lower_bound > good_enough && std::isfinite(good_enough)) return {lower_bound, witness};
        double farthest_corner = 0;
        for (const int32_t v : t) {
            const Point& corner = surface.vertices[idx(v)];
            if (!near_vertex[idx(v)]) near_vertex[idx(v)] = nearest(corner, threshold() / 2, previous);
            previous = near_vertex[idx(v)];
            farthest_corner = std::max(farthest_corner, length(corner - *previous));
        }
        if (farthest_corner + reach <= threshold())
            discarded_bound = std::max(discarded_bound, farthest_corner + reach);
        else
            add({surface.vertices[idx(t[0])], surface.vertices[idx(t[1])], surface.vertices[idx(t[2])]}, *previous);
    }
    while (!queue.empty()) {
        progress_.reach(0);
        const auto [upper_bound, corners, near] = queue.top();
        if (upper_bound <= threshold()) return {std::max(upper_bound, discarded_bound), witness};
        if (lower_bound > good_enough && std::isfinite(good_enough)) return {lower_bound, witness};
        queue.pop();
        for (const std::array<Point, 3>& half : bisect(corners)) add(half, near);
    }
    return {discarded_bound, witness};
}

}  // namespace partwheel::convex
