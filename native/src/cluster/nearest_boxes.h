// The nearest of many boxes.
#pragma once

#include "base/geometry.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace partwheel {

// A binary tree over boxes in the order in which they are given, in which nearby boxes should have nearby indices.
class NearestBoxes {
public:
    explicit NearestBoxes(std::vector<Box> boxes);

    // The `count` boxes nearest to box i, without i itself, by ascending distance. Among boxes at the same distance the
    // lowest indices win, so that the result depends on the boxes alone.
    std::vector<int32_t> nearest(size_t i, size_t count) const;

private:
    struct Search;
    // Node n has the boxes [first, last); its children are 2 n + 1 and 2 n + 2.
    void bound(size_t node, size_t first, size_t last);

    std::vector<Box> boxes_, nodes_;
};

}  // namespace partwheel
