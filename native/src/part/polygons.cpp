// Polygons -> what keeps them from being a closed, manifold, oriented surface.
#include "part/polygons.h"

#include "base/error.h"
#include "base/geometry.h"

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
        if (v < 0 || at(v) >= vertex_count) refuse();
    if (begin.empty() ? !corners.empty() : begin[0] != 0) refuse();
    std::vector<int32_t> next(corners.size());
    std::iota(next.begin(), next.end(), 1);
    for (size_t p = 0; p < begin.size(); ++p) {
        const size_t end = p + 1 < begin.size() ? at(begin[p + 1]) : corners.size();
        if (begin[p] < 0 || at(begin[p]) >= end || end > corners.size()) refuse();
        next[end - 1] = begin[p];
    }
    return next;
}

}  // namespace

PolygonFaults polygon_faults(std::span<const int32_t> corners, std::span<const int32_t> begin, size_t vertex_count) {
    const std::vector<int32_t> next = next_corners(corners, begin, vertex_count);
    const size_t in_reach = corners.empty() ? 0 : at(std::ranges::max(corners)) + 1;  // no other vertex has a polygon

    // Edges, each at the corner where a polygon begins to run along it, by their lower vertex.
    struct Side {
        int32_t high, corner;
    };
    std::vector<size_t> first(in_reach + 2, 0);
    const auto low = [&](size_t c) { return std::min(corners[c], corners[at(next[c])]); };
    for (size_t c = 0; c < corners.size(); ++c) ++first[at(low(c)) + 2];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Side> sides(corners.size());
    for (size_t c = 0; c < corners.size(); ++c)
        sides[first[at(low(c)) + 1]++] = {std::max(corners[c], corners[at(next[c])]), static_cast<int32_t>(c)};

    PolygonFaults faults;
    std::vector<int32_t> across(corners.size());
    for (size_t v = 0; v < in_reach; ++v) {
        const auto begin_of = sides.begin() + static_cast<std::ptrdiff_t>(first[v]);
        const auto end_of = sides.begin() + static_cast<std::ptrdiff_t>(first[v + 1]);
        std::sort(begin_of, end_of, [](const Side& a, const Side& b) { return a.high < b.high; });
        for (auto s = begin_of; s != end_of;) {
            auto after = s + 1;
            while (after != end_of && after->high == s->high) ++after;
            if (after - s != 2 || at(s->high) == v)
                ++faults.open;
            else if (corners[at(s[0].corner)] == corners[at(s[1].corner)])
                ++faults.against;
            else
                across[at(s[0].corner)] = s[1].corner, across[at(s[1].corner)] = s[0].corner;
            s = after;
        }
    }
    if (faults.open + faults.against > 0) return faults;

    // Around a vertex from corner to corner; a second round about it is a second fan.
    std::vector<int32_t> rounds(in_reach, 0);
    std::vector<bool> seen(corners.size(), false);
    for (size_t start = 0; start < corners.size(); ++start) {
        if (seen[start]) continue;
        ++rounds[at(corners[start])];
        for (size_t c = start; !seen[c]; c = at(next[at(across[c])])) seen[c] = true;
    }
    const auto simple = static_cast<size_t>(std::ranges::count(rounds, 1));
    faults.touching = vertex_count - simple;
    return faults;
}

}  // namespace partwheel
