// Adjacency: rows of items by key, the facet sides at each edge, and disjoint sets.
#pragma once

#include "base/geometry.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace partwheel {

// Items grouped by key (compressed sparse rows), by counting sort: O(keys + items), stable within a row.
template <class Item>
class CsrArray {
public:
    CsrArray() = default;
    // tell(put) calls put(key, item) for each item. It is called twice and must produce the same items both times.
    template <class Tell>
    CsrArray(size_t keys, const Tell& tell) : begin_(keys + 2, 0) {
        tell([&](size_t key, const Item&) { ++begin_[key + 2]; });
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        items_.resize(begin_.back());
        tell([&](size_t key, const Item& item) { items_[begin_[key + 1]++] = item; });
    }

    std::span<const Item> items() const { return items_; }
    std::span<Item> with(size_t key) { return std::span(items_).subspan(begin_[key], begin_[key + 1] - begin_[key]); }
    std::span<const Item> with(size_t key) const {
        return std::span(items_).subspan(begin_[key], begin_[key + 1] - begin_[key]);
    }

private:
    std::vector<Item> items_;
    std::vector<size_t> begin_;  // start of each row, then the end twice
};

// A side of a facet at an edge whose lower vertex is known.
struct Side {
    int32_t high, number;
    bool upwards;  // from the lower vertex to the higher one
};

// Calls meet(low, sides) for each edge, in ascending order of its vertices, with all sides at it, in ascending order.
// ends(i): the vertices that side i runs from and to. Grouping by the lower vertex leaves few sides to sort.
template <class Ends, class Meet>
void for_each_edge(size_t vertices, size_t sides, const Ends& ends, const Meet& meet) {
    CsrArray<Side> by_lower(vertices, [&](const auto& put) {
        for (size_t i = 0; i < sides; ++i) {
            const std::pair<int32_t, int32_t> way = ends(i);
            const auto [low, high] = std::minmax(way.first, way.second);
            put(idx(low), Side{high, static_cast<int32_t>(i), way.first < way.second});
        }
    });
    for (size_t v = 0; v < vertices; ++v) {
        const std::span<Side> here = by_lower.with(v);
        std::sort(here.begin(), here.end(), [](const Side& a, const Side& b) {
            return a.high != b.high ? a.high < b.high : a.number < b.number;
        });
        for (size_t i = 0, end = 0; i < here.size(); i = end) {
            while (end < here.size() && here[end].high == here[i].high) ++end;
            meet(static_cast<int32_t>(v), std::span<const Side>(here.subspan(i, end - i)));
        }
    }
}

// The same for triangles: side 3 t + k goes from corner k of triangle t to the next.
template <class Meet>
void for_each_edge(size_t vertices, std::span<const Triangle> triangles, const Meet& meet) {
    const auto ends = [&](size_t side) {
        const Triangle& t = triangles[side / 3];
        return std::pair(t[side % 3], t[(side + 1) % 3]);
    };
    for_each_edge(vertices, 3 * triangles.size(), ends, meet);
}

// Disjoint sets of 0..count-1; the representative of a set is its lowest member.
class UnionFind {
public:
    explicit UnionFind(size_t count) : up_(count) { std::iota(up_.begin(), up_.end(), 0); }
    size_t find(size_t i) {
        while (idx(up_[i]) != i) i = idx(up_[i] = up_[idx(up_[i])]);
        return i;
    }
    void join(size_t a, size_t b) {
        a = find(a), b = find(b);
        up_[std::max(a, b)] = static_cast<int32_t>(std::min(a, b));
    }

private:
    std::vector<int32_t> up_;
};

}  // namespace partwheel
