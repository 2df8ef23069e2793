// Polygons -> what keeps them from being a closed, manifold, oriented surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace partwheel {

struct PolygonFaults {
    size_t open = 0;      // edges that have not just two polygons
    size_t against = 0;   // edges whose two polygons run along them the same way
    size_t touching = 0;  // vertices without a polygon, or with several fans of them; if there are none of the others
};

// corners: vertices, polygon after polygon; begin: of each polygon, its first corner. Throws Error(PW_ERROR_INDEX).
PolygonFaults polygon_faults(std::span<const int32_t> corners, std::span<const int32_t> begin, size_t vertex_count);

}  // namespace partwheel
