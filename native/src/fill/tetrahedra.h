// Tetrahedra inside a closed surface, by TetGen: no vertex moves, and none is added on the surface.
#pragma once

#include "mesh/surface.h"

namespace partwheel {

struct TetMesh {
    std::vector<Point> vertices;  // the surface's, in its order, then points that TetGen added inside
    std::vector<Tetrahedron> tetrahedra;  // sorted by their corners, the lowest corner first
    std::vector<std::array<int32_t, 4>> neighbors;  // across the facet opposite each corner; -1: none
    std::vector<int32_t> tet_of_triangle;            // behind each triangle of the surface
    size_t cavities = 0;
};

// The volume of a tetrahedron, at least 0: rounding may make that of a sliver negative.
inline double volume(const TetMesh& mesh, size_t tetrahedron) {
    const auto corner = [&](size_t k) -> const Point& { return mesh.vertices[idx(mesh.tetrahedra[tetrahedron][k])]; };
    return std::max(0.0, signed_volume6(corner(0), corner(1), corner(2), corner(3)) / 6);
}

struct Solid {
    Surface surface;
    TetMesh mesh;
    bool surface_from_tetrahedra = false;  // it may touch itself, so TetGen can't fill it again
};

// A corner of a tetrahedron: its vertex, and the neighbor across the opposite facet; -1: none.
struct Corner {
    int32_t vertex, beyond;
};

// Tetrahedra in canonical order, each positively oriented. number, if not null, receives the new number of each.
TetMesh canonical(std::vector<Point> vertices, std::vector<std::array<Corner, 4>> corners, Progress& progress,
                  std::vector<int32_t>* number = nullptr);

// Tetrahedra and their boundary in any order.
struct Filling {
    std::vector<Point> vertices;
    std::vector<std::array<Corner, 4>> corners;  // of the tetrahedra
    std::vector<Triangle> triangles;             // of the boundary
    std::vector<int32_t> behind;                 // of each triangle the tetrahedron
};

// A filling in canonical order, with these vertices on its surface, of which source_vertex has the number in the
// filling. Triangle t of the filling is face t.
Solid canonical(const Frame& frame, Filling filling, std::span<const int32_t> on_surface, Progress& progress);

// The triangles may meet in common corners and edges. quality: 0, or the largest ratio of circumradius to shortest edge
// (see pw_build_options).
TetMesh tetrahedralize(const Surface& surface, double quality, Progress& progress);

}  // namespace partwheel
