// The tree of boxes: the hierarchy's joins, and below them halves by the surface-area heuristic.
#include "query/tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace partwheel::index {

namespace {

constexpr size_t leaf_size = 4;

// Where halves may be divided, of the longest side of their centres' box; and how deep it may go on like that.
constexpr size_t bins = 16;
constexpr int deepest = 48;

float rounded(double x, float towards) {
    const auto f = static_cast<float>(x);
    return (towards < 0 ? f > x : f < x) ? std::nextafter(f, towards) : f;
}

// Of an item without points.
bool is_empty(const Box& box) { return box.low[0] > box.high[0]; }

void add(Box& box, const Box& other) {
    if (is_empty(other)) return;
    box.add(other.low);
    box.add(other.high);
}

double half_area(const Box& box) {
    const Point side = box.high - box.low;
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
}

Point twice_centre(const Box& box) { return is_empty(box) ? Point{} : box.low + box.high; }

}  // namespace

Tree::Tree(std::span<const Box> items, const Top& top) : order(items.size()) {
    std::iota(order.begin(), order.end(), 0);
    nodes.reserve(items.size() / 2);
    std::vector<Subtree> made;
    for (size_t g = 0; g < top.groups(); ++g) {
        made.push_back(halved(items, idx(top.bounds[g]), idx(top.bounds[g + 1]), 0));
        made.back().number = static_cast<int32_t>(g);
    }
    for (const auto& [a, b] : top.joins) {
        const Subtree &left = made[idx(a)], &right = made[idx(b)];
        Subtree whole = left.empty() ? right : right.empty() ? left : join(left, right);
        whole.number = static_cast<int32_t>(made.size());
        made.push_back(whole);
    }
    root = made.back();
}

Tree::Subtree Tree::join(const Subtree& a, const Subtree& b) {
    Node node;
    for (size_t side = 0; side < 2; ++side) {
        const Subtree& s = side == 0 ? a : b;
        for (size_t k = 0; k < 3; ++k) {
            node.low[k][side] = rounded(s.box.low[k], -HUGE_VALF);
            node.high[k][side] = rounded(s.box.high[k], HUGE_VALF);
        }
        node.child[side] = s.child;
        node.count[side] = s.count;
    }
    nodes.push_back(node);
    numbers.push_back({a.number, b.number});
    Subtree whole{a.box, static_cast<int32_t>(nodes.size() - 1)};
    add(whole.box, b.box);
    return whole;
}

Tree::Subtree Tree::halved(std::span<const Box> items, size_t first, size_t last, int depth) {
    if (last - first > leaf_size) {
        const size_t m = middle(items, first, last, depth);
        const Subtree a = halved(items, first, m, depth + 1), b = halved(items, m, last, depth + 1);
        return join(a, b);
    }
    Subtree leaf;
    for (size_t i = first; i < last; ++i) add(leaf.box, items[idx(order[i])]);
    if (last > first) leaf.child = static_cast<int32_t>(first), leaf.count = static_cast<int32_t>(last - first);
    return leaf;
}

// Puts the items of the lower half first, and says where the other begins: where the sum of area times count is least.
size_t Tree::middle(std::span<const Box> items, size_t first, size_t last, int depth) {
    Box centres;
    for (size_t i = first; i < last; ++i) centres.add(twice_centre(items[idx(order[i])]));
    const Point extent = centres.high - centres.low;
    const auto axis = static_cast<size_t>(std::max_element(extent.begin(), extent.end()) - extent.begin());
    const auto begin = order.begin() + static_cast<std::ptrdiff_t>(first), end = order.begin() + static_cast<std::ptrdiff_t>(last);
    if (extent[axis] > 0 && depth < deepest) {
        const double per_bin = bins / extent[axis];
        const auto bin = [&](int32_t i) {
            const double place = (twice_centre(items[idx(i)])[axis] - centres.low[axis]) * per_bin;
            return std::min(static_cast<size_t>(place), bins - 1);
        };
        std::array<Box, bins> boxes;
        std::array<size_t, bins> counts{};
        for (size_t i = first; i < last; ++i) {
            const size_t b = bin(order[i]);
            add(boxes[b], items[idx(order[i])]);
            ++counts[b];
        }
        std::array<double, bins> costs{};  // of a border before each bin
        const auto sweep = [&](size_t b, Box& box, size_t& count) {
            if (counts[b] == 0) return count > 0 ? half_area(box) * static_cast<double>(count) : 0;
            add(box, boxes[b]);
            count += counts[b];
            return half_area(box) * static_cast<double>(count);
        };
        Box below, above;
        size_t in_below = 0, in_above = 0;
        for (size_t b = 1; b < bins; ++b) costs[b] += sweep(b - 1, below, in_below);
        for (size_t b = bins; --b > 0;) costs[b] += sweep(b, above, in_above);
        const auto best = static_cast<size_t>(std::min_element(costs.begin() + 1, costs.end()) - costs.begin());
        const auto m = std::stable_partition(begin, end, [&](int32_t i) { return bin(i) < best; });
        if (m != begin && m != end) return static_cast<size_t>(m - order.begin());
    }
    const auto m = begin + (end - begin) / 2;
    std::sort(begin, end, [&](int32_t i, int32_t j) {
        const double x = twice_centre(items[idx(i)])[axis], y = twice_centre(items[idx(j)])[axis];
        return x != y ? x < y : i < j;
    });
    return static_cast<size_t>(m - order.begin());
}

}  // namespace partwheel::index
