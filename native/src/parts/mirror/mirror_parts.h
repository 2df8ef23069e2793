// Symmetric labels: the parts on one side of a symmetry plane are copied to the other side.
#pragma once

#include "fill/tetrahedra.h"
#include "mesh/symmetry.h"
#include "parts/part_tree.h"
#include "parts/regions.h"

namespace partwheel {

struct TetLabels {
    std::vector<int32_t> label;  // of each tetrahedron: its part
    size_t count = 0;            // of parts
    // By plane: the mirror image of each part, which may be itself; -1 if it has none.
    std::vector<std::vector<int32_t>> mirror;
    // Set by copy_symmetric_labels() for each old part: what it has become, or -1; with marks, its area.
    std::vector<int32_t> new_part;
    std::vector<double> old_area{};
};

// label: of each tetrahedron, 0 to count - 1. scores: of each tetrahedron, counted by its boundary area. Plane by
// plane, the side with the higher mean score is copied to the other one: a tetrahedron there gets the mirror image of
// the part behind its own mirror image. A part is its own mirror image if a fair share of its volume lies on both
// sides, or if it is nearly convex together with its image. A tetrahedron without a counterpart within the tolerance
// keeps its part, which has no image unless it belongs to the copied side. regions: null, or those of marks: labels are
// copied between patches that are images of each other; parts of others stay.
TetLabels copy_symmetric_labels(const TetMesh& mesh, std::span<const Plane> planes, std::span<const int32_t> label,
                                size_t count, std::span<const double> scores, Progress& progress,
                                const Regions* regions = nullptr);

// Gives parts without tetrahedra those that they have in the tree, until no part is empty: what a part gets back may have
// been all that another one had.
void restore_lost_parts(const PartTree& tree, std::vector<int32_t>& label);

// The tree's labels, changed where borders lie beside their mirror images: a few times, each tetrahedron at the surface
// gets the label that most of its facets and of their mirror images in all planes have. The side that was copied to all
// others stays as it is. No part vanishes.
std::vector<int32_t> align_borders(const TetMesh& mesh, std::span<const Plane> planes, const PartTree& tree,
                                   std::span<const double> scores, Progress& progress);

// The area of the boundary facets with each label.
std::vector<double> surface_areas(const TetMesh& mesh, std::span<const int32_t> label, size_t count);

// Gives the tetrahedra of these parts to neighboring parts.
TetLabels dissolve_parts(const TetMesh& mesh, TetLabels parts, std::span<const int32_t> dissolved, Progress& progress);

}  // namespace partwheel
