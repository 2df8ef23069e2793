// Ray casting: the first triangle that a ray hits.
#pragma once

#include "mesh/bvh.h"
#include "mesh/surface.h"

namespace partwheel {

// A ray, prepared for watertight intersection: sheared to the axis z of its largest component (Woop, Benthin, Wald,
// "Watertight Ray/Triangle Intersection", 2013).
struct Ray {
    Point origin, direction;
    size_t x = 0, y = 0, z = 0;

    Ray(const Point& from, const Point& along) : origin(from), direction(along) {
        for (size_t k = 1; k < 3; ++k) z = std::fabs(along[k]) > std::fabs(along[z]) ? k : z;
        x = (z + 1) % 3, y = (z + 2) % 3;
    }

    // The distance to a triangle in lengths of the direction, negative behind the origin; NaN if it misses. No ray
    // passes between triangles that share an edge: rounding may make an edge function 0, which counts as a hit, but
    // never flips it.
    double intersect(const Point& a, const Point& b, const Point& c) const {
        const std::array<Point, 3> corner = {to_ray_space(a), to_ray_space(b), to_ray_space(c)};
        std::array<double, 3> side;  // edge functions
        for (size_t k = 0; k < 3; ++k) {
            const Point &p = corner[(k + 1) % 3], &q = corner[(k + 2) % 3];
            side[k] = p[0] * q[1] - p[1] * q[0];
        }
        const auto [least, most] = std::minmax({side[0], side[1], side[2]});
        const double sum = side[0] + side[1] + side[2];
        if ((least < 0 && most > 0) || sum == 0) return std::numeric_limits<double>::quiet_NaN();
        return (side[0] * corner[0][2] + side[1] * corner[1][2] + side[2] * corner[2][2]) / sum;
    }

    // Whether it may meet a box between these distances.
    bool may_hit(const Box& box, double near, double far) const {
        constexpr double rounding = 1e-12;  // relative: it may put the box's entry behind its exit
        for (size_t k = 0; k < 3; ++k) {
            double enter = (box.low[k] - origin[k]) / direction[k];
            double leave = (box.high[k] - origin[k]) / direction[k];
            if (enter > leave) std::swap(enter, leave);
            if (enter > near) near = enter;  // false for NaN, of a ray along a side of the box
            if (leave < far) far = leave;
        }
        return !(near > far + rounding * std::fabs(far));
    }

private:
    Point to_ray_space(const Point& p) const {
        const Point offset = p - origin;
        const double distance = offset[z] / direction[z];
        return {offset[x] - distance * direction[x], offset[y] - distance * direction[y], distance};
    }
};

struct RayHit {
    int32_t triangle = -1;  // none
    double distance = 0;    // in lengths of the direction
};

// A surface for ray casting, any triangles: a tree of boxes around groups of consecutive triangles along a
// space-filling curve.
class RayTarget {
public:
    // The mesh may be empty. Throws Error(PW_ERROR_INDEX, PW_ERROR_NOT_FINITE).
    explicit RayTarget(const MeshView& mesh, Progress& progress = unobserved_progress());

    // The nearest hit farther away than min_distance, in a tie the lowest triangle. No ray passes between triangles that
    // share an edge or that fill the space around a vertex.
    RayHit first_hit(const Point& origin, const Point& direction, double min_distance) const;

private:
    std::vector<Point> vertices_;
    std::vector<Triangle> triangles_;  // in curve order
    std::vector<int32_t> triangle_ids_;     // of the caller
    Bvh groups_;  // of consecutive triangles
};

}  // namespace partwheel
