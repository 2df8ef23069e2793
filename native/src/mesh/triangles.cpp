// Two triangles intersect if an edge of one intersects the other. All decisions use the exact orientation test.
#include "mesh/triangles.h"

#include "base/predicates.h"

namespace partwheel {

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
std::optional<Point> common_point_of_segments(size_t axis, const Point& p, const Point& q, const Point& r, const Point& s) {
    const auto turn = [&](const Point& a, const Point& b, const Point& c) { return orientation_along(axis, a, b, c); };
    const int pr = turn(p, q, r), ps = turn(p, q, s);
    if (pr * ps > 0 || (pr == 0 && ps == 0) || turn(r, s, p) * turn(r, s, q) > 0) return std::nullopt;
    return interpolate_zero(r, s, cross(q - p, r - p)[axis], cross(q - p, s - p)[axis]);
}

std::optional<Point> common_point_in_plane(const Corners& a, const Corners& b, size_t shared) {
    for (size_t axis = 0; axis < 3; ++axis) {
        const int turn = orientation_along(axis, a[0], a[1], a[2]);
        if (turn == 0 || orientation_along(axis, b[0], b[1], b[2]) == 0) continue;
        if (shared == 2) return orientation_along(axis, a[0], a[1], b[2]) == turn ? std::optional(b[2]) : std::nullopt;
        for (const auto& [inner, outer] : {std::pair(a, b), std::pair(b, a)})
            for (size_t k = shared; k < 3; ++k)
                if (contains(axis, outer, inner[k])) return inner[k];
        for (size_t i = 0; i < 3; ++i)
            for (size_t j = 0; j < 3; ++j) {
                if (shared == 1 && i != 1 && j != 1) continue;  // both edges end at the shared corner
                if (const auto p = common_point_of_segments(axis, a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3])) return p;
            }
        return std::nullopt;
    }
    return std::nullopt;
}

using Sides = std::array<int, 3>;

Sides sides_of_plane(const Corners& t, const Corners& points, size_t shared) {
    Sides sides{};
    for (size_t k = shared; k < 3; ++k) sides[k] = orientation(t[0], t[1], t[2], points[k]);
    return sides;
}

bool is_on_one_side(const Sides& s, size_t shared) {
    return s[2] != 0 && std::all_of(&s[shared], &s[2], [&](int side) { return side == s[2]; });
}

// A common point of an edge of one triangle and the other one, t. sides: of the first one's corners with respect to t's
// plane, not all 0.
std::optional<Point> edge_intersection(const Corners& edges, const Sides& sides, const Corners& t, size_t shared) {
    for (size_t k = shared; k + shared < 3; ++k) {  // not those that end at a shared corner
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

std::optional<Point> common_point(const Corners& a, const Corners& b, size_t shared) {
    const Sides b_sides = sides_of_plane(a, b, shared);
    if (is_on_one_side(b_sides, shared)) return std::nullopt;
    const Sides a_sides = sides_of_plane(b, a, shared);
    if (is_on_one_side(a_sides, shared)) return std::nullopt;
    const Sides none{};
    if (a_sides == none && b_sides == none) return common_point_in_plane(a, b, shared);
    if (b_sides != none)
        if (const auto p = edge_intersection(b, b_sides, a, shared)) return p;
    return a_sides != none ? edge_intersection(a, a_sides, b, shared) : std::nullopt;
}

}  // namespace partwheel
