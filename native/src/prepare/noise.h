// Rough surfaces: whether one is, as scans and noise are, and what it is like without.
//
// Noise shows where neighbours differ from what a smooth surface would have there: in the part along the normal of the
// twice applied umbrella operator. Independent noise gives a normal distribution, so that all quantiles tell the same
// deviation; corners, creases and coarse tessellations concern some vertices much and others not at all, and are not
// taken for it.
#pragma once

#include "base/geometry.h"

#include <span>
#include <vector>

namespace partwheel {

// The standard deviation of the noise along the normals, relative to the edges' length; 0 unless it is noise, and at
// least some twelfth.
double estimate_noise(std::span<const Point> vertices, std::span<const Triangle> triangles);

// The vertices with independent noise taken off. A pass moves each half of the way to the middle of its neighbours, so
// that what is left of the noise falls with the root of their number, and its slope with the number; what else they take
// off is given back.
std::vector<Point> smoothed(const std::vector<Point>& vertices, std::span<const Triangle> triangles, double passes);

}  // namespace partwheel
