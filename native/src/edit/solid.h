// Solids of parts: the closed, manifold surface around a set of tetrahedra, made of source triangles and caps.
#pragma once

#include "tree/hierarchy.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace partwheel {

// The tetrahedra of a hierarchy with their adjacency. Built once for all solids.
class SolidBuilder {
public:
    // outer_faces: the source face, or -1, of each boundary facet, by tetrahedron and then opposite corner. leaf: of
    // each source face. exact: of each tetrahedron, whether polygons stay whole there, see owner_. Throws
    // Error(PW_ERROR_DATA) for inconsistent tetrahedra.
    SolidBuilder(std::span<const Tetrahedron> tetrahedra, std::span<const int32_t> outer_faces,
           std::span<const int32_t> leaf, std::span<const uint8_t> exact, Progress& progress = unobserved_progress());

    // The tetrahedra whose owner is in [first, last); if first > last, outside [last, first).
    std::vector<int32_t> tets_of_slice(size_t first, size_t last) const;

    // The same for a part with a moved border. inside: of each source face, not 0 for those of the part. A
    // tetrahedron on the surface follows the majority of its surface area; inner ones near a change follow a minimum
    // cut, which minimizes the caps. Components that would be separated from the rest stay, and so does everything if
    // the old set fits the faces better.
    std::vector<int32_t> tets_of_faces(std::span<const Tetrahedron> tetrahedra, std::span<const Point> vertices,
                                    size_t first, size_t last, std::span<const uint8_t> inside,
                                    Progress& progress) const;

    // The surface around tetrahedra. Non-manifold edges and vertices are duplicated. split_edges: edges, by their two
    // vertices, that get a vertex at their midpoint wherever the surface contains them.
    TriangleMesh build(std::span<const Tetrahedron> tetrahedra, std::span<const Point> vertices,
                       std::span<const int32_t> tets, std::span<const std::array<int32_t, 2>> split_edges,
                       Progress& progress = unobserved_progress()) const;

private:
    // The connected component, across facets and on one side, of each tetrahedron: its lowest tetrahedron.
    std::vector<int32_t> components(std::span<const uint8_t> in) const;
    // Moves components that were connected to others before back to their old side.
    void restore_components(std::span<const uint8_t> before, std::vector<uint8_t>& in) const;

    struct Facet {
        int32_t tet, corner;  // the facet opposite this corner
    };
    Facet next_around(std::span<const Tetrahedron> tetrahedra, std::span<const uint8_t> inside, Facet facet,
                      int32_t edge) const;

    std::vector<std::array<int32_t, 4>> neighbors_;  // across the facet opposite each corner; -1: none
    std::vector<std::array<int32_t, 4>> faces_;       // the source face there; -1: none

    // A polygon belongs to one part, but its triangles may belong to different tetrahedra. A tetrahedron whose only
    // surface is one polygon is owned by that polygon's leaf, all others by themselves. So polygons stay whole where
    // possible, and the solids of any cut contain each tetrahedron once.
    std::vector<int32_t> owner_;
    std::vector<std::pair<int32_t, int32_t>> reassigned_;  // (owner, tetrahedron) where they differ, sorted
};

// The solids of a hierarchy, see pw_hierarchy_solid. The hierarchy must outlive it.
class Solids {
public:
    explicit Solids(const Hierarchy& hierarchy) : hierarchy_(hierarchy) {}

    TriangleMesh solid(size_t tet_first, size_t tet_last, std::span<const std::array<int32_t, 2>> split_edges,
                       Progress& progress) const;
    // Around several disjoint slices.
    TriangleMesh solid(std::span<const std::array<int32_t, 2>> slices,
                       std::span<const std::array<int32_t, 2>> split_edges, Progress& progress) const;
    // inside: of each source face, not 0 for the faces to use instead of the part's own.
    TriangleMesh solid_of_faces(size_t tet_first, size_t tet_last, std::span<const uint8_t> inside,
                                Progress& progress) const;

private:
    const SolidBuilder& builder(Progress& progress) const;

    const Hierarchy& hierarchy_;
    // Built on first use, by any thread. Not with std::call_once: an exception can't propagate through the system's C
    // library with a static C++ runtime.
    mutable std::mutex mutex_;
    mutable std::unique_ptr<SolidBuilder> builder_;
};

}  // namespace partwheel
