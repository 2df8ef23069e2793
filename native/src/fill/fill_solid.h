// From the caller's mesh to a filled solid: exact, repaired, from points, as a sheet; the first fill method that works.
#pragma once

#include "fill/tetrahedra.h"

namespace partwheel {

// pw_build_options, checked.
struct FillOptions {
    double quality = 0;
    uint32_t fill_methods = 0;
    std::function<void(pw_fill_method)> on_attempt;  // called with each fill method before it is tried; may be empty
    size_t threads = 0;                   // as cluster() takes it
    size_t exact_triangles = std::numeric_limits<size_t>::max();  // a larger mesh is decimated first
    size_t least_points = 2000;  // for from_points()
    double max_deviation_from_points = std::numeric_limits<double>::infinity();  // beyond it, a closer thin solid is taken
};

// Whether an error is about the shape of a mesh, so that another fill method may succeed.
bool is_about_shape(pw_status status);

// Throws the Error of the last allowed fill method if none succeeds. Works in the stages surface, repair and
// tetrahedra.
Solid fill_solid(const MeshView& mesh, const FillOptions& options, Progress& progress);

}  // namespace partwheel
