// Which tetrahedra share a facet.
#pragma once

#include "base/geometry.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace partwheel {

// For each tetrahedron, the neighbors across the facets opposite its corners; -1: none. Throws Error(PW_ERROR_DATA) if
// a tetrahedron repeats a corner or if more than two share a facet.
std::vector<std::array<int32_t, 4>> find_neighbors(std::span<const Tetrahedron> tetrahedra);

}  // namespace partwheel
