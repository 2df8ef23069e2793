// Propagation of part labels to unlabeled tetrahedra (label -1).
#pragma once

#include "parts/boundary.h"
#include "parts/mirror/votes.h"

#include <vector>

namespace partwheel {

// Gives each tetrahedron that has votes its majority label.
void assign_majority(std::vector<Vote> votes, std::vector<int32_t>& label);

// Gives each unlabeled tetrahedron its majority label; then, layer by layer, each of the others that of its labeled
// neighbors, weighted by the area of the common facets. Unreachable tetrahedra stay unlabeled.
void propagate_labels(const TetMesh& mesh, std::vector<Vote> votes, std::vector<int32_t>& label, Progress& progress);

// The votes of labeled tetrahedra (label >= 0) for their unlabeled neighbors.
std::vector<Vote> neighbor_votes(const TetMesh& mesh, const std::vector<int32_t>& label);

}  // namespace partwheel
