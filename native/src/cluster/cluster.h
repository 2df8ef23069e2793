// Hierarchical tet clustering: dual graph and queue -> binary tree with a cost for each merge (the paper's Listing 1).
#pragma once

#include "base/progress.h"
#include "cluster/binary_tree.h"
#include "fill/tetrahedra.h"

namespace partwheel {

// Up to this many components each is a candidate to be joined with each other; beyond, with its nearest ones.
inline constexpr int32_t all_pairs_components = 64;

// The paper's Listing 1 on the dual graph. When no dual edge is left, the components' clusters are joined in the same
// way, by the concavity of their common hulls, with pairs of components standing in for dual edges.
//
// Two facts keep it fast and exact. The hull of a union comes from the two hulls. And conv(A u B u C) contains
// conv(A u C), so that after a merge an old hull volume is a lower bound: only an edge that reaches the top of the
// queue needs its exact cost.
//
// threads: at most so many; 0: as many as help. The tree is the same, bit for bit.
BinaryTree cluster(const TetMesh& mesh, Progress& progress, size_t threads = 1);

}  // namespace partwheel
