// Convex hulls and predicates by CGAL's exact kernels: the reference of the library's own.
#pragma once

#include "base/geometry.h"
#include "support/shapes.h"

#include <span>
#include <vector>

namespace partwheel::test {

struct ReferenceHull {
    bool flat = true;               // all points in one plane: no facets, volume 0
    std::vector<int32_t> extreme;   // the extreme points, sorted; of equal points the first. Empty if flat
    std::vector<Triangle> facets;   // outward
    long double volume = 0;
};

// The hull of points, numbered as they come.
ReferenceHull reference_hull(std::span<const Point> points);

// Its volume alone.
long double reference_hull_volume(std::span<const Point> points);

// The sign of signed_volume6 in exact rational arithmetic.
int reference_orientation(const Point& a, const Point& b, const Point& c, const Point& d);

// Whether three points are collinear, in exact arithmetic.
bool reference_collinear(const Point& a, const Point& b, const Point& c);

// True if triangles meet elsewhere than at the vertices and edges they share by index.
bool reference_self_intersects(const TriMesh& mesh);

}  // namespace partwheel::test
