// Hierarchical tet clustering: dual graph and queue -> binary tree with a cost for each merge (the paper's Listing 1).
#pragma once

#include "base/progress.h"
#include "fill/tetrahedra.h"

#include <bit>
#include <compare>
#include <cstdint>
#include <vector>

namespace partwheel {

// A cluster is convex if its concavity is at most this part of its hull's volume: well above the rounding of volumes
// and of single-precision coordinates, well below what an eye can see.
inline constexpr double convex_tolerance = 1e-6;

// Concavities are compared after rounding to this many significant bits, so that merges that cost the same by symmetry
// tie, whatever rounding errors their volumes carry.
inline constexpr int concavity_bits = 28;

// Up to this many components each is a candidate to be joined with each other; beyond, with its nearest ones.
inline constexpr int32_t all_pairs_components = 64;

// Eq. 3 of the paper with its ties settled: ordered by concavity (0 if convex), then by C2 (Eq. 2, without its constant
// denominator), then by the lowest tetrahedra of the two clusters.
struct Cost {
    double concavity = 0;  // ranked_concavity
    double balance = 0;    // t1^2 + t2^2, exact
    int32_t low = 0;       // of the two clusters' lowest tetrahedra the lower one,
    int32_t high = 0;      // and the other

    auto operator<=>(const Cost&) const = default;
};

// Eq. 1, rounded to concavity_bits; 0 if convex within convex_tolerance.
inline double ranked_concavity(double hull_volume, double volume) {
    const double concavity = hull_volume - volume;
    if (!(concavity > convex_tolerance * hull_volume)) return 0;
    constexpr uint64_t last = uint64_t{1} << (53 - concavity_bits);
    return std::bit_cast<double>((std::bit_cast<uint64_t>(concavity) + last / 2) & ~(last - 1));
}

// Merge m joins two clusters: number i < T is the leaf of tetrahedron i, T + j what merge j made.
struct Merge {
    int32_t left = 0;  // the one that holds the lowest tetrahedron
    int32_t right = 0;
    double concavity = 0;    // ranked_concavity of the union
    double hull_volume = 0;  // of the union
};

// T - 1 merges: the paper's Listing 1 on the dual graph. When no dual edge is left, the components' clusters are joined
// in the same way, by the concavity of their common hulls, with pairs of components standing in for dual edges.
//
// Two facts keep it fast and exact. The hull of a union comes from the two hulls. And conv(A u B u C) contains
// conv(A u C), so that after a merge an old hull volume is a lower bound: only an edge that reaches the top of the
// queue needs its exact cost.
struct BinaryTree {
    std::vector<Merge> merges;
    size_t components = 0;  // clusters left when the dual edges had run out
};

// threads: at most so many; 0: as many as help. The tree is the same, bit for bit.
BinaryTree cluster(const TetMesh& mesh, Progress& progress, size_t threads = 1);

}  // namespace partwheel
