// A part of a surface -> the same part with its border in the creases nearby: a minimum cut in a band around it.
#pragma once

#include "surface.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace partwheel {

// Two faces of the band share an edge; what it costs to have the border there.
struct BandEdge {
    int32_t one, other;  // indices into BorderBand::faces
    int64_t cost;        // > 0
};

// The faces around a part's border that may change sides. All others keep theirs, and hold the band's together: every
// connected piece of the part, and of the rest, has some, and those are connected without the band's.
struct BorderBand {
    std::vector<int32_t> faces;
    std::vector<BandEdge> edges;
    std::vector<int64_t> to_part, to_rest;  // of each face: the cost of its edges with what stays in the part, the rest
};

// inside: of each face, not 0 if it is in the part. Throws an Error.
BorderBand border_band(const MeshView& mesh, std::span<const uint8_t> inside);

// Of each face of the band 1 if it belongs to the part, 0 to the rest, such that the sum of the costs between the two
// is least; of several such parts the smallest, which is one whatever the order of faces and edges.
std::vector<uint8_t> minimum_cut(const BorderBand& band);

// As pw_snapped_border.
void snapped_border(const MeshView& mesh, std::span<const uint8_t> inside, std::span<uint8_t> result);

}  // namespace partwheel
