// Clusters within parts: no dual edge runs between two of them; the pieces of one are joined in the end.
#include "cluster/within.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace partwheel {

Grown joined(Grown a, Grown b, HullKernel& kernel, size_t leaves, std::vector<Merge>& merges) {
    if (a.cluster < 0) return b;
    if (b.cluster < 0) return a;
    if (b.low < a.low) std::swap(a, b);
    const auto [small, large] = std::minmax(a.hull, b.hull, fewer_facets);
    Grown both{static_cast<int32_t>(leaves + merges.size()), a.low, a.volume + b.volume, {},
               kernel.unite(large, small.vertices())};
    const double hull = both.hull.volume();
    merges.push_back({a.cluster, b.cluster, ranked_concavity(hull, both.volume), hull});
    return both;
}

Within cluster_within(const TetMesh& mesh, std::span<const int32_t> part, size_t count, HullKernel& kernel,
                      Progress& progress, size_t threads) {
    const size_t leaves = mesh.tetrahedra.size();
    TetMesh apart = mesh;
    for (size_t t = 0; t < leaves; ++t)
        for (int32_t& n : apart.neighbours[t])
            if (n >= 0 && part[at(n)] != part[t]) n = -1;
    BinaryTree tree = cluster(apart, progress, threads);
    Within result{std::move(tree.merges), std::vector<Grown>(count)};
    std::vector<Merge>& merges = result.merges;
    merges.resize(leaves - tree.components);

    std::vector<int32_t> piece(leaves + merges.size());
    std::iota(piece.begin(), piece.end(), 0);
    hand_down(merges, leaves, piece);
    std::vector<Grown> pieces(piece.size());
    std::vector<int32_t> in_order;  // by their lowest tetrahedra
    for (size_t t = 0; t < leaves; ++t) {
        Grown& p = pieces[at(piece[t])];
        if (p.cluster < 0) {
            p.cluster = piece[t];
            p.low = static_cast<int32_t>(t);
            in_order.push_back(piece[t]);
        }
        const Tetrahedron& tet = mesh.tetrahedra[t];
        const auto corner = [&](size_t k) { return mesh.vertices[at(tet[k])]; };
        p.volume += std::max(0.0, six_volumes(corner(0), corner(1), corner(2), corner(3)) / 6);
        p.corners.insert(p.corners.end(), tet.begin(), tet.end());
    }
    for (const int32_t c : in_order) {
        Grown &p = pieces[at(c)], &whole = result.parts[at(part[at(p.low)])];
        p.hull = kernel.build(p.corners);
        whole = joined(std::move(whole), std::move(p), kernel, leaves, merges);
        progress.advance(1);
    }
    return result;
}

}  // namespace partwheel
