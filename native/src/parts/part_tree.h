// Parts of the tetrahedra, and what is joined from them, two at a time.
#pragma once

#include "base/geometry.h"

#include <array>
#include <span>
#include <vector>

namespace partwheel {

// Parts have the numbers 0 to count - 1, what join j makes is number count + j. The last join makes the whole.
struct PartTree {
    std::vector<int32_t> of;  // each tetrahedron: its part
    size_t count = 0;         // of the parts; none is empty
    std::vector<std::array<int32_t, 2>> joined;
    std::vector<double> costs;                 // of each join
    std::vector<uint8_t> steps;                // of each join: whether what it makes is but a step to what is more than two
    std::vector<std::vector<int32_t>> images;  // by plane: of each number its mirror image, or -1
};

// The same with other parts of the tetrahedra, of which some may be empty: those go, and the joins with them.
PartTree relabel(const PartTree& joins, std::span<const int32_t> of);

}  // namespace partwheel
