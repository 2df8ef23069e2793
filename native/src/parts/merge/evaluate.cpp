// The features of the two networks of merge_parts(), whose outputs are the cost of a pair and the score of a node.
#include "parts/merge/parts.h"

namespace partwheel {

namespace {

double convexity_defect(double volume, double hull) { return hull > 0 ? std::clamp(1 - volume / hull, 0.0, 1.0) : 0; }

double share(double part, double whole) { return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0; }

double mean(double sum, double length) { return length > 0 ? sum / length : 0; }

OwnFeatures own_features(const Part& p, const Part& model) {
    const double length = log2_of(p.border.length), section = log2_of(p.border.interface);
    const double thickness = p.log_volume - p.log_area;
    return {
        .area = p.log_area - model.log_area,
        .volume = p.log_volume - model.log_volume,
        .defect = convexity_defect(p.volume, p.hull_volume),
        .length_to_area = std::clamp(length - p.log_area / 2, -8.0, 4.0),
        .interface_to_volume = std::clamp(section - 2 * p.log_volume / 3, -8.0, 4.0),
        .crease = mean(p.border.crease, p.border.length),
        .concave = mean(p.border.concave, p.border.length),
        .curvature = mean(p.border.curvature, p.border.length),
        .sharpness = mean(p.border.sharpness, p.border.length),
        .ridge = mean(p.border.ridge, p.border.length),
        .valley = mean(p.border.valley, p.border.length),
        .wide_curvature = mean(p.border.wide_curvature, p.border.length),
        .interface_to_area = std::clamp(section - p.log_area, -8.0, 4.0),
        .own_cost = p.own_cost,
        .max_cost = p.subtree_cost,
        .thickness = std::clamp(thickness - model.log_volume / 3, -8.0, 2.0),
        .isoperimetric_ratio = std::clamp(2 * length - section, -4.0, 8.0),
        .section_to_thickness = std::clamp(section - length - thickness, -8.0, 4.0),
        .concavity = log2_of(1e-6 + std::max(0.0, p.hull_volume - p.volume) / model.hull_volume),
    };
}

}  // namespace

double log2_of(double x) {
    constexpr double limit = 20;
    if (!(x > 0)) return -limit;
    int exponent = 0;
    const double m = std::frexp(x, &exponent), root_half = 0.70710678118654752440;
    const double z = (m - root_half) / (m + root_half), q = z * z;
    const double series =
        z * (1 + q * (1.0 / 3 + q * (1.0 / 5 + q * (1.0 / 7 + q * (1.0 / 9 + q * (1.0 / 11 + q * (1.0 / 13)))))));
    return std::clamp(static_cast<double>(exponent) - 0.5 + 2 * 1.44269504088896340736 * series, -limit, limit);
}

PairFeatures pair_features(const Parts& parts, const Pair& pair, double hull_volume) {
    const Part &a = parts[pair.a], &b = parts[pair.b], &model = parts.model;
    const Border& border = pair.border;
    const auto area_a = static_cast<float>(a.area), area_b = static_cast<float>(b.area);
    const bool a_is_smaller = area_a < area_b || (area_a == area_b && a.lowest_tet < b.lowest_tet);
    const Part &s = a_is_smaller ? a : b, &l = a_is_smaller ? b : a;
    const double volume = s.volume + l.volume, area = s.area + l.area;
    const double concavities = std::max(0.0, s.hull_volume - s.volume) + std::max(0.0, l.hull_volume - l.volume);
    const double excess = std::max(0.0, hull_volume - volume - concavities);  // the concavity that merging adds
    const double defect = convexity_defect(volume, hull_volume), defect_s = convexity_defect(s.volume, s.hull_volume),
                 defect_l = convexity_defect(l.volume, l.hull_volume);
    const double length = log2_of(border.length), section = log2_of(border.interface);
    const double thickness_s = s.log_volume - s.log_area, thickness_l = l.log_volume - l.log_area;
    const double model_size = model.log_volume / 3;
    return {
        .area_s = s.log_area - model.log_area,
        .area_both = log2_of(area) - model.log_area,
        .volume_s = s.log_volume - model.log_volume,
        .volume_both = log2_of(volume) - model.log_volume,
        .defect_both = defect,
        .defect_s = defect_s,
        .defect_l = defect_l,
        .excess_to_s = log2_of(1e-4 + (s.hull_volume > 0 ? excess / s.hull_volume : 0)),
        .excess_to_all = log2_of(1e-8 + excess / model.hull_volume),
        .interface_to_volume_s = std::clamp(section - 2 * s.log_volume / 3, -8.0, 4.0),
        .interface_to_area_s = std::clamp(section - s.log_area, -8.0, 4.0),
        .length_to_area_s = std::clamp(length - s.log_area / 2, -8.0, 4.0),
        .length_share_s = share(border.length, s.border.length),
        .length_share_l = share(border.length, l.border.length),
        .interface_share_s = share(border.interface, s.border.interface),
        .interface_share_l = share(border.interface, l.border.interface),
        .thickness_step = std::clamp(thickness_s - thickness_l, -6.0, 6.0),
        .section_to_thickness_s = std::clamp(section - length - thickness_s, -8.0, 4.0),
        .section_to_thickness_l = std::clamp(section - length - thickness_l, -8.0, 4.0),
        .crease = mean(border.crease, border.length),
        .concave = share(border.concave, border.length),
        .curvature = mean(border.curvature, border.length),
        .sharpness = mean(border.sharpness, border.length),
        .ridge = mean(border.ridge, border.length),
        .valley = mean(border.valley, border.length),
        .wide_curvature = mean(border.wide_curvature, border.length),
        .isoperimetric_ratio = std::clamp(2 * length - section, -4.0, 8.0),
        .interface_to_volume_l = std::clamp(section - 2 * l.log_volume / 3, -10.0, 4.0),
        .defect_added = defect - std::max(defect_s, defect_l),
        .area_step = l.log_area - s.log_area,
        .thickness_s = std::clamp(thickness_s - model_size, -8.0, 2.0),
        .thickness_l = std::clamp(thickness_l - model_size, -8.0, 2.0),
    };
}

void summarize_children(Parts& parts) {
    std::vector<uint8_t> has_children(parts.nodes.size(), 0);  // merges without are intermediate
    for (size_t n = 0; n < parts.nodes.size(); ++n) {
        const Part& part = parts.nodes[n];
        if (part.parent < 0 || (n >= parts.initial_count && !has_children[n])) continue;
        Part& parent = parts[part.parent];
        parent.max_child_cost = std::max(parent.max_child_cost, part.own_cost);
        parent.max_child_defect = std::max(parent.max_child_defect, convexity_defect(part.volume, part.hull_volume));
        parent.min_child_log_area = std::min(parent.min_child_log_area, part.log_area);
        has_children[idx(part.parent)] = 1;
    }
}

NodeFeatures node_features(const Parts& parts, size_t node) {
    const Part &model = parts.model, &part = parts.nodes[node];
    const bool is_root = part.parent < 0;
    const size_t parent_id = is_root ? node : idx(part.parent), sibling_id = is_root ? node : idx(part.sibling);
    const OwnFeatures own = own_features(part, model), parent = own_features(parts.nodes[parent_id], model),
                      sibling = own_features(parts.nodes[sibling_id], model);
    const double parent_cost = is_root ? max_cost : parent.own_cost;
    double min_ancestor_cost = max_cost, max_ancestor_cost = is_root ? max_cost : -max_cost;
    for (int32_t p = part.parent; p >= 0; p = parts[p].parent) {
        min_ancestor_cost = std::min(min_ancestor_cost, parts[p].own_cost);
        max_ancestor_cost = std::max(max_ancestor_cost, parts[p].own_cost);
    }
    // The number of parts after the merge that creates a node.
    const size_t initial = parts.initial_count;
    const auto parts_after = [&](size_t n) { return static_cast<double>(n < initial ? initial : 2 * initial - 1 - n); };
    return {
        .own = own,
        .parent_cost = parent_cost,
        .cost_step = parent_cost - own.own_cost,
        .sibling_area = sibling.area - own.area,
        .parent_area = parent.area - own.area,
        .sibling_defect = sibling.defect,
        .sibling_thickness = sibling.thickness,
        .sibling_crease = sibling.crease,
        .sibling_length = sibling.length_to_area,
        .sibling_cost = sibling.own_cost,
        .sibling_max_cost = sibling.max_cost,
        .sibling_rejected_merges = log2_of(1 + parts.nodes[sibling_id].rejected_merges),
        .parent_defect = parent.defect,
        .parent_crease = parent.crease,
        .parent_concave = parent.concave,
        .parent_curvature = parent.curvature,
        .is_root = is_root ? 1.0 : 0.0,
        .defect_step = parent.defect - own.defect,
        .parts_after_merge = log2_of(parts_after(node)),
        .parts_before_parent = log2_of(is_root ? 1 : parts_after(parent_id) + 1),
        .min_ancestor_cost = min_ancestor_cost,
        .max_ancestor_cost = max_ancestor_cost,
        .sibling_volume = std::abs(sibling.volume - own.volume),
        .max_child_cost = part.max_child_cost,
        .max_child_defect = part.max_child_defect,
        .min_child_area = node < initial ? 0 : part.min_child_log_area - part.log_area,
        .rejected_merges = log2_of(1 + part.rejected_merges),
        .whole_rejected_merges = log2_of(1 + parts.nodes.back().rejected_merges),
        .whole_defect = convexity_defect(model.volume, model.hull_volume),
        .whole_thickness = std::clamp(2 * model.log_volume / 3 - model.log_area, -8.0, 2.0),
    };
}

}  // namespace partwheel
