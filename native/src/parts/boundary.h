// The boundary of tetrahedra: the facets without a neighbor.
#pragma once

#include "base/corners.h"
#include "fill/tetrahedra.h"

namespace partwheel {

// Calls visit(tetrahedron, corner) for each of these facets. It is opposite the corner.
template <class Visit>
void for_each_boundary_facet(const TetMesh& mesh, const Visit& visit) {
    for (size_t t = 0; t < mesh.tetrahedra.size(); ++t)
        for (size_t k = 0; k < 4; ++k)
            if (mesh.neighbors[t][k] < 0) visit(t, k);
}

// These facets, and the tetrahedron behind each.
struct BoundaryFacets {
    std::vector<Triangle> triangles;
    std::vector<int32_t> tetrahedra;

    explicit BoundaryFacets(const TetMesh& mesh) {
        for_each_boundary_facet(mesh, [&](size_t t, size_t k) {
            triangles.push_back(facet(mesh.tetrahedra[t], k));
            tetrahedra.push_back(static_cast<int32_t>(t));
        });
    }
};

// The area of the facet opposite a corner.
inline double facet_area(const TetMesh& mesh, size_t tetrahedron, size_t opposite) {
    return area(mesh.vertices, facet(mesh.tetrahedra[tetrahedron], opposite));
}

}  // namespace partwheel
