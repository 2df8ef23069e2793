// The third rung: a new closed surface close around the source.
#pragma once

#include "surface/surface.h"

namespace partwheel {

// A surface that passes check_surface(). open_surfaces: take sheets as thin solids, else throw PW_ERROR_NOT_SOLID if
// there is nothing but sheets. coarseness: 1, or more for a wrap less close.
Surface wrap(const Surface& source, bool open_surfaces, double coarseness, Progress& progress);

}  // namespace partwheel
