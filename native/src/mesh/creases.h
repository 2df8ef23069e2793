// Creases of hard surfaces: where a window meets its frame, a shelf its wall, a handle its door.
//
// A built model has flat polygons, and where one of its pieces ends, its surface is folded inward (the minima rule:
// Hoffman and Richards, "Parts of recognition", 1984). Where such creases surround an area, they count as marks. On
// rounded models, such as animals, they say less than the merge policy does.
#pragma once

#include "mesh/shells.h"

namespace partwheel {

// The edges at which shells that consist mostly of flat polygons are folded inward, ascending, as welded vertices
// (Shells::vertex). O(n log n).
std::vector<std::array<int32_t, 2>> find_creases(const MeshView& mesh, const Shells& shells);

}  // namespace partwheel
