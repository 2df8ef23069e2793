// How often a surface winds around a point: about 1 inside and 0 outside, also if it has holes or crosses itself.
//
// The generalized winding number (Jacobson, Kavan, Sorkine-Hornung, "Robust Inside-Outside Segmentation using
// Generalized Winding Numbers", 2013), with far triangles taken together as one dipole, as in Barill, Dickson, Schmidt,
// Levin, Jacobson, "Fast Winding Numbers for Soups and Clouds" (2018).
#pragma once

#include "base/geometry.h"

namespace partwheel {

// The winding number at a point, by the sum over all triangles: O(triangles).
double winding_number(std::span<const Point> vertices, std::span<const Triangle> triangles, const Point& p);

class WindingNumber {
public:
    // The vertices must outlive this. Triangles count with their orientation.
    WindingNumber(std::span<const Point> vertices, std::span<const Triangle> triangles);

    // The winding number at a point, to a few hundredths. Thread-safe; the same bits on every machine.
    double at(const Point& p) const;

    // The number of nodes that at() visits: a few thousand for a surface, also with fans of many triangles; all of them
    // if triangles that share no vertex are near each other.
    size_t visits(const Point& p) const;

private:
    // A triangle, a fan, or nodes that follow each other along a space-filling curve.
    struct Node {
        Point center{}, dipole{};  // the centroid; the sum of area times unit normal over the triangles
        double radius = 0;         // of a ball around the center that contains all triangles
    };
    using Levels = std::vector<std::vector<Node>>;  // each level: runs of nodes of the level before

    // Many triangles around a vertex, the apex. All are near it, so they are far from a point only where their rim is:
    // nodes are runs of rim edges. A node's dipole is that of a surface between its edges and their chord.
    struct Fan {
        Point apex{};
        std::vector<Point> rim;  // triangle t has the corners apex, rim[t], rim[t + 1]
        Levels levels;
    };

    static void complete(Levels& levels, std::vector<double> areas);
    std::vector<Triangle> find_fans(std::span<const Triangle> triangles);
    void add_fan(int32_t apex, std::span<const int32_t> rim);
    Node leaf(const Triangle& item, double& area) const;
    double at(const Point& p, size_t level, size_t begin, size_t end, size_t& visits) const;  // of nodes [begin, end)
    double at(const Triangle& item, const Point& p, size_t& visits) const;
    double at(const Fan& fan, const Point& p, size_t level, size_t index, size_t& visits) const;

    std::span<const Point> vertices_;
    std::vector<Fan> fans_;
    std::vector<Triangle> items_;  // along the curve: triangles, and {-1 - fan, ...}
    Levels levels_;                // the first level: items
};

}  // namespace partwheel
