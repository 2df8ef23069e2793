// Parts that are their own mirror images: those of one side of a plane are copied to the other.
#pragma once

#include "fill/tetrahedra.h"
#include "mesh/symmetry.h"

#include <span>
#include <vector>

namespace partwheel {

struct TetLabels {
    std::vector<int32_t> of;  // each tetrahedron
    size_t count = 0;
    // By plane: of each part its mirror image, which may be itself; -1: it has none.
    std::vector<std::vector<int32_t>> images;
    std::vector<int32_t> stands;  // of mirrored(): for each part that was given one that it has become; -1: none
};

// part: of each tetrahedron, 0 to count - 1.
// Plane by plane, the side whose area is worth more (worth: of each tetrahedron, for its area) is copied to the other: what
// lies there goes with the mirror image of the part that lies behind its own mirror image. A part becomes its own
// image if it has a fair share of its volume on either side, or is convex together with its image. What has no
// counterpart within the tolerance keeps the part it had, which has no image unless it lives on the side that is
// copied.
TetLabels mirrored(const TetMesh& mesh, std::span<const Plane> planes, std::span<const int32_t> part,
                           size_t count, std::span<const double> worth, Progress& progress);

// Some of the parts given to their neighbours.
TetLabels dissolve_parts(const TetMesh& mesh, TetLabels parts, std::span<const int32_t> scraps,
                            Progress& progress);

}  // namespace partwheel
