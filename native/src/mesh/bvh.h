// A bounding volume hierarchy over a sequence of items whose neighbors are near each other, as along a space-filling
// curve.
#pragma once

#include "base/geometry.h"

namespace partwheel {

inline double squared_distance(const Box& a, const Box& b) {
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) {
        const double gap = std::max(std::max(a.low[k] - b.high[k], b.low[k] - a.high[k]), 0.0);  // no branches
        sum += gap * gap;
    }
    return sum;
}

inline double squared_distance(const Box& box, const Point& p) { return squared_distance(box, Box{p, p}); }

// A balanced binary tree: the children of a node halve its range of items.
class Bvh {
public:
    // The subtree of items [first, last) has 2 (last - first) - 1 nodes, from `index` on, in preorder.
    struct Node {
        size_t index, first, last;
        bool is_leaf() const { return last - first == 1; }
    };

    // The bounds of each item.
    explicit Bvh(std::span<const Box> items = {}) : bounds_(items.empty() ? 0 : 2 * items.size() - 1) {
        if (!items.empty()) set_bounds(items, root());
    }

    bool empty() const { return bounds_.empty(); }
    Node root() const { return {0, 0, (bounds_.size() + 1) / 2}; }
    const Box& bounds(const Node& node) const { return bounds_[node.index]; }
    std::array<Node, 2> children(const Node& node) const {
        const size_t middle = node.first + (node.last - node.first) / 2;
        return {{{node.index + 1, node.first, middle}, {node.index + 2 * (middle - node.first), middle, node.last}}};
    }

    // Calls visit(item), in order, for the items that all nodes with may_contain(bounds) lead to, until it returns
    // true. Returns whether it did.
    template <class MayContain, class Visit>
    bool any_of(const MayContain& may_contain, const Visit& visit) const {
        return !empty() && any_of(root(), may_contain, visit);
    }

    // Calls visit(item, distance), the nearer child first. distance(bounds) is at most that of each item within. Before
    // a node is entered, is_wanted(distance, first item) decides whether.
    template <class Distance, class IsWanted, class Visit>
    void nearest_first(const Distance& distance, const IsWanted& is_wanted, const Visit& visit) const {
        if (!empty()) nearest_first(root(), 0, distance, is_wanted, visit);
    }

private:
    const Box& set_bounds(std::span<const Box> items, const Node& node) {
        Box& result = bounds_[node.index];
        if (node.is_leaf()) return result = items[node.first];
        for (const Node& child : children(node)) result.add(set_bounds(items, child));
        return result;
    }

    template <class MayContain, class Visit>
    bool any_of(const Node& node, const MayContain& may_contain, const Visit& visit) const {
        if (!may_contain(bounds(node))) return false;
        if (node.is_leaf()) return visit(node.first);
        const auto [left, right] = children(node);
        return any_of(left, may_contain, visit) || any_of(right, may_contain, visit);
    }

    template <class Distance, class IsWanted, class Visit>
    void nearest_first(const Node& node, double far, const Distance& distance, const IsWanted& is_wanted,
                       const Visit& visit) const {
        if (!is_wanted(far, node.first)) return;
        if (node.is_leaf()) return visit(node.first, far);
        const std::array<Node, 2> child = children(node);
        const std::array<double, 2> from = {distance(bounds(child[0])), distance(bounds(child[1]))};
        const size_t nearer = from[1] < from[0];
        for (const size_t i : {nearer, 1 - nearer}) nearest_first(child[i], from[i], distance, is_wanted, visit);
    }

    std::vector<Box> bounds_;
};

}  // namespace partwheel
