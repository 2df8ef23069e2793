// A closed surface with interior walls, so that more than two triangles meet at some edges: fills each of its cells.
#pragma once

#include "fill/tetrahedra.h"

#include <optional>

namespace partwheel {

// The tetrahedra inside, separated along the walls. The surface used covers both sides of a wall, with copies of the
// source's vertices on each. The wall's source face belongs to the side behind it; the other side has none. No vertex
// moves. Returns nothing if the source has no such walls, is open, or passes through itself. Stages: repair and
// tetrahedra.
std::optional<Solid> fill_cells(const Surface& source, double quality, Progress& progress);

}  // namespace partwheel
