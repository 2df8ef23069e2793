// An outer approximation of a hull with fewer vertices.
#pragma once

#include "base/geometry.h"
#include "base/progress.h"

namespace partwheel::convex {

// A convex polytope with at most max_vertices (8 or more) vertices that contains the hull exactly, with a margin of
// about 1e-9 of its box. Starts from the hull's box; each step adds the supporting plane of the hull toward the
// polytope's farthest corner, in coordinates in which the box is a cube.
TriangleMesh simplify_outer_hull(const TriangleMesh& hull, size_t max_vertices,
                                 Progress& progress = unobserved_progress());

}  // namespace partwheel::convex
