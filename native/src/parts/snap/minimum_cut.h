// Nodes that may lie on either side of a border, and the border that costs least.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace partwheel {

// What it costs to have two nodes on different sides.
struct CutEdge {
    int32_t one, other;
    int64_t cost;  // > 0
};

// A cost in whole numbers of 1 / 2^24, at least 1 and at most some 2^36. So rounding hardly ever decides, and what is
// least is so beyond doubt.
inline int64_t quantize_cost(double cost) {
    constexpr double most = static_cast<double>(int64_t{1} << 36);
    return 1 + static_cast<int64_t>(std::min(cost * (1 << 24), most) + 0.5);
}

struct Cut {
    std::vector<CutEdge> edges;
    std::vector<int64_t> to_part, to_rest;  // of each node: the cost of its edges with what stays in the part, the rest

    void set_node_count(size_t count) {
        to_part.assign(count, 0);
        to_rest.assign(count, 0);
    }
    // An edge between a node and another, or with what stays (other: -1), in the part or not.
    void add_edge(size_t node, int32_t other, bool is_in_part, int64_t cost) {
        if (other >= 0)
            edges.push_back({static_cast<int32_t>(node), other, cost});
        else
            (is_in_part ? to_part : to_rest)[node] += cost;
    }
};

// Of each node 1 if it belongs to the part, 0 to the rest, such that the sum of the costs between the two is least; of
// several such parts the smallest, which is one whatever the order of nodes and edges.
std::vector<uint8_t> minimum_cut(const Cut& cut);

}  // namespace partwheel
