// The triangle nearest to a point.
#pragma once

#include "base/corners.h"
#include "mesh/bvh.h"
#include "mesh/triangles.h"

namespace partwheel {

Point nearest_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c);

// The triangle that is nearest to a point, its squared distance, and its nearest point.
struct Near {
    int32_t triangle = -1;
    double squared = HUGE_VAL;
    Point point{};
};

// Nearest-triangle queries on at least one triangle. Which of several at the same distance is found depends on where they
// are, not on their numbering.
class NearestTriangle {
public:
    NearestTriangle(std::span<const Point> vertices, std::span<const Triangle> triangles);

    // The nearest triangle. Fastest if each query is near the previous one.
    Near operator()(const Point& p);
    // The nearest triangle within this distance of p; none: the result's triangle is -1.
    Near operator()(const Point& p, double distance) const;
    // Whether any triangle is within this distance of p; faster than the nearest triangle.
    bool within(const Point& p, double distance) const;
    // Whether p is outside, by the parity of crossings along a ray. Not exact, which is enough for many samples far
    // from the surface.
    bool is_outside(const Point& p) const;

private:
    struct Found {
        size_t place = none;
        Point point{};
        double squared = HUGE_VAL;
    };
    static constexpr size_t none = std::numeric_limits<size_t>::max();

    // The nearest that is at least as near as this one.
    Found search(const Point& p, Found best) const;
    Near near(const Found& found) const { return {order_[found.place], found.squared, found.point}; }

    Point nearest_on(size_t place, const Point& p) const {
        const auto& [a, b, c] = corners_[place];
        return nearest_on_triangle(p, a, b, c);
    }

    std::vector<int32_t> order_;    // the triangles in the tree's order
    std::vector<Corners> corners_;  // of each, in this order
    Bvh tree_;
    Found last_;
};

}  // namespace partwheel
