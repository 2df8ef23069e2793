// Two triangles intersect if an edge of one intersects the other. All decisions use the exact orientation test.
#include "query/triangles.h"

#include "base/predicates.h"

namespace partwheel::index {

namespace {

// The point between p and q where a height that changes linearly from `from` to `to` is 0, clamped to the segment.
Point interpolate_zero(const Point& p, const Point& q, double from, double to) {
    return from == to ? p : p + std::clamp(from / (from - to), 0.0, 1.0) * (q - p);
}

// axis: coplanar triangles are projected along it, and keep an area.

bool contains(size_t axis, const Corners& t, const Point& p) {
    const auto [least, most] = std::minmax({orientation_along(axis, t[0], t[1], p), orientation_along(axis, t[1], t[2], p),
                                            orientation_along(axis, t[2], t[0], p)});
    return least >= 0 || most <= 0;
}

// A common point of two segments. Of collinear ones none: there an end is common, which contains() finds.
std::optional<Point> common_point(size_t axis, const Point& p, const Point& q, const Point& r, const Point& s) {
    const auto turn = [&](const Point& a, const Point& b, const Point& c) { return orientation_along(axis, a, b, c); };
    const int pr = turn(p, q, r), ps = turn(p, q, s);
    if (pr * ps > 0 || (pr == 0 && ps == 0) || turn(r, s, p) * turn(r, s, q) > 0) return std::nullopt;
    return interpolate_zero(r, s, cross(q - p, r - p)[axis], cross(q - p, s - p)[axis]);
}

std::optional<Point> common_point_in_plane(const Corners& a, const Corners& b) {
    for (size_t axis = 0; axis < 3; ++axis) {
        if (orientation_along(axis, a[0], a[1], a[2]) == 0 || orientation_along(axis, b[0], b[1], b[2]) == 0) continue;
        for (const Point& p : a)
            if (contains(axis, b, p)) return p;
        for (const Point& p : b)
            if (contains(axis, a, p)) return p;
        for (size_t i = 0; i < 3; ++i)
            for (size_t j = 0; j < 3; ++j)
                if (const auto p = common_point(axis, a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3])) return p;
        return std::nullopt;
    }
    return std::nullopt;
}

using Sides = std::array<int, 3>;

Sides sides_of_plane(const Corners& t, const Corners& points) {
    return {orientation(t[0], t[1], t[2], points[0]), orientation(t[0], t[1], t[2], points[1]),
            orientation(t[0], t[1], t[2], points[2])};
}

bool is_on_one_side(const Sides& s) { return s[0] == s[1] && s[1] == s[2] && s[0] != 0; }

// A common point of an edge of one triangle and the other one, t. sides: of the first one's corners with respect to t's
// plane, not all 0.
std::optional<Point> edge_intersection(const Corners& edges, const Sides& sides, const Corners& t) {
    for (size_t k = 0; k < 3; ++k) {
        const Point &p = edges[k], &q = edges[(k + 1) % 3];
        const int from = sides[k], to = sides[(k + 1) % 3];
        if (from * to > 0 || (from == 0 && to == 0)) continue;
        const auto [least, most] =
            std::minmax({orientation(p, q, t[0], t[1]), orientation(p, q, t[1], t[2]), orientation(p, q, t[2], t[0])});
        if (least < 0 && most > 0) continue;
        const double below = signed_volume6(t[0], t[1], t[2], p), above = signed_volume6(t[0], t[1], t[2], q);
        return from == 0 ? p : to == 0 ? q : interpolate_zero(p, q, below, above);
    }
    return std::nullopt;
}

}  // namespace

std::optional<Point> common_point(const Corners& a, const Corners& b) {
    const Sides b_sides = sides_of_plane(a, b);
    if (is_on_one_side(b_sides)) return std::nullopt;
    const Sides a_sides = sides_of_plane(b, a);
    if (is_on_one_side(a_sides)) return std::nullopt;
    const Sides none{};
    if (a_sides == none && b_sides == none) return common_point_in_plane(a, b);
    if (b_sides != none)
        if (const auto p = edge_intersection(b, b_sides, a)) return p;
    return a_sides != none ? edge_intersection(a, a_sides, b) : std::nullopt;
}

}  // namespace partwheel::index
