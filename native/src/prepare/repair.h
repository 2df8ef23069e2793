// The second fill method: the source mended, its crossing parts united; most vertices stay the caller's.
#pragma once

#include "mesh/surface.h"

namespace partwheel {

// A surface that passes check_surface(). Throws an Error if it can't be had in this way.
Surface repair(const Surface& source, Progress& progress);

}  // namespace partwheel
