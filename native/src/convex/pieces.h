// Pieces of a coarse solid and their hulls; the operations of the search: divide a piece by a plane, unite two pieces.
#pragma once

#include "base/geometry.h"
#include "base/parallel.h"
#include "hull/hull.h"
#include "convex/slice.h"

namespace partwheel::convex {

using Edge = std::array<int32_t, 2>;

// The vertices and edges of a piece, ascending. They determine the hulls of both sides of any plane.
struct VertexEdgeSet {
    std::vector<int32_t> vertices;
    std::vector<Edge> edges;

    // rank: scratch, -1 for each vertex.
    VertexEdgeSet(std::span<const Tetrahedron> tetrahedra, std::vector<int32_t>& rank);
    VertexEdgeSet(const VertexEdgeSet& a, const VertexEdgeSet& b);
};

struct ConvexPiece {
    std::vector<Tetrahedron> tetrahedra;
    VertexEdgeSet mesh;
    Hull hull;
    Box bounds;     // of the hull
    double volume;  // of the tetrahedra

    double cost() const { return hull.volume(); }
};

// A plane through a piece, and the sum of the volumes of the two hulls.
struct Division {
    Plane plane;
    double cost = HUGE_VAL;  // none found
};

// Parallel planes, from below. normal: of length 1.
struct PlaneStack {
    Point normal;
    std::vector<double> offsets;
};

// The sums of the hulls' volumes on both sides of planes. One per thread: it keeps scratch memory.
class PlaneSweep {
public:
    void copy_points(const HullKernel& from) { kernel_.copy_points(from); }
    void forget_points(size_t count) { kernel_.forget(std::min(count, kernel_.point_count())); }
    // One sum for each plane.
    std::vector<double> costs(const VertexEdgeSet& mesh, const PlaneStack& planes);

private:
    struct Height {
        double value;
        size_t band;  // between planes, from below
    };

    HullKernel kernel_{std::span<const Point>{}};
    std::vector<Height> heights_;                // of the vertices along the normal
    std::vector<std::vector<int32_t>> bands_;    // the vertices between consecutive planes
    std::vector<std::vector<Point>> crossings_;  // where edges cross each plane
};

// Operations on pieces. All share one array of points, to which planes add more, in working coordinates. The results
// don't depend on the number of threads.
class PieceFactory {
public:
    // walls: further planes to try, in the order of ConcaveEdges.
    PieceFactory(std::span<const Point> points, ThreadPool& threads, std::span<const Plane> walls = {})
        : kernel_(points), threads_(threads), sweeps_(threads.count()), walls_(walls.begin(), walls.end()) {}

    ConvexPiece build_piece(std::vector<Tetrahedron> tetrahedra);
    ConvexPiece unite(const ConvexPiece& a, const ConvexPiece& b);
    double union_cost(const ConvexPiece& a, const ConvexPiece& b);
    // Whether the bounding boxes of the hulls meet.
    bool may_touch(const ConvexPiece& a, const ConvexPiece& b) const;

    // The best plane perpendicular to one of several directions, at a few offsets each, then at finer ones around the
    // best. One piece: its principal directions and the 13 lattice directions; or a wall, if that is no worse. Two
    // pieces: their common principal directions and that from one center to the other.
    Division find_best_division(const ConvexPiece& piece);
    Division find_best_division(const ConvexPiece& a, const ConvexPiece& b);
    // The walls, in the first max_wall_directions directions, that divide the piece. walls: parallel ones are adjacent.
    std::vector<Division> evaluate_walls(const VertexEdgeSet& mesh, std::span<const Plane> walls);
    // The first of the best two planes through p, in the directions of find_best_division(), with the cost of all pieces
    // that both make. If they gain nothing, the plane that halves the piece's longest side.
    Division find_best_pair(const ConvexPiece& piece, const Point& p, const std::function<void()>& tick);
    // The best plane near a division of both pieces together: shifted, and tilted about the center of the cut, in
    // decreasing steps.
    Division refine_division(const ConvexPiece& a, const ConvexPiece& b, Division best);
    // Below and above the plane.
    std::array<ConvexPiece, 2> divide(std::vector<Tetrahedron> tetrahedra, const Plane& plane);

    const HullKernel& kernel() const { return kernel_; }
    size_t sweep_count() const { return n_sweeps_; }  // along any direction, of all pieces: nearly all work is in these

private:
    std::vector<Point> find_directions(const VertexEdgeSet& mesh) const;
    std::vector<Point> find_principal_directions(const VertexEdgeSet& mesh) const;
    std::array<double, 2> extent(const VertexEdgeSet& mesh, const Point& direction) const;
    std::optional<Point> cut_center(const VertexEdgeSet& mesh, const Plane& plane) const;
    Division find_best_across(const VertexEdgeSet& mesh, const std::vector<Point>& directions);
    std::vector<Division> evaluate_planes(const VertexEdgeSet& mesh, std::span<const PlaneStack> stacks);
    std::vector<std::vector<double>> costs_of_planes(const VertexEdgeSet& mesh, std::span<const PlaneStack> stacks);
    void forget_points(size_t count);

    HullKernel kernel_;
    ThreadPool& threads_;
    std::vector<PlaneSweep> sweeps_;  // one per thread
    std::vector<Plane> walls_;
    std::vector<int32_t> rank_;  // scratch
    size_t n_sweeps_ = 0;
};

}  // namespace partwheel::convex
