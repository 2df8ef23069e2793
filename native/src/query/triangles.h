// Triangle-triangle intersection: the decision is exact, the point rounded.
#pragma once

#include "base/geometry.h"

#include <optional>

namespace partwheel::index {

using Corners = std::array<Point, 3>;

// A common point, or none. Degenerate triangles intersect only what crosses them.
std::optional<Point> common_point(const Corners& a, const Corners& b);

}  // namespace partwheel::index
