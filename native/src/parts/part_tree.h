// A labeling of the tetrahedra by parts, and the merges of these parts.
#pragma once

#include "base/geometry.h"

namespace partwheel {

// Nodes 0 to count - 1 are the parts, merge j creates node count + j. The last merge creates the root.
struct PartTree {
    std::vector<int32_t> label;  // (T,) the part of each tetrahedron
    size_t count = 0;            // of parts; none is empty
    std::vector<std::array<int32_t, 2>> children;  // of each merge
    std::vector<double> costs;                     // of each merge
    std::vector<uint8_t> is_intermediate;          // of each merge: only a step of a merge of more than two nodes
    std::vector<std::vector<int32_t>> mirror;      // by plane: the mirror image of each node, or -1
};

// Numbers the items with number 0 in sequence, and returns their count.
size_t number_in_sequence(std::span<int32_t> numbers);

// The images of items by new numbers. image: of each old item, or -1; new_id: of each old item, or -1; count: of new
// ones.
std::vector<int32_t> renumber_images(std::span<const int32_t> image, std::span<const int32_t> new_id, size_t count);

// The same tree with another labeling. Parts without tetrahedra disappear, and so do their merges.
PartTree relabel(const PartTree& tree, std::span<const int32_t> label);

}  // namespace partwheel
