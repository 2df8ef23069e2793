// The second fill method: the source repaired and its crossing parts united. Most vertices stay where the caller has
// them.
#pragma once

#include "mesh/surface.h"

namespace partwheel {

// Returns a surface that passes check_surface(). Throws an Error if this kind of repair doesn't succeed.
Surface repair(const Surface& source, Progress& progress);

}  // namespace partwheel
