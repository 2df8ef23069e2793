// Hierarchical tet clustering by two threads, each in a half of its own: the same merges as one after the other.
#pragma once

#include "dual_graph.h"
#include "progress.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace partwheel {

// How many merges each thread makes in a round that has so many.
using Pace = std::function<std::array<size_t, 2>(size_t)>;

// Contracts the dual graph's edges, cheapest first, until some dozens of clusters are left, or no edge, or until two
// threads don't pay any more; returns the merges in their order. The graph must be as it was made; halves says for each
// of its clusters which thread has it at first, 0 or 1. The workers must be two. The pace is for tests: without
// one, who is done goes on until the other is.
std::vector<Merge> merge_in_domains(DualGraph& graph, std::vector<uint8_t> halves, Workers& workers,
                                    Progress& progress, const Pace& pace = {});

}  // namespace partwheel
