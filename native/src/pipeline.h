// The whole flow, from a mesh to its hierarchy.
#pragma once

#include "fill/fill_solid.h"
#include "mesh/patches.h"
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

// A mesh of one shell is filled and clustered. One of several, an assembly, is built shell by shell, and the trees joined
// by contact: no union is computed. PW_MODE_PAPER takes any mesh as a whole, as the paper does.
Hierarchy build_hierarchy(const MeshView& mesh, const BuildOptions& options, Progress& progress);

}  // namespace partwheel
