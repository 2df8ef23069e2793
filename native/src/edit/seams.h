// Seams for unwrapping: along the borders of parts, in creases. A part whose conformal map would overlap itself or
// distort areas too much gets more cuts: into it, or through it along the tree. See docs/seams.md.
#pragma once

#include "base/progress.h"
#include "mesh/surface.h"
#include "tree/hierarchy.h"

namespace partwheel {

using TriangleUvs = std::array<std::array<double, 2>, 3>;

// As pw_hierarchy_seams. Throws an Error.
std::vector<uint8_t> find_seams(const Hierarchy& hierarchy, const MeshView& mesh, std::span<const int32_t> labels,
                                bool keep_borders, double max_distortion, Progress& progress = unobserved_progress());

// As pw_hierarchy_refine_seams. Throws an Error.
void refine_seams(const Hierarchy& hierarchy, const MeshView& mesh, std::span<const TriangleUvs> uvs, double max_distortion,
                  std::span<uint8_t> is_seam, Progress& progress = unobserved_progress());

}  // namespace partwheel
