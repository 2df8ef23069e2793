// As-rigid-as-possible deformation of a triangle surface by handles, and distances along a surface.
#pragma once

#include "base/geometry.h"
#include "base/adjacency.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "partwheel_edit.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace partwheel {

// Three numbers, two of which are worked with at once.
struct Wide {
    using Pair = double __attribute__((vector_size(16)));
    Pair xy;
    double z;
};
using Matrix = std::array<Wide, 3>;        // by columns
using Quaternion = std::array<double, 4>;  // w, x, y, z

// The surface as it was at rest, and where it is now. After Sorkine, Alexa, "As-Rigid-As-Possible Surface Modeling"
// (2007), with the energy "spokes and rims" (Chao, Pinkall, Sanan, Schroeder, "A Simple Geometric Model for Elastic
// Deformations", 2010), whose matrix is positive definite also where triangles are obtuse:
//
//   E = sum over vertices i, triangles t at i, edges e of t:  cot(t, e) |e' - R_i e|^2
//
// where cot(t, e) is the cotangent of t's angle opposite e, e' the edge now, e at rest, and R_i the rotation that fits
// best around i. An iteration finds every R_i (the local step), then the positions for these R_i (the global step: a
// linear system that was factorized once). Neither raises E.
class Deformation {
public:
    // role: PW_VERTEX_FREE, PW_VERTEX_FIXED or the number of a handle, of each vertex. Vertices of a component without any
    // fixed vertex or handle, and those of no triangle, stay. threads: at most so many; 0: as many as help; the results
    // are the same. Throws an Error.
    Deformation(std::span<const Point> vertices, std::span<const Triangle> triangles, std::span<const int32_t> roles,
                size_t threads = 0, Progress& progress = unwatched());

    size_t vertex_count() const { return now_.size(); }
    size_t handle_count() const { return handles_.size(); }

    // Takes a handle's vertices to matrix * (their place at rest); the others some of the way, as a first guess. Throws
    // an Error if that is no place.
    void move(size_t handle, const Affine& matrix);
    void iterate(size_t iterations);
    double energy();
    void reset();

    // Of all vertices, in the order given; of those that have not moved, the very numbers given.
    void positions(std::span<Point> out) const;

private:
    struct Handle {
        std::vector<int32_t> vertices;
        std::vector<double> weight;  // of each free vertex, in the order of elimination: how much it follows
        Affine matrix;               // about the origin
    };
    // A triangle's part of the equations: sum over its edges of cot * e e'^T is
    // (p0 - p2) d0^T + (p1 - p2) d1^T, with p the positions now and d made of cotangents and edges at rest.
    struct Element {
        Wide d0, d1;
        Triangle corners;
    };

    void build_elements(std::span<const Triangle> triangles);
    void factorize(std::span<const Triangle> triangles, Progress& progress);
    void find_weights();
    void fit_rotations();
    void place();
    void solve(std::vector<Point>& x) const;

    Point origin_{};
    // Below, vertices and triangles stand in an order of our own, in which neighbours are near each other in memory.
    std::vector<int32_t> place_in_given_;    // of each vertex
    std::vector<Point> given_;               // at rest, as the caller has them
    std::vector<Point> rest_, now_;          // about the origin
    std::vector<int32_t> role_;              // as given; those that stay for want of a connection are fixed
    std::vector<int32_t> unknown_;           // number of each free vertex in the order of elimination, else -1
    std::vector<int32_t> vertex_of_;         // the reverse
    std::vector<Handle> handles_;
    std::vector<std::array<double, 3>> cot_;  // of each triangle: opposite corner 0, 1, 2
    std::vector<Element> elements_;
    struct Corner {
        int32_t element, corner;
    };
    CsrArray<Corner> around_;  // each vertex
    // L D L^T of the free vertices' part of the cotangent Laplacian: L by columns, without its unit diagonal.
    std::vector<int32_t> column_, row_;
    std::vector<double> value_, one_by_d_;
    // The Laplacian between free vertices (columns: unknowns) and those that are not.
    struct Coupling {
        int32_t unknown, vertex;
        double weight;
    };
    std::vector<Coupling> couplings_;
    std::vector<Quaternion> quaternion_;  // of each vertex, as last fitted: where the next fit starts
    std::vector<Matrix> rotation_;
    std::vector<Point> right_;
    Threads threads_;
};

// As pw_vertex_normals.
void vertex_normals(std::span<const Point> vertices, std::span<const Triangle> triangles, std::span<Point> normals);

// The length of a short way along the surface from the nearest vertex with start != 0 to each vertex; infinity where
// none leads. Ways go along edges, and straight over an edge to the corner opposite it where the two triangles, laid
// flat, allow that.
std::vector<double> surface_distances(std::span<const Point> vertices, std::span<const Triangle> triangles,
                                      std::span<const uint8_t> start, Progress& progress = unwatched());

}  // namespace partwheel
