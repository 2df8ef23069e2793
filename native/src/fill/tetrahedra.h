// Tetrahedra inside a closed surface, by TetGen: no vertex moves, and none is added on the surface.
#pragma once

#include "mesh/surface.h"

#include <algorithm>
#include <functional>

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

// The facets without a neighbor, by tetrahedron and then corner.
std::vector<Triangle> boundary_facets(const TetMesh& mesh);

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

// quality: 0, or the largest ratio of circumradius to shortest edge (see pw_build_options).
TetMesh tetrahedralize(const Surface& surface, double quality, Progress& progress);

// The same for triangles that meet only in common corners and edges, but need not be a manifold. keep() gets all of
// TetGen's tetrahedra, even those in cavities, and removes the ones that are not wanted. If it throws
// PW_ERROR_TETRAHEDRA, TetGen runs again with its input in another order.
TetMesh tetrahedralize(const Surface& surface, double quality, Progress& progress,
                       const std::function<void(TetMesh&)>& keep);

// A facet of a tetrahedron that is a triangle of the surface.
struct Wall {
    int32_t triangle = -1;
    bool behind = false;  // whether the tetrahedron is on the inner side
};

// The walls opposite the corners of each tetrahedron.
std::vector<std::array<Wall, 4>> find_walls(const Surface& surface, const TetMesh& mesh, Progress& progress);

// Throws: a triangle of the surface is not a facet of any tetrahedron.
[[noreturn]] void throw_lost();

}  // namespace partwheel
