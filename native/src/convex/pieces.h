// Pieces of a coarse solid and their hulls; the operations of the search: divide a piece by a plane, unite two pieces.
#pragma once

#include "base/geometry.h"
#include "hull/hull.h"
#include "convex/slice.h"

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace partwheel::convex {

using Edge = std::array<int32_t, 2>;

// The vertices and edges of a piece, ascending. They determine the hulls of both sides of any plane.
struct VertexEdgeSet {
    std::vector<int32_t> vertices;
    std::vector<Edge> edges;

    explicit VertexEdgeSet(std::span<const Tetrahedron> tetrahedra);
    VertexEdgeSet(const VertexEdgeSet& a, const VertexEdgeSet& b);
};

struct ConvexPiece {
    std::vector<Tetrahedron> tetrahedra;
    VertexEdgeSet mesh;
    Hull hull;
    double volume;  // of the tetrahedra

    double cost() const { return hull.volume(); }
};

// A plane through a piece, and the sum of the volumes of the two hulls.
struct Division {
    CutPlane plane;
    double cost = HUGE_VAL;  // none found
};

// Operations on pieces. All share one array of points, to which planes add more, in working coordinates.
class PieceFactory {
public:
    // walls: further planes to try, in the order of ConcaveEdges.
    explicit PieceFactory(std::span<const Point> points, std::span<const CutPlane> walls = {})
        : kernel_(points), walls_(walls.begin(), walls.end()) {}

    ConvexPiece build_piece(std::vector<Tetrahedron> tetrahedra);
    ConvexPiece unite(const ConvexPiece& a, const ConvexPiece& b);
    double union_cost(const ConvexPiece& a, const ConvexPiece& b);
    // Whether the bounding boxes of the hulls meet.
    bool may_touch(const ConvexPiece& a, const ConvexPiece& b) const;

    // The best plane perpendicular to one of several directions, at a few offsets each, then at finer ones around the
    // best. One piece: its principal directions and the 13 lattice directions; or a wall, if that is no worse. Two pieces:
    // their common principal directions and that from one center to the other.
    Division find_best_division(const ConvexPiece& piece);
    Division find_best_division(const ConvexPiece& a, const ConvexPiece& b);
    // Those of the walls that divide the piece, in the first few directions; parallel ones follow each other.
    std::vector<Division> evaluate_walls(const VertexEdgeSet& mesh, std::span<const CutPlane> walls);
    // The first of the two planes through a point that are best together, and the cost of all sides; of the directions
    // that find_best_division() tries. If they gain nothing, the one that halves the piece's longest side.
    Division find_best_pair(const ConvexPiece& piece, const Point& p, const std::function<void()>& tick);
    // The best plane near a division of both pieces together: shifted, and tilted about the center of the cut, in
    // decreasing steps.
    Division refine_division(const ConvexPiece& a, const ConvexPiece& b, Division best);
    // Below and above the plane.
    std::array<ConvexPiece, 2> divide(std::vector<Tetrahedron> tetrahedra, const CutPlane& plane);

    const HullKernel& kernel() const { return kernel_; }
    size_t sweep_count() const { return n_sweeps_; }  // of all pieces, along a direction: nearly all work is in these

private:
    std::vector<Point> find_directions(const VertexEdgeSet& mesh) const;
    std::vector<Point> find_principal_directions(const VertexEdgeSet& mesh) const;
    std::array<double, 2> extent(const VertexEdgeSet& mesh, const Point& direction) const;
    std::optional<Point> cut_center(const VertexEdgeSet& mesh, const CutPlane& plane) const;
    Division find_best_across(const VertexEdgeSet& mesh, std::vector<Point> directions);
    void evaluate_planes(const VertexEdgeSet& mesh, const Point& direction, std::span<const double> offsets,
                         Division& best);
    std::vector<double> costs_of_planes(const VertexEdgeSet& mesh, const Point& direction,
                                        std::span<const double> offsets);

    HullKernel kernel_;
    std::vector<CutPlane> walls_;
    std::vector<double> heights_;  // scratch: of the vertices along a direction
    size_t n_sweeps_ = 0;
};

}  // namespace partwheel::convex
