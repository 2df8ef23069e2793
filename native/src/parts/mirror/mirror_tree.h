// Parts and their mirror images, joined in the same order.
#pragma once

#include "parts/part_tree.h"
#include "parts/mirror/mirror_parts.h"

namespace partwheel {

// The parts of the side that is worth more copied to the other side of each plane (mirror.h), and joined in the order in
// which what they stand for was, each join with its images at once: two, or where an image meets what it is the image of
// more; then each of these but the first is joined with one before it. worth: of each tetrahedron, for its area. Beside
// the borders a copied part may have small separate components, which reassign_small_components() of snap.h moves.
PartTree mirror_tree(const TetMesh& mesh, std::span<const Plane> planes, const PartTree& joins, std::span<const double> worth,
            Progress& progress);

// Its second half: the parts joined as those before were that stand for them, or nothing but the scraps, which are to be
// dissolved: parts that nothing reaches, in all less than this share of the area. areas: of the parts.
PartTree merge_symmetrically(const TetLabels& parts, std::span<const double> areas, const PartTree& before, double scrap,
                   std::vector<int32_t>& scraps);

}  // namespace partwheel
