// A bounding volume hierarchy (BVH) of boxes whose top levels are those of a part hierarchy.
#pragma once

#include "base/geometry.h"

namespace partwheel::index {

// Both children side by side, tested together.
struct alignas(64) Node {
    std::array<std::array<float, 2>, 3> low, high;  // [axis][child], rounded outward
    std::array<int32_t, 2> child;  // a node, or the first item of a leaf
    std::array<int32_t, 2> count;  // items of a leaf; 0 for a node

    Box box(size_t side) const {
        return {{low[0][side], low[1][side], low[2][side]}, {high[0][side], high[1][side], high[2][side]}};
    }
};

// The top levels of a hierarchy: group g has the items bounds[g] to bounds[g + 1] - 1; merge j creates id groups + j
// from two earlier ids.
struct TopLevels {
    std::vector<int32_t> bounds;
    std::vector<std::array<int32_t, 2>> merges;

    size_t groups() const { return bounds.size() - 1; }
};

struct PartBvh {
    // Empty: child = -1, count = 0.
    struct Subtree {
        Box box;
        int32_t child = -1, count = 0;
        int32_t id = -1;  // of the group or merge that it equals; -1: part of a group

        bool empty() const { return child < 0; }
    };

    Subtree root;
    std::vector<Node> nodes;
    std::vector<std::array<int32_t, 2>> ids;  // of the children
    std::vector<int32_t> order;                   // of the items: leaves are ranges

    PartBvh() = default;
    // items: their boxes; coordinates must fit into float.
    PartBvh(std::span<const Box> items, const TopLevels& top);

    Subtree child(int32_t node, size_t side) const {
        const Node& n = nodes[idx(node)];
        return {n.box(side), n.child[side], n.count[side], ids[idx(node)][side]};
    }

    // Calls visit(position) for items by their positions in `order`, the nearer child first. distance(node, side): to a
    // child. Children farther than `limit`, which visit may lower, are skipped.
    template <class Distance, class Visit>
    void nearest_first(const Distance& distance, const double& limit, const Visit& visit) const {
        if (!root.empty()) nearest_first(root.child, root.count, distance, limit, visit);
    }

private:
    template <class Distance, class Visit>
    void nearest_first(int32_t child, int32_t count, const Distance& distance, const double& limit,
                       const Visit& visit) const {
        for (auto i = idx(child); i < idx(child + count); ++i) visit(i);
        if (count > 0) return;
        const Node& node = nodes[idx(child)];
        const std::array<double, 2> near = {distance(node, 0), distance(node, 1)};
        const size_t first = near[1] < near[0];
        for (const size_t side : {first, 1 - first})
            if (near[side] <= limit) nearest_first(node.child[side], node.count[side], distance, limit, visit);
    }

    Subtree add_node(const Subtree& a, const Subtree& b);
    Subtree build(std::span<const Box> items, size_t first, size_t last, int depth);
    size_t split(std::span<const Box> items, size_t first, size_t last, int depth);
};

}  // namespace partwheel::index
