// The closed surface filled with tetrahedra by TetGen; no vertex moved, none added on the surface.
#pragma once

#include "mesh/surface.h"

#include <algorithm>
#include <functional>

namespace partwheel {

struct TetMesh {
    std::vector<Point> vertices;  // the surface's, in its order, then points that TetGen added inside
    std::vector<Tetrahedron> tetrahedra;  // sorted by their corners, of which the lowest comes first
    std::vector<std::array<int32_t, 4>> neighbors;  // across the facet opposite each corner; -1: none
    std::vector<int32_t> tet_of_triangle;            // behind each triangle of the surface
    size_t cavities = 0;
};

// Of a tetrahedron, not below 0: a sliver's may be rounded to less.
inline double volume(const TetMesh& mesh, size_t tetrahedron) {
    const auto corner = [&](size_t k) -> const Point& { return mesh.vertices[idx(mesh.tetrahedra[tetrahedron][k])]; };
    return std::max(0.0, signed_volume6(corner(0), corner(1), corner(2), corner(3)) / 6);
}

// The facets with nothing on their other side, by tetrahedron and then corner.
std::vector<Triangle> boundary_facets(const TetMesh& mesh);

struct Solid {
    Surface surface;
    TetMesh mesh;
    bool surface_from_tetrahedra = false;  // it may touch itself, and TetGen can't be asked for another filling
};

// A corner of a tetrahedron: its vertex, and the tetrahedron beyond the facet opposite; -1: none.
struct Corner {
    int32_t vertex, beyond;
};

// Tetrahedra in canonical order, each positively oriented. number, if given, receives the place of each.
TetMesh canonical(std::vector<Point> vertices, std::vector<std::array<Corner, 4>> corners, Progress& progress,
                  std::vector<int32_t>* number = nullptr);

// quality: 0, or the largest ratio of circumradius to shortest edge (see pw_build_options).
TetMesh tetrahedralize(const Surface& surface, double quality, Progress& progress);

// The same of triangles that meet in common corners and edges alone, but needn't be a manifold. keep() gets all of
// TetGen's tetrahedra, those of cavities included, and takes away what is not wanted. Where it throws
// PW_ERROR_TETRAHEDRA, TetGen is asked again, in another order.
TetMesh tetrahedralize(const Surface& surface, double quality, Progress& progress,
                       const std::function<void(TetMesh&)>& keep);

// A facet of a tetrahedron that is a triangle of the surface.
struct Wall {
    int32_t triangle = -1;
    bool behind = false;  // the tetrahedron is on the inner side
};

// Those opposite the corners of each tetrahedron.
std::vector<std::array<Wall, 4>> find_walls(const Surface& surface, const TetMesh& mesh, Progress& progress);

// That a triangle of the surface is none of a tetrahedron.
[[noreturn]] void throw_lost();

}  // namespace partwheel
