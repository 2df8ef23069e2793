// A surface of which more than two triangles meet at some edges: fills each region that it encloses.
#pragma once

#include "fill/tetrahedra.h"

namespace partwheel {

// Such a mesh may be closed although none of its manifold patches is.
bool has_non_manifold_edges(const Surface& surface);

// The tetrahedra inside, separated along the walls between regions. The surface used covers both sides of a wall, with
// copies of the source's vertices on each. The wall's source face belongs to the side behind it; the other side has
// none. Triangles that enclose nothing, such as walls with a hole and fins, are left out: their faces go with the
// nearest face. No vertex moves. Returns nothing if there is neither wall nor such a triangle, if the source passes
// through itself, or if what encloses nothing might be an open solid. Stages: repair and tetrahedra.
std::optional<Solid> fill_cells(const Surface& source, double quality, Progress& progress);

}  // namespace partwheel
