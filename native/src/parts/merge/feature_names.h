// The input features of the two networks of merge_parts(), in the order of their weights. This is the only list:
// tests/core/merge_network.py reads it for fit.py and the tests.
//
// Notation. s is the part of the pair with the smaller area, l the other one (compared in single precision; in a tie
// s has the lowest tetrahedron). log is base 2, clamped to [-20, 20]; [a, b] clamps what precedes it; a quotient by 0
// is 0; shares and defects are clamped to [0, 1]. merge_policy.h defines area, interface, crease and so on.
//
//   thickness(p)    = log volume(p) - log area(p)
//   hull(p)         = volume of the convex hull of p
//   defect(p)       = 1 - volume(p) / hull(p), the convexity defect
//   concavity(p)    = max(0, hull(p) - volume(p))
//   excess          = max(0, hull(both) - volume(both) - concavity(s) - concavity(l)): what merging adds
//   section         = log interface
#pragma once

#include <array>
#include <bit>
#include <cstddef>

namespace partwheel {

// In the order of the weights of pair_network.
struct PairFeatures {
    double area_s;                  // log area(s) - log area(model)
    double area_both;               // log(area(s) + area(l)) - log area(model)
    double volume_s;                // log volume(s) - log volume(model)
    double volume_both;             // log volume(both) - log volume(model)
    double defect_both;             // defect(both)
    double defect_s;                // defect(s)
    double defect_l;                // defect(l)
    double excess_to_s;             // log(0.0001 + excess / hull(s))
    double excess_to_all;           // log(0.00000001 + excess / hull(model))
    double interface_to_volume_s;   // section - 2/3 log volume(s) [-8, 4]
    double interface_to_area_s;     // section - log area(s) [-8, 4]
    double length_to_area_s;        // log length - 1/2 log area(s) [-8, 4]
    double length_share_s;          // length / length of the border of s
    double length_share_l;          // length / length of the border of l
    double interface_share_s;       // interface / interface of the border of s
    double interface_share_l;       // interface / interface of the border of l
    double thickness_step;          // thickness(s) - thickness(l) [-6, 6]
    double section_to_thickness_s;  // section - log length - thickness(s) [-8, 4]
    double section_to_thickness_l;  // section - log length - thickness(l) [-8, 4]
    double crease;                  // crease / length
    double concave;                 // concave length / length
    double curvature;               // curvature / length
    double sharpness;               // sharpness / length
    double ridge;                   // ridge / length
    double valley;                  // valley / length
    double wide_curvature;          // wide curvature / length
    double isoperimetric_ratio;     // 2 log length - section [-4, 8]
    double interface_to_volume_l;   // section - 2/3 log volume(l) [-10, 4]
    double defect_added;            // defect(both) - max(defect(s), defect(l))
    double area_step;               // log area(l) - log area(s)
    double thickness_s;             // thickness(s) - 1/3 log volume(model) [-8, 2]
    double thickness_l;             // thickness(l) - 1/3 log volume(model) [-8, 2]
};

// Features of a node alone. length, section, crease and so on are those of its border. own_cost: the cost of the merge
// that created it, clamped to [-8, 8]; -8 for an initial part, 8 where components merge.
struct OwnFeatures {
    double area;                  // log area - log area(model)
    double volume;                // log volume - log volume(model)
    double defect;                // defect
    double length_to_area;        // log length - 1/2 log area [-8, 4]
    double interface_to_volume;   // section - 2/3 log volume [-8, 4]
    double crease;                // crease / length
    double concave;               // concave length / length
    double curvature;             // curvature / length
    double sharpness;             // sharpness / length
    double ridge;                 // ridge / length
    double valley;                // valley / length
    double wide_curvature;        // wide curvature / length
    double interface_to_area;     // section - log area [-8, 4]
    double own_cost;              // own_cost
    double max_cost;              // the largest own_cost in its subtree
    double thickness;             // thickness - 1/3 log volume(model) [-8, 2]
    double isoperimetric_ratio;   // 2 log length - section [-4, 8]
    double section_to_thickness;  // section - log length - thickness [-8, 4]
    double concavity;             // log(0.000001 + concavity / hull(model))
};

// In the order of the weights of node_network. The root is its own parent and sibling. A rejected merge has an
// own_cost in (0, 8): people would rather separate its two parts. 8 itself merges components.
struct NodeFeatures {
    OwnFeatures own;
    double parent_cost;              // own_cost of the parent; 8 at the root
    double cost_step;                // parent_cost - own_cost
    double sibling_area;             // area of the sibling - area
    double parent_area;              // area of the parent - area
    double sibling_defect;           // defect of the sibling
    double sibling_thickness;        // thickness of the sibling
    double sibling_crease;           // crease of the sibling
    double sibling_length;           // length_to_area of the sibling
    double sibling_cost;             // own_cost of the sibling
    double sibling_max_cost;         // max_cost of the sibling
    double sibling_rejected_merges;  // rejected_merges of the sibling
    double parent_defect;            // defect of the parent
    double parent_crease;            // crease of the parent
    double parent_concave;           // concave of the parent
    double parent_curvature;         // curvature of the parent
    double is_root;                  // 1 at the root, else 0
    double defect_step;              // defect of the parent - defect
    double parts_after_merge;        // log of the number of parts after the merge that created it; initially for a part
    double parts_before_parent;      // log of the number of parts before the merge that created its parent; 0 at the root
    double min_ancestor_cost;        // the smallest own_cost of its ancestors, at most 8
    double max_ancestor_cost;        // the largest own_cost of its ancestors, at least -8; 8 at the root
    double sibling_volume;           // |volume of the sibling - volume|
    double max_child_cost;           // the larger own_cost of its children; -8 for a part
    double max_child_defect;         // the larger defect of its children; 0 for a part
    double min_child_area;           // the smaller area of its children - area; 0 for a part
    double rejected_merges;          // log(1 + number of rejected merges in its subtree)
    double whole_rejected_merges;    // log(1 + number of rejected merges in the model)
    double whole_defect;             // defect(model)
    double whole_thickness;          // thickness(model) - 1/3 log volume(model) [-8, 2]
};

inline constexpr size_t pair_feature_count = sizeof(PairFeatures) / sizeof(double);
inline constexpr size_t node_feature_count = sizeof(NodeFeatures) / sizeof(double);

// A struct of doubles.
template <class Doubles>
auto as_array(const Doubles& doubles) {
    return std::bit_cast<std::array<double, sizeof(Doubles) / sizeof(double)>>(doubles);
}

}  // namespace partwheel
