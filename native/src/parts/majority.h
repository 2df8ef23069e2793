// Majority votes, weighted by area, and the propagation of part labels to unlabeled tetrahedra.
#pragma once

#include "parts/boundary.h"

namespace partwheel {

inline constexpr int32_t unlabeled = -1;

struct Vote {
    int32_t target, label;
    double area;
};

// Calls assign(target, label) once per target, in ascending order, with the label that has the largest sum of areas;
// the lowest label in a tie. Sums are compared in single precision, so that labels that are equal by symmetry tie.
// The result does not depend on the order of the votes.
template <class Assign>
void for_each_majority(std::vector<Vote> votes, const Assign& assign) {
    std::ranges::sort(votes, {}, [](const Vote& v) { return std::tie(v.target, v.label, v.area); });
    for (size_t i = 0; i < votes.size();) {
        const int32_t target = votes[i].target;
        int32_t winner = votes[i].label;
        double max_area = -1;
        while (i < votes.size() && votes[i].target == target) {
            const int32_t label = votes[i].label;
            double sum = 0;
            for (; i < votes.size() && votes[i].target == target && votes[i].label == label; ++i) sum += votes[i].area;
            if (const double rounded = static_cast<float>(sum); rounded > max_area) {
                max_area = rounded;
                winner = label;
            }
        }
        assign(target, winner);
    }
}

// For each label, 0 to count - 1: the patch in front of most of its surface. label, patch_of: of each tetrahedron.
std::vector<int32_t> majority_patches(const TetMesh& mesh, std::span<const int32_t> label, size_t count,
                                      std::span<const int32_t> patch_of);

// Gives each tetrahedron that has votes its majority label.
void assign_majority(std::vector<Vote> votes, std::vector<int32_t>& label);

// Gives each unlabeled tetrahedron its majority label; then, layer by layer, each of the others that of its labeled
// neighbors, weighted by the area of the common facets. Unreachable tetrahedra stay unlabeled. patch_of: of each
// tetrahedron; labels don't spread from one patch to another. Empty: there are none.
void propagate_labels(const TetMesh& mesh, std::vector<Vote> votes, std::vector<int32_t>& label, Progress& progress,
                      std::span<const int32_t> patch_of = {});

// The votes of labeled tetrahedra (label >= 0) for their unlabeled neighbors, of the same patch.
std::vector<Vote> neighbor_votes(const TetMesh& mesh, const std::vector<int32_t>& label, std::span<const int32_t> patch_of = {});

}  // namespace partwheel
