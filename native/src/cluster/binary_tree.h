// The merge tree of clusters: merges, the concavity of each union (the paper's Eq. 1), traversals and cuts.
#pragma once

#include "base/geometry.h"

namespace partwheel {

// A cluster is convex if its concavity is at most this fraction of its hull's volume: well above the rounding of
// volumes and of single-precision coordinates, well below what is visible.
inline constexpr double convex_tolerance = 1e-6;

// Concavities are compared after rounding to this many significant bits, so that merges that cost the same by symmetry
// tie in spite of rounding errors in their volumes.
inline constexpr int concavity_bits = 28;

// Eq. 1, rounded to concavity_bits; 0 if convex within convex_tolerance.
inline double ranked_concavity(double hull_volume, double volume) {
    const double concavity = hull_volume - volume;
    if (!(concavity > convex_tolerance * hull_volume)) return 0;
    constexpr uint64_t last = uint64_t{1} << (53 - concavity_bits);
    return std::bit_cast<double>((std::bit_cast<uint64_t>(concavity) + last / 2) & ~(last - 1));
}

// A merge of two clusters. Cluster i < T is tetrahedron i; cluster T + j is the result of merge j.
struct Merge {
    int32_t left = 0;  // the cluster with the lowest tetrahedron
    int32_t right = 0;
    double concavity = 0;    // ranked_concavity of the union
    double hull_volume = 0;  // of the union
};

// T - 1 merges.
struct BinaryTree {
    std::vector<Merge> merges;
    size_t components = 0;  // clusters that remained without any dual edge
};

// Copies the label of each merged cluster, unless negative, to all its descendants. leaves: T; labels: one per cluster.
inline void propagate_to_leaves(std::span<const Merge> merges, size_t leaves, std::vector<int32_t>& labels) {
    for (size_t m = merges.size(); m-- > 0;)
        if (labels[leaves + m] >= 0)
            labels[idx(merges[m].left)] = labels[idx(merges[m].right)] = labels[leaves + m];
}

// The clusters, in depth-first order, that remain when every cluster from the root down is split for which
// is_split(merge) holds.
template <class IsSplit>
std::vector<int32_t> cut_tree(std::span<const Merge> merges, const IsSplit& is_split) {
    const size_t leaves = merges.size() + 1;
    std::vector<int32_t> clusters, todo = {static_cast<int32_t>(leaves + merges.size() - 1)};
    while (!todo.empty()) {
        const int32_t c = todo.back();
        todo.pop_back();
        if (idx(c) < leaves || !is_split(idx(c) - leaves)) {
            clusters.push_back(c);
            continue;
        }
        todo.push_back(merges[idx(c) - leaves].right);
        todo.push_back(merges[idx(c) - leaves].left);
    }
    return clusters;
}

// The clusters, in depth-first order, that remain when the last parts - 1 merges are undone. 1 <= parts <= T.
inline std::vector<int32_t> cut_undoing_last(std::span<const Merge> merges, size_t parts) {
    return cut_tree(merges, [&](size_t m) { return m + parts > merges.size(); });
}

}  // namespace partwheel
