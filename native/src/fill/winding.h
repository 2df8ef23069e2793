// How often a surface winds around a point: about 1 inside and 0 outside, also if it has holes or crosses itself.
//
// The generalized winding number (Jacobson, Kavan, Sorkine-Hornung, "Robust Inside-Outside Segmentation using
// Generalized Winding Numbers", 2013), with far triangles taken together as one dipole, as in Barill, Dickson, Schmidt,
// Levin, Jacobson, "Fast Winding Numbers for Soups and Clouds" (2018).
#pragma once

#include "base/geometry.h"

#include <cstddef>
#include <span>
#include <vector>

namespace partwheel {

// The winding number at a point, by the sum over all triangles: O(triangles).
double winding_number(std::span<const Point> vertices, std::span<const Triangle> triangles, const Point& p);

class WindingNumber {
public:
    // The vertices must outlive this. Triangles count with their orientation.
    WindingNumber(std::span<const Point> vertices, std::span<const Triangle> triangles);

    // The winding number at a point, to a few hundredths. Thread-safe; the same bits on every machine.
    double at(const Point& p) const;

    // The number of nodes that at() visits: a few thousand for a surface, all of them if all triangles are near each
    // other.
    size_t visits(const Point& p) const;

private:
    // A triangle, or nodes that follow each other along a space-filling curve.
    struct Node {
        Point center{}, dipole{};  // the centroid; the sum of area times unit normal over the triangles
        double radius = 0;         // of a ball around the center that contains all triangles
    };
    double at(const Point& p, size_t level, size_t index) const;
    size_t visits(const Point& p, size_t level, size_t index) const;

    std::span<const Point> vertices_;
    std::vector<Triangle> triangles_;        // along the curve
    std::vector<std::vector<Node>> levels_;  // the first level: triangles; each other level: runs of nodes of the level before
};

}  // namespace partwheel
