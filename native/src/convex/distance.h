// How far a hull's surface goes away from the solid.
#pragma once

#include "base/geometry.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace partwheel::convex {

// Facets that have nothing on their other side, and the tetrahedron of each; in the order of their vertices.
struct OuterFacet {
    Triangle corners;
    int32_t tetrahedron;
};
std::vector<OuterFacet> boundary_facets(std::span<const Tetrahedron> tetrahedra);

inline double squared(const Point& p) { return dot(p, p); }

Point nearest_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c);

// Boxes in a binary tree: of node n the halves are 2 n + 1 and 2 n + 2, each half of what n has in `order`.
struct BoxTree {
    std::vector<size_t> order;
    std::vector<Box> boxes;

    explicit BoxTree(std::span<const Box> items);

private:
    void bound(std::span<const Box> items, size_t node, size_t first, size_t last);
};

// Distances from tetrahedra. They and their points stay where they are.
class Distances {
public:
    Distances(std::span<const Point> points, std::span<const Tetrahedron> tetrahedra);

    // The point of them that is nearest to p, p itself inside; or any that is no farther than `enough`.
    Point nearest(const Point& p, double enough = 0) const;

    // The largest distance of a surface, at most `slack` too much and never too little; or anything below `enough` that is
    // not too little; or anything above it that is not too much.
    double farthest(const TriangleMesh& surface, double slack,
                    double enough = -std::numeric_limits<double>::infinity()) const;

private:
    struct Found {
        Point point{};
        double squared = HUGE_VAL;  // of its distance
    };
    void look(size_t node, size_t first, size_t last, const Point& p, double enough, Found& best) const;
    bool inside(size_t node, size_t first, size_t last, const Point& p) const;

    std::span<const Point> points_;
    std::span<const Tetrahedron> tetrahedra_;
    std::vector<Triangle> surface_;  // the outer facets
    BoxTree of_tetrahedra_, of_surface_;
};

}  // namespace partwheel::convex
