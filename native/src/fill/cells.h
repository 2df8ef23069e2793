// A closed surface with walls inside, where more than two triangles meet at an edge: each of its cells is filled.
#pragma once

#include "fill/tetrahedra.h"

#include <optional>

namespace partwheel {

// The tetrahedra inside, cut apart along the walls. The surface used goes along both sides of a wall, with the source's
// vertices on each: its face is that of the side that it looks away from, and the other side has none. No vertex is moved.
// None: the source has no such walls, is open, or passes through itself. Works in the stages repair and tetrahedra.
std::optional<Solid> fill_cells(const Surface& source, double quality, Progress& progress);

}  // namespace partwheel
