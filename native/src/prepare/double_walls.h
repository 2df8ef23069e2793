// Double walls: an inner wall close behind the outer one, as generated meshes and hollow prints have.
#pragma once

#include "base/geometry.h"
#include "base/progress.h"

namespace partwheel {

// For each triangle: -1, or, if it is part of an inner wall, the outer triangle in front of it. Empty if there is no
// double wall.
//
// The triangles are those of one connected shell and of the shells enclosed in it. Holes may connect both walls, and
// the inner wall may be oriented either way. An enclosed shell most of which is visible from outside is no inner wall.
// The result does not depend on the order of the triangles.
std::vector<int32_t> find_double_wall(std::span<const Point> vertices, std::span<const Triangle> triangles,
                                      Progress& progress);

}  // namespace partwheel
