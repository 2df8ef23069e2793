// What both lower fill methods begin with: any triangles -> an oriented manifold with its holes filled, that may cross itself.
#pragma once

#include "mesh/surface.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <string>
#include <vector>

namespace partwheel {

using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;

// What was done, as a list: "3 holes filled, 12 triangles turned round".
class Account {
public:
    void add(size_t count, const char* one, const char* many);  // nothing if count is 0
    const std::string& text() const { return text_; }

private:
    std::string text_;
};

// How often each thing was done.
struct SoupRepairCounts {
    size_t merged = 0;    // vertices at the place of another
    size_t dropped = 0;   // triangles without area, and copies of others
    size_t split = 0;     // vertices that were doubled, where more than two faces or several sheets met
    size_t turned = 0;    // triangles that looked the other way than most of their part
    size_t stitched = 0;  // pairs of edges
    size_t holes = 0;     // filled

    void tell(Account& account) const;
};

// An open part counts as a sheet, and not as a solid with holes, if closing it takes more new area than this share of
// its own, and it encloses, when closed, less volume than that share of its area to the power of 3/2.
//
//                 new area   volume
//   plane            1        0
//   car door         0.95     0.01 to 0.02
//   hemisphere       0.5      0.07
//   drum, no ends    1        0.07
//   open box         0.2      0.07
//   closed sphere    0        0.09
inline constexpr double sheet_area = 0.8;
inline constexpr double sheet_volume = 0.03;

struct RepairedSoup {
    CgalMesh mesh;       // in working coordinates; open where a part is a sheet
    SoupRepairCounts done;
    size_t solids = 0;   // closed parts
    size_t sheets = 0;   // open ones
    double sheet_share = 0;  // of the area
};

RepairedSoup repair_soup(const Surface& source, Progress& progress);

// A closed mesh as a Surface, whose vertices know the source's of the same place. Its pieces are not yet the source's.
Surface to_surface(const Surface& source, const CgalMesh& mesh);

}  // namespace partwheel
