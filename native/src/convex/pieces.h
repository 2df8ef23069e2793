// Pieces of a coarse solid with their hulls, which planes divide and which are joined again: what the search is made of.
#pragma once

#include "base/geometry.h"
#include "hull/hull.h"
#include "convex/slice.h"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace partwheel::convex {

using Edge = std::array<int32_t, 2>;

// What hulls of a piece's parts are made of, in rising order.
struct Outline {
    std::vector<int32_t> vertices;
    std::vector<Edge> edges;

    explicit Outline(std::span<const Tetrahedron> tetrahedra);
    Outline(const Outline& a, const Outline& b);
};

struct Piece {
    std::vector<Tetrahedron> tetrahedra;
    Outline outline;
    Hull hull;
    double solid;  // volume of the tetrahedra

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
    explicit Pieces(std::span<const Point> points) : kernel_(points) {}

    Piece piece(std::vector<Tetrahedron> tetrahedra);
    Piece joined(const Piece& a, const Piece& b);
    double joined_cost(const Piece& a, const Piece& b);
    // Whether boxes about the hulls meet. Those that don't are apart.
    bool touch(const Piece& a, const Piece& b) const;

    // The best of planes across some directions, in few places each and then finer about the best: across the principal
    // directions of the piece and the 13 of the lattice; and of two pieces, across theirs and from the one to the other.
    Division best_division(const Piece& piece);
    Division best_division(const Piece& a, const Piece& b);
    // The best of planes near a division of two pieces together: shifted, and tilted about the middle of the cut, by less and
    // less.
    Division refined(const Piece& a, const Piece& b, Division best);
    // The two sides of some pieces.
    std::array<Piece, 2> divided(std::vector<Tetrahedron> tetrahedra, const CutPlane& plane);

    const HullKernel& kernel() const { return kernel_; }

private:
    std::vector<Point> principal(const Outline& outline) const;
    std::array<double, 2> span(const Outline& outline, const Point& direction) const;
    std::optional<Point> middle_of_cut(const Outline& outline, const CutPlane& plane) const;
    Division best_across(const Outline& outline, std::vector<Point> directions);
    void try_planes(const Outline& outline, const Point& direction, std::span<const double> offsets, Division& best);

    HullKernel kernel_;
    std::vector<double> heights_;  // scratch: of vertices, along a direction
};

}  // namespace partwheel::convex
