// Builds an assembly, a mesh of several shells: shell by shell, then joins their trees.
#pragma once

#include "fill/fill_solid.h"
#include "mesh/patches.h"
#include "prepare/divide.h"
#include "tree/hierarchy.h"

namespace partwheel {

struct BuildOptions {
    FillOptions fill;
    int32_t mode = 0;            // pw_mode
    bool find_symmetry = true;   // see mirror_planes()
    bool find_inner_walls = true;  // faces of an inner wall go with the outer wall
    std::vector<EdgeMarks> marks;
    bool refuse_sheets = false;  // throw Error(PW_ERROR_NOT_SOLID) for a mesh of nothing but sheets
};

// The patches of the whole mesh, and the patch of each face of a shell, or -1. Empty: it has none.
struct ShellPatches {
    const Patches& all;
    std::vector<int32_t> of_face;
};

using BuildShell = std::function<Hierarchy(const MeshView&, const ShellPatches&, const BuildOptions&, Progress&)>;

// Trees are joined by contact: no union is computed.
Hierarchy build_assembly(const MeshView& mesh, Assembly assembly, const Patches& patches, const BuildOptions& options,
                         const BuildShell& build_shell, Progress& progress);

}  // namespace partwheel
