// The planes in which a surface is its own mirror image, nearly.
#pragma once

#include "mesh/face_assignment.h"

#include <span>
#include <vector>

namespace partwheel {

struct Plane {
    Point normal{};     // of length 1
    double offset = 0;  // of the plane's points along the normal

    double height(const Point& p) const { return dot(normal, p) - offset; }
    Point mirrored(const Point& p) const { return p - 2 * height(p) * normal; }
};

// What lies within this of its mirror image, relative to the bounding box's diagonal, has one there.
inline constexpr double mirror_tolerance = 1.0 / 100;

// The plane in which most of the surface has its mirror image, and those perpendicular to it and to each other: at
// most three, in each of which `least_mirrored` of the area has. Candidates are the planes through the middle of the
// area, the origin and the middle of the bounding box, normal to the coordinate axes and the principal ones; and each moved to
// where its two sides meet best, which is taken if clearly more of the surface has its mirror image then. How vertices and
// triangles are numbered does not matter.
inline constexpr double least_mirrored = 0.95;
std::vector<Plane> mirror_planes(std::span<const Point> vertices, std::span<const Triangle> triangles,
                                 Progress& progress);

}  // namespace partwheel
