// Tetrahedra cut by a plane: what is on a side is one tetrahedron, a pyramid or a prism, which are tetrahedra again.
#include "convex/slice.h"

#include "hull/hull.h"

#include <cmath>
#include <map>

namespace partwheel::convex {

namespace {

constexpr double flat_share = 1e-9;            // of the extent across the plane
constexpr double golden = 0.6180339887498949;  // multiples of it are spread evenly, less whole numbers

// The prism between two triangles whose corners go with each other.
void add_prism(const Triangle& t, const Triangle& u, std::vector<Tetrahedron>& to) {
    to.push_back({t[0], t[1], t[2], u[0]});
    to.push_back({t[1], t[2], u[0], u[1]});
    to.push_back({t[2], u[0], u[1], u[2]});
}

}  // namespace

Sliced slice(std::span<const Tetrahedron> tetrahedra, const CutPlane& plane, HullKernel& kernel, double jitter) {
    Sliced made;
    std::map<std::array<int32_t, 2>, int32_t> crossings;
    const auto height = [&](int32_t v) { return plane.height(kernel.point(v)); };
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Tetrahedron& t : tetrahedra)
        for (const int32_t v : t) {
            low = std::min(low, height(v));
            high = std::max(high, height(v));
        }
    const double flat = flat_share * (high - low);
    const auto crossing = [&](int32_t a, int32_t b) {
        if (a > b) std::swap(a, b);
        const auto [found, is_new] = crossings.try_emplace({a, b}, -1);
        if (is_new) {
            const double ha = height(a), hb = height(b);
            const Point p = kernel.point(a), q = kernel.point(b);
            const auto n = static_cast<double>(crossings.size());
            const double off = jitter * (golden * n - std::floor(golden * n));
            made.edges.push_back({a, b});
            found->second = kernel.add(p + ha / (ha - hb) * (q - p) + off * plane.normal);
        }
        return found->second;
    };
    // One side's share: its own corners, those in the plane, and those beyond it.
    const auto add_side = [&](std::span<const int32_t> own, std::span<const int32_t> on, std::span<const int32_t> beyond,
                              std::vector<Tetrahedron>& to) {
        if (own.size() == 1) {
            Tetrahedron t{own[0], own[0], own[0], own[0]};
            size_t k = 1;
            for (const int32_t v : on) t[k++] = v;
            for (const int32_t v : beyond) t[k++] = crossing(own[0], v);
            to.push_back(t);
        } else if (own.size() == 3) {
            const Triangle far = {crossing(own[0], beyond[0]), crossing(own[1], beyond[0]), crossing(own[2], beyond[0])};
            add_prism({own[0], own[1], own[2]}, far, to);
        } else if (beyond.size() == 2) {
            add_prism({own[0], crossing(own[0], beyond[0]), crossing(own[0], beyond[1])},
                      {own[1], crossing(own[1], beyond[0]), crossing(own[1], beyond[1])}, to);
        } else {  // a pyramid, its tip in the plane
            const int32_t a = crossing(own[0], beyond[0]), b = crossing(own[1], beyond[0]);
            to.push_back({own[0], own[1], b, on[0]});
            to.push_back({own[0], b, a, on[0]});
        }
    };
    for (const Tetrahedron& t : tetrahedra) {
        std::array<std::array<int32_t, 4>, 3> sides{};  // below, in the plane, above
        std::array<size_t, 3> counts{};
        for (const int32_t v : t) {
            const double h = height(v);
            const size_t side = h < -flat ? 0 : (h > flat ? 2 : 1);
            sides[side][counts[side]++] = v;
        }
        const auto part = [&](size_t side) { return std::span<const int32_t>(sides[side].data(), counts[side]); };
        if (counts[2] == 0) {
            made.below.push_back(t);
        } else if (counts[0] == 0) {
            made.above.push_back(t);
        } else {
            add_side(part(0), part(1), part(2), made.below);
            add_side(part(2), part(1), part(0), made.above);
        }
    }
    return made;
}

}  // namespace partwheel::convex
