// The parts that regroup() joins, and what lies between them.
#pragma once

#include "hull/hull.h"
#include "parts/merge/merge_policy.h"

#include <limits>

namespace partwheel {

// Logarithm to the base 2 by arithmetic alone, so that it is the same on every machine; clamped.
double log2_of(double x);

// Costs are the logits of a likelihood; more than this tells no more.
inline constexpr double largest_cost = 8;

// What lies between two parts, or around one: all of it is added up when parts are joined.
struct Border {
    double interface = 0;  // area of the facets between the tetrahedra
    double length = 0;     // of the border on the surface
    double crease = 0;     // its length times the sine of half the angle it bends by, below 0 where concave
    double sharpness = 0;  // the same without a sign
    double concave = 0;    // the length that is concave by more than concave_bend
    double ridge = 0;      // the length that is convex by more than sharp_bend
    double valley = 0;     // the length that is concave by as much
    double curvature = 0;  // its length times the smoothed mean curvature, squashed to -1..1
    double wide = 0;       // the same of curvature that is smoothed farther

    Border& operator+=(const Border& other) {
        interface += other.interface;
        length += other.length;
        crease += other.crease;
        sharpness += other.sharpness;
        concave += other.concave;
        ridge += other.ridge;
        valley += other.valley;
        curvature += other.curvature;
        wide += other.wide;
        return *this;
    }
};

// An edge of the surface, whatever the parts.
struct SurfaceEdge {
    int32_t one, other;  // the tetrahedra behind its two triangles
    Border border;       // what it adds to one that it lies on
};

struct Pair {
    int32_t a = 0, b = 0;  // parts
    Border border;
    double hull = 0;  // volume of the hull of both, or of less than both have become
    double cost = -std::numeric_limits<double>::infinity();
    bool alive = true;
    bool guessed = true;  // the cost; else it was worked out with the hull
};

struct Part {
    double volume = 0, area = 0;
    double log_volume = 0, log_area = 0;  // log2_of() them: each is in many measures
    Border rim;
    Hull hull;
    double hull_volume = 0;
    int32_t number = 0;  // its cluster's, see Merge
    int32_t low = 0;     // its lowest tetrahedron
    std::vector<int32_t> pairs;
    double own_cost = -largest_cost, worst_cost = -largest_cost;  // of the merge that made it; of any below
    int32_t above = -1, beside = -1;  // what it became a part of, and with which other
    // See look_below(); least_half: the least log_area of a half.
    double halves_cost = -largest_cost, halves_gap = 0, least_half = std::numeric_limits<double>::infinity();
    double dear = 0;  // how many dear joins it holds

    void take_logs() {
        log_volume = log2_of(volume);
        log_area = log2_of(area);
    }
};

struct Parts {
    std::vector<Part> all;  // those chosen, then those that were joined from them
    std::vector<Pair> pairs;
    size_t fine = 0;         // so many were chosen
    Part whole;              // its volume, area and hull
    double volume_unit = 1;  // of the kernel's volumes

    Part& operator[](int32_t p) { return all[idx(p)]; }
    const Part& operator[](int32_t p) const { return all[idx(p)]; }
};

// The clusters of the paper's tree that are the parts, in rising order.
std::vector<int32_t> choose_initial_parts(const TetMesh& mesh, const BinaryTree& tree);

std::vector<SurfaceEdge> surface_edges(const TetMesh& mesh);

// The parts and the pairs of them. folds: the mesh's; part_of: of each tetrahedron, and more; hull_volume: of all. hulls: of
// the parts, where they are known; else they are built.
Parts compute_part_features(const TetMesh& mesh, std::span<const SurfaceEdge> folds, std::span<const int32_t> part_of, size_t count,
                    double hull_volume, std::vector<Hull> hulls, HullKernel& kernel, Progress& progress);

// When all is joined: notes of each part what holds of its halves.
void summarize_subtrees(Parts& parts);

// The features of a pair, where hull is the volume of the hull of both; and of a node, after summarize_subtrees().
PairFeatures measures(const Parts& parts, const Pair& pair, double hull);
NodeFeatures measures(const Parts& parts, size_t node);

}  // namespace partwheel
