// The tetrahedra at each facet.
#pragma once

#include "base/adjacency.h"

#include <tuple>

namespace partwheel {

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

}  // namespace partwheel
