// Triangle-triangle intersection: the decision is exact, the point rounded.
#pragma once

#include "base/geometry.h"

namespace partwheel {

using Corners = std::array<Point, 3>;

// A common point, or none. The first `shared` corners of both, 0 to 2, are the same, and don't count, nor does the edge
// between two of them. Degenerate triangles intersect only what crosses them.
std::optional<Point> common_point(const Corners& a, const Corners& b, size_t shared = 0);

}  // namespace partwheel
