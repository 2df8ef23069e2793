// Parametric closed surfaces and tet meshes. Random ones have fixed seeds.
#pragma once

#include "fill/tetrahedra.h"

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace partwheel::test {

// A surface of a caller of the library.
struct TriMesh {
    std::string name;
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;
    std::vector<int32_t> faces;  // source face of each triangle; empty: each triangle is a face
    size_t face_count = 0;

    MeshView view() const;
    const double* vertex_data() const { return vertices.data()->data(); }
    const int32_t* triangle_data() const { return triangles.data()->data(); }
    const int32_t* face_data() const { return faces.empty() ? nullptr : faces.data(); }
    int32_t face_of(size_t triangle) const {
        return faces.empty() ? static_cast<int32_t>(triangle) : faces[triangle];
    }
};

// The volume that a closed surface encloses, by the divergence theorem.
double enclosed_volume(const TriMesh& mesh);
double surface_area(const TriMesh& mesh);

// ---- Surfaces ----

TriMesh tetrahedron();
TriMesh cube();  // 8 vertices, 12 triangles, 6 faces
TriMesh octahedron();

// Unit cubes of the integer grid, which their surface and their tetrahedra are made of. Many coplanar faces, many
// exact ties. Where two cubes touch, a facet must join them: in any other way the surface is not manifold.
using Cell = std::array<int, 3>;
using Cells = std::vector<Cell>;
Cells block(Cell low, Cell high);  // low <= cell < high
Cells operator+(Cells a, const Cells& b);
Cells operator-(const Cells& a, const Cells& b);

// Its outside: two triangles a square, each square a face.
TriMesh surface_of(const std::string& name, const Cells& cells, const Point& spacing = {1, 1, 1});

// A profile turned about the z axis: rings of `segments` vertices with these radii and heights, closed by a fan at
// each end. Quads are faces of two triangles (planar ones, as all are trapezoids).
struct Ring {
    double radius, z;
};
TriMesh lathe(const std::string& name, const std::vector<Ring>& rings, int segments);
TriMesh sphere(int rings, int segments);
TriMesh snowman(int rings, int segments);       // two spheres united
TriMesh stacked_cylinders(int segments);        // a stepped shaft: coplanar annuli
TriMesh torus(int around, int across, double radius, double tube);
TriMesh star_prism(int points, double inner, double outer, double height);
TriMesh hedgehog(int spikes);                   // a sphere with long spikes

// ---- Modified surfaces ----

TriMesh named(TriMesh mesh, const std::string& name);
TriMesh stretched(TriMesh mesh, const Point& factors);
TriMesh moved(TriMesh mesh, const Point& by);
TriMesh rotated(TriMesh mesh, double angle, Point axis);
TriMesh inside_out(TriMesh mesh);
TriMesh together(const std::string& name, const TriMesh& a, const TriMesh& b);
TriMesh perturbed(TriMesh mesh, double amount, unsigned seed);  // each coordinate by up to amount
TriMesh snapped(TriMesh mesh, double step);                     // coordinates to multiples of step
TriMesh without_faces(TriMesh mesh);                            // each triangle a face

// The same surface with its vertices, triangles, corners and faces in random order, and some vertices of no triangle.
struct Shuffled {
    TriMesh mesh;
    std::vector<int32_t> vertex;  // the original of each new vertex, -1 for those of no triangle
    std::vector<int32_t> face;    // the original of each new face
};
Shuffled shuffled(const TriMesh& mesh, unsigned seed);

// ---- Tet meshes, independent of the library's fill layer ----

// Orients the tetrahedra and finds their neighbors. tet_of_triangle stays empty.
TetMesh tet_mesh(std::vector<Point> vertices, std::vector<Tetrahedron> tetrahedra);

// Six tetrahedra a cube (Kuhn's subdivision).
TetMesh tets_of(const Cells& cells, const Point& spacing = {1, 1, 1});

// Figure 4 of the paper, one dimension up: a regular tetrahedron in four, which meet at its barycenter.
TetMesh figure_4();

TetMesh perturbed(TetMesh mesh, double amount, unsigned seed);

}  // namespace partwheel::test
