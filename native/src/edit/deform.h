// As-rigid-as-possible deformation of a triangle surface by handles.
#pragma once

#include "base/geometry.h"
#include "base/adjacency.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "edit/sparse_factor.h"
#include "partwheel_edit.h"

namespace partwheel {

using Matrix = std::array<Point, 3>;       // by columns
using Quaternion = std::array<double, 4>;  // w, x, y, z

// See pw_deformation for the energy E, whose matrix is positive definite also where triangles are obtuse. An iteration
// computes all rotations R_i (local step), then the positions for these R_i (global step: a linear system that is
// factorized once). Neither increases E.
class Deformation {
public:
    // roles: PW_VERTEX_FREE, PW_VERTEX_FIXED or a handle id, of each vertex. Components without fixed vertices or
    // handles and vertices without triangles don't move. threads: maximum; 0: automatic; the results don't depend on
    // it. Throws an Error.
    Deformation(std::span<const Point> vertices, std::span<const Triangle> triangles, std::span<const int32_t> roles,
                size_t threads = 0, Progress& progress = unobserved_progress());

    size_t vertex_count() const { return positions_.size(); }
    size_t handle_count() const { return handles_.size(); }

    // Moves a handle's vertices to matrix * (their rest positions), and free ones by their weight, as an initial
    // guess. Throws an Error for entries that are not finite or too large.
    void move(size_t handle, const Affine& matrix);
    void iterate(size_t iterations);
    double energy();
    void reset();

    // The positions of all vertices, in the caller's order; bit-identical to the input where nothing has moved.
    void positions(std::span<Point> out) const;

private:
    struct Handle {
        std::vector<int32_t> vertices;
        std::vector<double> weight;  // of each unknown: how much it follows the handle, 0..1
        Affine matrix;               // relative to origin_
    };
    // A triangle's contribution: the sum over its edges of cot * e e'^T is (p0 - p2) d0^T + (p1 - p2) d1^T, with
    // deformed positions p and constants d from the rest shape.
    struct Element {
        Point d0, d1;
        Triangle corners;
    };

    void fix_unconnected_vertices(std::span<const Triangle> triangles);
    void set_handles();
    void build_elements(std::span<const Triangle> triangles);
    void factorize(std::span<const Triangle> triangles, Progress& progress);
    void compute_weights(Progress& progress);
    void fit_rotations();
    void solve_positions();

    Point origin_{};
    // Below, vertices and triangles are sorted along a space-filling curve, for memory locality.
    std::vector<int32_t> source_vertex_;   // the caller's index of each vertex
    std::vector<Point> source_positions_;  // at rest, the caller's coordinates
    std::vector<Point> rest_, positions_;  // relative to origin_
    std::vector<int32_t> role_;            // vertices that can't move are fixed
    std::vector<int32_t> unknown_;         // of each free vertex, in elimination order; else -1
    std::vector<int32_t> free_vertex_;     // inverse of unknown_
    std::vector<Handle> handles_;
    std::vector<std::array<double, 3>> cot_;  // of each triangle, opposite corner 0, 1, 2
    std::vector<Element> elements_;
    struct Corner {
        int32_t element, corner;
    };
    CsrArray<Corner> corners_at_;  // by vertex
    SparseFactor factor_;          // of the cotangent Laplacian of the free vertices
    // Laplacian entries between free and other vertices.
    struct Coupling {
        int32_t unknown, vertex;
        double weight;
    };
    std::vector<Coupling> couplings_;
    std::vector<Quaternion> quaternion_;  // of each vertex: initial guess of the next local step
    std::vector<Matrix> rotation_;
    std::vector<Point> right_hand_side_;
    ThreadPool threads_;
};

}  // namespace partwheel
