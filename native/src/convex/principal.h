// Principal component analysis.
#pragma once

#include "base/geometry.h"

#include <array>
#include <span>

namespace partwheel::convex {

// Orthonormal eigenvectors of the covariance matrix.
std::array<Point, 3> principal_directions(std::span<const Point> points);

}  // namespace partwheel::convex
