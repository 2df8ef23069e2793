// The paper's clustering restricted to given parts: one tree per part, built from scratch or from an existing tree.
#pragma once

#include "cluster/cluster.h"
#include "hull/hull.h"

namespace partwheel {

// A cluster of a tree under construction.
struct Subtree {
    int32_t cluster = -1;  // -1: empty
    int32_t low = 0;       // its lowest tetrahedron
    double volume = 0;
    std::vector<int32_t> corners;  // of all its tetrahedra, until it has a hull
    Hull hull;
};

// Merges two subtrees, appending one merge; returns the other one if one is empty. leaves: T, see Merge.
Subtree merge_subtrees(Subtree a, Subtree b, HullKernel& kernel, size_t leaves, std::vector<Merge>& merges);

struct RestrictedTree {
    std::vector<Merge> merges;   // none merges two parts
    std::vector<Subtree> parts;  // the root of each part; empty if it has no tetrahedron
};

// Clusters each part on its own. part: the label of each tetrahedron, 0 to count - 1. If a part has several components,
// they merge last, in the order of their lowest tetrahedra. kernel: for the mesh's vertices; must outlive the result.
// threads: as for cluster().
RestrictedTree cluster_within_labels(const TetMesh& mesh, std::span<const int32_t> part, size_t count, HullKernel& kernel,
                      Progress& progress, size_t threads);

// The same from an existing tree, keeping as much of it as possible: a cluster inside one part stays, one that spans
// several parts is divided among them, and clusters that came from elsewhere merge last, lowest first. merges: those of
// the tree that merged no two of its own parts.
RestrictedTree restrict_tree_to_labels(const TetMesh& mesh, std::span<const Merge> merges,
                                       std::span<const int32_t> part, size_t count, HullKernel& kernel);

}  // namespace partwheel
