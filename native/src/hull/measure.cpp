// The volume of a union's hull, usually without building it: if a single point is outside, the added volume is a sum
// over the facets visible from it.
#include "hull/view.h"

namespace partwheel {

namespace {

// From this many facets on, points are inserted in a fixed order rather than sorted by the volume that each adds.
constexpr size_t large_hull = 32;

// That order: every first_stride-th point, then those halfway between, and so on. Vertices are numbered along a
// space-filling curve, so the first few are spread over the set and add most of the volume. More than most_strided
// points are spread out by their numbers.
constexpr size_t first_stride = 64, most_strided = 4096;

// When only the volume is needed, points that add less than this fraction of it are ignored.
constexpr double negligible = 1e-14;

// Six times the volume that p alone and q alone add to the hull, rounded.
std::array<double, 2> added_volumes6(const FacetsView& h, const Point& p, const Point& q) {
    Double2 sum_p = {0, 0}, sum_q = {0, 0};
    for (size_t f = 0; f < h.count; f += 2) {
        sum_p += positive(h.sides(f, p));
        sum_q += positive(h.sides(f, q));
    }
    return {sum_p[0] + sum_p[1], sum_q[0] + sum_q[1]};
}

// Conservative: false if rounding leaves it open.
bool is_certainly_inside(const FacetsView& h, const Point& p) {
    const double factor = h.error_factor(p);
    unsigned negative = 3;
    for (size_t f = 0; f < h.count; f += 2)
        negative &= sign_mask(h.sides(f, p) + factor * vector_at<Double2>(h.size + f));
    return negative == 3;
}

}  // namespace

void HullKernel::collect_candidates(const Hull& hull, std::span<const int32_t> points) {
    candidates_hull_ = hull.block_.get();
    candidates_points_.assign(points.begin(), points.end());
    candidates_.clear();
    inserted_count_ = 0;
    loaded_ = false;
    const FacetsView h = view(hull);
    reserve(h.count);
    const std::span<const int32_t> own = hull.vertices();
    constexpr size_t max_linear_search = 64;
    const auto is_own = [&](int32_t v) {
        return own.size() > max_linear_search ? std::binary_search(own.begin(), own.end(), v) : contains(own, v);
    };
    if (h.count >= large_hull) {
        const auto take = [&](int32_t v) {
            if (is_own(v)) return;
            prefetch_line(&at(v));
            candidates_.push_back({HUGE_VAL, v});
        };
        if (points.size() > most_strided) {
            std::vector<int32_t> order(points.begin(), points.end());
            spread_out(order);
            for (const int32_t v : order) take(v);
            return;
        }
        for (size_t i = 0; i < points.size(); i += first_stride) take(points[i]);
        for (size_t stride = first_stride / 2; stride > 0; stride /= 2)
            for (size_t i = stride; i < points.size(); i += 2 * stride) take(points[i]);
        return;
    }
    // Branch-free filter: entries written past the end are overwritten or ignored.
    untested_.resize(points.size());
    size_t n_untested = 0;
    for (const int32_t v : points) {
        untested_[n_untested] = v;
        n_untested += !is_own(v);
    }
    for (size_t i = 0; i < n_untested; i += 2) {
        const std::array<int32_t, 2> v = {untested_[i], untested_[std::min(i + 1, n_untested - 1)]};
        const std::array<Point, 2> p = {at(v[0]) - h.origin, at(v[1]) - h.origin};
        const auto volumes6 = added_volumes6(h, p[0], p[1]);
        for (size_t k = 0; k < 2 && i + k < n_untested; ++k)
            if (volumes6[k] > 0 || !is_certainly_inside(h, p[k])) candidates_.push_back({volumes6[k], v[k]});
    }
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
        return a.volume6 != b.volume6 ? a.volume6 > b.volume6 : a.vertex < b.vertex;
    });
}

HullKernel::VolumeBound HullKernel::union_volume(const Hull& hull, std::span<const int32_t> points,
                                                 double early_out_volume) {
    if (hull.facet_count() == 0) return {unite(hull, points).volume(), true};
    collect_candidates(hull, points);
    const double volume = hull.volume();
    if (candidates_.empty()) return {volume, true};
    if (const double first = candidates_[0].volume6; first < HUGE_VAL) {
        const double with_first = volume + first / 6;
        if (candidates_.size() == 1 || candidates_[1].volume6 <= negligible * volume) return {with_first, true};
        if (with_first > early_out_volume) return {with_first, false};
    }
    load(hull);
    for (;;) {
        const int32_t vertex = candidates_[inserted_count_].vertex;
        const double volume6 = volume6_ + find_visible(vertex);
        if (volume6 / 6 > early_out_volume) {
            candidates_hull_ = nullptr;
            return {volume6 / 6, false};
        }
        // The last point need not be inserted.
        if (inserted_count_ + 1 == candidates_.size() || candidates_[inserted_count_ + 1].volume6 <= negligible * volume)
            return {volume6 / 6, true};
        volume6_ = volume6;
        replace_visible_facets(vertex);
        ++inserted_count_;
    }
}

}  // namespace partwheel
