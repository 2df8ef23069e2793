// Adds one supporting plane at a time. The polytope is computed by duality: planes are points, and each facet of
// their hull is a corner of the polytope.
#include "convex/simplify.h"

#include "base/predicates.h"
#include "base/principal.h"
#include "hull/hull.h"
#include "convex/distance.h"

namespace partwheel::convex {

namespace {

// Relative to the sides of the box.
constexpr double margin = 1e-9;         // of the polytope around the hull
constexpr double weld_distance = 1e-6;  // closer corners are welded, as readers of the hull do
constexpr double tolerance = 1e-6;      // corners this close to the hull need no further plane

// The corners of the polytope dot(n, x) <= 1 for all planes n.
std::vector<Point> dual_corners(std::span<const Point> planes, Progress& progress) {
    const TriangleMesh dual = convex_hull(planes, progress);
    std::vector<Point> corners;
    for (const Triangle& t : dual.triangles) {
        const Point &a = dual.vertices[idx(t[0])], &b = dual.vertices[idx(t[1])], &c = dual.vertices[idx(t[2])];
        const Point n = cross(b - a, c - a);
        corners.push_back(1 / dot(n, a) * n);
    }
    std::sort(corners.begin(), corners.end());
    std::vector<Point> unique;
    for (const Point& p : corners)
        if (std::ranges::none_of(unique, [&](const Point& q) { return length(p - q) < weld_distance; }))
            unique.push_back(p);
    return unique;
}

bool is_inside(const TriangleMesh& hull, const Point& p) {
    return std::ranges::all_of(hull.triangles, [&](const Triangle& t) {
        return orientation(hull.vertices[idx(t[0])], hull.vertices[idx(t[1])], hull.vertices[idx(t[2])], p) <= 0;
    });
}

double extent_along(std::span<const Point> points, const Point& direction) {
    double most = -HUGE_VAL;
    for (const Point& p : points) most = std::max(most, dot(direction, p));
    return most;
}

// The directions of the smaller box: the axes or the principal directions.
std::array<Point, 3> box_directions(std::span<const Point> points) {
    const std::array<Point, 3> axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, principal = principal_directions(points);
    const auto volume = [&](const std::array<Point, 3>& directions) {
        double product = 1;
        for (const Point& d : directions) product *= extent_along(points, d) + extent_along(points, -1 * d);
        return product;
    };
    return volume(principal) < (1 - tolerance) * volume(axes) ? principal : axes;
}

// Maps the box around a hull to a cube: otherwise a thin hull would get all planes around its rim.
class BoxFrame {
public:
    explicit BoxFrame(std::span<const Point> points) : center(centroid(points)) {
        std::vector<Point> centered;
        for (const Point& p : points) centered.push_back(p - center);
        directions_ = box_directions(centered);
        for (size_t k = 0; k < 3; ++k)
            sizes_[k] = extent_along(centered, directions_[k]) + extent_along(centered, -1 * directions_[k]);
    }
    Point to_cube(const Point& point) const {
        const Point p = point - center;
        return {dot(directions_[0], p) / sizes_[0], dot(directions_[1], p) / sizes_[1], dot(directions_[2], p) / sizes_[2]};
    }
    // Relative to the center.
    Point from_cube(const Point& p) const {
        return p[0] * sizes_[0] * directions_[0] + p[1] * sizes_[1] * directions_[1] + p[2] * sizes_[2] * directions_[2];
    }

    Point center;

private:
    std::array<Point, 3> directions_{};
    Point sizes_{};
};

std::vector<Plane> half_spaces(const TriangleMesh& hull, std::span<const Point> points) {
    std::vector<Plane> sides;
    for (const auto& [a, b, c] : hull.triangles) {
        const Point n = cross(hull.vertices[idx(b)] - hull.vertices[idx(a)], hull.vertices[idx(c)] - hull.vertices[idx(a)]);
        if (length(n) > 0) sides.push_back({1 / length(n) * n, extent_along(points, 1 / length(n) * n)});
    }
    return sides;
}

// The corner farthest beyond a facet; null if none is farther than the tolerance.
const Point* farthest_corner(std::span<const Point> corners, std::span<const Plane> sides) {
    double max_distance = tolerance;
    const Point* farthest = nullptr;
    for (const Point& p : corners)
        for (const Plane& side : sides)
            if (side.height(p) > max_distance) {
                max_distance = side.height(p);
                farthest = &p;
            }
    return farthest;
}

Point direction_from_nearest(const TriangleMesh& hull, const Point& p) {
    Point nearest{};
    double distance = HUGE_VAL;
    for (const auto& [a, b, c] : hull.triangles) {
        const Point q = nearest_on_triangle(p, hull.vertices[idx(a)], hull.vertices[idx(b)], hull.vertices[idx(c)]);
        if (length(p - q) < distance) {
            distance = length(p - q);
            nearest = q;
        }
    }
    return 1 / distance * (p - nearest);
}

// The corners of a cube around points of which planes cut off the farthest corner, one after the other. As many corners have
// less than twice as many planes; only planes that miss their corner, because rounding has moved it, could be more.
std::vector<Point> cut_cube(std::span<const Point> points, size_t max_vertices, Progress& progress) {
    std::vector<Point> planes;  // see dual_corners()
    const auto add = [&](const Point& direction) {
        planes.push_back(1 / (extent_along(points, direction) + margin) * direction);
    };
    for (size_t k = 0; k < 3; ++k)
        for (const double sign : {1.0, -1.0}) {
            Point axis{};
            axis[k] = sign;
            add(axis);
        }
    const TriangleMesh inner = convex_hull(points, progress);
    const std::vector<Plane> sides = half_spaces(inner, points);
    std::vector<Point> corners = dual_corners(planes, progress);
    while (planes.size() < 2 * max_vertices) {
        const Point* const corner = farthest_corner(corners, sides);
        if (!corner) break;
        progress.reach(0);
        add(direction_from_nearest(inner, *corner));
        auto next = dual_corners(planes, progress);
        if (next.size() > max_vertices) break;
        corners = std::move(next);
    }
    return corners;
}

}  // namespace

TriangleMesh simplify_outer_hull(const TriangleMesh& hull, size_t max_vertices, Progress& progress) {
    if (hull.vertices.size() <= max_vertices) return hull;
    const BoxFrame box(hull.vertices);
    std::vector<Point> points;
    for (const Point& p : hull.vertices) points.push_back(box.to_cube(p));
    std::vector<Point> corners = cut_cube(points, max_vertices, progress);
    for (Point& p : corners) p = box.from_cube(p);
    TriangleMesh result = convex_hull(corners);
    const std::vector<Point> centered = result.vertices;
    // Welded corners and those of nearly parallel planes are off by more than the margin: scale up until everything is
    // inside.
    double growth = 0;
    do {
        progress.reach(0);
        for (size_t i = 0; i < centered.size(); ++i) result.vertices[i] = box.center + (1 + growth) * centered[i];
        growth = std::max(margin, 2 * growth);
    } while (!std::ranges::all_of(hull.vertices, [&](const Point& p) { return is_inside(result, p); }));
    return result;
}

}  // namespace partwheel::convex
