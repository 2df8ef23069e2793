// Shells within shells, and cavities.
#pragma once

#include "mesh/shells.h"

#include <span>
#include <vector>

namespace partwheel {

// Of each closed shell, the smallest closed shell that winds around it, tested at two vertices; -1: none, or open. At most
// `most_holders` candidates are tried for each, the smallest bounding boxes first: O(n log n).
std::vector<int32_t> find_enclosing_shells(const MeshView& mesh, const Shells& shells);

// Shells joined with their cavities: closed shells directly inside them that are oriented the other way.
Shells join_cavities(const MeshView& mesh, const Shells& shells, std::span<const int32_t> enclosing);

}  // namespace partwheel
