// Normals of vertices, and distances along a surface.
#pragma once

#include "base/geometry.h"
#include "base/progress.h"

namespace partwheel {

// Throws an Error if there are no triangles, or if check_arrays() does.
void require_triangles(std::span<const Point> vertices, std::span<const Triangle> triangles);

// See pw_vertex_normals.
void vertex_normals(std::span<const Point> vertices, std::span<const Triangle> triangles, std::span<Point> normals);

// Approximate geodesic distance from the nearest vertex with start != 0 to each vertex; infinity if unreachable.
// Dijkstra's algorithm along edges, and straight across an edge between its two opposite corners where the unfolded
// triangles allow it.
std::vector<double> surface_distances(std::span<const Point> vertices, std::span<const Triangle> triangles,
                                      std::span<const uint8_t> start, Progress& progress = unobserved_progress());

}  // namespace partwheel
