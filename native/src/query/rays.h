// The first triangle that a ray meets: what is under the mouse.
#pragma once

#include "mesh/surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace partwheel {

// A ray in the form that the intersection test needs: along its longest direction, z, and moved to x = y = 0 (Woop, Benthin, Wald,
// "Watertight Ray/Triangle Intersection", 2013).
struct Ray {
    Point origin, direction;
    size_t x = 0, y = 0, z = 0;

    Ray(const Point& from, const Point& along) : origin(from), direction(along) {
        for (size_t k = 1; k < 3; ++k) z = std::fabs(along[k]) > std::fabs(along[z]) ? k : z;
        x = (z + 1) % 3, y = (z + 2) % 3;
    }

    // How far away it meets a triangle, in lengths of the direction, also behind the origin; NaN where it doesn't. None
    // passes between triangles that share an edge: rounding may make a side 0, which counts as either, but never turns it.
    double to(const Point& a, const Point& b, const Point& c) const {
        const std::array<Point, 3> corner = {seen(a), seen(b), seen(c)};
        std::array<double, 3> side;  // on which it passes each edge
        for (size_t k = 0; k < 3; ++k) {
            const Point &p = corner[(k + 1) % 3], &q = corner[(k + 2) % 3];
            side[k] = p[0] * q[1] - p[1] * q[0];
        }
        const auto [least, most] = std::minmax({side[0], side[1], side[2]});
        const double sum = side[0] + side[1] + side[2];
        if ((least < 0 && most > 0) || sum == 0) return std::numeric_limits<double>::quiet_NaN();
        return (side[0] * corner[0][2] + side[1] * corner[1][2] + side[2] * corner[2][2]) / sum;
    }

private:
    Point seen(const Point& p) const {
        const Point way = p - origin;
        const double far = way[z] / direction[z];
        return {way[x] - far * direction[x], way[y] - far * direction[y], far};
    }
};

struct RayHit {
    int32_t triangle = -1;  // none
    double distance = 0;    // in lengths of the direction
};

// A surface that rays can be sent at, any triangles: boxes about runs of them along a space-filling curve, and boxes about
// runs of those.
class RayTarget {
public:
    // Of no triangles, too. Throws Error(PW_ERROR_INDEX, PW_ERROR_NOT_FINITE).
    explicit RayTarget(const MeshView& mesh, Progress& progress = unwatched());

    // The nearest hit that is farther than `beyond`, of several as near the lowest. No ray passes between triangles that
    // share an edge or fill the space about a vertex.
    RayHit first(const Point& origin, const Point& direction, double beyond) const;

private:
    void search(const Ray& ray, double beyond, size_t level, size_t index, RayHit& best) const;

    std::vector<Point> vertices_;
    std::vector<Triangle> triangles_;  // in the order of the curve
    std::vector<int32_t> numbers_;     // those that they were given in
    std::vector<std::vector<Box>> levels_;  // the first about runs of triangles, each other about runs of the one before
};

}  // namespace partwheel
