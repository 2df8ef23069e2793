// Points, index tuples and the signed volume: the words that all rooms share.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace partwheel {

using Point = std::array<double, 3>;
using Triangle = std::array<int32_t, 3>;    // vertex indices, counter-clockwise seen from outside
using Tetrahedron = std::array<int32_t, 4>;  // vertex indices, positively oriented

struct TriangleMesh {
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;

    // Of solids alone, see pw_mesh_origins; empty for hulls.
    std::vector<std::array<int32_t, 2>> ends;
    std::vector<int32_t> faces, beyond;
};

// An index as the standard library's containers take it.
inline size_t at(int32_t index) { return static_cast<size_t>(index); }

inline Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Point operator*(double s, const Point& p) { return {s * p[0], s * p[1], s * p[2]}; }

inline Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline double length(const Point& p) { return std::sqrt(dot(p, p)); }

// Along the axes, about points; about none its corners are the wrong way round.
struct Box {
    Point low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

    void add(const Point& p) {
        for (size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    }
    static Box around(std::span<const Point> points) {
        Box box;
        for (const Point& p : points) box.add(p);
        return box;
    }
    double diagonal() const { return length(high - low); }
};

// Six times the signed volume of the tetrahedron a, b, c, d: positive if d sees a, b, c counter-clockwise. Rounded;
// use orientation() of predicates.h where the sign decides.
inline double six_volumes(const Point& a, const Point& b, const Point& c, const Point& d) {
    return dot(cross(b - a, c - a), d - a);
}

inline double area(const Point& a, const Point& b, const Point& c) { return length(cross(b - a, c - a)) / 2; }

// Which corners of a tetrahedron its facet opposite each corner has, counter-clockwise seen from outside.
inline constexpr std::array<std::array<size_t, 3>, 4> facet_corners = {{{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}}};

inline Triangle facet(const Tetrahedron& tetrahedron, size_t opposite) {
    const auto& [i, j, k] = facet_corners[opposite];
    return {tetrahedron[i], tetrahedron[j], tetrahedron[k]};
}

// One of the 13 directions, up to their sign, whose coordinates are -1, 0 or 1.
constexpr size_t lattice_directions = 13;
inline Point lattice_direction(size_t i) {
    const auto code = static_cast<int>(i) + 14;  // in base 3
    return {static_cast<double>(code / 9 - 1), static_cast<double>(code / 3 % 3 - 1), static_cast<double>(code % 3 - 1)};
}

}  // namespace partwheel
