// The paper's clusters within given parts: a tree for each of them, made anew or what is left of one.
#pragma once

#include "cluster/cluster.h"
#include "cluster/hull/hull.h"

#include <span>
#include <vector>

namespace partwheel {

// A cluster of a tree as it grows.
struct Grown {
    int32_t cluster = -1;  // none yet
    int32_t low = 0;       // its lowest tetrahedron
    double volume = 0;
    std::vector<int32_t> corners;  // of all its tetrahedra, while it has no hull
    Hull hull;
};

// What is in both, by one more merge, or in the one that is any. leaves: T, see Merge.
Grown joined(Grown a, Grown b, HullKernel& kernel, size_t leaves, std::vector<Merge>& merges);

struct Within {
    std::vector<Merge> merges;  // none joins two parts
    std::vector<Grown> parts;   // of each the whole; cluster -1 where no tetrahedron is of it
};

// part: of each tetrahedron, 0 to count - 1. Where a part's tetrahedra are in several pieces these are joined last, from
// the lowest on. kernel: of the mesh's vertices; outlives what is returned. threads: as cluster() takes it.
Within cluster_within(const TetMesh& mesh, std::span<const int32_t> part, size_t count, HullKernel& kernel,
                      Progress& progress, size_t threads);

// The same from a tree that was made of parts before, with most of what it has: what is in one part stays as it was, of
// what is in several each keeps its share; what came from elsewhere is joined last, the lowest first. merges: those of
// the tree that join no two parts of before.
Within kept_within(const TetMesh& mesh, std::span<const Merge> merges, std::span<const int32_t> part, size_t count,
                   HullKernel& kernel);

}  // namespace partwheel
