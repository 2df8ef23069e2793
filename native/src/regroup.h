// The top of the tree built anew: a few hundred parts of the paper's tree, joined in the order that people would.
//
// Concavity alone joins a leg's two halves late and a cup's handle early. So the paper's tree is cut into some parts,
// which are joined again bottom-up, the cheapest pair of neighbours first (a new or grown pair is entered by a guess
// at the least that it can cost; its hull is only made when it would come next); the cost is how unlikely it is that
// people put both into one part, told from 28 measures of the pair: sizes, convexity, the hull of both, the area of the
// facets between them (the cross-section) and the length and the crease of the border on the surface, after the ideas
// of Golovinskiy and Funkhouser, "Randomized Cuts for 3D Mesh Analysis" (2008). Another such function scores each node
// of the result. Both were fitted to segmentations made by people (tests/quality/fit.py); their numbers are in
// regroup_fitted.h. All of it is arithmetic without library functions but the square root, so it is the same on every
// machine.
#pragma once

#include "cluster.h"

#include <array>
#include <span>
#include <vector>

namespace partwheel {

inline constexpr size_t pair_measures = 28, node_measures = 32;

// So many parts at most, but at least one a component: enough that most borders people draw run between them.
inline constexpr size_t most_regrouped_parts = 600;

// A sum of bounded ramps: hidden x (bias, weights of the inputs, weight of the ramp z / (1 + |z|)), then a bias.
double fitted(std::span<const double> numbers, std::span<const double> inputs);

struct Regrouped {
    // Its first merges are the paper's, below the parts; the last ones join the parts, and at the very end components,
    // as the paper's do.
    BinaryTree tree;
    // How well each node at or above the parts is expected to match what people would take, 0..1 (the mean overlap,
    // intersection over union): first the parts in depth-first order, then the merges that join them. 2 parts - 1.
    std::vector<double> scores;
};

// What fitting needs to see. Parts are numbered as their clusters in the paper's tree are; what merge j makes is
// number parts + j.
struct RegroupTrace {
    struct Pair {
        int32_t a, b;
        std::array<double, pair_measures> measures;
    };
    std::vector<int32_t> part_of_tetrahedron;
    std::vector<Pair> pairs;
    std::vector<std::array<int32_t, 2>> merges;
    std::vector<std::array<double, node_measures>> nodes;
};

// tree: the paper's of this mesh. pair_numbers: null, or another cost to be tried; trace: null, or what to fill.
Regrouped regroup(const TetMesh& mesh, const BinaryTree& tree, Progress& progress,
                  std::span<const double> pair_numbers = {}, RegroupTrace* trace = nullptr);

}  // namespace partwheel
