// Parts spread into the tetrahedra that have none yet.
#pragma once

#include "fill/tetrahedra.h"
#include "parts/mirror/votes.h"

#include <vector>

namespace partwheel {

// Of a facet: how much of it counts for who is behind.
double facet_area(const TetMesh& mesh, size_t tetrahedron, size_t opposite);

// Each tetrahedron that is claimed gets the part that claims most of it.
void settle(std::vector<Vote> claims, std::vector<int32_t>& part);

// Each tetrahedron of part -1 gets the part that claims most of it; then, layer by layer, those without a claim get that
// of the neighbours behind most of their facets' area. Those that nothing reaches stay as they are.
void spread(const TetMesh& mesh, std::vector<Vote> claims, std::vector<int32_t>& part, Progress& progress);

// The claims of those that have a part (0 or more) on their neighbours of part -1.
std::vector<Vote> neighbor_votes(const TetMesh& mesh, const std::vector<int32_t>& part);

}  // namespace partwheel
