// Triangle meshes that are cut open along edges, into patches that are topological disks.
#pragma once

#include "base/adjacency.h"
#include "mesh/surface.h"

namespace partwheel {

// A triangle mesh and its interior edges, those with two triangles. Sides and corners: see next_corner().
struct SeamMesh {
    struct Face {
        std::array<Point, 3> corners;
        int32_t polygon;
        double area;
        std::array<double, 3> angle;  // at each corner
    };
    struct Edge {
        int32_t number;                                 // in the whole mesh
        std::array<std::array<int32_t, 2>, 2> corners;  // [e][t] is at end e of the edge, in its triangle t
        bool is_diagonal;                               // within a polygon; can't be cut
        double cost;                                    // of a cut
        double weight;                                  // half the sum of the cotangents of the opposite angles

        int32_t triangle(size_t t) const { return corners[0][t] / 3; }
        int32_t side(size_t t) const { return next_corner(corners[0][t]) == corners[1][t] ? corners[0][t] : corners[1][t]; }
    };

    std::vector<Face> faces;
    std::vector<Edge> edges;
    std::vector<int32_t> side_edge;           // of each side its edge, or -1
    std::vector<int32_t> non_manifold_sides;  // at edges with more than two triangles; only of a whole mesh

    explicit SeamMesh(const MeshView& mesh);
    // A mesh of some triangles of another one, ascending, numbered in this order.
    SeamMesh(const SeamMesh& whole, std::span<const int32_t> selected);

    // For each edge: whether it separates two labels of triangles.
    std::vector<uint8_t> borders(std::span<const int32_t> labels) const;

    // The connected components of the mesh after cuts along edges: the triangles of each, ascending.
    std::vector<std::vector<int32_t>> components(std::span<const uint8_t> is_cut) const;

    double area() const;

private:
    void index_sides();
};

// A path to each vertex of a patch: its cost, its last edge (an index into Patch::uncut), and the vertex before that.
// -1 at the start and where there is no path; the distance there is infinite.
struct ShortestPaths {
    std::vector<double> distance;
    std::vector<int32_t> via, previous;

    int32_t farthest_vertex() const;
};

// A connected mesh, cut open along edges, but still connected. A vertex of the mesh is several vertices of the patch
// where it is cut open.
struct Patch {
    const SeamMesh& mesh;
    std::vector<int32_t> vertex;  // of each corner
    size_t vertex_count = 0;
    std::vector<int32_t> uncut;                      // indices into mesh.edges
    std::vector<std::array<int32_t, 2>> uncut_ends;  // their vertices
    std::vector<int32_t> boundary_sides;
    std::vector<uint8_t> is_boundary;  // of each vertex

    Patch(const SeamMesh& mesh, std::span<const uint8_t> is_cut);

    // Vertices - edges + triangles: 1 for a disk.
    ptrdiff_t euler_characteristic() const;

    // Around a disk: each vertex, and the length of the side to the next one.
    struct BoundaryStep {
        int32_t vertex;
        double length;
    };
    std::vector<BoundaryStep> boundary_loop() const;
    std::vector<int32_t> boundary_vertices() const;

    // The shortest paths from any start vertex, along edges that may be cut. Of equally short ones, the one whose last
    // edge has the lowest number.
    ShortestPaths shortest_paths(std::span<const int32_t> start) const;

    // Cuts along the path to a vertex.
    void cut_path(const ShortestPaths& paths, int32_t to, std::span<uint8_t> is_cut) const;
};

// Cuts a connected mesh so that it becomes a disk, with shortest paths: a tube from end to end, a sphere between two of
// its farthest points, a surface with handles or more holes by a tree-cotree decomposition (Erickson, Har-Peled 2004).
// is_cut: of each edge, cuts that exist already. Returns all cuts.
std::vector<uint8_t> cut_to_disk(const SeamMesh& mesh, std::vector<uint8_t> is_cut);

}  // namespace partwheel
