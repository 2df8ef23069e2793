// A tree of boxes over a hierarchy's own: its nodes at the top, below them halves of what is near each other.
#pragma once

#include "base/geometry.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace partwheel::index {

// Both children side by side, to be looked at at once.
struct alignas(64) Node {
    std::array<std::array<float, 2>, 3> low, high;  // of each coordinate, of both; rounded outwards
    std::array<int32_t, 2> child;  // a node; of a leaf its first item
    std::array<int32_t, 2> count;  // of a leaf's items; 0: a node

    Box box(size_t side) const {
        return {{low[0][side], low[1][side], low[2][side]}, {high[0][side], high[1][side], high[2][side]}};
    }
};

// The top of a hierarchy: groups of items, group g those from bounds[g] to bounds[g + 1], and what joins them: join j
// makes number groups + j of two earlier numbers.
struct Top {
    std::vector<int32_t> bounds;
    std::vector<std::array<int32_t, 2>> joins;

    size_t groups() const { return bounds.size() - 1; }
};

struct Tree {
    // Nothing in it: count and child are 0 and -1.
    struct Subtree {
        Box box;
        int32_t child = -1, count = 0;
        int32_t number = -1;  // of the group or join that it is all of; -1: less than a group

        bool empty() const { return child < 0; }
    };

    Subtree root;
    std::vector<Node> nodes;
    std::vector<std::array<int32_t, 2>> numbers;  // of the children, as above
    std::vector<int32_t> order;                   // of the items, in which leaves have them

    Tree() = default;
    // Boxes of the items; coordinates are no larger than floats.
    Tree(std::span<const Box> items, const Top& top);

    Subtree child(int32_t node, size_t side) const {
        const Node& n = nodes[idx(node)];
        return {n.box(side), n.child[side], n.count[side], numbers[idx(node)][side]};
    }

private:
    Subtree join(const Subtree& a, const Subtree& b);
    Subtree halved(std::span<const Box> items, size_t first, size_t last, int depth);
    size_t middle(std::span<const Box> items, size_t first, size_t last, int depth);
};

}  // namespace partwheel::index
