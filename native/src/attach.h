// Each source face goes with the triangles of the surface used that are nearest to it.
#pragma once

#include "surface.h"

namespace partwheel {

// Samples of a source triangle are at most this part of the bounding box's diagonal apart.
inline constexpr double sample_spacing = 1.0 / 100;

// Gives `surface`, which was made from `source`, its pieces, its deviation and its number of source faces.
void attach(const Surface& source, Surface& surface, Progress& progress);

}  // namespace partwheel
