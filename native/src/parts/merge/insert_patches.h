// Patches as nodes of a tree of parts.
//
// Merging by cost makes a node of a patch only if its border is the most expensive one around. But what an artist has marked is
// worth a node unless that would divide a better one.
#pragma once

#include "fill/tetrahedra.h"
#include "parts/part_tree.h"
#include "parts/regions.h"

namespace partwheel {

// Nodes that overlap by less than this are different stops in any case, see wheel_stops().
inline constexpr double same_look = 0.8;

// The least score of a node with this share of its border marked: what is marked all along is what people see.
inline double mark_score(double share) { return share * share * share * share; }

// For each part: the patch in front of most of its surface, or for parts without surface that of join_inner_parts().
std::vector<int32_t> patches_of_parts(const TetMesh& mesh, const PartTree& tree, const Regions& regions);

// Gives parts without surface the patch of a part with which they merge first, so that every piece of a node has one.
void join_inner_parts(const PartTree& tree, std::span<const uint8_t> has_surface, std::span<int32_t> patch_of);

// For each patch: whether all nodes that it would visibly divide score less than about half of what it does. patch_of: of
// each part; areas, scores: of each node; strengths: of each patch's marks. O(n p log p) time for n nodes and p patches.
std::vector<uint8_t> choose_patches(const PartTree& tree, std::span<const int32_t> patch_of, std::span<const double> areas,
                                    std::span<const double> scores, std::span<const double> strengths);

// Chooses the mirror images of chosen patches, too. patch_of: of each part.
void choose_images(const PartTree& tree, std::span<const int32_t> patch_of, std::vector<uint8_t>& is_chosen);

// The tree with a node for each chosen patch. The smallest node around a patch becomes the union of the patch and the
// rest; nodes below it are divided into a piece in each patch and a piece outside. patch_of: of each part.
PartTree insert_patches(const PartTree& tree, std::span<const int32_t> patch_of, std::span<const uint8_t> is_chosen);

}  // namespace partwheel
