// Points and measures of triangles and tetrahedra that are given by their vertices.
#pragma once

#include "base/geometry.h"

namespace partwheel {

// The points at the corners of a triangle or tetrahedron.
template <size_t n>
std::array<Point, n> corner_points(std::span<const Point> vertices, const std::array<int32_t, n>& corners) {
    std::array<Point, n> points;
    for (size_t k = 0; k < n; ++k) points[k] = vertices[idx(corners[k])];
    return points;
}

inline std::vector<Point> points_at(std::span<const Point> vertices, std::span<const int32_t> numbers) {
    std::vector<Point> points;
    points.reserve(numbers.size());
    for (const int32_t v : numbers) points.push_back(vertices[idx(v)]);
    return points;
}

// The mean of these points.
template <size_t n>
Point centroid(std::span<const Point> vertices, const std::array<int32_t, n>& corners) {
    Point sum{};
    for (const int32_t v : corners) sum = sum + 1.0 / n * vertices[idx(v)];
    return sum;
}

// The corner of a tetrahedron that is not one of its facet's.
inline size_t opposite_corner(const Tetrahedron& tetrahedron, const Triangle& of_facet) {
    size_t k = 0;
    while (std::ranges::find(of_facet, tetrahedron[k]) != of_facet.end()) ++k;
    return k;
}

inline double area(std::span<const Point> vertices, const Triangle& triangle) {
    const auto [a, b, c] = corner_points(vertices, triangle);
    return area(a, b, c);
}

inline double signed_volume6(std::span<const Point> vertices, const Tetrahedron& tetrahedron) {
    const auto [a, b, c, d] = corner_points(vertices, tetrahedron);
    return signed_volume6(a, b, c, d);
}

}  // namespace partwheel
