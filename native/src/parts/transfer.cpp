// Parts are found on a proxy and transferred to the solid: labels by votes of the surface, and a merge tree that has
// them as nodes.
#include "parts/transfer.h"

#include "base/corners.h"
#include "base/error.h"
#include "cluster/within.h"
#include "prepare/noise.h"
#include "parts/majority.h"

#include <CGAL/exceptions.h>

namespace partwheel {

namespace {

// Passes of smoothing, as a multiple of the noise: a surface that is only measured may lose more than one that is used.
constexpr double smoothing_passes = 90;

// The tree above the parts. Nodes are numbered like their scores: the parts in depth-first order, then the merges.
struct TreeAbove {
    std::vector<int32_t> part_of_tetrahedron;
    std::vector<std::array<int32_t, 2>> children;  // of each merge
};

TreeAbove tree_above_parts(const ScoredTree& parts, size_t leaves) {
    const std::vector<Merge>& merges = parts.tree.merges;
    const size_t merges_above = parts.scores.size() / 2, merges_below = merges.size() - merges_above;
    std::vector<int32_t> number(leaves + merges.size(), -1);
    int32_t next = 0;
    for (const int32_t c : cut_undoing_last(merges, merges_above + 1)) number[idx(c)] = next++;
    TreeAbove result;
    for (size_t m = merges_below; m < merges.size(); ++m) {
        number[leaves + m] = next++;
        result.children.push_back({number[idx(merges[m].left)], number[idx(merges[m].right)]});
    }
    propagate_to_leaves(std::span(merges).first(merges_below), leaves, number);
    number.resize(leaves);
    result.part_of_tetrahedron = std::move(number);
    return result;
}

}  // namespace

std::optional<TetMesh> fill_proxy(const Solid& solid, bool points_inside, Progress& progress) {
    if (solid.surface_from_tetrahedra) return {};
    Surface surface = solid.surface;
    const double noise = estimate_noise(surface.vertices, surface.triangles);
    bool smooth = false;
    const Progress::Section second(progress, points_inside ? 0.6 : 0.9, 1);
    if (noise > 0) {
        surface.vertices = remove_noise(surface.vertices, surface.triangles, smoothing_passes * noise);
        smooth = surface_status(surface, progress) == PW_OK;
        if (!smooth) surface.vertices = solid.surface.vertices;
    }
    if (!smooth && !points_inside) return {};
    try {
        return tetrahedralize(surface, 0, progress);
    } catch (const Error& error) {
        if (error.status() != PW_ERROR_TETRAHEDRA) throw;
        return {};
    } catch (const CGAL::Failure_exception&) {
        return {};
    }
}

ScoredTree transfer_parts(const TetMesh& proxy, const ScoredTree& parts, const Solid& solid, Progress& progress,
                          size_t threads) {
    const size_t leaves = solid.mesh.tetrahedra.size(), count = parts.scores.size() / 2 + 1;
    const TreeAbove above = tree_above_parts(parts, proxy.tetrahedra.size());
    std::vector<Vote> votes;  // each tetrahedron goes with the part of most of the surface that it lies behind
    for (size_t i = 0; i < proxy.tet_of_triangle.size(); ++i) {
        votes.push_back({solid.mesh.tet_of_triangle[i], above.part_of_tetrahedron[idx(proxy.tet_of_triangle[i])],
                         area(solid.mesh.vertices, solid.surface.triangles[i])});
    }
    std::vector<int32_t> part(leaves, -1);
    propagate_labels(solid.mesh, std::move(votes), part, progress);

    HullKernel kernel(solid.mesh.vertices, progress);  // outlives all hulls
    RestrictedTree within = [&] {
        const Progress::Section most(progress, 0, 0.9);
        return cluster_within_labels(solid.mesh, part, count, kernel, progress, threads);
    }();
    ScoredTree result;
    result.tree = {std::move(within.merges), parts.tree.components};
    std::vector<Merge>& merges = result.tree.merges;
    std::vector<Subtree> grown = std::move(within.parts);
    grown.resize(2 * count - 1);

    // The merges above the parts, and the scores of what isn't empty.
    const size_t top = leaves + merges.size();
    std::vector<double> score(top, 0);
    for (size_t p = 0; p < count; ++p)
        if (grown[p].cluster >= 0) score[idx(grown[p].cluster)] = parts.scores[p];
    for (size_t j = 0; j + 1 < count; ++j) {
        Subtree& a = grown[idx(above.children[j][0])];
        Subtree& b = grown[idx(above.children[j][1])];
        grown[count + j] = merge_subtrees(std::move(a), std::move(b), kernel, leaves, merges);
        if (leaves + merges.size() > score.size()) score.push_back(parts.scores[count + j]);
        progress.advance(0.9 + 0.1 * static_cast<double>(j) / static_cast<double>(count));
    }
    for (const int32_t c : cut_undoing_last(merges, score.size() - top + 1)) result.scores.push_back(score[idx(c)]);
    result.scores.insert(result.scores.end(), score.begin() + static_cast<std::ptrdiff_t>(top), score.end());
    return result;
}

}  // namespace partwheel
