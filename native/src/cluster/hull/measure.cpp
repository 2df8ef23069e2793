// The volume of a union's hull, mostly without building it: where one point is outside it is a sum over the facets that
// the point sees.
#include "cluster/hull/view.h"

namespace partwheel {

namespace {

// From so many facets on, points that are to be added are taken as they come, rather than tested first for what they add.
constexpr size_t large_hull = 32;

// Then every so many-th point is first, then those halfway between, and so on: as vertices are numbered along a curve
// through space, the first few are from all over and add most of what all will.
constexpr size_t first_stride = 64;

// A point that adds less than this part of the hull's volume does not count when the volume is all that is asked for.
constexpr double negligible = 1e-14;

// Six times what each of the points alone adds to the hull, to rounding.
std::array<double, 2> added_volumes6(const FacetsView& h, const Point& p, const Point& q) {
    Two sum_p = {0, 0}, sum_q = {0, 0};
    for (size_t f = 0; f < h.count; f += 2) {
        sum_p += positive(h.sides(f, p));
        sum_q += positive(h.sides(f, q));
    }
    return {sum_p[0] + sum_p[1], sum_q[0] + sum_q[1]};
}

// As far as rounded numbers tell.
bool surely_inside(const FacetsView& h, const Point& p) {
    const double factor = h.error_factor(p);
    unsigned negative = 3;
    for (size_t f = 0; f < h.count; f += 2) negative &= signs(h.sides(f, p) + factor * vector_at<Two>(h.size + f));
    return negative == 3;
}

}  // namespace

void HullKernel::survey(const Hull& hull, std::span<const int32_t> points) {
    surveyed_ = hull.block_.get();
    surveyed_points_.assign(points.begin(), points.end());
    candidates_.clear();
    inserted_ = 0;
    loaded_ = false;
    const FacetsView h = view(hull);
    reserve(h.count);
    const std::span<const int32_t> own = hull.vertices();
    constexpr size_t few = 64;
    const auto is_own = [&](int32_t v) {
        return own.size() > few ? std::binary_search(own.begin(), own.end(), v) : contains(own, v);
    };
    if (h.count >= large_hull) {
        const auto take = [&](int32_t v) {
            if (is_own(v)) return;
            prefetch_line(&at(v));
            candidates_.push_back({HUGE_VAL, v});
        };
        for (size_t i = 0; i < points.size(); i += first_stride) take(points[i]);
        for (size_t stride = first_stride / 2; stride > 0; stride /= 2)
            for (size_t i = stride; i < points.size(); i += 2 * stride) take(points[i]);
        return;
    }
    // Those that remain to be tested. What is written past their end is no harm.
    others_.resize(points.size());
    size_t others = 0;
    for (const int32_t v : points) {
        others_[others] = v;
        others += !is_own(v);
    }
    for (size_t i = 0; i < others; i += 2) {
        const std::array<int32_t, 2> v = {others_[i], others_[std::min(i + 1, others - 1)]};
        const std::array<Point, 2> p = {at(v[0]) - h.origin, at(v[1]) - h.origin};
        const auto volumes6 = added_volumes6(h, p[0], p[1]);
        for (size_t k = 0; k < 2 && i + k < others; ++k)
            if (volumes6[k] > 0 || !surely_inside(h, p[k])) candidates_.push_back({volumes6[k], v[k]});
    }
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
        return a.volume6 != b.volume6 ? a.volume6 > b.volume6 : a.vertex < b.vertex;
    });
}

HullKernel::Measure HullKernel::united_volume(const Hull& hull, std::span<const int32_t> points, double enough) {
    if (hull.facet_count() == 0) return {unite(hull, points).volume(), true};
    survey(hull, points);
    const double volume = hull.volume();
    if (candidates_.empty()) return {volume, true};
    if (const double first = candidates_[0].volume6; first < HUGE_VAL) {
        const double with_first = volume + first / 6;
        if (candidates_.size() == 1 || candidates_[1].volume6 <= negligible * volume) return {with_first, true};
        if (with_first > enough) return {with_first, false};
    }
    load(hull);
    for (;;) {
        const int32_t vertex = candidates_[inserted_].vertex;
        const double volume6 = volume6_ + look(vertex);
        if (volume6 / 6 > enough) {
            surveyed_ = nullptr;
            return {volume6 / 6, false};
        }
        // The last one need not be taken in.
        if (inserted_ + 1 == candidates_.size() || candidates_[inserted_ + 1].volume6 <= negligible * volume)
            return {volume6 / 6, true};
        volume6_ = volume6;
        attach(vertex);
        ++inserted_;
    }
}

}  // namespace partwheel
