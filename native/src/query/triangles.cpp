// Two triangles intersect if an edge of one intersects the other. All decisions use the exact orientation test.
#include "query/triangles.h"

#include "base/predicates.h"

#include <algorithm>

namespace partwheel::index {

namespace {

// The point between p and q where a height that changes linearly from `from` to `to` is 0, clamped to the segment.
Point interpolate_zero(const Point& p, const Point& q, double from, double to) {
    return from == to ? p : p + std::clamp(from / (from - to), 0.0, 1.0) * (q - p);
}

// Coplanar triangles projected along an axis along which they keep an area.
class Projection {
public:
    explicit Projection(size_t along) : along_(along) {}

    // 1: a, b, c turn left, -1: right, 0: collinear.
    int orientation_2d(const Point& a, const Point& b, const Point& c) const {
        const Point fa = project(a);
        return orientation(fa, project(b), project(c), {fa[0], fa[1], 1});
    }

    bool contains(const Corners& t, const Point& p) const {
        const auto [least, most] =
            std::minmax({orientation_2d(t[0], t[1], p), orientation_2d(t[1], t[2], p), orientation_2d(t[2], t[0], p)});
        return least >= 0 || most <= 0;
    }

    // A common point of two segments. Of collinear ones none: there an end is common, which contains() finds.
    std::optional<Point> common_point(const Point& p, const Point& q, const Point& r, const Point& s) const {
        const int pr = orientation_2d(p, q, r), ps = orientation_2d(p, q, s);
        if (pr * ps > 0 || (pr == 0 && ps == 0) || orientation_2d(r, s, p) * orientation_2d(r, s, q) > 0)
            return std::nullopt;
        const double from = signed_area2(p, q, r), to = signed_area2(p, q, s);
        return interpolate_zero(r, s, from, to);
    }

private:
    Point project(const Point& p) const { return {p[(along_ + 1) % 3], p[(along_ + 2) % 3], 0}; }
    double signed_area2(const Point& a, const Point& b, const Point& c) const {
        return cross(project(b) - project(a), project(c) - project(a))[2];
    }

    size_t along_;
};

std::optional<Point> common_point_in_plane(const Corners& a, const Corners& b) {
    for (size_t k = 0; k < 3; ++k) {
        const Projection projection(k);
        if (projection.orientation_2d(a[0], a[1], a[2]) == 0 || projection.orientation_2d(b[0], b[1], b[2]) == 0)
            continue;
        for (const Point& p : a)
            if (projection.contains(b, p)) return p;
        for (const Point& p : b)
            if (projection.contains(a, p)) return p;
        for (size_t i = 0; i < 3; ++i)
            for (size_t j = 0; j < 3; ++j)
                if (const auto p = projection.common_point(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3])) return p;
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
