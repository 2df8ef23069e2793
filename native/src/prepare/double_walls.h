// Double walls: an inner wall close behind the outer one, as generated meshes and hollow prints have.
#pragma once

#include "base/geometry.h"
#include "base/progress.h"

#include <cstdint>
#include <span>
#include <vector>

namespace partwheel {

// For each triangle: -1, or the outer triangle that it lies behind, if the mesh has a double wall. Empty: the mesh has none.
//
// The triangles are those of one connected shell, together with the shells enclosed in it. Leaks may join both walls, and
// the inner one may be wound either way. The result does not depend on the order of the triangles.
std::vector<int32_t> find_inner_walls(std::span<const Point> vertices, std::span<const Triangle> triangles,
                                      Progress& progress);

}  // namespace partwheel
