// The ladder from the caller's mesh to a filled solid: exact, repaired, from points; the first fill method that holds.
#pragma once

#include "fill/tetrahedra.h"

#include <functional>
#include <limits>

namespace partwheel {

// pw_build_options, checked.
struct FillOptions {
    double quality = 0;
    uint32_t fill_methods = 0;
    bool open_surfaces = false;
    std::function<void(pw_fill_method)> trying;  // called with each fill method before it is tried; may be empty
    size_t threads = 0;                   // as cluster() takes it
    size_t exact_triangles = std::numeric_limits<size_t>::max();  // of more than this a coarser copy is filled
};

// Throws the Error of the last fill method allowed if none holds. Works in the stages surface, repair and tetrahedra.
Solid fill_solid(const MeshView& mesh, const FillOptions& options, Progress& progress);

}  // namespace partwheel
