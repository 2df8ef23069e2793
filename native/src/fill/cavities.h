// Shells that are cavities of others.
#pragma once

#include "mesh/shells.h"

namespace partwheel {

// A shell is a cavity of the smallest shell that holds it if both are closed and oriented the other way: then they are one
// shell. A shell holds another if it winds around it, at two vertices. At most `most_holders` candidates are tried for
// each, the smallest bounding boxes first: O(n log n).
Shells with_cavities(const MeshView& mesh, const Shells& shells);

}  // namespace partwheel
