// What a border of a part costs on a surface: less in a crease.
//
// People end parts where a surface is concave (the minima rule). So a border costs its length, times a weight that is 1
// where the surface is flat, and falls with the angle a between the normals of the two faces:
//
//     w = (1 - sin(a / 2)) ^ p       p = 10 at a concave edge, 1 at a convex one
//
// After Golovinskiy and Funkhouser, "Randomized Cuts for 3D Mesh Analysis" (2008): length times (1 - a / pi) ^ 10, at
// concave edges only. sin(a / 2) instead of a / pi needs only a square root, which is the same on every machine. Convex
// edges count a tenth, as in Katz and Tal, "Hierarchical Mesh Decomposition Using Fuzzy Clustering and Cuts" (2003), so
// that a cut follows a box's edges where nothing is concave. The cut in a band with fixed sides is from there, too.
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
