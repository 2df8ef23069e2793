// The part of a tetrahedron on one side of a plane is a tetrahedron, a pyramid or a prism; the latter two are divided
// again.
#include "convex/slice.h"

#include "hull/hull.h"

namespace partwheel::convex {

namespace {

constexpr double flat_share = 1e-9;            // of the extent along the normal
constexpr double golden = 0.6180339887498949;  // fractional parts of its multiples are spread evenly

// The prism between two triangles with corresponding corners.
void add_prism(const Triangle& t, const Triangle& u, std::vector<Tetrahedron>& to) {
    to.push_back({t[0], t[1], t[2], u[0]});
    to.push_back({t[1], t[2], u[0], u[1]});
    to.push_back({t[2], u[0], u[1], u[2]});
}

class Slicer {
public:
    Slicer(std::span<const Tetrahedron> tetrahedra, const Plane& plane, HullKernel& kernel, double jitter)
        : tetrahedra_(tetrahedra), plane_(plane), kernel_(kernel), jitter_(jitter) {}

    SliceResult slice() {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (const Tetrahedron& t : tetrahedra_)
            for (const int32_t v : t) {
                low = std::min(low, height(v));
                high = std::max(high, height(v));
            }
        for (const Tetrahedron& t : tetrahedra_) add(t, flat_share * (high - low));
        return std::move(result_);
    }

private:
    double height(int32_t v) const { return plane_.height(kernel_.point(v)); }

    void add(const Tetrahedron& t, double flat) {
        std::array<std::array<int32_t, 4>, 3> sides{};  // below, in the plane, above
        std::array<size_t, 3> counts{};
        for (const int32_t v : t) {
            const double h = height(v);
            const size_t side = h < -flat ? 0 : (h > flat ? 2 : 1);
            sides[side][counts[side]++] = v;
        }
        const auto on_side = [&](size_t side) { return std::span<const int32_t>(sides[side].data(), counts[side]); };
        if (counts[2] == 0) {
            result_.below.push_back(t);
        } else if (counts[0] == 0) {
            result_.above.push_back(t);
        } else {
            add_side(on_side(0), on_side(1), on_side(2), result_.below);
            add_side(on_side(2), on_side(1), on_side(0), result_.above);
        }
    }

    // The part on one side. own: its corners; on: those in the plane; beyond: those on the other side.
    void add_side(std::span<const int32_t> own, std::span<const int32_t> on, std::span<const int32_t> beyond,
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
        } else {  // a pyramid with its apex in the plane
            const int32_t a = crossing(own[0], beyond[0]), b = crossing(own[1], beyond[0]);
            to.push_back({own[0], own[1], b, on[0]});
            to.push_back({own[0], b, a, on[0]});
        }
    }

    // The point where an edge crosses the plane.
    int32_t crossing(int32_t a, int32_t b) {
        if (a > b) std::swap(a, b);
        const auto [entry, is_new] = crossings_.try_emplace({a, b}, -1);
        if (is_new) {
            const double ha = height(a), hb = height(b);
            const Point p = kernel_.point(a), q = kernel_.point(b);
            const auto n = static_cast<double>(crossings_.size());
            const double off = jitter_ * (golden * n - std::floor(golden * n));
            result_.edges.push_back({a, b});
            entry->second = kernel_.add(p + ha / (ha - hb) * (q - p) + off * plane_.normal);
        }
        return entry->second;
    }

    std::span<const Tetrahedron> tetrahedra_;
    const Plane& plane_;
    HullKernel& kernel_;
    const double jitter_;
    std::map<std::array<int32_t, 2>, int32_t> crossings_;
    SliceResult result_;
};

}  // namespace

SliceResult slice(std::span<const Tetrahedron> tetrahedra, const Plane& plane, HullKernel& kernel, double jitter) {
    return Slicer(tetrahedra, plane, kernel, jitter).slice();
}

}  // namespace partwheel::convex
