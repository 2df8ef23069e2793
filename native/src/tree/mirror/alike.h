// In which order parts and their mirror images are joined: as those were that stand for one side.
#pragma once

#include "tree/mirror/mirror.h"

#include <array>
#include <span>
#include <vector>

namespace partwheel {

// What is joined at once: two, or where an image meets what it is the image of more. Parts have the numbers 0 to
// count - 1, what join i makes is number count + i.
struct JoinedAlike {
    std::vector<int32_t> members;
    double cost = 0;
};

struct Alike {
    std::vector<JoinedAlike> joins;
    std::vector<std::vector<int32_t>> images;  // by plane, of all numbers: see PartsOfTetrahedra
    // Scraps that nothing reaches; where there are some the joins are none. To be dissolved.
    std::vector<int32_t> scraps;
};

// joined, costs: the joins of the parts that parts.stands tells of, in order, and what each cost. areas: of the parts.
// scrap: what is left over with less than this share of the area is one.
Alike joined_alike(const PartsOfTetrahedra& parts, std::span<const double> areas,
                   std::span<const std::array<int32_t, 2>> joined, std::span<const double> costs,
                   double scrap);

}  // namespace partwheel
