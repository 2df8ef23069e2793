// The first step of the repaired and the points fill method: any triangles -> an oriented manifold with its holes
// filled, which may cross itself.
#pragma once

#include "mesh/surface.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

namespace partwheel {

using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;

// Repairs as text: "3 holes filled, 12 triangles turned round".
class NoteList {
public:
    void add(size_t count, const char* one, const char* many);  // does nothing if count is 0
    const std::string& text() const { return text_; }

private:
    std::string text_;
};

// An open component is a sheet, not a solid with holes, if closing it adds more area than min_sheet_added_area times
// its own, and the closed one encloses less volume than max_sheet_volume times its area to the power of 3/2; or if
// closing it adds more than max_added_area times its own, like a cape or a belt.
//
//                 new area   volume
//   plane            1        0
//   car door         0.95     0.01 to 0.02
//   hemisphere       0.5      0.07
//   drum, no ends    1        0.07
//   cape             1.1      0.05
//   belt             5        0.04
//   open box         0.2      0.07
//   closed sphere    0        0.09
inline constexpr double min_sheet_added_area = 0.8;
inline constexpr double max_added_area = 1.05;
inline constexpr double max_sheet_volume = 0.03;

struct RepairedSoup {
    CgalMesh mesh;           // in working coordinates; only sheets are open
    NoteList notes;          // how many repairs of each kind were made
    size_t solids = 0;       // closed components
    size_t sheets = 0;       // open components
    double sheet_share = 0;  // of the area
};

RepairedSoup repair_soup(const Surface& source, Progress& progress);

// A closed mesh as a Surface. Its vertices at the positions of source vertices have these as source_vertex; its samples
// are not those of the source yet.
Surface to_surface(const Surface& source, const CgalMesh& mesh);

}  // namespace partwheel
