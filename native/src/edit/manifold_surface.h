// The closed, manifold surface around a set of tetrahedra.
#pragma once

#include "base/progress.h"
#include "base/geometry.h"

namespace partwheel {

// Tetrahedra with what is across the facet opposite each corner.
struct TetFacets {
    std::span<const Tetrahedron> tetrahedra;
    std::span<const Point> vertices;
    std::vector<std::array<int32_t, 4>> neighbors;  // the tetrahedron there; -1: none
    std::vector<std::array<int32_t, 4>> faces;      // the source face there; -1: none
};

[[noreturn]] void throw_inconsistent_tetrahedra();

// The surface around tets. Non-manifold edges and vertices are duplicated. Throws Error(PW_ERROR_EMPTY) if there are
// no tets.
TriangleMesh build_surface(const TetFacets& facets, std::span<const int32_t> tets, Progress& progress);

}  // namespace partwheel
