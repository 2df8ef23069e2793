// Each source face goes with the triangles of the surface used that are nearest to it.
#pragma once

#include "surface.h"

namespace partwheel {

// Samples of a source triangle are at most this part of the bounding box's diagonal apart.
inline constexpr double sample_spacing = 1.0 / 100;

// Less than this, relative to the diagonal, is not looked at more closely.
inline constexpr double near_enough = 1.0 / 200;

// Gives `surface`, which was made from `source`, its pieces, its deviation and its number of source faces. Returns how
// far the source reaches out of the solid, relative to the diagonal; 0 if that is no more than near_enough.
double attach(const Surface& source, Surface& surface, Progress& progress);

// "0.12 %"
std::string percent(double share);

}  // namespace partwheel
