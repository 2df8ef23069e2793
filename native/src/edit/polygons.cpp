// Counts edges by their sides, then fans of polygons around vertices.
#include "edit/polygons.h"

#include "base/error.h"
#include "base/adjacency.h"

namespace partwheel {

namespace {

// The successor of each corner in its polygon.
std::vector<int32_t> next_corners(std::span<const int32_t> corners, std::span<const int32_t> begin,
                                  size_t vertex_count) {
    const auto throw_error = [] {
        throw Error(PW_ERROR_INDEX, "Polygons must be in ascending order, and their corners vertices of this mesh.");
    };
    for (int32_t v : corners)
        if (v < 0 || idx(v) >= vertex_count) throw_error();
    if (begin.empty() ? !corners.empty() : begin[0] != 0) throw_error();
    std::vector<int32_t> next(corners.size());
    std::iota(next.begin(), next.end(), 1);
    for (size_t p = 0; p < begin.size(); ++p) {
        const size_t end = p + 1 < begin.size() ? idx(begin[p + 1]) : corners.size();
        if (begin[p] < 0 || idx(begin[p]) >= end || end > corners.size()) throw_error();
        next[end - 1] = begin[p];
    }
    return next;
}

}  // namespace

PolygonFaults polygon_faults(std::span<const int32_t> corners, std::span<const int32_t> begin, size_t vertex_count) {
    const std::vector<int32_t> next = next_corners(corners, begin, vertex_count);
    const size_t used_vertices = corners.empty() ? 0 : idx(std::ranges::max(corners)) + 1;

    PolygonFaults faults;
    std::vector<int32_t> across(corners.size());
    // Side i runs from corner i to the next corner.
    const auto ends = [&](size_t corner) { return std::pair(corners[corner], corners[idx(next[corner])]); };
    for_each_edge(used_vertices, corners.size(), ends, [&](int32_t low, std::span<const Side> sides) {
        if (sides.size() != 2 || sides[0].high == low)
            ++faults.non_manifold_edges;
        else if (sides[0].is_ascending == sides[1].is_ascending)
            ++faults.inconsistent_edges;
        else
            across[idx(sides[0].number)] = sides[1].number, across[idx(sides[1].number)] = sides[0].number;
    });
    if (faults.non_manifold_edges + faults.inconsistent_edges > 0) return faults;

    // Walks around each vertex from polygon to polygon; each walk is a fan.
    std::vector<int32_t> fans(used_vertices, 0);
    std::vector<bool> is_visited(corners.size(), false);
    for (size_t start = 0; start < corners.size(); ++start) {
        if (is_visited[start]) continue;
        ++fans[idx(corners[start])];
        for (size_t c = start; !is_visited[c]; c = idx(next[idx(across[c])])) is_visited[c] = true;
    }
    const auto manifold = static_cast<size_t>(std::ranges::count(fans, 1));
    faults.non_manifold_vertices = vertex_count - manifold;
    return faults;
}

}  // namespace partwheel
