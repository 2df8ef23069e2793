// The principal directions of points.
#pragma once

#include "base/geometry.h"

#include <array>
#include <span>

namespace partwheel::convex {

// Eigenvectors of their covariance: of length 1, across each other.
std::array<Point, 3> principal_directions(std::span<const Point> points);

}  // namespace partwheel::convex
