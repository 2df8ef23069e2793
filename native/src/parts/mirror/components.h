// The pieces that parts fall into: tetrahedra that hang together by facets.
#pragma once

#include "fill/tetrahedra.h"

#include <vector>

namespace partwheel {

// part: of each tetrahedron, 0 to count - 1, unsettled, or less, which is not touched.
inline constexpr int32_t unassigned = -1;

// Pieces of the same part are connected by the shortest way through what is unsettled, if it is short: the largest first,
// each with what is nearest.
void connect_components(const TetMesh& mesh, size_t count, std::vector<int32_t>& part);

// Each part keeps its largest piece; what else is of it becomes unsettled.
void keep_largest_components(const TetMesh& mesh, size_t count, std::vector<int32_t>& part);

}  // namespace partwheel
