// Adds one supporting plane at a time. The polytope is computed by duality: planes are points, and each facet of
// their hull is a corner of the polytope.
#include "convex/simplify.h"

#include "base/predicates.h"
#include "hull/hull.h"
#include "convex/distance.h"
#include "convex/principal.h"

#include <algorithm>
#include <cmath>

namespace partwheel::convex {

namespace {

constexpr double margin = 1e-9;   // of the box's sides
constexpr double weld_distance = 1e-6;     // of them: closer corners are welded, as readers of the hull do
constexpr double tolerance = 1e-6;   // of them: corners this close to the hull need no further plane

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
    double max_vertices = -HUGE_VAL;
    for (const Point& p : points) max_vertices = std::max(max_vertices, dot(direction, p));
    return max_vertices;
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

}  // namespace

TriangleMesh simplify_outer_hull(const TriangleMesh& hull, size_t max_vertices, Progress& progress) {
    if (hull.vertices.size() <= max_vertices) return hull;
    Point center{};
    for (const Point& p : hull.vertices) center = center + 1 / static_cast<double>(hull.vertices.size()) * p;
    std::vector<Point> centered;  // the hull's vertices relative to the center
    for (const Point& p : hull.vertices) centered.push_back(p - center);
    // Scales the box to a cube: otherwise a thin hull would get all planes around its rim.
    const std::array<Point, 3> directions = box_directions(centered);
    Point sizes;
    for (size_t k = 0; k < 3; ++k)
        sizes[k] = extent_along(centered, directions[k]) + extent_along(centered, -1 * directions[k]);
    for (Point& p : centered)
        p = {dot(directions[0], p) / sizes[0], dot(directions[1], p) / sizes[1], dot(directions[2], p) / sizes[2]};
    const auto back = [&](const Point& p) {
        return p[0] * sizes[0] * directions[0] + p[1] * sizes[1] * directions[1] + p[2] * sizes[2] * directions[2];
    };

    const TriangleMesh inner = convex_hull(centered, progress);
    struct Side {
        Point normal;
        double offset;
    };
    std::vector<Side> facets;
    for (const auto& [a, b, c] : inner.triangles) {
        const Point n =
            cross(inner.vertices[idx(b)] - inner.vertices[idx(a)], inner.vertices[idx(c)] - inner.vertices[idx(a)]);
        if (length(n) > 0) facets.push_back({1 / length(n) * n, extent_along(centered, 1 / length(n) * n)});
    }
    std::vector<Point> planes;  // see dual_corners()
    const auto add = [&](const Point& direction) {
        planes.push_back(1 / (extent_along(centered, direction) + margin) * direction);
    };
    for (size_t k = 0; k < 3; ++k)
        for (const double sign : {1.0, -1.0}) {
            Point axis{};
            axis[k] = sign;
            add(axis);
        }
    std::vector<Point> corners = dual_corners(planes, progress);
    for (;;) {
        progress.reach(0);
        // The corner farthest beyond a facet.
        double max_distance = tolerance;
        const Point* corner = nullptr;
        for (const Point& p : corners)
            for (const Side& side : facets)
                if (dot(side.normal, p) - side.offset > max_distance) {
                    max_distance = dot(side.normal, p) - side.offset;
                    corner = &p;
                }
        if (!corner) break;
        Point nearest{};
        double distance = HUGE_VAL;
        for (const auto& [a, b, c] : inner.triangles) {
            const Point q =
                nearest_on_triangle(*corner, inner.vertices[idx(a)], inner.vertices[idx(b)], inner.vertices[idx(c)]);
            if (length(*corner - q) < distance) {
                distance = length(*corner - q);
                nearest = q;
            }
        }
        add(1 / distance * (*corner - nearest));
        auto next = dual_corners(planes, progress);
        if (next.size() > max_vertices) break;
        corners = std::move(next);
    }
    for (Point& p : corners) p = back(p);
    TriangleMesh result = convex_hull(corners);
    const std::vector<Point> centered_result = result.vertices;
    // Welded corners and those of nearly parallel planes are off by more than the margin: scale up until everything is
    // inside.
    double growth = 0;
    do {
        progress.reach(0);
        for (size_t i = 0; i < centered_result.size(); ++i)
            result.vertices[i] = center + (1 + growth) * centered_result[i];
        growth = std::max(margin, 2 * growth);
    } while (!std::ranges::all_of(hull.vertices, [&](const Point& p) { return is_inside(result, p); }));
    return result;
}

}  // namespace partwheel::convex
