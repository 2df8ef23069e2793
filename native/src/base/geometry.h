// Points, index tuples, affine maps, boxes and measures, shared by all layers.
#pragma once

// Of the standard library, what many files need: those that see this header don't repeat it.
// IWYU pragma: begin_exports
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>
// IWYU pragma: end_exports

namespace partwheel {

using Point = std::array<double, 3>;
using Triangle = std::array<int32_t, 3>;    // vertex indices, counterclockwise seen from outside
using Tetrahedron = std::array<int32_t, 4>;  // vertex indices, positively oriented

struct TriangleMesh {
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;

    // Only of solids, see pw_mesh_origins; empty for hulls.
    std::vector<int32_t> source_vertices;              // per vertex
    std::vector<int32_t> source_faces, neighbor_tets;  // per triangle, or -1
};

// An index of the standard library's containers.
inline size_t idx(int32_t index) { return static_cast<size_t>(index); }

// 0 to count - 1.
inline std::vector<int32_t> iota(size_t count) {
    std::vector<int32_t> numbers(count);
    for (size_t i = 0; i < count; ++i) numbers[i] = static_cast<int32_t>(i);
    return numbers;
}

inline Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Point operator*(double s, const Point& p) { return {s * p[0], s * p[1], s * p[2]}; }

inline Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <size_t n>
bool is_finite(const std::array<double, n>& values) {
    return std::ranges::all_of(values, [](double x) { return std::isfinite(x); });
}

inline double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline double squared(const Point& p) { return dot(p, p); }

inline double length(const Point& p) { return std::sqrt(dot(p, p)); }

inline Point centroid(std::span<const Point> points) {
    Point sum{};
    for (const Point& p : points) sum = sum + 1 / static_cast<double>(points.size()) * p;
    return sum;
}

// The rows of a 3 x 4 matrix (A | b): x -> A x + b.
using Affine = std::array<double, 12>;

inline constexpr Affine identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

inline Point transform_point(const Affine& m, const Point& p) {
    return {m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3], m[4] * p[0] + m[5] * p[1] + m[6] * p[2] + m[7],
            m[8] * p[0] + m[9] * p[1] + m[10] * p[2] + m[11]};
}

// b * inverse(a); not finite if a is singular.
inline Affine compose_with_inverse(const Affine& b, const Affine& a) {
    const Point r0{a[0], a[1], a[2]}, r1{a[4], a[5], a[6]}, r2{a[8], a[9], a[10]};
    const Point columns[3] = {cross(r1, r2), cross(r2, r0), cross(r0, r1)};  // of the adjugate
    const double det = dot(r0, columns[0]);
    Affine d{};
    for (size_t row = 0; row < 12; row += 4) {
        for (size_t k = 0; k < 3; ++k) d[row + k] = dot({b[row], b[row + 1], b[row + 2]}, columns[k]) / det;
        d[row + 3] = b[row + 3] - dot({d[row], d[row + 1], d[row + 2]}, {a[3], a[7], a[11]});
    }
    return d;
}

template <size_t n>
constexpr std::array<double, n> filled(double value) {
    std::array<double, n> values{};
    values.fill(value);
    return values;
}

// Bounds of points in n dimensions; low > high if empty.
template <size_t n>
struct Bounds {
    std::array<double, n> low = filled<n>(HUGE_VAL), high = filled<n>(-HUGE_VAL);

    void add(const std::array<double, n>& p) { add({p, p}); }
    void add(const Bounds& other) {
        for (size_t k = 0; k < n; ++k) {
            low[k] = std::min(low[k], other.low[k]);
            high[k] = std::max(high[k], other.high[k]);
        }
    }
    static Bounds around(std::span<const std::array<double, n>> points) {
        Bounds bounds;
        for (const std::array<double, n>& p : points) bounds.add(p);
        return bounds;
    }
    bool is_empty() const { return low[0] > high[0]; }
    bool overlaps(const Bounds& other) const {
        for (size_t k = 0; k < n; ++k)
            if (high[k] < other.low[k] || other.high[k] < low[k]) return false;
        return true;
    }
    bool contains(const std::array<double, n>& p) const { return overlaps({p, p}); }
    double longest_side() const { return std::ranges::max(high - low); }
    double diagonal() const { return length(high - low); }
};

// An axis-aligned bounding box.
using Box = Bounds<3>;

// Six times the signed volume of the tetrahedron a, b, c, d: positive if d sees a, b, c counterclockwise. Rounded: use
// orientation() of predicates.h for decisions by sign.
inline double signed_volume6(const Point& a, const Point& b, const Point& c, const Point& d) {
    return dot(cross(b - a, c - a), d - a);
}

inline double area(const Point& a, const Point& b, const Point& c) { return length(cross(b - a, c - a)) / 2; }

// The corners of the facet opposite each corner of a tetrahedron, counterclockwise seen from outside.
inline constexpr std::array<std::array<size_t, 3>, 4> facet_corners = {{{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}}};

inline Triangle facet(const Tetrahedron& tetrahedron, size_t opposite) {
    const auto& [i, j, k] = facet_corners[opposite];
    return {tetrahedron[i], tetrahedron[j], tetrahedron[k]};
}

struct Plane {
    Point normal{};     // of length 1
    double offset = 0;  // of the plane's points along the normal

    double height(const Point& p) const { return dot(normal, p) - offset; }
    Point mirrored(const Point& p) const { return p - 2 * height(p) * normal; }
};

// The 13 directions, up to sign, with coordinates -1, 0 or 1.
constexpr size_t lattice_directions = 13;
inline Point lattice_direction(size_t i) {
    const auto code = static_cast<int>(i) + 14;  // in base 3
    return {static_cast<double>(code / 9 - 1), static_cast<double>(code / 3 % 3 - 1), static_cast<double>(code % 3 - 1)};
}

}  // namespace partwheel
