// Which tetrahedron each source face belongs to, and which face each outer facet.
#pragma once

#include "fill/tetrahedra.h"

namespace partwheel {

// For each face, the tetrahedron behind most of its area, and its area. Duplicates go with their original and have area
// 0.
void assign_faces(const Surface& surface, const TetMesh& mesh, std::span<const int32_t> leaf_of_tet,
                  std::vector<int32_t>& leaf, std::vector<double>& face_area);

// The source face that each outer facet of the tetrahedra is of, or nearest to; -1: none. Sorted by leaf, then corner.
std::vector<int32_t> faces_of_outer_facets(const Surface& surface, const TetMesh& mesh,
                                           std::span<const int32_t> leaf_of_tet);

}  // namespace partwheel
