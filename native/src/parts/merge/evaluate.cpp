// The two networks of merge_parts(): their inputs and outputs, the cost of a pair and the score of a node.
#include "parts/merge/parts.h"

#include <algorithm>
#include <cmath>

namespace partwheel {

namespace {

double convexity_gap(double volume, double hull) { return hull > 0 ? std::clamp(1 - volume / hull, 0.0, 1.0) : 0; }

double share(double part, double whole) { return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0; }

double mean(double sum, double length) { return length > 0 ? sum / length : 0; }

// What a node is by itself.
OwnFeatures own_measures(const Part& p, const Part& whole) {
    const double length = log2_of(p.rim.length), face = log2_of(p.rim.interface);
    const double thick = p.log_volume - p.log_area;
    return {
        .area = p.log_area - whole.log_area,
        .volume = p.log_volume - whole.log_volume,
        .gap = convexity_gap(p.volume, p.hull_volume),
        .length_to_area = std::clamp(length - p.log_area / 2, -8.0, 4.0),
        .face_to_volume = std::clamp(face - 2 * p.log_volume / 3, -8.0, 4.0),
        .crease = mean(p.rim.crease, p.rim.length),
        .concave = mean(p.rim.concave, p.rim.length),
        .curvature = mean(p.rim.curvature, p.rim.length),
        .sharpness = mean(p.rim.sharpness, p.rim.length),
        .ridge = mean(p.rim.ridge, p.rim.length),
        .valley = mean(p.rim.valley, p.rim.length),
        .wide = mean(p.rim.wide, p.rim.length),
        .face_to_area = std::clamp(face - p.log_area, -8.0, 4.0),
        .own_cost = p.own_cost,
        .worst_cost = p.worst_cost,
        .thickness = std::clamp(thick - whole.log_volume / 3, -8.0, 2.0),
        .outline = std::clamp(2 * length - face, -4.0, 8.0),
        .face_to_thick = std::clamp(face - length - thick, -8.0, 4.0),
        .dents = log2_of(1e-6 + std::max(0.0, p.hull_volume - p.volume) / whole.hull_volume),
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

PairFeatures measures(const Parts& parts, const Pair& pair, double hull) {
    const Part &a = parts[pair.a], &b = parts[pair.b], &whole = parts.whole;
    const Border& border = pair.border;
    const auto rough_a = static_cast<float>(a.area), rough_b = static_cast<float>(b.area);
    const bool ordered = rough_a < rough_b || (rough_a == rough_b && a.low < b.low);
    const Part &s = ordered ? a : b, &l = ordered ? b : a;
    const double volume = s.volume + l.volume, area = s.area + l.area;
    const double gaps = std::max(0.0, s.hull_volume - s.volume) + std::max(0.0, l.hull_volume - l.volume);
    const double excess = std::max(0.0, hull - volume - gaps);  // the concavity that joining adds
    const double gap = convexity_gap(volume, hull), gap_s = convexity_gap(s.volume, s.hull_volume),
                 gap_l = convexity_gap(l.volume, l.hull_volume);
    const double length = log2_of(border.length), face = log2_of(border.interface);
    const double thick_s = s.log_volume - s.log_area, thick_l = l.log_volume - l.log_area;
    const double size = whole.log_volume / 3;
    return {
        .area_s = s.log_area - whole.log_area,
        .area_both = log2_of(area) - whole.log_area,
        .volume_s = s.log_volume - whole.log_volume,
        .volume_both = log2_of(volume) - whole.log_volume,
        .gap_both = gap,
        .gap_s = gap_s,
        .gap_l = gap_l,
        .excess_to_s = log2_of(1e-4 + (s.hull_volume > 0 ? excess / s.hull_volume : 0)),
        .excess_to_all = log2_of(1e-8 + excess / whole.hull_volume),
        .face_to_volume_s = std::clamp(face - 2 * s.log_volume / 3, -8.0, 4.0),
        .face_to_area_s = std::clamp(face - s.log_area, -8.0, 4.0),
        .length_to_area_s = std::clamp(length - s.log_area / 2, -8.0, 4.0),
        .length_share_s = share(border.length, s.rim.length),
        .length_share_l = share(border.length, l.rim.length),
        .face_share_s = share(border.interface, s.rim.interface),
        .face_share_l = share(border.interface, l.rim.interface),
        .thickness_step = std::clamp(thick_s - thick_l, -6.0, 6.0),
        .face_to_thick_s = std::clamp(face - length - thick_s, -8.0, 4.0),
        .face_to_thick_l = std::clamp(face - length - thick_l, -8.0, 4.0),
        .crease = mean(border.crease, border.length),
        .concave = share(border.concave, border.length),
        .curvature = mean(border.curvature, border.length),
        .sharpness = mean(border.sharpness, border.length),
        .ridge = mean(border.ridge, border.length),
        .valley = mean(border.valley, border.length),
        .wide = mean(border.wide, border.length),
        .outline = std::clamp(2 * length - face, -4.0, 8.0),
        .face_to_volume_l = std::clamp(face - 2 * l.log_volume / 3, -10.0, 4.0),
        .gap_added = gap - std::max(gap_s, gap_l),
        .area_step = l.log_area - s.log_area,
        .thickness_s = std::clamp(thick_s - size, -8.0, 2.0),
        .thickness_l = std::clamp(thick_l - size, -8.0, 2.0),
    };
}

void summarize_subtrees(Parts& parts) {
    std::vector<uint8_t> seen(parts.all.size(), 0);  // that have halves; the other joined ones are steps
    for (size_t n = 0; n < parts.all.size(); ++n) {
        const Part& part = parts.all[n];
        if (part.above < 0 || (n >= parts.fine && !seen[n])) continue;
        Part& above = parts[part.above];
        above.halves_cost = std::max(above.halves_cost, part.own_cost);
        above.halves_gap = std::max(above.halves_gap, convexity_gap(part.volume, part.hull_volume));
        above.least_half = std::min(above.least_half, part.log_area);
        seen[idx(part.above)] = 1;
    }
}

NodeFeatures measures(const Parts& parts, size_t node) {
    const Part &whole = parts.whole, &part = parts.all[node];
    const bool root = part.above < 0;
    const size_t up = root ? node : idx(part.above), side = root ? node : idx(part.beside);
    const OwnFeatures own = own_measures(part, whole), parent = own_measures(parts.all[up], whole),
                      sibling = own_measures(parts.all[side], whole);
    const double out = root ? largest_cost : parent.own_cost;
    double cheapest_above = largest_cost, dearest_above = root ? largest_cost : -largest_cost;
    for (int32_t p = part.above; p >= 0; p = parts[p].above) {
        cheapest_above = std::min(cheapest_above, parts[p].own_cost);
        dearest_above = std::max(dearest_above, parts[p].own_cost);
    }
    // How many parts there are when it comes, and when it goes.
    const size_t fine = parts.fine;
    const auto parts_at = [&](size_t n) { return static_cast<double>(n < fine ? fine : 2 * fine - 1 - n); };
    return {
        .own = own,
        .parent_cost = out,
        .cost_step = out - own.own_cost,
        .sibling_area = sibling.area - own.area,
        .parent_area = parent.area - own.area,
        .sibling_gap = sibling.gap,
        .sibling_thickness = sibling.thickness,
        .sibling_crease = sibling.crease,
        .sibling_length = sibling.length_to_area,
        .sibling_cost = sibling.own_cost,
        .sibling_worst = sibling.worst_cost,
        .sibling_dear = log2_of(1 + parts.all[side].dear),
        .parent_gap = parent.gap,
        .parent_crease = parent.crease,
        .parent_concave = parent.concave,
        .parent_curvature = parent.curvature,
        .root = root ? 1.0 : 0.0,
        .gap_step = parent.gap - own.gap,
        .parts_when_made = log2_of(parts_at(node)),
        .parts_when_joined = log2_of(root ? 1 : parts_at(up) + 1),
        .cheapest_above = cheapest_above,
        .dearest_above = dearest_above,
        .sibling_volume = std::abs(sibling.volume - own.volume),
        .halves_cost = part.halves_cost,
        .halves_gap = part.halves_gap,
        .halves_area = node < fine ? 0 : part.least_half - part.log_area,
        .dear_below = log2_of(1 + part.dear),
        .dear = log2_of(1 + parts.all.back().dear),
        .whole_gap = convexity_gap(whole.volume, whole.hull_volume),
        .whole_thickness = std::clamp(2 * whole.log_volume / 3 - whole.log_area, -8.0, 2.0),
    };
}

double mlp_forward(std::span<const double> numbers, std::span<const double> inputs) {
    double sum = numbers.back();
    const size_t row = inputs.size() + 2;
    for (size_t h = 0; h + row < numbers.size(); h += row) {
        double z = numbers[h];
        for (size_t i = 0; i < inputs.size(); ++i) z += numbers[h + 1 + i] * inputs[i];
        sum += numbers[h + 1 + inputs.size()] * (z / (1 + std::abs(z)));
    }
    return sum;
}

}  // namespace partwheel
