// The binary tree pruned to a dendrogram (the paper's Listing 2; for a scored tree, see merge_policy.h, a rule of ours),
// cuts of it, and the stops of the mouse wheel in a scored tree (in the paper's they are the whole path).
#pragma once

#include "base/progress.h"
#include "cluster/binary_tree.h"

#include <span>

namespace partwheel {

// Eq. 3 of the paper, of what a merge makes: its class, then what is compared within it. The paper adds 1 to the second
// to keep them apart; beside that a small concavity would be rounded away.
struct NodeCost {
    bool concave = false;
    double value = 0;  // C2 (Eq. 2), or the concavity (Eq. 1)

    auto operator<=>(const NodeCost&) const = default;
};
std::vector<NodeCost> node_costs(std::span<const Merge> merges);

// Which merges survive Listing 2: a node goes if it costs at least as much as the ancestor it would hang from. So what
// is concave goes below what is convex, and what is convex always stays: its C2 is less than that of any ancestor.
std::vector<uint8_t> prune(std::span<const Merge> merges);

// The same for a scored tree, by concavity alone: convex nodes within a convex node go as well, since where C2 has
// them divided is no feature of the shape. The last merges, those of merge_parts(), stay unless their score is 0, and what
// they join is held against no ancestor. scores: of each of these.
std::vector<uint8_t> prune_scored(std::span<const Merge> merges, std::span<const double> scores);

// The cut of the binary tree into `parts` subtrees with the least total concavity, by dynamic programming over the
// tree. Takes O(T parts) time and at most T parts / 12 + 100 T bytes. Returns the clusters' numbers (see Merge), in
// depth-first order. 1 <= parts <= T.
std::vector<int32_t> cut_least_concavity(std::span<const Merge> merges, size_t parts, Progress& progress = unwatched());

// The cut whose clusters have the largest sum of area x score, less half a hundredth of the whole area for each: the
// parts that people would most likely take, without scraps between them. areas, scores: of each cluster. The last `top`
// merges, those of merge_parts(), may be divided, those of them with a score of 0 must be where what they are in is.
// Numbers as above.
std::vector<int32_t> best_scoring_cut(std::span<const Merge> merges, size_t top, std::span<const double> areas,
                                   std::span<const double> scores);

// A path's wheel stops, as indices into the path, and which of them a click alone takes (an index into stops).
struct WheelStops {
    std::vector<int32_t> stops;
    size_t start = 0;
};

// Of a scored tree. The path runs from a leaf to the root; areas (growing, the first one above 0) and scores (0
// below the parts) are those of its nodes. Two nodes of a path overlap (intersection over union) by the quotient of
// their areas. So, from the best score down, a node is a stop unless it overlaps one that is by more than 85 %; the
// root is always one. Below the parts, each stop has at most half the area of the next. The click takes the best score.
WheelStops wheel_stops(std::span<const double> areas, std::span<const double> scores);

// A shell with less than this share of the whole area is one part, whatever is within.
inline constexpr double small_shell = 0.1;

// The index of the stop that a click takes in a view of this size, see pw_hierarchy_wheel: of those up to `shell`.
// scores, extents: of the nodes of the path.
size_t start_in_view(std::span<const int32_t> stops, std::span<const double> scores, std::span<const double> extents,
                     size_t shell, double view);

// Of an assembly: the node at path index `shell`, which is all of a shell, is always a stop. Below it the stops are those of
// the shell alone, above it those of the joined shells. The click takes a small shell, and within a larger
// one what it takes there. The same as wheel_stops() where the shell is the root.
WheelStops assembly_wheel_stops(std::span<const double> areas, std::span<const double> scores, size_t shell);

}  // namespace partwheel
