// Connected components of parts: tetrahedra that are connected through common facets.
#pragma once

#include "parts/majority.h"

namespace partwheel {

// In both functions label[t] is the part of tetrahedron t: 0 to count - 1, or unlabeled. Lower labels never change.

// Connects the components of each part by paths of at most 12 unlabeled tetrahedra, the shortest first, until each
// component is connected to the part's largest one.
void connect_components(const TetMesh& mesh, size_t count, std::vector<int32_t>& label);

// Makes all but the largest component of each part unlabeled.
void keep_largest_components(const TetMesh& mesh, size_t count, std::vector<int32_t>& label);

}  // namespace partwheel
