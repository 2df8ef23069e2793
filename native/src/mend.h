// What both lower rungs begin with: any triangles -> an oriented manifold with its holes filled, that may cross itself.
#pragma once

#include "surface.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <string>
#include <vector>

namespace partwheel {

using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;

// How often each thing was done.
struct Mending {
    size_t dropped = 0;   // triangles without area, and copies of others
    size_t split = 0;     // vertices that were doubled, where more than two faces or several sheets met
    size_t turned = 0;    // triangles that looked the other way than most of their part
    size_t stitched = 0;  // pairs of edges
    size_t holes = 0;     // filled

    std::string account() const;  // "3 holes were filled, 12 triangles turned round"; "" if nothing was done
};

// An open part counts as a sheet, and not as a solid with holes, if closing it takes more new area than this share of
// its own. A hemisphere takes 0.5, a tube as long as wide 0.5, an open box 0.2; a plane takes 1, and a car door nearly.
inline constexpr double sheet_share = 0.8;

struct Mended {
    CgalMesh mesh;       // in working coordinates; open where a part is a sheet
    Mending done;
    size_t solids = 0;   // closed parts
    size_t sheets = 0;   // open ones
};

Mended mend(const Surface& source, Progress& progress);

// A closed mesh as a Surface, whose vertices know the source's of the same place. Its pieces are not yet the source's.
Surface to_surface(const Surface& source, const CgalMesh& mesh);

}  // namespace partwheel
