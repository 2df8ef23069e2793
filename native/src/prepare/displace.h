// The gentlest repair: vertices are moved, and every source face stays one triangle.
#pragma once

#include "mesh/surface.h"

#include <optional>

namespace partwheel {

// For a source that only fails check_surface() by touching or crossing itself. Vertices at one place, as where a part
// was cut off and what is left touches itself, are moved inwards by a thousandth of their shortest edge; else a surface
// that is rough all over is smoothed until it doesn't cross itself. Nothing if neither helps, or if a vertex would be
// moved by more than a twentieth of the model's diagonal.
std::optional<Surface> displace_vertices(const Surface& source, Progress& progress);

}  // namespace partwheel
