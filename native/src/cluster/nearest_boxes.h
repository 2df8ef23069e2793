// The nearest of many boxes.
#pragma once

#include "base/geometry.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace partwheel {

// A balanced binary tree over boxes, split by index: it is fast if nearby boxes have nearby indices.
class NearestBoxes {
public:
    explicit NearestBoxes(std::vector<Box> boxes);

    // The `count` boxes nearest to box i, without i itself, by ascending distance. Among boxes at the same distance the
    // lowest indices win, so that the result depends on the boxes alone.
    std::vector<int32_t> nearest(size_t i, size_t count) const;

private:
    struct Search;
    // Computes the bounding box of boxes [first, last), node n, and of its children, 2 n + 1 and 2 n + 2.
    void build_node(size_t node, size_t first, size_t last);

    std::vector<Box> boxes_, nodes_;
};

}  // namespace partwheel
