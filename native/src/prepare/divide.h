// An assembly divided into shells that are meshes of their own. Copies and inner walls go with the faces that they
// repeat.
#pragma once

#include "base/progress.h"
#include "mesh/shells.h"

namespace partwheel {

// Some triangles of a mesh, and the numbers that its vertices and faces have there.
struct SubMesh {
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;
    std::vector<int32_t> faces, vertex_numbers, face_numbers;
    double area = 0;
    size_t welded = 0;  // vertices that were merged with others

    MeshView view() const { return {vertices, triangles, faces, face_numbers.size()}; }
    int32_t source_face(size_t t) const { return face_numbers[idx(faces[t])]; }
    // The triangle with the vertex numbers of the whole mesh.
    Triangle source_triangle(size_t t) const {
        const Triangle& c = triangles[t];
        return {vertex_numbers[idx(c[0])], vertex_numbers[idx(c[1])], vertex_numbers[idx(c[2])]};
    }
    void append(const SubMesh& other);
};

struct Assembly {
    std::vector<SubMesh> shells;        // without faces that go with others
    std::vector<int32_t> original;      // of each face of the mesh, the one that it goes with, or itself
    std::vector<int32_t> duplicates;    // faces of shells that are copies of another one, or of faces of it
    std::vector<int32_t> inner_faces;   // faces of inner walls
};

// For each triangle, the outer triangle that it lies behind, or -1; empty if there is no double wall. Examines each
// outermost shell together with all shells inside it. enclosing: of each shell, the one around it, or -1.
std::vector<int32_t> find_inner_walls(const MeshView& mesh, const Shells& shells, std::span<const int32_t> enclosing,
                                      Progress& progress);

// inner_walls: those of find_inner_walls(). Vertices and faces keep their order.
Assembly divide_into_shells(const MeshView& mesh, const Shells& shells, std::span<const int32_t> inner_walls);

}  // namespace partwheel
