// Merges mirrored parts symmetrically.
#pragma once

#include "parts/part_tree.h"
#include "parts/mirror/mirror_parts.h"

namespace partwheel {

// Copies the parts of the side with the better scores to the other side of each plane (mirror_parts.h). The new parts
// merge in the order of their originals, each merge together with its images. Where a merge and an image share a
// part, more than two parts merge at once: an intermediate merge for each but the last, each with a part that already
// belongs to the group. scores: of each tetrahedron, counted by its boundary area. regions: as in mirror_parts.h.
// Copied parts may also have small separate components, which reassign_small_components() of snap.h moves.
PartTree mirror_tree(const TetMesh& mesh, std::span<const Plane> planes, const PartTree& tree,
                     std::span<const double> scores, Progress& progress, const Regions* regions = nullptr);

// For each patch, how well its best node matches it (intersection over union), times its share of the surface.
std::map<int32_t, double> patch_overlaps(const TetMesh& mesh, const PartTree& tree, std::span<const int32_t> patch_of);

// The second half of mirror_tree(): merges parts as their originals merge in the old tree. areas: of the parts. If
// parts remain that no merge reaches, and each has less than max_leftover of the area: returns an empty tree and
// these parts in leftover.
PartTree merge_symmetrically(const TetLabels& parts, std::span<const double> areas, const PartTree& old_tree,
                             double max_leftover, std::vector<int32_t>& leftover);

}  // namespace partwheel
