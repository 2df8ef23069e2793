// Adjacency: sparse rows, the sides of polygons at each edge, the tetrahedra at each facet, disjoint sets, shortest paths.
#pragma once

#include "base/geometry.h"

#include <queue>

namespace partwheel {

// Items grouped by key (compressed sparse rows), by counting sort: O(keys + items), stable within a row.
template <class Item>
class CsrArray {
public:
    CsrArray() = default;
    // produce(put) must call put(key, item) for each item. It is called twice, with the same items.
    template <class Produce>
    CsrArray(size_t keys, const Produce& produce) : begin_(keys + 2, 0) {
        produce([&](size_t key, const Item&) { ++begin_[key + 2]; });
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        items_.resize(begin_.back());
        produce([&](size_t key, const Item& item) { items_[begin_[key + 1]++] = item; });
    }

    std::span<const Item> items() const { return items_; }
    std::span<Item> row(size_t key) { return std::span(items_).subspan(begin_[key], begin_[key + 1] - begin_[key]); }
    std::span<const Item> row(size_t key) const {
        return std::span(items_).subspan(begin_[key], begin_[key + 1] - begin_[key]);
    }

private:
    std::vector<Item> items_;
    std::vector<size_t> begin_;  // start of each row, then the end twice
};

// Corner k of triangle t has the number 3 t + k, as the side from it to the next one.
template <std::integral Number>
Number next_corner(Number corner) {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

// A side of a facet at an edge with a known lower vertex.
struct Side {
    int32_t high, number;
    bool is_ascending;  // the facet traverses it from the lower vertex to the higher one
};

// Calls visit(low, sides) for each edge, in ascending order of its vertices, with all sides at it, in ascending order.
// ends(i): the vertices that side i runs from and to. Grouping by the lower vertex leaves few sides to sort.
template <class Ends, class Visit>
void for_each_edge(size_t vertices, size_t sides, const Ends& ends, const Visit& visit) {
    CsrArray<Side> by_lower(vertices, [&](const auto& put) {
        for (size_t i = 0; i < sides; ++i) {
            const std::pair<int32_t, int32_t> edge = ends(i);
            const auto [low, high] = std::minmax(edge.first, edge.second);
            put(idx(low), Side{high, static_cast<int32_t>(i), edge.first < edge.second});
        }
    });
    for (size_t v = 0; v < vertices; ++v) {
        const std::span<Side> row = by_lower.row(v);
        std::sort(row.begin(), row.end(), [](const Side& a, const Side& b) {
            return a.high != b.high ? a.high < b.high : a.number < b.number;
        });
        for (size_t i = 0, end = 0; i < row.size(); i = end) {
            while (end < row.size() && row[end].high == row[i].high) ++end;
            visit(static_cast<int32_t>(v), std::span<const Side>(row.subspan(i, end - i)));
        }
    }
}

// The same for the sides of triangles, see next_corner().
template <class Visit>
void for_each_edge(size_t vertices, std::span<const Triangle> triangles, const Visit& visit) {
    const auto ends = [&](size_t side) {
        const Triangle& t = triangles[side / 3];
        return std::pair(t[side % 3], t[(side + 1) % 3]);
    };
    for_each_edge(vertices, 3 * triangles.size(), ends, visit);
}

// A facet of a tetrahedron with a known lowest vertex.
struct TetFacet {
    int32_t middle, high;  // its other vertices, ascending
    int32_t tet, corner;   // it is opposite this corner
};

// Calls visit(facets) for each facet, in ascending order of its sorted vertices, with all tetrahedra that have it,
// ascending.
template <class Visit>
void for_each_facet(std::span<const Tetrahedron> tetrahedra, const Visit& visit) {
    int32_t vertices = 0;
    for (const Tetrahedron& t : tetrahedra) vertices = std::max(vertices, std::ranges::max(t) + 1);
    CsrArray<TetFacet> by_lowest(idx(vertices), [&](const auto& put) {
        for (size_t t = 0; t < tetrahedra.size(); ++t)
            for (size_t c = 0; c < 4; ++c) {
                Triangle v = facet(tetrahedra[t], c);
                std::ranges::sort(v);
                put(idx(v[0]), TetFacet{v[1], v[2], static_cast<int32_t>(t), static_cast<int32_t>(c)});
            }
    });
    for (size_t v = 0; v < idx(vertices); ++v) {
        const std::span<TetFacet> row = by_lowest.row(v);
        std::ranges::sort(row, {}, [](const TetFacet& f) { return std::tie(f.middle, f.high, f.tet); });
        for (size_t i = 0, end = 0; i < row.size(); i = end) {
            while (end < row.size() && row[end].middle == row[i].middle && row[end].high == row[i].high) ++end;
            visit(std::span<const TetFacet>(row.subspan(i, end - i)));
        }
    }
}

// For each tetrahedron, the neighbors across the facets opposite its corners; -1: none. Nothing if more than two
// tetrahedra share a facet.
inline std::optional<std::vector<std::array<int32_t, 4>>> neighbors_across_facets(
    std::span<const Tetrahedron> tetrahedra) {
    std::vector<std::array<int32_t, 4>> neighbors(tetrahedra.size(), {-1, -1, -1, -1});
    bool is_valid = true;
    for_each_facet(tetrahedra, [&](std::span<const TetFacet> facets) {
        is_valid = is_valid && facets.size() <= 2;
        if (facets.size() != 2) return;
        const TetFacet &a = facets[0], &b = facets[1];
        neighbors[idx(a.tet)][idx(a.corner)] = b.tet;
        neighbors[idx(b.tet)][idx(b.corner)] = a.tet;
    });
    if (!is_valid) return {};
    return neighbors;
}

// Disjoint sets of 0..count-1; the representative of a set is its lowest member.
class UnionFind {
public:
    explicit UnionFind(size_t count) : parent_(iota(count)) {}
    size_t find(size_t i) {
        while (idx(parent_[i]) != i) i = idx(parent_[i] = parent_[idx(parent_[i])]);
        return i;
    }
    void unite(size_t a, size_t b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = static_cast<int32_t>(std::min(a, b));
    }

private:
    std::vector<int32_t> parent_;
};

// Dijkstra's algorithm, from those of the start items that have a finite distance. Calls visit(item, distance, relax)
// for items, nearest first, until it returns false. It calls relax(neighbor, distance) for each path to a neighbor.
template <class Visit>
void find_shortest_paths(std::span<double> distances, std::span<const int32_t> start, const Visit& visit) {
    using Entry = std::pair<double, int32_t>;
    std::vector<Entry> entries;
    for (const int32_t item : start)
        if (distances[idx(item)] < HUGE_VAL) entries.emplace_back(distances[idx(item)], item);
    std::priority_queue queue(std::greater<Entry>(), std::move(entries));
    const auto relax = [&](int32_t item, double distance) {
        if (distance < distances[idx(item)]) queue.emplace(distances[idx(item)] = distance, item);
    };
    while (!queue.empty()) {
        const auto [distance, item] = queue.top();
        queue.pop();
        if (distance <= distances[idx(item)] && !visit(item, distance, relax)) return;
    }
}

}  // namespace partwheel
