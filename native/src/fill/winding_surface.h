// A surface that winds around the inside of a repaired mesh, and points distributed over it.
#pragma once

#include "base/geometry.h"
#include "prepare/soup_repair.h"

namespace partwheel {

// Triangles that may cross each other. Each component is oriented outward and, except for holes that repair left,
// closed.
struct WindingSurface {
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;

    double area() const;

    // The vertices, and points on edges and inside larger triangles, as far apart as `count` points distributed evenly
    // over the area would be, but no closer than least_spacing. Distinct and sorted.
    std::vector<Point> points(size_t count, double least_spacing) const;
};

// The repaired mesh; sheets become thin solids, by moving copies half a thickness to either side, and components that
// are inside out are reversed.
WindingSurface make_winding_surface(const RepairedSoup& repaired, double thickness);

}  // namespace partwheel
