// The ladder from the caller's mesh to a filled solid: exact, repaired, wrapped; the first rung that holds.
#pragma once

#include "fill/tetrahedra.h"

#include <functional>

namespace partwheel {

// pw_build_options, checked.
struct LadderOptions {
    double quality = 0;
    uint32_t rungs = 0;
    bool open_surfaces = false;
    size_t exact_triangles = 0;  // of more than this the parts are found on a coarser copy
    size_t threads = 0;
    std::function<void(pw_rung)> trying;  // told of each rung before it is tried; may be empty
};

struct Solid {
    Surface surface;
    TetMesh mesh;
};

// Throws the Error of the last rung allowed if none holds. Works in the stages surface, repair and tetrahedra.
Solid climb(const MeshView& mesh, const LadderOptions& options, Progress& progress);

}  // namespace partwheel
