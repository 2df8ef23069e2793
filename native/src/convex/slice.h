// Tetrahedra cut by a plane: tetrahedra on both sides.
#pragma once

#include "base/geometry.h"

#include <array>
#include <span>
#include <vector>

namespace partwheel {
class HullKernel;
}

namespace partwheel::convex {

// The points p with dot(normal, p) = offset. The normal is of length 1.
struct CutPlane {
    Point normal{};
    double offset = 0;

    double height(const Point& p) const { return dot(normal, p) - offset; }
};

struct Sliced {
    std::vector<Tetrahedron> below, above;  // of positive height; corners in no special order
    std::vector<std::array<int32_t, 2>> edges;  // of each vertex that was added: it is between these two
};

// Vertices that are nearer to the plane than rounding are in it, and on both sides: so no slivers are made. Edges that
// cross the plane get a vertex there, which the kernel takes in; each edge one, for all tetrahedra about it. jitter: up to
// so far off it. Tetrahedra may be flat, with a corner repeated.
Sliced slice(std::span<const Tetrahedron> tetrahedra, const CutPlane& plane, HullKernel& kernel, double jitter = 0);

}  // namespace partwheel::convex
