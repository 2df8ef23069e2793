// The first triangle that a ray meets: what is under the mouse.
#pragma once

#include "surface/surface.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace partwheel {

struct RayHit {
    int32_t triangle = -1;  // none
    double distance = 0;    // in lengths of the direction
};

// A surface that rays can be sent at, any triangles: boxes about runs of them along a space-filling curve, and boxes about
// runs of those.
class RayTarget {
public:
    // Of no triangles, too. Throws Error(PW_ERROR_INDEX, PW_ERROR_NOT_FINITE).
    explicit RayTarget(const MeshView& mesh);

    // The nearest hit that is farther than `beyond`, of several as near the lowest. No ray passes between triangles that
    // share an edge or fill the space about a vertex.
    RayHit first(const Point& origin, const Point& direction, double beyond) const;

private:
    struct Ray;
    void search(const Ray& ray, size_t level, size_t index, RayHit& best) const;

    std::vector<Point> vertices_;
    std::vector<Triangle> triangles_;  // in the order of the curve
    std::vector<int32_t> numbers_;     // those that they were given in
    std::vector<std::vector<Box>> levels_;  // the first about runs of triangles, each other about runs of the one before
};

}  // namespace partwheel
