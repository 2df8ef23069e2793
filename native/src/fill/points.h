// The third fill method: tetrahedra from points on the mesh, which may be open; the inside is where its triangles wind
// around.
#pragma once

#include "fill/tetrahedra.h"

namespace partwheel {

// The tetrahedra of the Delaunay tetrahedralization of the mesh's vertices, and of points distributed over its
// triangles, around which the repaired mesh winds. Their boundary is the surface used; a smoothing step makes it
// smaller where the winding number is uncertain. Stages: repair and tetrahedra. The result doesn't depend on the number
// of threads (see cluster()). Throws PW_ERROR_NOT_SOLID if there are only sheets that don't enclose anything together.
// least_points: the least number of points.
Solid from_points(const Surface& source, size_t least_points, size_t threads, Progress& progress);

}  // namespace partwheel
