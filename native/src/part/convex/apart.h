// How far a hull's surface goes away from the solid.
#pragma once

#include "base/geometry.h"

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace partwheel::convex {

Point nearest_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c);

// Distances from tetrahedra, by a tree of boxes. They and their points stay where they are.
class Distances {
public:
    // Tetrahedra that follow each other had better be near each other.
    Distances(std::span<const Point> points, std::span<const Tetrahedron> tetrahedra);

    // Of a point from the nearest of them, 0 inside; or anything from that up to `enough`, if it is no more.
    double distance(const Point& p, double enough = 0) const;

    // The largest distance of a surface, at most `slack` too much and never too little; or anything below `enough` that is
    // not too little; or anything above it that is not too much.
    double farthest(const TriangleMesh& surface, double slack,
                    double enough = -std::numeric_limits<double>::infinity()) const;

private:
    void nearest(size_t node, size_t first, size_t last, const Point& p, double enough, double& best) const;
    void bound(size_t node, size_t first, size_t last);

    std::span<const Point> points_;
    std::span<const Tetrahedron> tetrahedra_;
    std::vector<Box> boxes_;  // of node n the halves are 2 n + 1 and 2 n + 2
};

}  // namespace partwheel::convex
