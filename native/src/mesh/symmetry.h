// The planes in which a surface is its own mirror image, nearly.
#pragma once

#include "base/geometry.h"
#include "base/progress.h"

namespace partwheel {

// A point has a mirror image if the surface is within this of its reflection, relative to the bounding box's diagonal.
inline constexpr double mirror_tolerance = 1.0 / 100;

// At most three perpendicular planes, the best first, in each of which at least min_mirrored_share of the area has a
// mirror image. Candidates are normal to the coordinate axes and to the principal axes and go through the centroid, the
// origin or the middle of the bounding box. Each is also moved to where its two sides meet best, if clearly more of the
// surface has a mirror image then. The result doesn't depend on the numbering of vertices and triangles.
inline constexpr double min_mirrored_share = 0.95;
std::vector<Plane> mirror_planes(std::span<const Point> vertices, std::span<const Triangle> triangles,
                                 Progress& progress);

}  // namespace partwheel
