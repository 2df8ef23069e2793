// Divides tetrahedra by a plane.
#pragma once

#include "base/geometry.h"

namespace partwheel {
class HullKernel;
}

namespace partwheel::convex {

struct SliceResult {
    std::vector<Tetrahedron> below, above;  // above: positive height; corners in arbitrary order
    std::vector<std::array<int32_t, 2>> edges;  // of each added vertex: the edge that it lies on
};

// Vertices within rounding of the plane count as in it and belong to both sides, which avoids slivers. Each edge that
// crosses the plane gets one vertex there, added to the kernel and shared by the tetrahedra around the edge. jitter:
// the largest distance of added vertices from the plane. Tetrahedra may be flat, with a repeated corner.
SliceResult slice(std::span<const Tetrahedron> tetrahedra, const Plane& plane, HullKernel& kernel, double jitter = 0);

}  // namespace partwheel::convex
