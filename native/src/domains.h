// Hierarchical tet clustering by two threads, each in a half of its own: the same merges as one after the other.
#pragma once

#include "dual_graph.h"
#include "pair_of_threads.h"
#include "progress.h"

#include <array>
#include <vector>

namespace partwheel {

// Contracts the dual graph's edges, cheapest first, until some hundreds of clusters are left, or no edge, or until two
// threads don't pay any more; returns the merges in their order. Threads and kernels belong together.
std::vector<Merge> merge_in_domains(DualGraph& graph, const TetMesh& mesh, std::array<HullKernel*, 2> kernels,
                                    PairOfThreads& threads, Progress& progress);

}  // namespace partwheel
