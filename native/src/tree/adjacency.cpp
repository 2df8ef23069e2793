// Which tetrahedra share a facet.
#include "tree/adjacency.h"

#include "base/facets.h"
#include "tree/packed.h"

#include <algorithm>

namespace partwheel {

std::vector<std::array<int32_t, 4>> find_neighbors(std::span<const Tetrahedron> tetrahedra) {
    for (Tetrahedron t : tetrahedra) {
        std::ranges::sort(t);
        if (std::ranges::adjacent_find(t) != t.end()) refuse_saved("a tetrahedron has a vertex twice");
    }
    std::vector<std::array<int32_t, 4>> neighbors(tetrahedra.size(), {-1, -1, -1, -1});
    for_each_facet(tetrahedra, [&](std::span<const TetFacet> facets) {
        if (facets.size() > 2) refuse_saved("more than two tetrahedra share a facet");
        if (facets.size() != 2) return;
        const TetFacet &a = facets[0], &b = facets[1];
        neighbors[idx(a.tet)][idx(a.corner)] = b.tet;
        neighbors[idx(b.tet)][idx(b.corner)] = a.tet;
    });
    return neighbors;
}

}  // namespace partwheel
