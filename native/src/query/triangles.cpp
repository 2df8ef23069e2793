// Two triangles meet if an edge of one meets the other: by the exact side-of-plane test alone.
#include "query/triangles.h"

#include "base/predicates.h"

#include <algorithm>

namespace partwheel::index {

namespace {

// Where a height is 0 that goes from one end's to the other's; on the way, whatever rounding has done to them.
Point between(const Point& p, const Point& q, double from, double to) {
    return from == to ? p : p + std::clamp(from / (from - to), 0.0, 1.0) * (q - p);
}

// Triangles in one plane, seen along an axis across which they don't vanish: a two-dimensional test.
class Flat {
public:
    explicit Flat(size_t along) : along_(along) {}

    // 1: a, b, c turn to the left, 0: they are on one line.
    int turn(const Point& a, const Point& b, const Point& c) const {
        const Point fa = flat(a);
        return orientation(fa, flat(b), flat(c), {fa[0], fa[1], 1});
    }

    bool holds(const Corners& t, const Point& p) const {
        const auto [least, most] = std::minmax({turn(t[0], t[1], p), turn(t[1], t[2], p), turn(t[2], t[0], p)});
        return least >= 0 || most <= 0;
    }

    // A point of both segments. Where they lie on one line it is an end, which holds() sees as well.
    std::optional<Point> common_point(const Point& p, const Point& q, const Point& r, const Point& s) const {
        const int pr = turn(p, q, r), ps = turn(p, q, s);
        if (pr * ps > 0 || (pr == 0 && ps == 0) || turn(r, s, p) * turn(r, s, q) > 0) return std::nullopt;
        const double from = area_of(p, q, r), to = area_of(p, q, s);
        return between(r, s, from, to);
    }

private:
    Point flat(const Point& p) const { return {p[(along_ + 1) % 3], p[(along_ + 2) % 3], 0}; }
    double area_of(const Point& a, const Point& b, const Point& c) const { return cross(flat(b) - flat(a), flat(c) - flat(a))[2]; }

    size_t along_;
};

std::optional<Point> common_point_in_plane(const Corners& a, const Corners& b) {
    for (size_t k = 0; k < 3; ++k) {
        const Flat flat(k);
        if (flat.turn(a[0], a[1], a[2]) == 0 || flat.turn(b[0], b[1], b[2]) == 0) continue;
        for (const Point& p : a)
            if (flat.holds(b, p)) return p;
        for (const Point& p : b)
            if (flat.holds(a, p)) return p;
        for (size_t i = 0; i < 3; ++i)
            for (size_t j = 0; j < 3; ++j)
                if (const auto p = flat.common_point(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3])) return p;
        return std::nullopt;
    }
    return std::nullopt;
}

using Sides = std::array<int, 3>;

Sides sides(const Corners& t, const Corners& of) {
    return {orientation(t[0], t[1], t[2], of[0]), orientation(t[0], t[1], t[2], of[1]), orientation(t[0], t[1], t[2], of[2])};
}

bool beside(const Sides& s) { return s[0] == s[1] && s[1] == s[2] && s[0] != 0; }

// Where an edge of one triangle meets the other. sides: of the corners, of the other's plane, in which not all are.
std::optional<Point> on_edge(const Corners& of, const Sides& sides, const Corners& t) {
    for (size_t k = 0; k < 3; ++k) {
        const Point &p = of[k], &q = of[(k + 1) % 3];
        const int from = sides[k], to = sides[(k + 1) % 3];
        if (from * to > 0 || (from == 0 && to == 0)) continue;
        const auto [least, most] =
            std::minmax({orientation(p, q, t[0], t[1]), orientation(p, q, t[1], t[2]), orientation(p, q, t[2], t[0])});
        if (least < 0 && most > 0) continue;
        const double below = signed_volume6(t[0], t[1], t[2], p), above = signed_volume6(t[0], t[1], t[2], q);
        return from == 0 ? p : to == 0 ? q : between(p, q, below, above);
    }
    return std::nullopt;
}

}  // namespace

std::optional<Point> common_point(const Corners& a, const Corners& b) {
    const Sides of_b = sides(a, b);
    if (beside(of_b)) return std::nullopt;
    const Sides of_a = sides(b, a);
    if (beside(of_a)) return std::nullopt;
    const Sides none{};
    if (of_a == none && of_b == none) return common_point_in_plane(a, b);
    if (of_b != none)
        if (const auto p = on_edge(b, of_b, a)) return p;
    return of_a != none ? on_edge(a, of_a, b) : std::nullopt;
}

}  // namespace partwheel::index
