// Distances from a solid, and the one-sided Hausdorff distance of a hull's surface.
#pragma once

#include "base/progress.h"
#include "mesh/nearest.h"

namespace partwheel::convex {

// Facets of one tetrahedron only, in the order of their sorted vertices.
struct BoundaryFacet {
    Triangle corners;
    int32_t tetrahedron;
};
std::vector<BoundaryFacet> boundary_facets(std::span<const Tetrahedron> tetrahedra);

// Distances from a solid of tetrahedra. Refers to the points, which must outlive it, as must progress.
class SolidDistance {
public:
    SolidDistance(std::span<const Point> points, std::span<const Tetrahedron> tetrahedra, Progress& progress);

    // The nearest point of the solid, p itself inside; or any that is at most `good_enough` away. near: a point of the
    // solid, where the search starts.
    Point nearest(const Point& p, double good_enough = 0,
                  const std::optional<Point>& near = {}) const;

    // An upper bound d of the one-sided Hausdorff distance h from the surface to the solid: h <= d <= h + slack. If h
    // is below good_enough, any d with h <= d <= good_enough; if it is above, any d with good_enough < d <= h.
    double max_distance(const TriangleMesh& surface, double slack,
                        double good_enough = -std::numeric_limits<double>::infinity()) const {
        return farthest(surface, slack, good_enough).distance;
    }

    struct Farthest {
        double distance = 0;
        Point point{};  // of the surface; its distance is at least distance - slack, if that is above good_enough
    };
    Farthest farthest(const TriangleMesh& surface, double slack,
                      double good_enough = -std::numeric_limits<double>::infinity()) const;

private:
    bool is_inside(const Point& p) const;

    std::span<const Point> points_;
    Progress& progress_;  // for cancellation
    // Tetrahedra and boundary facets along a space-filling curve.
    std::vector<Tetrahedron> tetrahedra_;
    std::vector<Triangle> surface_;
    Bvh tet_tree_, surface_tree_;
};

}  // namespace partwheel::convex
