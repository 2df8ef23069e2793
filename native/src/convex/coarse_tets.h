// A coarse copy of the solid by vertex clustering: the search takes about the same time for all models.
#pragma once

#include "base/geometry.h"
#include "base/progress.h"

namespace partwheel::convex {

// The representative of each point: one per occupied cell of a grid, about target_count in total.
std::vector<int32_t> cluster_vertices(std::span<const Point> points, size_t target_count,
                                      Progress& progress = unobserved_progress());

// The distinct tetrahedra between representatives. Collapsed ones (triangles, edges, vertices) that are not part of a
// larger simplex remain, with a repeated corner, so thin parts of the solid are not lost.
std::vector<Tetrahedron> coarsen(std::span<const Tetrahedron> tetrahedra, std::span<const int32_t> representative);

}  // namespace partwheel::convex
