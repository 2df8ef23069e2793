// Convex parts: few convex hulls that cover the solid and little else. From the cut of least concavity, improved by planes.
#pragma once

#include "part/solid.h"
#include "tree/hierarchy.h"

#include <cstddef>
#include <vector>

namespace partwheel {

struct ConvexOptions {
    size_t hulls = 0;         // so many; 0: as few as are found that keep the error
    double error = 0;         // the largest distance of a hull's surface from the solid; 0: any
    size_t max_vertices = 0;  // of a hull; 0: any number
    bool approximate = false; // a hull of fewer vertices may leave out some of its part
};

struct ConvexPart {
    TriangleMesh hull;
    double volume = 0;  // of what it covers, of the solid
    double error = 0;   // its surface's largest distance from the solid, at most so much; -1 if none was asked for
};

// The largest first.
std::vector<ConvexPart> convex_parts(const Hierarchy& hierarchy, const Solids& solids, const ConvexOptions& options);

}  // namespace partwheel
