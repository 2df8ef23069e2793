// A hull of fewer vertices around a hull.
#pragma once

#include "base/geometry.h"

#include <cstddef>

namespace partwheel::convex {

// A convex polytope that contains a closed, convex surface, with `most` vertices at most, 8 or more. Its sides are those of a
// box, and planes against the hull where it went farthest away from it. To be around it in spite of rounding it keeps
// some 1e-9 of the hull's extent away.
TriangleMesh fewer_around(const TriangleMesh& hull, size_t most);

}  // namespace partwheel::convex
