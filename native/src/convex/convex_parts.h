// Convex parts: few convex hulls that cover the solid and little else.
#pragma once

#include "base/progress.h"
#include "tree/hierarchy.h"

#include <cstddef>
#include <vector>

namespace partwheel {

// hulls or error is given, not both.
struct ConvexOptions {
    size_t hulls = 0;         // so many
    double error = 0;         // few, of which no surface is farther from the solid
    size_t max_vertices = 0;  // of a hull, 8 or more; 0: any number
};

struct ConvexPart {
    TriangleMesh hull;
    double volume = 0;  // of what it is for, of the solid
    double error = 0;   // its surface's largest distance from the solid, at most so much; -1 if none was asked for
};

// The largest first.
std::vector<ConvexPart> convex_parts(const Hierarchy& hierarchy, const ConvexOptions& options, Progress& progress);

}  // namespace partwheel
