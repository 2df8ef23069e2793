// Clustering within parts: dual edges between parts are removed; the components of a part merge at the end.
#include "cluster/within.h"

namespace partwheel {

Subtree merge_subtrees(Subtree a, Subtree b, HullKernel& kernel, size_t leaves, std::vector<Merge>& merges) {
    if (a.cluster < 0) return b;
    if (b.cluster < 0) return a;
    if (b.low < a.low) std::swap(a, b);
    Subtree both{static_cast<int32_t>(leaves + merges.size()), a.low, a.volume + b.volume, {}, kernel.unite(a.hull, b.hull)};
    const double hull = both.hull.volume();
    merges.push_back({a.cluster, b.cluster, ranked_concavity(hull, both.volume), hull});
    return both;
}

RestrictedTree cluster_within_labels(const TetMesh& mesh, std::span<const int32_t> part, size_t count, HullKernel& kernel,
                      Progress& progress, size_t threads) {
    const size_t leaves = mesh.tetrahedra.size();
    TetMesh divided_mesh = mesh;
    for (size_t t = 0; t < leaves; ++t)
        for (int32_t& n : divided_mesh.neighbors[t])
            if (n >= 0 && part[idx(n)] != part[t]) n = -1;
    BinaryTree tree = [&] {
        const Progress::Section section(progress, 0, 0.9);
        return cluster(divided_mesh, progress, threads);
    }();
    RestrictedTree result{std::move(tree.merges), std::vector<Subtree>(count)};
    std::vector<Merge>& merges = result.merges;
    merges.resize(leaves - tree.components);

    std::vector<int32_t> component = iota(leaves + merges.size());
    propagate_to_leaves(merges, leaves, component);
    std::vector<Subtree> components(component.size());
    std::vector<int32_t> ordered;  // by lowest tetrahedron
    for (size_t t = 0; t < leaves; ++t) {
        Subtree& p = components[idx(component[t])];
        if (p.cluster < 0) {
            p.cluster = component[t];
            p.low = static_cast<int32_t>(t);
            ordered.push_back(component[t]);
        }
        const Tetrahedron& tet = mesh.tetrahedra[t];
        p.volume += volume(mesh, t);
        p.corners.insert(p.corners.end(), tet.begin(), tet.end());
    }
    size_t done = 0;
    for (const int32_t c : ordered) {
        progress.advance(0.9 + 0.1 * static_cast<double>(done++) / static_cast<double>(ordered.size()));
        Subtree &p = components[idx(c)], &whole = result.parts[idx(part[idx(p.low)])];
        p.hull = kernel.build(p.corners);
        whole = merge_subtrees(std::move(whole), std::move(p), kernel, leaves, merges);
    }
    return result;
}

namespace {

// The corners of a cluster's tetrahedra, with duplicates.
std::vector<int32_t> corners_of_cluster(const TetMesh& mesh, std::span<const Merge> merges, int32_t cluster) {
    const size_t leaves = mesh.tetrahedra.size();
    std::vector<int32_t> todo = {cluster}, corners;
    while (!todo.empty()) {
        const auto c = idx(todo.back());
        todo.pop_back();
        if (c < leaves)
            corners.insert(corners.end(), mesh.tetrahedra[c].begin(), mesh.tetrahedra[c].end());
        else
            todo.insert(todo.end(), {merges[c - leaves].left, merges[c - leaves].right});
    }
    return corners;
}

}  // namespace

RestrictedTree restrict_tree_to_labels(const TetMesh& mesh, std::span<const Merge> merges,
                                       std::span<const int32_t> part, size_t count, HullKernel& kernel) {
    const size_t leaves = mesh.tetrahedra.size(), clusters = leaves + merges.size();
    // Per cluster: its part, or -1 if it spans several; its number in the result, volume and lowest tetrahedron.
    std::vector<int32_t> owner(part.begin(), part.end()), number = iota(leaves), low = number;
    std::vector<double> volumes(clusters);
    owner.resize(clusters, -1);
    number.resize(clusters, -1);
    low.resize(clusters);
    for (size_t t = 0; t < leaves; ++t) volumes[t] = volume(mesh, t);
    RestrictedTree result;
    result.parts.resize(count);

    // A cluster that lies in one part, with its hull.
    const auto subtree_of = [&](int32_t cluster) {
        return Subtree{number[idx(cluster)], low[idx(cluster)], volumes[idx(cluster)], {},
                       kernel.build(corners_of_cluster(mesh, merges, cluster))};
    };
    // The shares of clusters that span several parts, until those are merged.
    struct Share {
        int32_t part;
        Subtree subtree;
    };
    std::vector<std::vector<Share>> shares(clusters);
    const auto shares_of = [&](int32_t cluster) {
        if (owner[idx(cluster)] < 0) return std::move(shares[idx(cluster)]);
        std::vector<Share> single;
        single.push_back({owner[idx(cluster)], subtree_of(cluster)});
        return single;
    };
    std::vector<uint8_t> merged(clusters, 0);
    for (size_t m = 0; m < merges.size(); ++m) {
        const auto& [left, right, concavity, hull_volume] = merges[m];
        const size_t c = leaves + m;
        merged[idx(left)] = merged[idx(right)] = 1;
        low[c] = std::min(low[idx(left)], low[idx(right)]);
        volumes[c] = volumes[idx(left)] + volumes[idx(right)];
        if (owner[idx(left)] >= 0 && owner[idx(left)] == owner[idx(right)]) {
            owner[c] = owner[idx(left)];
            number[c] = static_cast<int32_t>(leaves + result.merges.size());
            result.merges.push_back({number[idx(left)], number[idx(right)], concavity, hull_volume});
            continue;
        }
        std::vector<Share> all = shares_of(left);
        for (Share& share : shares_of(right)) {
            const auto same = std::ranges::find(all, share.part, &Share::part);
            if (same == all.end())
                all.push_back(std::move(share));
            else
                same->subtree =
                    merge_subtrees(std::move(same->subtree), std::move(share.subtree), kernel, leaves, result.merges);
        }
        shares[c] = std::move(all);
    }
    std::vector<Share> roots;
    for (size_t c = 0; c < clusters; ++c)
        if (!merged[c])
            for (Share& share : shares_of(static_cast<int32_t>(c))) roots.push_back(std::move(share));
    std::ranges::sort(roots, {}, [](const Share& share) { return std::pair(share.part, share.subtree.low); });
    for (Share& share : roots) {
        Subtree& whole = result.parts[idx(share.part)];
        whole = merge_subtrees(std::move(whole), std::move(share.subtree), kernel, leaves, result.merges);
    }
    return result;
}

}  // namespace partwheel
