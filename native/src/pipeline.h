// The whole flow, from a mesh to its hierarchy.
#pragma once

#include "assembly.h"

namespace partwheel {

// A mesh of one shell is filled and clustered. One of several, an assembly, is built shell by shell, and the trees
// joined by contact. PW_MODE_PAPER takes any mesh as a whole, as the paper does.
Hierarchy build_hierarchy(const MeshView& mesh, const BuildOptions& options, Progress& progress);

}  // namespace partwheel
