// Pieces of the solid with their hulls, which planes divide and which are joined again: what the search is made of.
#pragma once

#include "base/geometry.h"
#include "cluster/hull/hull.h"
#include "part/convex/slice.h"

#include <cstddef>
#include <span>
#include <vector>

namespace partwheel::convex {

struct Piece {
    std::vector<Tetrahedron> tetrahedra;
    Hull hull;

    double cost() const { return hull.volume(); }
};

// A plane through a piece, and the volumes of the two hulls together.
struct Division {
    CutPlane plane;
    double cost = HUGE_VAL;  // none has been found
};

// Works on one array of points, to which planes add more. All in working coordinates.
class Pieces {
public:
    // In the order of the cost of a hull, points are few million at most.
    explicit Pieces(std::span<const Point> points) : kernel_(points) {}

    Piece piece(std::vector<Tetrahedron> tetrahedra);
    Piece joined(const Piece& a, const Piece& b);
    double joined_cost(const Piece& a, const Piece& b);
    // Of two hulls. Those that don't touch are apart.
    bool touch(const Piece& a, const Piece& b, double gap) const;

    // The best of planes across some directions: a sweep along each, hulls growing from both ends, then finer about the
    // best. Axes, diagonals and the principal directions if `more` is empty, else the principal ones and those of `more`.
    Division best_division(std::span<const Tetrahedron> tetrahedra, std::span<const Point> more);
    // The two sides; of an empty hull if all is on one side.
    std::array<Piece, 2> divided(std::span<const Tetrahedron> tetrahedra, const CutPlane& plane);

    const HullKernel& kernel() const { return kernel_; }

private:
    void sweep(std::span<const int32_t> vertices, std::span<const std::array<int32_t, 2>> edges, const Point& direction,
               Division& best);
    void try_planes(std::span<const int32_t> vertices, std::span<const std::array<int32_t, 2>> edges,
                    const Point& direction, std::span<const double> offsets, Division& best);

    HullKernel kernel_;
};

}  // namespace partwheel::convex
