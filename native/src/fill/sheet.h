// The last fill method: a sheet (plane, cloth, leaf) as a thin solid.
#pragma once

#include "fill/tetrahedra.h"

namespace partwheel {

// The thickness of a sheet, relative to the diagonal of its bounding box.
inline constexpr double sheet_thickness = 1.0 / 200;

// One prism of three tetrahedra behind each triangle that has an area; prisms of adjacent triangles share their side.
// The front of the solid is the source itself, the back has no source face. Works for any triangles of which one has an
// area: prisms are separate where more than two triangles meet at an edge, where the surface is not orientable, and
// where it folds back onto itself. The solid may overlap itself in space, but not as tetrahedra that share facets.
// Where an offset vertex would turn a prism inside out, the sheet is thinner. O(n log n). Throws
// Error(PW_ERROR_NO_VOLUME) if no triangle has an area.
Solid fill_sheet(const Surface& source, Progress& progress);

// Throws Error(PW_ERROR_NOT_SOLID): the mesh is a sheet.
[[noreturn]] void throw_sheet();

}  // namespace partwheel
