// A hull of fewer vertices around a hull.
#pragma once

#include "base/geometry.h"

#include <cstddef>

namespace partwheel::convex {

// A convex polytope that contains a closed, convex surface, exactly, with `most` vertices at most, 8 or more. Its sides are
// those of a box, and planes against the hull where it went farthest away from it, as seen where the box is a cube. It keeps
// some 1e-9 of the box's sides away from the hull.
TriangleMesh simplify_outer_hull(const TriangleMesh& hull, size_t most);

}  // namespace partwheel::convex
