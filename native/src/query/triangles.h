// Where two triangles meet: whether they do is exact, the place rounded.
#pragma once

#include "base/geometry.h"

#include <array>
#include <optional>

namespace partwheel::index {

using Corners = std::array<Point, 3>;

// A point of both; none if they have no point in common. Triangles without area meet only what crosses them.
std::optional<Point> common_point(const Corners& a, const Corners& b);

}  // namespace partwheel::index
