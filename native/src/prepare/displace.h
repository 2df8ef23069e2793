// The gentlest repair: moves vertices, and keeps all triangles.
#pragma once

#include "mesh/surface.h"

namespace partwheel {

// For a source that check_surface() refuses only because it touches or crosses itself. Moves coincident vertices, as
// where a part was cut off and the rest touches itself, inward by a thousandth of their shortest edge. If the surface
// still crosses itself and is noisy, smooths it until it doesn't. Returns nothing if neither helps, or if a vertex
// would move by more than a twentieth of the model's diagonal.
std::optional<Surface> displace_vertices(const Surface& source, Progress& progress);

}  // namespace partwheel
