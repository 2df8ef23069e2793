// Defects that keep polygons from being a closed, manifold, oriented surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace partwheel {

struct PolygonFaults {
    size_t non_manifold_edges = 0;     // with a number of polygons other than two
    size_t inconsistent_edges = 0;     // with two polygons that traverse it in the same direction
    size_t non_manifold_vertices = 0;  // with no or several fans of polygons; counted only if both others are 0
};

// corners: the vertices of the polygons, one after the other; begin: the first corner of each polygon. O(corners).
// Throws Error(PW_ERROR_INDEX).
PolygonFaults polygon_faults(std::span<const int32_t> corners, std::span<const int32_t> begin, size_t vertex_count);

}  // namespace partwheel
