// Pruning of the binary tree to a dendrogram (the paper's Listing 2, or our rule for scored trees, see merge_policy.h),
// cuts, and the stops of the mouse wheel in a scored tree (in the paper's tree, the whole path).
#pragma once

#include "base/progress.h"
#include "cluster/binary_tree.h"

namespace partwheel {

// Eq. 3 of the paper for the result of a merge: the class, then the value within the class. The paper adds 1 to the
// concavity instead of a class; that would round small concavities away.
struct NodeCost {
    bool concave = false;
    double value = 0;  // C2 (Eq. 2), or the concavity (Eq. 1)

    auto operator<=>(const NodeCost&) const = default;
};
std::vector<NodeCost> node_costs(std::span<const Merge> merges);

// Which merges survive Listing 2: a node is removed if it costs at least as much as its parent-to-be. So concave nodes
// below convex ones are removed, and convex ones always stay: their C2 is less than that of any ancestor.
std::vector<uint8_t> prune(std::span<const Merge> merges);

// The same for a scored tree, by concavity alone: convex nodes inside a convex node are removed too, since C2 divides
// them at no feature of the shape. The last merges, those of merge_parts(), stay unless their score is 0, and the nodes
// that they join are compared with no ancestor. scores: one for each of these merges.
std::vector<uint8_t> prune_scored(std::span<const Merge> merges, std::span<const double> scores);

// The cut of the binary tree into `parts` subtrees with the least total concavity, by dynamic programming over the
// tree. Takes O(T parts) time and at most T parts / 12 + 100 T bytes. Returns the clusters' numbers (see Merge), in
// depth-first order. 1 <= parts <= T.
std::vector<int32_t> cut_least_concavity(std::span<const Merge> merges, size_t parts, Progress& progress = unobserved_progress());

// The cut with the largest sum of area x score - 0.005 x total area over its clusters: the parts that people would most
// likely choose, without tiny ones between them. A cluster with more than 0.99 of the area scores no more than the
// whole, because it looks the same. Likewise, a cluster scores no less than a part of it with more than 0.95 of its
// area, if the rest are slivers: they score below 0.3 and are worth less than their own cost. areas, scores: of each
// cluster. The last `top` merges, those of merge_parts(), may be divided; those with a score of 0 must be, if their
// parent is. Numbers as above.
std::vector<int32_t> best_scoring_cut(std::span<const Merge> merges, size_t top, std::span<const double> areas,
                                   std::span<const double> scores);

// Renumbers the leaves in depth-first order; returns the old number of each.
std::vector<int32_t> sort_leaves(std::vector<Merge>& merges);

// The wheel stops of a path, as indices into the path, and the one that a click selects (an index into stops).
struct WheelStops {
    std::vector<int32_t> stops;
    size_t start = 0;
};

// The wheel stops of a scored tree. The path runs from a leaf to the root; areas (growing, the first one above 0) and scores (0
// below the parts) are those of its nodes. Two nodes of a path overlap (intersection over union) by the quotient of
// their areas. So, from the best score down, a node is a stop unless it overlaps one that is by more than 85 %; the
// root is always one. Below the parts, each stop has at most half the area of the next. The click takes the best score.
WheelStops wheel_stops(std::span<const double> areas, std::span<const double> scores);

// A shell with less than this share of the total area is a single part.
inline constexpr double small_shell = 0.1;

// The wheel stops of an assembly: the node at path index `shell`, which is all of a shell, is always a stop. Below it the stops are
// those of the shell alone, above it those of the joined shells. The click takes a small shell, and within a larger one
// the best score up to largest_click(). The same as wheel_stops() where the shell is the root.
WheelStops assembly_wheel_stops(std::span<const double> areas, std::span<const double> scores, size_t shell);

// The path index of the largest stop that a click takes: the shell; if the shell has more than half of an assembly's
// area, the largest smaller stop with a good score, or a part made by hand. People point at the windows and doors of a
// bus, not at its body. areas, scores: of the nodes of the path.
size_t largest_click(std::span<const int32_t> stops, std::span<const double> areas, std::span<const double> scores,
                     size_t shell);

// The index of the stop that a click takes in a view of this size, see pw_hierarchy_wheel: of those up to path index
// `largest`. scores, extents: of the nodes of the path.
size_t start_in_view(std::span<const int32_t> stops, std::span<const double> scores, std::span<const double> extents,
                     size_t largest, double view);

}  // namespace partwheel
