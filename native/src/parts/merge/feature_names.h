// The features of the two networks of merge_parts(), by name: those of a pair of parts, and those of a node of the new tree.
// It is the only list of them: tests/core/merge_network.py reads it for fit.py and the tests.
//
// s is the part of the two with the smaller area, l the other (areas in single precision; where these tie, s has the
// lowest tetrahedron). log is to the base 2, at least -20 and at most 20; [a, b] keeps what is before it within a and
// b; a quotient by 0 is 0, and shares and gaps stay within 0 and 1. merge_policy.h says what area, interface, crease and so
// on are.
//
//   thick(p) = log volume(p) - log area(p)
//   gap(p)   = 1 - volume(p) / hull(p)
//   dents(p) = hull(p) - volume(p), not below 0
//   excess   = hull(both) - volume(both) - dents(s) - dents(l), not below 0: the concavity that joining adds
//   face     = log interface
#pragma once

#include <array>
#include <bit>
#include <cstddef>

namespace partwheel {

// Names in the order in which fitted_pair_numbers has a weight for each.
struct PairFeatures {
    double area_s;             // log area(s) - log area(all)
    double area_both;          // log(area(s) + area(l)) - log area(all)
    double volume_s;           // log volume(s) - log volume(all)
    double volume_both;        // log(volume(s) + volume(l)) - log volume(all)
    double gap_both;           // gap(both)
    double gap_s;              // gap(s)
    double gap_l;              // gap(l)
    double excess_to_s;        // log(0.0001 + excess / hull(s))
    double excess_to_all;      // log(0.00000001 + excess / hull(all))
    double face_to_volume_s;   // face - 2/3 log volume(s) [-8, 4]
    double face_to_area_s;     // face - log area(s) [-8, 4]
    double length_to_area_s;   // log length - 1/2 log area(s) [-8, 4]
    double length_share_s;     // length / length of the rim of s
    double length_share_l;     // length / length of the rim of l
    double face_share_s;       // interface / interface of the rim of s
    double face_share_l;       // interface / interface of the rim of l
    double thickness_step;     // thick(s) - thick(l) [-6, 6]
    double face_to_thick_s;    // face - log length - thick(s) [-8, 4]
    double face_to_thick_l;    // face - log length - thick(l) [-8, 4]
    double crease;             // crease / length
    double concave;            // concave / length
    double curvature;          // curvature / length
    double sharpness;          // sharpness / length
    double ridge;              // ridge / length
    double valley;             // valley / length
    double wide;               // wide curvature / length
    double outline;            // 2 log length - face [-4, 8]
    double face_to_volume_l;   // face - 2/3 log volume(l) [-10, 4]
    double gap_added;          // gap(both) - the larger of gap(s) and gap(l)
    double area_step;          // log area(l) - log area(s)
    double thickness_s;        // thick(s) - 1/3 log volume(all) [-8, 2]
    double thickness_l;        // thick(l) - 1/3 log volume(all) [-8, 2]
};

// What a node is by itself. face and length are those of its rim. own_cost is what the merge that made it costs, as a
// logit within -8 and 8, worst_cost the largest own_cost of it and all below; both are -8 for a part, and own_cost is 8
// where components are joined.
struct OwnFeatures {
    double area;               // log area - log area(all)
    double volume;             // log volume - log volume(all)
    double gap;                // gap
    double length_to_area;     // log length - 1/2 log area [-8, 4]
    double face_to_volume;     // face - 2/3 log volume [-8, 4]
    double crease;             // crease / length
    double concave;            // concave / length
    double curvature;          // curvature / length
    double sharpness;          // sharpness / length
    double ridge;              // ridge / length
    double valley;             // valley / length
    double wide;               // wide curvature / length
    double face_to_area;       // face - log area [-8, 4]
    double own_cost;           // own_cost
    double worst_cost;         // worst_cost
    double thickness;          // thick - 1/3 log volume(all) [-8, 2]
    double outline;            // 2 log length - face [-4, 8]
    double face_to_thick;      // face - log length - thick [-8, 4]
    double dents;              // log(0.000001 + dents / hull(all))
};

// Names in the order in which fitted_node_numbers has a weight for each. The root is its own parent and sibling. A join
// is dear if people rather part than join the two: its own_cost is above 0, but below 8, which joins components.
struct NodeFeatures {
    OwnFeatures own;
    double parent_cost;        // own_cost of the parent; 8 at the root
    double cost_step;          // parent_cost - own_cost
    double sibling_area;       // area of the sibling - area
    double parent_area;        // area of the parent - area
    double sibling_gap;        // gap of the sibling
    double sibling_thickness;  // thickness of the sibling
    double sibling_crease;     // crease of the sibling
    double sibling_length;     // length_to_area of the sibling
    double sibling_cost;       // own_cost of the sibling
    double sibling_worst;      // worst_cost of the sibling
    double sibling_dear;       // dear_below of the sibling
    double parent_gap;         // gap of the parent
    double parent_crease;      // crease of the parent
    double parent_concave;     // concave of the parent
    double parent_curvature;   // curvature of the parent
    double root;               // 1 at the root, else 0
    double gap_step;           // gap of the parent - gap
    double parts_when_made;    // log of how many parts there were once it was made; for a part, at first
    double parts_when_joined;  // log of how many there were before its parent was made; 0 at the root
    double cheapest_above;     // the least own_cost of its ancestors, at most 8
    double dearest_above;      // the largest own_cost of its ancestors, at least -8; 8 at the root
    double sibling_volume;     // how far the volume of the sibling is from volume, without a sign
    double halves_cost;        // the larger own_cost of its two halves; -8 for a part
    double halves_gap;         // the larger gap of its two halves; 0 for a part
    double halves_area;        // area of the smaller half - area; 0 for a part
    double dear_below;         // log(1 + how many dear joins it holds, its own too)
    double dear;               // the same of all
    double whole_gap;          // gap of all
    double whole_thickness;    // thick(all) - 1/3 log volume(all) [-8, 2]
};

inline constexpr size_t pair_feature_count = sizeof(PairFeatures) / sizeof(double);
inline constexpr size_t node_feature_count = sizeof(NodeFeatures) / sizeof(double);

inline std::array<double, pair_feature_count> in_order(const PairFeatures& m) {
    return std::bit_cast<std::array<double, pair_feature_count>>(m);
}
inline std::array<double, node_feature_count> in_order(const NodeFeatures& m) {
    return std::bit_cast<std::array<double, node_feature_count>>(m);
}

}  // namespace partwheel
