// Fairing: moves free vertices to where the surface is smoothest.
#pragma once

#include "base/geometry.h"
#include "base/progress.h"

namespace partwheel {

// Returns the positions of all vertices, see pw_fair_vertices. Throws Error(PW_ERROR_INDEX, PW_ERROR_NOT_FINITE).
std::vector<Point> fair_vertices(std::span<const Point> vertices, std::span<const std::array<int32_t, 2>> edges,
                                 std::span<const uint8_t> free, Progress& progress);

}  // namespace partwheel
