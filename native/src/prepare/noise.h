// Noisy surfaces, such as scans: how much noise there is, and its removal.
//
// The measure of noise at a vertex is the component along the normal of the umbrella operator applied twice: how far
// the vertex is from where a smooth surface would have it. Independent noise makes it normally distributed, so all
// quantiles give the same standard deviation. Corners, creases and coarse tessellations affect some vertices a lot and
// the others not at all, so quantiles disagree, and that is not noise.
#pragma once

#include "base/geometry.h"

namespace partwheel {

// The standard deviation of the noise along the normals, relative to the length of edges; 0 if it is less than 0.08 or
// not noise.
double estimate_noise(std::span<const Point> vertices, std::span<const Triangle> triangles);

// The vertices without independent noise. Each pass moves every vertex halfway to the mean of its neighbors. After n
// passes the remaining noise is proportional to n^-1/2 and its slope to 1/n. What the passes take off the smooth shape
// is restored.
std::vector<Point> remove_noise(const std::vector<Point>& vertices, std::span<const Triangle> triangles, double passes);

}  // namespace partwheel
