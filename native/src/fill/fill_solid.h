// From the caller's mesh to a filled solid: exact, repaired, from points, as a sheet; the first fill method that works.
#pragma once

#include "fill/tetrahedra.h"

#include <functional>
#include <limits>

namespace partwheel {

// pw_build_options, checked.
struct FillOptions {
    double quality = 0;
    uint32_t fill_methods = 0;
    std::function<void(pw_fill_method)> trying;  // called with each fill method before it is tried; may be empty
    size_t threads = 0;                   // as cluster() takes it
    size_t exact_triangles = std::numeric_limits<size_t>::max();  // of more than this a coarser copy is filled
    size_t least_points = 2000;  // that from_points() spreads over the mesh
};

// Whether an error says that a surface can't be filled in one way, so that another fill method may work.
bool is_about_shape(pw_status status);

// Throws the Error of the last fill method allowed if none holds. Works in the stages surface, repair and tetrahedra.
Solid fill_solid(const MeshView& mesh, const FillOptions& options, Progress& progress);

}  // namespace partwheel
