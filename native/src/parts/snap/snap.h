// Border snapping: from the root of a part tree down, each split is moved into the creases nearby by a minimum cut
// through the tetrahedra.
//
// merge_parts() merges clusters of tetrahedra, whose borders are ragged and lie next to the crease in which people
// end a part. So each split above the initial parts is moved within the tetrahedra that it divides, before the splits
// below it. A sheet of facets separates the two halves. It costs its area, plus its edges on the surface by their
// length and crease (mesh/crease.h). In a band around the split, the cheapest sheet wins, after Katz and Tal,
// "Hierarchical Mesh Decomposition Using Fuzzy Clustering and Cuts" (2003), who cut the surface only. So tetrahedra
// and faces remain one tree, and a connected set is split into two connected sets. tests/core/reference_snap.py
// implements this description:
//
// Definitions. The area of a tetrahedron is that of its boundary facets; its position is the mean of their centroids,
// or else its own centroid. Tetrahedra with a common facet are neighbors.
//
// Halves. The last merge splits all tetrahedra, each other merge those that the splits above left to it. The first
// half is the one with the lower number. A tetrahedron belongs to the half that its part was merged into. Tetrahedra
// that splits above brought from elsewhere are unassigned: they go to the half that is fewest facets away through
// unassigned ones, to the first half in a tie or if all are unassigned. A half is too small if it has less than 0.001
// of the model's area while both together have 0.01 or more, and some neighbors belong to two of the three sets
// (halves, unassigned): then all of it becomes unassigned (first the first half, then the second, given the result).
//
// Components. Each half has a largest component: by area, in single precision; then by the number of tetrahedra; then
// by the lowest tetrahedron. Components other than the largest that touch the other half change sides: those of the
// first half first, then those of the second, given the result.
//
// Band. The reach is 0.6 times the square root of the smaller half's area. If it is 0, or both halves have less than
// 0.01 of the model's area, the split stays. The depth of a tetrahedron is the length of the shortest path to the
// split, from position to position of neighbors in its half; the last step, across the split, counts half. If more
// than 12000 tetrahedra are at most as deep as the reach, the depth of the 12001st is the reach instead. Deeper ones
// count as infinitely deep. A tetrahedron is free if it is less deep (by more than 1e-9 of it) than the reach, than
// half the greatest depth in its half, and than half the greatest depth that its half has in the same limb. So a limb
// doesn't change sides as a whole: twelve posts between rail and steps would all become one part with the rail.
//
// Costs. A facet costs, as an integer,
//
//     1 + round(min(2^36, 2^24 (1 + 0.3 away) (0.3 area / reach^2 + edges / reach)))
//
// where edges is the sum of length x weight (mesh/crease.h) over its edges on the surface, and away is 0 between the
// halves, otherwise the mean depth of its two tetrahedra / reach, at most 1.
//
// Cut. The free tetrahedra are divided so that the facets between the halves cost least in total; of several such
// cuts, the one with the smallest first half, which is contained in all others. If components would have to change
// sides afterward, or a half would be too small, the split stays as it was before the cut.
#pragma once

#include "fill/tetrahedra.h"
#include "parts/part_tree.h"
#include "parts/regions.h"

namespace partwheel {

// The same tree with its borders snapped. Parts that lose all their tetrahedra disappear, and so do their merges.
// limb_of: of each part, the node that is a limb and contains it, or -1; none contains another.
// regions: null, or those that marks divide the solid into: a split along marks stays.
PartTree snap_borders(const TetMesh& mesh, const PartTree& tree, std::span<const int32_t> limb_of, Progress& progress,
                      const Regions* regions = nullptr);

// The same tree with its borders unchanged: from the root down, a component changes sides if it is not the largest of
// its half, has less than 0.1 of the largest one's area, and touches the other half. Larger components are intended:
// mirror images that merged at once. A half without area becomes unassigned. regions: as for snap_borders().
PartTree reassign_small_components(const TetMesh& mesh, const PartTree& tree, Progress& progress,
                                   const Regions* regions = nullptr);

}  // namespace partwheel
