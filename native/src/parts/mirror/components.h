// Connected components of parts: tetrahedra that are connected through common facets.
#pragma once

#include "fill/tetrahedra.h"

namespace partwheel {

// In both functions label[t] is the part of tetrahedron t: 0 to count - 1, or unassigned. Lower labels never change.
inline constexpr int32_t unassigned = -1;

// Connects the components of each part by paths of at most 12 unassigned tetrahedra, the shortest first, until each
// component is connected to the part's largest one.
void connect_components(const TetMesh& mesh, size_t count, std::vector<int32_t>& label);

// Makes all but the largest component of each part unassigned.
void keep_largest_components(const TetMesh& mesh, size_t count, std::vector<int32_t>& label);

}  // namespace partwheel
