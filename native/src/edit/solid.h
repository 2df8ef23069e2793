// Tetrahedra -> the closed, manifold surface around them: the source's own triangles, and caps where the rest was.
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

// How the tetrahedra of a hierarchy meet. Made once, for all of its solids.
class Facets {
public:
    // outer_faces: the source face, or -1, of each facet that has nothing on its other side, by tetrahedron and then
    // corner. leaf: of each source face. Throws Error(PW_ERROR_DATA) for tetrahedra that don't fit together.
    Facets(std::span<const Tetrahedron> tetrahedra, std::span<const int32_t> outer_faces,
           std::span<const int32_t> leaf, bool whole_faces, Progress& progress = unwatched());

    // The tetrahedra whose home is in [first, last); if first is the larger, outside [last, first).
    std::vector<int32_t> at_home(size_t first, size_t last) const;

    // The same where other faces are to be the part's, the ones that inside (of each source face) is not 0 for: those of
    // a border that was moved. A tetrahedron on the surface goes with the faces that most of its area there is of; those
    // within, near the ones that changed sides, with whom the caps become smallest: a minimum cut. All others stay; and
    // so do splinters, those that would only touch what they were joined with, and all where that fits better.
    std::vector<int32_t> with_faces(std::span<const Tetrahedron> tetrahedra, std::span<const Point> vertices,
                                    size_t first, size_t last, std::span<const uint8_t> inside,
                                    Progress& progress) const;

    // The surface around tetrahedra. Where they only touch, at an edge or a vertex, it is cut apart.
    // middles: edges, as their two vertices, that get a vertex in their middle wherever they are on it.
    TriangleMesh solid(std::span<const Tetrahedron> tetrahedra, std::span<const Point> vertices,
                       std::span<const int32_t> tets, std::span<const std::array<int32_t, 2>> middles,
                       Progress& progress = unwatched()) const;

private:
    // Of each tetrahedron the lowest of the piece it is in: joined across facets, all on one side.
    std::vector<int32_t> pieces(std::span<const uint8_t> in) const;
    // Pieces that only touch the others, and were joined with them before, change sides.
    void drop_splinters(std::span<const uint8_t> before, std::vector<uint8_t>& in) const;

    struct Facet {
        int32_t tet, corner;  // the facet opposite this corner
    };
    Facet next_around(std::span<const Tetrahedron> tetrahedra, std::span<const uint8_t> inside, Facet facet,
                      int32_t edge) const;

    std::vector<std::array<int32_t, 4>> neighbors_;  // across the facet opposite each corner; -1: none
    std::vector<std::array<int32_t, 4>> faces_;       // the source face there; -1: none

    // A polygon is in one part, but its triangles may have different tetrahedra. A tetrahedron that has nothing on the
    // surface but one polygon goes with it: its home is the polygon's leaf. Each other one is its own. So polygons stay
    // whole where they can, and whatever the cut, its solids have each tetrahedron once.
    std::vector<int32_t> home_;
    std::vector<std::pair<int32_t, int32_t>> moved_;  // (home, tetrahedron) where they differ, sorted
};

// The solids of a hierarchy, which stays where it is: slices of its tetrahedra, as pw_hierarchy_solid documents them.
class Solids {
public:
    explicit Solids(const Hierarchy& hierarchy) : hierarchy_(hierarchy) {}

    TriangleMesh solid(size_t tet_first, size_t tet_last, std::span<const std::array<int32_t, 2>> middles,
                       Progress& progress) const;
    // Around several slices that are apart.
    TriangleMesh solid(std::span<const std::array<int32_t, 2>> slices,
                       std::span<const std::array<int32_t, 2>> middles, Progress& progress) const;
    // inside: of each source face, not 0 for those that the part is to have in place of its own.
    TriangleMesh solid_of_faces(size_t tet_first, size_t tet_last, std::span<const uint8_t> inside,
                                Progress& progress) const;

private:
    const Facets& facets(Progress& progress) const;

    const Hierarchy& hierarchy_;
    // Made when a solid is first asked for, whichever thread asks. Not by std::call_once: an exception would have to
    // pass through the system's C library, which the C++ runtime that is linked into this library can't do.
    mutable std::mutex mutex_;
    mutable std::unique_ptr<Facets> facets_;
};

}  // namespace partwheel
