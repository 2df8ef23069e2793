// Hierarchical tet clustering (the paper's Listing 1): from the dual graph to a merge tree with a cost for each merge.
#pragma once

#include "base/progress.h"
#include "cluster/binary_tree.h"
#include "fill/tetrahedra.h"

namespace partwheel {

// Up to this many components, all pairs are candidates for a merge; above, each component and its nearest ones.
inline constexpr int32_t all_pairs_components = 64;

// The paper's Listing 1 on the dual graph. When no dual edge is left, the components merge in the same way, by the
// concavity of the hull of their union, with pairs of components instead of dual edges.
//
// Two facts make it fast and keep it exact. The hull of a union needs only the vertices of the two hulls. And
// conv(A u B u C) contains conv(A u C), so after a merge an old hull volume is a lower bound: only an edge at the top
// of the queue needs its exact cost.
//
// threads: the maximum number; 0: as many as help. The tree is the same for any number, bit for bit.
BinaryTree cluster(const TetMesh& mesh, Progress& progress, size_t threads = 1);

}  // namespace partwheel
