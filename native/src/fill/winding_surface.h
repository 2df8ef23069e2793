// What winds around the inside of a mesh, and points spread over it.
#pragma once

#include "base/geometry.h"
#include "prepare/soup_repair.h"

#include <vector>

namespace partwheel {

// Triangles that may cross each other; each part of them winds outwards and is closed but for what mending left open.
struct WindingSurface {
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;

    double area() const;

    // The vertices; where triangles are larger, others along their edges and within, as far apart as so many would be that
    // are spread evenly over all, and no closer. Each place once, in rising order.
    std::vector<Point> points(size_t wanted, double least_spacing) const;
};

// The mended mesh, its sheets made thin solids by moving them half of a thickness to either side, and parts that are
// inside out turned.
WindingSurface make_winding_surface(const RepairedSoup& mended, double thickness);

}  // namespace partwheel
