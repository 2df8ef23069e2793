// Which tetrahedra share a facet.
#include "tree/adjacency.h"

#include "base/adjacency.h"
#include "tree/packed.h"

#include <algorithm>
#include <tuple>

namespace partwheel {

std::vector<std::array<int32_t, 4>> find_neighbors(std::span<const Tetrahedron> tetrahedra) {
    struct TetFacet {
        int32_t middle, high, tet, corner;
    };
    // Groups facets by their lowest vertex, so that few must be compared.
    int32_t vertices = 0;
    for (const Tetrahedron& t : tetrahedra) vertices = std::max({vertices, t[0] + 1, t[1] + 1, t[2] + 1, t[3] + 1});
    CsrArray<TetFacet> by_lowest(idx(vertices), [&](const auto& put) {
        for (size_t t = 0; t < tetrahedra.size(); ++t)
            for (size_t c = 0; c < 4; ++c) {
                Triangle v = facet(tetrahedra[t], c);
                std::sort(v.begin(), v.end());
                if (v[0] == v[1] || v[1] == v[2]) refuse_saved("a tetrahedron has a vertex twice");
                put(idx(v[0]), TetFacet{v[1], v[2], static_cast<int32_t>(t), static_cast<int32_t>(c)});
            }
    });

    std::vector<std::array<int32_t, 4>> neighbors(tetrahedra.size(), {-1, -1, -1, -1});
    const auto same = [](const TetFacet& a, const TetFacet& b) { return a.middle == b.middle && a.high == b.high; };
    for (size_t v = 0; v < idx(vertices); ++v) {
        const std::span<TetFacet> facets = by_lowest.row(v);
        std::sort(facets.begin(), facets.end(), [](const TetFacet& a, const TetFacet& b) {
            return std::tie(a.middle, a.high, a.tet) < std::tie(b.middle, b.high, b.tet);
        });
        for (auto f = facets.begin(); f != facets.end(); ++f) {
            if (f + 1 == facets.end() || !same(f[0], f[1])) continue;
            if (f + 2 != facets.end() && same(f[1], f[2])) refuse_saved("more than two tetrahedra share a facet");
            neighbors[idx(f[0].tet)][idx(f[0].corner)] = f[1].tet;
            neighbors[idx(f[1].tet)][idx(f[1].corner)] = f[0].tet;
            ++f;
        }
    }
    return neighbors;
}

}  // namespace partwheel
