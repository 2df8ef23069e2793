// Tetrahedra of a part whose border was moved.
#pragma once

#include "edit/manifold_surface.h"

namespace partwheel {

// Adapts a set of tetrahedra to a part with a moved border. inside: of each source face, not 0 for those of the part. A
// tetrahedron on the surface follows the majority of its surface area; inner ones near a change follow a minimum cut,
// which minimizes the caps. Components that would be separated from the rest stay, and so does everything if the old
// set fits the faces better. in: of each tetrahedron, whether it is in the set; not empty.
std::vector<uint8_t> move_border(const TetFacets& facets, std::vector<uint8_t> in, std::span<const uint8_t> inside,
                                 Progress& progress);

}  // namespace partwheel
