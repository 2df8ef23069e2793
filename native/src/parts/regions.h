// Regions: what the patches of a surface divide a solid into.
//
// Where a tetrahedron lies behind several patches, a border between them can't be a border of parts. So it is divided
// at its centroid first. Each tetrahedron then belongs to the patch in front of it, or of most of what is around it.
// The paper's clusters, and so the initial parts, lie within regions.
#pragma once

#include "cluster/cluster.h"
#include "mesh/patches.h"

namespace partwheel {

// The patch in front of each triangle of the surface, or -1. A patch is connected on it, and its faces are assigned to
// its own triangles. of_face: the patch of each source face, or -1.
std::vector<int32_t> assign_patches(Surface& surface, std::span<const int32_t> of_face);

// Divides each tetrahedron with facets in several patches at its centroid. Flat ones, that have none, stay.
void divide_tetrahedra(TetMesh& mesh, const Surface& surface, std::span<const int32_t> patch_of_triangle, Progress& progress);

class Regions {
public:
    // surface: the boundary of the mesh.
    Regions(const TetMesh& mesh, const Surface& surface, const Patches& patches,
            std::span<const int32_t> patch_of_triangle, Progress& progress);

    // The strength of the marks between two tetrahedra; see Patches.
    float strength(int32_t tet_a, int32_t tet_b) const { return patches_.strength(patch_[idx(tet_a)], patch_[idx(tet_b)]); }
    std::span<const int32_t> patches() const { return patch_; }  // of each tetrahedron; -1: none
    // The patches that are connected without crossing a hard mark; -1: no patch.
    int32_t group(int32_t tet) const {
        const int32_t patch = patch_[idx(tet)];
        return patch < 0 ? -1 : patches_.group[idx(patch)];
    }

    std::vector<double> mean_strengths() const;  // of the marks around each patch
    bool is_divided_by_hard_marks() const;

    size_t count = 0;
    bool has_hints = false;          // whether marks of the caller divide it, not only creases
    std::vector<int32_t> of_tet;     // the region of each tetrahedron: those of a patch that are connected
    std::vector<int32_t> component;  // of each region: the lowest one with which it forms a connected component

private:
    const Patches& patches_;
    std::vector<int32_t> patch_;  // of each tetrahedron
};

// cluster() within regions. The last merges, one less than there are regions, join them.
BinaryTree cluster_in_regions(const TetMesh& mesh, const Regions& regions, Progress& progress, size_t threads);

}  // namespace partwheel
