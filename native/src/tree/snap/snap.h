// Borders in the creases nearby: each split of a tree of parts moved, from the root down, by a minimum cut through the
// tetrahedra.
//
// regroup() joins clusters of tetrahedra, whose borders are where hulls had them: ragged, and beside the crease in which
// people end a part. So each split above the parts is moved within what it splits, before those below it. What lies
// between the two halves is a sheet of facets. It costs its area, and its edges on the surface by their length and
// crease (surface/crease.h). In a band around the split the sheet that costs least is taken, after Katz and Tal,
// "Hierarchical Mesh Decomposition Using Fuzzy Clustering and Cuts" (2003), who cut the surface alone. Tetrahedra and
// faces so stay one tree, and what is split in one piece is split into two.
#pragma once

#include "fill/tetrahedra.h"
#include "tree/mirror/joins.h"

namespace partwheel {

// The same joins with other parts; some may be gone.
Joins snapped(const TetMesh& mesh, const Joins& joins, Progress& progress);

}  // namespace partwheel
