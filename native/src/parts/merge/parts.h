// The parts that merge_parts() merges, and their features.
#pragma once

#include "hull/hull.h"
#include "parts/merge/merge_policy.h"

namespace partwheel {

// log2(x), clamped to [-20, 20], by basic arithmetic, so that every machine computes the same bits.
double log2_of(double x);

// Costs are logits, clamped to +-max_cost in the features.
inline constexpr double max_cost = 8;

// The border between two parts, or around one. Borders are additive. The unit of length is the model's longest side.
struct Border {
    double interface = 0;       // area of the facets between the tetrahedra
    double length = 0;          // of the border on the surface
    double crease = 0;          // integral of the bend: the sine of half the dihedral turn, negative where concave
    double sharpness = 0;       // integral of |bend|
    double concave = 0;         // length with a bend below -concave_bend
    double ridge = 0;           // length with a bend above sharp_bend
    double valley = 0;          // length with a bend below -sharp_bend
    double curvature = 0;       // integral of the smoothed mean curvature, mapped to -1..1
    double wide_curvature = 0;  // the same with more smoothing
    double marked = 0;          // integral of the strength of marks along the border
    double marked_interface = 0;  // the same over the interface

    Border& operator+=(const Border& other) {
        auto sums = as_array(*this);
        const auto more = as_array(other);
        for (size_t i = 0; i < sums.size(); ++i) sums[i] += more[i];
        return *this = std::bit_cast<Border>(sums);
    }
    double marked_share() const {
        return length > 0 ? marked / length : interface > 0 ? marked_interface / interface : 0;
    }
};

// An edge between two triangles of the solid's boundary.
struct SurfaceEdge {
    int32_t tet_a, tet_b;  // behind its two triangles
    Border border;         // what it adds to a border that contains it
};

// Two adjacent parts.
struct Pair {
    int32_t a = 0, b = 0;  // parts
    Border border;
    double hull_volume = 0;  // of both together, or a lower bound
    double cost = -std::numeric_limits<double>::infinity();
    bool is_alive = true;
    bool is_estimate = true;  // the cost comes from a lower bound of the hull volume
};

inline constexpr int32_t several_groups = -2;  // a part that hard marks divide

struct Part {
    double volume = 0, area = 0;
    double log_volume = 0, log_area = 0;
    Border border;
    Hull hull;
    double hull_volume = 0;
    int32_t cluster = 0;     // its number in the merge tree, see Merge
    int32_t lowest_tet = 0;
    int32_t group = -1;      // Regions::group() of its tetrahedra, or several_groups
    bool joins_patches = false;  // merged across a marked border
    std::vector<int32_t> pairs;
    double own_cost = -max_cost, subtree_cost = -max_cost;  // of the merge that created it; the largest in its subtree
    int32_t parent = -1, sibling = -1;
    // Summary of its children, see summarize_children().
    double max_child_cost = -max_cost, max_child_defect = 0, min_child_log_area = std::numeric_limits<double>::infinity();
    double rejected_merges = 0;  // in its subtree, see NodeFeatures

    void update_logs() {
        log_volume = log2_of(volume);
        log_area = log2_of(area);
    }
};

struct Parts {
    std::vector<Part> nodes;  // the initial parts, then one per merge
    std::vector<Pair> pairs;
    size_t initial_count = 0;
    Part model;              // volume, area and hull of all parts together
    double volume_unit = 1;  // of the parts' volumes, in the hull kernel's unit

    Part& operator[](int32_t p) { return nodes[idx(p)]; }
    const Part& operator[](int32_t p) const { return nodes[idx(p)]; }
};

// The clusters of the paper's tree that become the initial parts, ascending.
std::vector<int32_t> choose_initial_parts(const TetMesh& mesh, const BinaryTree& tree, const Regions* regions);

std::vector<SurfaceEdge> compute_surface_edges(const TetMesh& mesh, const Regions* regions);

// The parts and their pairs. edges: those of the mesh; label: the part of each tetrahedron (longer is fine), 0 to
// count - 1; hull_volume: of the model; hulls: of the parts, or empty to build them.
Parts build_parts(const TetMesh& mesh, std::span<const SurfaceEdge> edges, std::span<const int32_t> label, size_t count,
                  double hull_volume, std::vector<Hull> hulls, const Regions* regions, HullKernel& kernel,
                  Progress& progress);

// After the last merge: computes each part's summary of its children.
void summarize_children(Parts& parts);

// hull_volume: of both parts together.
PairFeatures pair_features(const Parts& parts, const Pair& pair, double hull_volume);
// Call summarize_children() first.
NodeFeatures node_features(const Parts& parts, size_t node);

}  // namespace partwheel
