// Shells that are copies of another shell of the mesh, moved, turned or mirrored: wheels, rivets, windows, a pair of
// boots.
#pragma once

#include "base/progress.h"
#include "mesh/patches.h"
#include "prepare/divide.h"

namespace partwheel {

struct Congruence {
    size_t original = 0;  // the shell that this one is a copy of
    Affine motion{};      // from the original to the copy
    bool is_mirrored = false;
    std::vector<int32_t> vertices, faces;  // of each vertex and face of the original, the one of the copy
};

// For each shell that is a copy: how. Its original is a later shell, and no copy itself. The copy's vertices are where
// the motion takes the original's, apart from rounding to float32; its triangles, faces and patches are the same. The
// order of vertices and triangles doesn't matter. O(n log n) unless many shells nearly are copies.
std::vector<std::optional<Congruence>> find_congruent_shells(std::span<const SubMesh> shells, const Patches& patches,
                                                             Progress& progress);

}  // namespace partwheel
