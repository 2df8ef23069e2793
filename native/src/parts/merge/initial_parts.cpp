// Cuts the paper's tree into initial parts, components first, then where most surface lies in the least convex
// clusters.
#include "parts/boundary.h"
#include "parts/merge/parts.h"

#include <queue>

namespace partwheel {

std::vector<int32_t> choose_initial_parts(const TetMesh& mesh, const BinaryTree& tree, const Regions* regions) {
    const size_t leaves = mesh.tetrahedra.size(), merges = tree.merges.size();
    std::vector<double> area(leaves + merges, 0);
    for_each_boundary_facet(mesh, [&](size_t t, size_t k) { area[t] += facet_area(mesh, t, k); });
    for (size_t m = 0; m < merges; ++m)
        area[leaves + m] = area[idx(tree.merges[m].left)] + area[idx(tree.merges[m].right)];
    std::priority_queue<std::pair<float, int32_t>> queue;  // in a tie the lowest id first
    std::vector<int32_t> parts;
    const auto add = [&](int32_t c) {
        float concavity = 0;  // single precision, see merge_policy.h
        if (const Merge* m = idx(c) < leaves ? nullptr : &tree.merges[idx(c) - leaves]; m && m->concavity > 0)
            concavity = static_cast<float>(m->concavity / m->hull_volume * area[idx(c)]);
        if (concavity > 0)
            queue.push({concavity, -c});
        else
            parts.push_back(c);
    };
    for (const int32_t c : cut_undoing_last(tree.merges, regions ? regions->count : tree.components)) add(c);
    while (!queue.empty() && queue.size() + parts.size() < initial_part_count) {
        const auto m = idx(-queue.top().second) - leaves;
        queue.pop();
        add(tree.merges[m].left);
        add(tree.merges[m].right);
    }
    for (; !queue.empty(); queue.pop()) parts.push_back(-queue.top().second);
    std::sort(parts.begin(), parts.end());
    return parts;
}

}  // namespace partwheel
