// The third fill method: tetrahedra from points on the mesh, inside where its triangles wind around them. It may be open.
#pragma once

#include "fill/tetrahedra.h"

namespace partwheel {

// The Delaunay tetrahedralization of the mesh's vertices and of points spread over its triangles, of which those are
// kept that the mended mesh winds around; their boundary, the surface used, is smooth where that leaves a choice. Works
// in the stages repair and tetrahedra; the result is the same for any number of threads (as cluster() takes it).
// Throws PW_ERROR_NOT_SOLID if there is nothing but sheets, which wind around nothing together.
// least_points: to be spread over a mesh of fewer vertices.
Solid from_points(const Surface& source, size_t least_points, size_t threads, Progress& progress);

}  // namespace partwheel
