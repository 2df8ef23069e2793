// The top levels follow the hierarchy's merges; each group is divided by the binned surface area heuristic (SAH).
#include "query/tree.h"

namespace partwheel::index {

namespace {

constexpr size_t max_leaf_size = 4;

// Bins along the longest side of the box of centers; deeper levels are divided at the median.
constexpr size_t n_bins = 16;
constexpr int max_sah_depth = 48;

float round_outward(double x, float direction) {
    const auto f = static_cast<float>(x);
    return (direction < 0 ? f > x : f < x) ? std::nextafter(f, direction) : f;
}

double half_area(const Box& box) {
    const Point side = box.high - box.low;
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
}

Point twice_center(const Box& box) { return box.is_empty() ? Point{} : box.low + box.high; }

}  // namespace

PartBvh::PartBvh(std::span<const Box> items, const TopLevels& top) : order(iota(items.size())) {
    nodes.reserve(items.size() / 2);
    std::vector<Subtree> subtrees;
    for (size_t g = 0; g < top.groups(); ++g) {
        subtrees.push_back(build(items, idx(top.bounds[g]), idx(top.bounds[g + 1]), 0));
        subtrees.back().id = static_cast<int32_t>(g);
    }
    for (const auto& [a, b] : top.merges) {
        const Subtree &left = subtrees[idx(a)], &right = subtrees[idx(b)];
        Subtree whole = left.empty() ? right : right.empty() ? left : add_node(left, right);
        whole.id = static_cast<int32_t>(subtrees.size());
        subtrees.push_back(whole);
    }
    root = subtrees.back();
}

PartBvh::Subtree PartBvh::add_node(const Subtree& a, const Subtree& b) {
    Node node;
    for (size_t side = 0; side < 2; ++side) {
        const Subtree& s = side == 0 ? a : b;
        for (size_t k = 0; k < 3; ++k) {
            node.low[k][side] = round_outward(s.box.low[k], -HUGE_VALF);
            node.high[k][side] = round_outward(s.box.high[k], HUGE_VALF);
        }
        node.child[side] = s.child;
        node.count[side] = s.count;
    }
    nodes.push_back(node);
    ids.push_back({a.id, b.id});
    Subtree whole{a.box, static_cast<int32_t>(nodes.size() - 1)};
    whole.box.add(b.box);
    return whole;
}

PartBvh::Subtree PartBvh::build(std::span<const Box> items, size_t first, size_t last, int depth) {
    if (last - first > max_leaf_size) {
        const size_t m = split(items, first, last, depth);
        const Subtree a = build(items, first, m, depth + 1), b = build(items, m, last, depth + 1);
        return add_node(a, b);
    }
    Subtree leaf;
    for (size_t i = first; i < last; ++i) leaf.box.add(items[idx(order[i])]);
    if (last > first) leaf.child = static_cast<int32_t>(first), leaf.count = static_cast<int32_t>(last - first);
    return leaf;
}

// Partitions the items where the sum of area x count over both sides is smallest. Returns the start of the upper side.
size_t PartBvh::split(std::span<const Box> items, size_t first, size_t last, int depth) {
    Box centers;
    for (size_t i = first; i < last; ++i) centers.add(twice_center(items[idx(order[i])]));
    const Point extent = centers.high - centers.low;
    const auto axis = static_cast<size_t>(std::max_element(extent.begin(), extent.end()) - extent.begin());
    const auto begin = order.begin() + static_cast<std::ptrdiff_t>(first),
               end = order.begin() + static_cast<std::ptrdiff_t>(last);
    if (extent[axis] > 0 && depth < max_sah_depth) {
        const double per_bin = n_bins / extent[axis];
        const auto bin = [&](int32_t i) {
            const double place = (twice_center(items[idx(i)])[axis] - centers.low[axis]) * per_bin;
            return std::min(static_cast<size_t>(place), n_bins - 1);
        };
        std::array<Box, n_bins> boxes;
        std::array<size_t, n_bins> counts{};
        for (size_t i = first; i < last; ++i) {
            const size_t b = bin(order[i]);
            boxes[b].add(items[idx(order[i])]);
            ++counts[b];
        }
        std::array<double, n_bins> costs{};  // of a split before each bin
        const auto sweep = [&](size_t b, Box& box, size_t& count) {
            if (counts[b] == 0) return count > 0 ? half_area(box) * static_cast<double>(count) : 0;
            box.add(boxes[b]);
            count += counts[b];
            return half_area(box) * static_cast<double>(count);
        };
        Box below, above;
        size_t in_below = 0, in_above = 0;
        for (size_t b = 1; b < n_bins; ++b) costs[b] += sweep(b - 1, below, in_below);
        for (size_t b = n_bins; --b > 0;) costs[b] += sweep(b, above, in_above);
        const auto best = static_cast<size_t>(std::min_element(costs.begin() + 1, costs.end()) - costs.begin());
        const auto m = std::stable_partition(begin, end, [&](int32_t i) { return bin(i) < best; });
        if (m != begin && m != end) return static_cast<size_t>(m - order.begin());
    }
    const auto m = begin + (end - begin) / 2;
    std::sort(begin, end, [&](int32_t i, int32_t j) {
        const double x = twice_center(items[idx(i)])[axis], y = twice_center(items[idx(j)])[axis];
        return x != y ? x < y : i < j;
    });
    return static_cast<size_t>(m - order.begin());
}

}  // namespace partwheel::index
