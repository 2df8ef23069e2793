// Points, index tuples and the signed volume: the words that all rooms share.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace partwheel {

using Point = std::array<double, 3>;
using Triangle = std::array<int32_t, 3>;    // vertex indices, counter-clockwise seen from outside
using Tetrahedron = std::array<int32_t, 4>;  // vertex indices, positively oriented

inline Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

inline Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Six times the signed volume of the tetrahedron a, b, c, d: positive if d sees a, b, c counter-clockwise. Rounded;
// use orientation() of predicates.h where the sign decides.
inline double six_volumes(const Point& a, const Point& b, const Point& c, const Point& d) {
    return dot(cross(b - a, c - a), d - a);
}

inline double area(const Point& a, const Point& b, const Point& c) {
    const Point n = cross(b - a, c - a);
    return std::sqrt(dot(n, n)) / 2;
}

}  // namespace partwheel
