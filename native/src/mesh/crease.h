// What a border of a part costs on a surface: less in a crease.
//
// People end parts where a surface is concave (the minima rule). So a border costs its length, times a weight that is 1
// where the surface is flat, and falls with the angle a between the normals of the two faces:
//
//     w = (1 - sin(a / 2)) ^ p       p = 10 at a concave edge, 1 at a convex one
//
// After Golovinskiy and Funkhouser, "Randomized Cuts for 3D Mesh Analysis" (2008): length times (1 - a / pi) ^ 10, at
// concave edges alone. sin(a / 2) in place of a / pi needs a square root only, the same on every machine. That convex
// edges count too, a tenth, is from Katz and Tal, "Hierarchical Mesh Decomposition Using Fuzzy Clustering and Cuts"
// (2003), as is the cut in a band with both sides of it held: with nothing concave near, a cut follows a box's edges.
#pragma once

#include "base/geometry.h"

namespace partwheel {

// The weight, by the normals of the two faces, each of length 1.
inline double crease_weight(const Point& n, const Point& m, bool convex) {
    const double base = std::max(1 - length(n - m) / 2, 0.0);
    if (convex) return base;
    const double second = base * base, fourth = second * second;
    return fourth * fourth * second;
}

}  // namespace partwheel
