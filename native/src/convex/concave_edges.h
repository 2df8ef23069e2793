// The concave edges of a solid, and the planes of its flat walls: candidates for exact cuts.
#pragma once

#include "convex/slice.h"

#include <span>
#include <vector>

namespace partwheel::convex {

// An edge of the surface where the solid's angle is above 180 degrees. Any plane between the two facets' makes it
// convex on both sides.
struct ConcaveEdge {
    Point from{}, to{};
    double angle = 0;  // above 180 degrees, in radians

    double weight() const { return angle * length(to - from); }
};

struct ConcaveEdges {
    std::vector<ConcaveEdge> edges;
    // Planes of the facets at concave edges, and those that halve their angles, if a few contain most of these edges;
    // parallel ones follow each other, by their offsets. Curved surfaces have none.
    std::vector<CutPlane> walls;

    ConcaveEdges(std::span<const Point> points, std::span<const Tetrahedron> solid);
};

// Whether the edge lies in the plane.
bool is_in_plane(const ConcaveEdge& edge, const CutPlane& plane);

// The parts of edges below and above the plane. Edges in the plane are in neither.
void divide_edges(std::span<const ConcaveEdge> edges, const CutPlane& plane, std::vector<ConcaveEdge>& below,
                  std::vector<ConcaveEdge>& above);

}  // namespace partwheel::convex
