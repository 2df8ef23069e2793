// Votes are sorted, and labels spread layer by layer, each with the votes of the one before.
#include "parts/majority.h"

namespace partwheel {

namespace {

void append_votes(const TetMesh& mesh, size_t t, const std::vector<int32_t>& label, std::span<const int32_t> patch_of,
                  std::vector<Vote>& votes) {
    for (size_t k = 0; k < 4; ++k) {
        const int32_t neighbor = mesh.neighbors[t][k];
        if (neighbor >= 0 && label[idx(neighbor)] == unlabeled && (patch_of.empty() || patch_of[idx(neighbor)] == patch_of[t]))
            votes.push_back({neighbor, label[t], facet_area(mesh, t, k)});
    }
}

}  // namespace

std::vector<Vote> neighbor_votes(const TetMesh& mesh, const std::vector<int32_t>& label, std::span<const int32_t> patch_of) {
    std::vector<Vote> votes;
    for (size_t t = 0; t < label.size(); ++t)
        if (label[t] >= 0) append_votes(mesh, t, label, patch_of, votes);
    return votes;
}

std::vector<int32_t> majority_patches(const TetMesh& mesh, std::span<const int32_t> label, size_t count,
                                      std::span<const int32_t> patch_of) {
    std::vector<Vote> votes;
    for (size_t t = 0; t < label.size(); ++t) votes.push_back({label[t], patch_of[t], 0});
    for_each_boundary_facet(mesh, [&](size_t t, size_t k) { votes[t].area += facet_area(mesh, t, k); });
    std::vector<int32_t> result(count, -1);
    for_each_majority(std::move(votes), [&](int32_t of_label, int32_t patch) { result[idx(of_label)] = patch; });
    return result;
}

void assign_majority(std::vector<Vote> votes, std::vector<int32_t>& label) {
    for_each_majority(std::move(votes), [&](int32_t t, int32_t winner) { label[idx(t)] = winner; });
}

void propagate_labels(const TetMesh& mesh, std::vector<Vote> votes, std::vector<int32_t>& label, Progress& progress,
                      std::span<const int32_t> patch_of) {
    std::vector<int32_t> layer;
    while (!votes.empty()) {
        layer.clear();
        for_each_majority(std::exchange(votes, {}), [&](int32_t t, int32_t winner) {
            label[idx(t)] = winner;
            layer.push_back(t);
        });
        for (const int32_t t : layer) append_votes(mesh, idx(t), label, patch_of, votes);
        progress.advance_by(0.01);
    }
}

}  // namespace partwheel
