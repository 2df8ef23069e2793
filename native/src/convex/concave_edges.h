// The concave edges of a solid, and the planes of its flat walls: candidates for exact cuts.
#pragma once

#include "base/progress.h"
#include "convex/slice.h"

namespace partwheel::convex {

// An edge of the surface where the solid's angle is above 180 degrees.
struct ConcaveEdge {
    Point from{}, to{};
    double angle = 0;                // above 180 degrees, in radians
    std::array<Point, 2> normals{};  // of the two facets

    double weight() const { return angle * length(to - from); }
    // Whether the plane contains the edge and lies between the two facets' planes, so that both sides are convex there.
    bool is_resolved_by(const Plane& plane) const;
};

struct ConcaveEdges {
    std::vector<ConcaveEdge> edges;
    // Planes that resolve most of the edges, if a few can: those of facets, those that halve the angle of an edge and,
    // of few edges, those through two. The heaviest direction first; parallel ones by their offsets. Curved surfaces
    // have none.
    std::vector<Plane> walls;

    ConcaveEdges() = default;
    ConcaveEdges(std::span<const Point> points, std::span<const Tetrahedron> solid,
                 Progress& progress = unobserved_progress());
};

// The sum of the weights of the edges that the plane resolves.
double resolved_weight(std::span<const ConcaveEdge> edges, const Plane& plane);

// The parts of edges below and above the plane, without those that it resolves.
void divide_edges(std::span<const ConcaveEdge> edges, const Plane& plane, std::vector<ConcaveEdge>& below,
                  std::vector<ConcaveEdge>& above);

}  // namespace partwheel::convex
