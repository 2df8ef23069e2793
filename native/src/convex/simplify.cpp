// A polytope around a hull, plane by plane, each where the polytope's farthest corner is.
//
// In the dual, planes are points: of those against the polytope the hull is built, and each of its facets is a corner.
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
constexpr double same = 1e-6;     // of them: corners that are nearer to each other are one, as for whoever reads the hull
constexpr double nearer = 1e-6;   // of them: a corner that is no farther out has all it needs

// The corners where planes n meet, of which all points x with dot(n, x) <= 1 are on the inner side.
std::vector<Point> corners_of(std::span<const Point> planes) {
    const TriangleMesh dual = convex_hull(planes);
    std::vector<Point> corners;
    for (const Triangle& t : dual.triangles) {
        const Point &a = dual.vertices[idx(t[0])], &b = dual.vertices[idx(t[1])], &c = dual.vertices[idx(t[2])];
        const Point n = cross(b - a, c - a);
        corners.push_back(1 / dot(n, a) * n);
    }
    std::sort(corners.begin(), corners.end());
    std::vector<Point> kept;
    for (const Point& p : corners)
        if (std::ranges::none_of(kept, [&](const Point& q) { return length(p - q) < same; })) kept.push_back(p);
    return kept;
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

// The axes, or the principal directions if a box along these is smaller.
std::array<Point, 3> directions_of_box(std::span<const Point> points) {
    const std::array<Point, 3> axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, principal = principal_directions(points);
    const auto volume = [&](const std::array<Point, 3>& directions) {
        double product = 1;
        for (const Point& d : directions) product *= extent_along(points, d) + extent_along(points, -1 * d);
        return product;
    };
    return volume(principal) < (1 - nearer) * volume(axes) ? principal : axes;
}

}  // namespace

TriangleMesh simplify_outer_hull(const TriangleMesh& hull, size_t most) {
    if (hull.vertices.size() <= most) return hull;
    Point middle{};
    for (const Point& p : hull.vertices) middle = middle + 1 / static_cast<double>(hull.vertices.size()) * p;
    std::vector<Point> around;  // of the middle
    for (const Point& p : hull.vertices) around.push_back(p - middle);
    // Where the box is a cube, as volumes see it: else a thin hull would get all planes about its rim.
    const std::array<Point, 3> directions = directions_of_box(around);
    Point sizes;
    for (size_t k = 0; k < 3; ++k)
        sizes[k] = extent_along(around, directions[k]) + extent_along(around, -1 * directions[k]);
    for (Point& p : around)
        p = {dot(directions[0], p) / sizes[0], dot(directions[1], p) / sizes[1], dot(directions[2], p) / sizes[2]};
    const auto back = [&](const Point& p) {
        return p[0] * sizes[0] * directions[0] + p[1] * sizes[1] * directions[1] + p[2] * sizes[2] * directions[2];
    };

    const TriangleMesh inner = convex_hull(around);
    struct Side {
        Point normal;
        double offset;
    };
    std::vector<Side> facets;
    for (const auto& [a, b, c] : inner.triangles) {
        const Point n = cross(inner.vertices[idx(b)] - inner.vertices[idx(a)], inner.vertices[idx(c)] - inner.vertices[idx(a)]);
        if (length(n) > 0) facets.push_back({1 / length(n) * n, extent_along(around, 1 / length(n) * n)});
    }
    std::vector<Point> planes;  // as corners_of() takes them
    const auto add = [&](const Point& direction) {
        planes.push_back(1 / (extent_along(around, direction) + margin) * direction);
    };
    for (size_t k = 0; k < 3; ++k)
        for (const double sign : {1.0, -1.0}) {
            Point axis{};
            axis[k] = sign;
            add(axis);
        }
    std::vector<Point> corners = corners_of(planes);
    for (;;) {
        // The corner that is farthest beyond a facet.
        double farthest = nearer;
        const Point* corner = nullptr;
        for (const Point& p : corners)
            for (const Side& side : facets)
                if (dot(side.normal, p) - side.offset > farthest) {
                    farthest = dot(side.normal, p) - side.offset;
                    corner = &p;
                }
        if (!corner) break;
        Point nearest{};
        double distance = HUGE_VAL;
        for (const auto& [a, b, c] : inner.triangles) {
            const Point q = nearest_on_triangle(*corner, inner.vertices[idx(a)], inner.vertices[idx(b)], inner.vertices[idx(c)]);
            if (length(*corner - q) < distance) {
                distance = length(*corner - q);
                nearest = q;
            }
        }
        add(1 / distance * (*corner - nearest));
        auto next = corners_of(planes);
        if (next.size() > most) break;
        corners = std::move(next);
    }
    for (Point& p : corners) p = back(p);
    TriangleMesh made = convex_hull(corners);
    const std::vector<Point> of_middle = made.vertices;
    // Corners that were taken for one, or of planes that are nearly parallel, are off by more than the margin: so, larger
    // until all is inside.
    double grown = 0;
    do {
        for (size_t i = 0; i < of_middle.size(); ++i) made.vertices[i] = middle + (1 + grown) * of_middle[i];
        grown = std::max(margin, 2 * grown);
    } while (!std::ranges::all_of(hull.vertices, [&](const Point& p) { return is_inside(made, p); }));
    return made;
}

}  // namespace partwheel::convex
