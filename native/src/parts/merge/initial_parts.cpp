// Which clusters of the paper's tree are the parts: it is cut where most surface lies in what is least convex,
// components first.
#include "parts/mirror/propagate.h"
#include "parts/merge/parts.h"

#include <algorithm>
#include <queue>
#include <utility>

namespace partwheel {

std::vector<int32_t> choose_initial_parts(const TetMesh& mesh, const BinaryTree& tree) {
    const size_t leaves = mesh.tetrahedra.size(), merges = tree.merges.size();
    std::vector<double> area(leaves + merges, 0);
    for (size_t t = 0; t < leaves; ++t)
        for (size_t k = 0; k < 4; ++k)
            if (mesh.neighbors[t][k] < 0) area[t] += facet_area(mesh, t, k);
    for (size_t m = 0; m < merges; ++m)
        area[leaves + m] = area[idx(tree.merges[m].left)] + area[idx(tree.merges[m].right)];
    std::priority_queue<std::pair<float, int32_t>> queue;  // the lower number first where they tie
    std::vector<int32_t> chosen;
    const auto offer = [&](int32_t c) {
        float concavity = 0;  // rounded as costs are, see merge_policy.h
        if (const Merge* m = idx(c) < leaves ? nullptr : &tree.merges[idx(c) - leaves]; m && m->concavity > 0)
            concavity = static_cast<float>(m->concavity / m->hull_volume * area[idx(c)]);
        if (concavity > 0)
            queue.push({concavity, -c});
        else
            chosen.push_back(c);
    };
    for (const int32_t c : cut_undoing_last(tree.merges, tree.components)) offer(c);
    while (!queue.empty() && queue.size() + chosen.size() < initial_part_count) {
        const auto m = idx(-queue.top().second) - leaves;
        queue.pop();
        offer(tree.merges[m].left);
        offer(tree.merges[m].right);
    }
    for (; !queue.empty(); queue.pop()) chosen.push_back(-queue.top().second);
    std::sort(chosen.begin(), chosen.end());
    return chosen;
}

}  // namespace partwheel
