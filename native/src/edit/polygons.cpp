// Polygons -> what keeps them from being a closed, manifold, oriented surface.
#include "edit/polygons.h"

#include "base/error.h"
#include "base/adjacency.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace partwheel {

namespace {

// The corner after each in its polygon.
std::vector<int32_t> next_corners(std::span<const int32_t> corners, std::span<const int32_t> begin,
                                  size_t vertex_count) {
    const auto refuse = [] {
        throw Error(PW_ERROR_INDEX, "The polygons are not in order, or a corner is no vertex of this mesh.");
    };
    for (int32_t v : corners)
        if (v < 0 || idx(v) >= vertex_count) refuse();
    if (begin.empty() ? !corners.empty() : begin[0] != 0) refuse();
    std::vector<int32_t> next(corners.size());
    std::iota(next.begin(), next.end(), 1);
    for (size_t p = 0; p < begin.size(); ++p) {
        const size_t end = p + 1 < begin.size() ? idx(begin[p + 1]) : corners.size();
        if (begin[p] < 0 || idx(begin[p]) >= end || end > corners.size()) refuse();
        next[end - 1] = begin[p];
    }
    return next;
}

}  // namespace

PolygonFaults polygon_faults(std::span<const int32_t> corners, std::span<const int32_t> begin, size_t vertex_count) {
    const std::vector<int32_t> next = next_corners(corners, begin, vertex_count);
    const size_t in_reach = corners.empty() ? 0 : idx(std::ranges::max(corners)) + 1;  // no other vertex has a polygon

    PolygonFaults faults;
    std::vector<int32_t> across(corners.size());
    // A side is the corner where a polygon begins to run along it.
    const auto ends = [&](size_t corner) { return std::pair(corners[corner], corners[idx(next[corner])]); };
    for_each_edge(in_reach, corners.size(), ends, [&](int32_t low, std::span<const Side> sides) {
        if (sides.size() != 2 || sides[0].high == low)
            ++faults.open;
        else if (sides[0].upwards == sides[1].upwards)
            ++faults.against;
        else
            across[idx(sides[0].number)] = sides[1].number, across[idx(sides[1].number)] = sides[0].number;
    });
    if (faults.open + faults.against > 0) return faults;

    // Around a vertex from corner to corner; a second round about it is a second fan.
    std::vector<int32_t> rounds(in_reach, 0);
    std::vector<bool> seen(corners.size(), false);
    for (size_t start = 0; start < corners.size(); ++start) {
        if (seen[start]) continue;
        ++rounds[idx(corners[start])];
        for (size_t c = start; !seen[c]; c = idx(next[idx(across[c])])) seen[c] = true;
    }
    const auto simple = static_cast<size_t>(std::ranges::count(rounds, 1));
    faults.touching = vertex_count - simple;
    return faults;
}

}  // namespace partwheel
