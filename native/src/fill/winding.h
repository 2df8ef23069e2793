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

// At a point, by all triangles one after the other.
double winding_number(std::span<const Point> vertices, std::span<const Triangle> triangles, const Point& p);

class WindingNumber {
public:
    // The surface must live as long. Each triangle counts as it winds.
    WindingNumber(std::span<const Point> vertices, std::span<const Triangle> triangles);

    // At a point, to some hundredths. Any number of threads may ask. The same bits on every machine.
    double at(const Point& p) const;

    // How many nodes at() visits: some thousands of a surface, all of them where all triangles are near each other.
    size_t visits(const Point& p) const;

private:
    // A triangle, or nodes that follow each other along a space-filling curve.
    struct Node {
        Point center{}, dipole{};  // the middle of the area; half the sum of the triangles' normals, by area
        double radius = 0;         // of a ball about the centre with all of it
    };
    double at(const Point& p, size_t level, size_t index) const;
    size_t visits(const Point& p, size_t level, size_t index) const;

    std::span<const Point> vertices_;
    std::vector<Triangle> triangles_;        // along the curve
    std::vector<std::vector<Node>> levels_;  // the first of triangles, each other of runs of the one before
};

}  // namespace partwheel
