// Solids of parts: the closed, manifold surface around a set of tetrahedra, made of source triangles and caps.
#pragma once

#include "edit/manifold_surface.h"

namespace partwheel {

// The tetrahedra of a hierarchy with their adjacency, see pw_hierarchy_solid. Built once for all solids. The arrays of
// tetrahedra and vertices must outlive it.
class SolidBuilder {
public:
    // outer_faces: the source face, or -1, of each boundary facet, by tetrahedron and then opposite corner. leaf: of
    // each source face. exact: of each tetrahedron, whether polygons stay whole there, see owner_. Throws
    // Error(PW_ERROR_DATA) for inconsistent tetrahedra.
    SolidBuilder(std::span<const Tetrahedron> tetrahedra, std::span<const Point> vertices, std::span<const int32_t> outer_faces,
                 std::span<const int32_t> leaf, std::span<const uint8_t> exact, Progress& progress = unobserved_progress());

    // The tetrahedra whose owner is in [first, last); if first > last, outside [last, first).
    std::vector<int32_t> tets_of_slice(size_t first, size_t last) const;
    // The same for several disjoint slices. Each tetrahedron has one owner, so none is there twice.
    std::vector<int32_t> tets_of_slices(std::span<const std::array<int32_t, 2>> slices) const;
    // The same for a part with a moved border, see move_border(). inside: of each source face, not 0 for those to use
    // instead of the part's own.
    std::vector<int32_t> tets_of_faces(size_t first, size_t last, std::span<const uint8_t> inside, Progress& progress) const;

    TriangleMesh build(std::span<const int32_t> tets, Progress& progress = unobserved_progress()) const {
        return build_surface(facets_, tets, progress);
    }

private:
    TetFacets facets_;

    // A polygon belongs to one part, but its triangles may belong to different tetrahedra. A tetrahedron whose only
    // surface is one polygon is owned by that polygon's leaf, all others by themselves. So polygons stay whole where
    // possible, and the solids of any cut contain each tetrahedron once.
    std::vector<int32_t> owner_;
    std::vector<std::pair<int32_t, int32_t>> reassigned_;  // (owner, tetrahedron) where they differ, sorted
};

}  // namespace partwheel
