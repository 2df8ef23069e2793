// Nodes that may lie on either side of a border, and the border that costs least.
#pragma once

#include "base/adjacency.h"

namespace partwheel {

// The band around a border: as find_shortest_paths(), within reach, which is reduced if more than max_count items are nearer.
// visit returns nothing. Returns the items within reach. All others get an infinite distance, also those of start.
template <class Visit>
std::vector<int32_t> find_band(double& reach, size_t max_count, std::span<double> distances, std::span<const int32_t> start,
                               const Visit& visit) {
    std::vector<int32_t> band;
    const auto is_beyond = [&](int32_t item) {
        if (distances[idx(item)] <= reach) return false;
        distances[idx(item)] = HUGE_VAL;
        return true;
    };
    std::ranges::remove_copy_if(start, std::back_inserter(band), is_beyond);
    size_t n_visited = 0;
    find_shortest_paths(distances, start, [&](int32_t item, double distance, const auto& relax) {
        if (n_visited++ == max_count) {
            reach = distance;
            return false;
        }
        visit(item, distance, [&](int32_t neighbor, double longer) {
            if (longer > reach) return;
            if (distances[idx(neighbor)] == HUGE_VAL) band.push_back(neighbor);
            relax(neighbor, longer);
        });
        return true;
    });
    std::erase_if(band, is_beyond);
    return band;
}

// What it costs to have two nodes on different sides.
struct CutEdge {
    int32_t one, other;
    int64_t cost;  // > 0
};

// The cost in units of 2^-24, from 1 to 2^36 + 1. Sums of integers are exact, so the minimum is, too.
inline int64_t quantize_cost(double cost) {
    constexpr double most = static_cast<double>(int64_t{1} << 36);
    return 1 + static_cast<int64_t>(std::min(cost * (1 << 24), most) + 0.5);
}

struct Cut {
    std::vector<CutEdge> edges;
    std::vector<int64_t> to_part, to_rest;  // of each node: the cost of its edges to fixed nodes of the part, of the rest

    void set_node_count(size_t count) {
        to_part.assign(count, 0);
        to_rest.assign(count, 0);
    }
    // An edge between a node and another one, or a fixed one (other: -1), which is in the part or not.
    void add_edge(size_t node, int32_t other, bool is_in_part, int64_t cost) {
        if (other >= 0)
            edges.push_back({static_cast<int32_t>(node), other, cost});
        else
            (is_in_part ? to_part : to_rest)[node] += cost;
    }
};

// For each node 1 if it belongs to the part, 0 if to the rest, so that the sum of the costs between the two is least. Of
// several such parts the smallest, which does not depend on the order of nodes and edges.
std::vector<uint8_t> minimum_cut(const Cut& cut);

}  // namespace partwheel
