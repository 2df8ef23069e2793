// The binary tree pruned to a dendrogram (the paper's Listing 2), cuts of it, and the stops of the mouse wheel. Of the
// latter there are two: by concavity for the paper's tree, by scores for the regrouped one (see regroup.h).
#pragma once

#include "cluster.h"

#include <span>

namespace partwheel {

// Which merges survive Listing 2: a node goes if it is at least as high as the ancestor it would hang from. Height is
// the concavity, 0 for convex nodes: C2 orders merges, but is no property of a shape.
// The last `top` merges, those of regroup(), all stay, and what they join is held against no ancestor.
std::vector<uint8_t> prune(std::span<const Merge> merges, size_t top = 0);

// The cut of the binary tree into `parts` subtrees with the least total concavity, by dynamic programming over the
// tree: O(T parts) time at most. Returns the clusters' numbers (see Merge), in depth-first order. 1 <= parts <= T.
std::vector<int32_t> cut_into_parts(std::span<const Merge> merges, size_t parts);

// The cut that is left when the last parts - 1 merges are undone; numbers as above. 1 <= parts <= T.
std::vector<int32_t> cut_undoing_last(std::span<const Merge> merges, size_t parts);

// The cut whose clusters have the largest sum of area x score: the parts that people would most likely take. areas,
// scores: of each cluster; those with a score of 0 are not divided. Numbers as above.
std::vector<int32_t> likeliest_cut(std::span<const Merge> merges, std::span<const double> areas,
                                   std::span<const double> scores);

// A path's wheel stops, as indices into the path, and which of them a click alone takes (an index into stops).
struct WheelStops {
    std::vector<int32_t> stops;
    size_t start = 0;
};

// The path runs from a leaf to the root; areas (growing, the first one above 0) and heights (growing) are those of its
// nodes. Each stop has at least 10 % more area than the one before; the last is the root. The click takes the stop
// between 1 % and 60 % of the area that is the clearest part: whose parent is higher than itself by the largest factor.
WheelStops wheel_stops(std::span<const double> areas, std::span<const double> heights);

// The same for a regrouped tree: scores are those of the path's nodes, 0 below the parts. Two nodes of a path overlap
// (intersection over union) by the quotient of their areas. So, from the best score down, a node is a stop unless it
// overlaps one that is by more than 85 %; the root is always one. Below the parts, each stop has at most half the area
// of the next. The click takes the best score.
WheelStops scored_wheel_stops(std::span<const double> areas, std::span<const double> scores);

}  // namespace partwheel
