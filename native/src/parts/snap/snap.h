// Borders in the creases nearby: each split of a tree of parts moved, from the root down, by a minimum cut through the
// tetrahedra.
//
// regroup() joins clusters of tetrahedra, whose borders are where hulls had them: ragged, and beside the crease in
// which people end a part. So each split above the parts is moved within what it splits, before those below it. What
// lies between the two halves is a sheet of facets. It costs its area, and its edges on the surface by their length and
// crease (mesh/crease.h). In a band around the split the sheet that costs least is taken, after Katz and Tal,
// "Hierarchical Mesh Decomposition Using Fuzzy Clustering and Cuts" (2003), who cut the surface alone. Tetrahedra and
// faces so stay one tree, and what is split in one piece is split into two. tests/core/reference_snap.py does the same
// from what is said here:
//
// A tetrahedron's area is that of its outer triangles, its place the mean of their middles, or else its own middle.
// Those with a common facet are neighbours.
//
// Halves. The last join splits all tetrahedra, each other join what the split above left to it. Its first half is the
// one of the lower number. A tetrahedron is of the half that its part was joined into. Newcomers, which splits above
// brought from elsewhere, go with the half that is fewest facets away through them, the first if both are; all go with
// the first if there is nothing but newcomers. A half of less than 0.001 of the model's area would be a crumb: where both
// together have 0.01 or more, and tetrahedra of two of the two halves and the newcomers are neighbours, all of it is
// newcomers (first the first half, then the second as it is then).
//
// Pieces. Each half has a largest piece: of most area, in single precision; where they tie the one of most tetrahedra,
// then the one with the lowest. What is apart from it, and beside the other half, changes sides: first of the first
// half, then of the second as it has become.
//
// Band. The reach is 0.6 times the square root of the smaller half's area. If it is 0, or both halves have less than
// 0.01 of the model's area, the split stays like that. The depth of a tetrahedron is the length of the shortest way
// from it to the split, from place to place of neighbours in its half; the last step, over the split, counts half. If
// more than 12000 tetrahedra are no deeper than the reach, the depth of the 12001st is the reach instead. What is
// deeper counts as infinitely deep. Free is what is less deep (by more than 1e-9 of it) than the reach and than half
// the greatest depth in its half.
//
// Costs. A facet costs, in whole numbers,
//
//     1 + round(min(2^36, 2^24 (1 + 0.3 away) (0.3 area / reach^2 + folds / reach)))
//
// where folds is the sum of length x weight (mesh/crease.h) over those of its edges that are on the surface, and
// away is 0 between the halves, else the mean depth of its two tetrahedra / reach, at most 1.
//
// Cut. What is free is divided anew, such that the facets between the two halves cost least in all; of several such
// cuts the one with the smallest first half, which is within all others. If pieces would have to change sides now, or a
// half would be a crumb, the split stays as it was before the cut.
#pragma once

#include "fill/tetrahedra.h"
#include "parts/part_tree.h"

namespace partwheel {

// The same joins with other parts. Those that have lost all their tetrahedra are gone, and the joins with them.
PartTree snapped(const TetMesh& mesh, const PartTree& joins, Progress& progress);

// The same joins with borders where they are: from the root down, a piece that lies apart from the largest piece of its half,
// has less than 0.1 of its area and is beside the other half changes sides. Larger pieces are meant: images joined at once.
// A half that has lost all its area is newcomers.
PartTree reassign_small_components(const TetMesh& mesh, const PartTree& joins, Progress& progress);

}  // namespace partwheel
