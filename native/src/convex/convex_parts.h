// Convex decomposition: few convex hulls that cover the solid with little excess volume.
#pragma once

#include "base/progress.h"
#include "tree/hierarchy.h"

namespace partwheel {

// Exactly one of hulls and error is above 0. See pw_convex_options.
struct ConvexOptions {
    size_t hulls = 0;         // number of hulls
    double error = 0;         // largest distance of a hull's surface from the solid, with as few hulls as possible
    size_t max_vertices = 0;  // per hull, at least 8; 0: unlimited
    double keep_open = 0;     // radius of a ball that shall pass where it passes the solid; 0: any
    std::span<const std::array<int32_t, 2>> slices{};  // of the tetrahedra: disjoint, [first, last); none: all
    size_t threads = 0;  // at most; 0: as many as help
};

struct ConvexPart {
    TriangleMesh hull;
    double volume = 0;  // of the part of the solid that it covers
    double error = 0;   // upper bound of its surface's distance from the solid; -1 if error and keep_open are 0
};

// Largest first.
std::vector<ConvexPart> convex_parts(const Hierarchy& hierarchy, const ConvexOptions& options, Progress& progress);

}  // namespace partwheel
