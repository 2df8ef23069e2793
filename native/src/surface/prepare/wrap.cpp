// The third rung: a new closed surface close around the source, by CGAL's alpha wrapping.
#include "surface/prepare/wrap.h"

#include "surface/attach.h"
#include "surface/prepare/mend.h"

#include <CGAL/alpha_wrap_3.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace partwheel {

namespace {

using Corners = std::array<size_t, 3>;

struct Soup {
    std::vector<CgalKernel::Point_3> points;
    std::vector<Corners> triangles;
};

// A wrap of more vertices than this is given up, and begun again half as fine: it would take minutes. So is one of more
// steps, which would not end; real models take about 19 for each vertex.
constexpr size_t most_vertices = 80000, most_steps = 10000000;
class TooFine {};

// Told of every step; CGAL offers no other way to stop a wrap.
class Watcher : public CGAL::Alpha_wraps_3::internal::Wrapping_default_visitor {
public:
    // done: the steps of earlier wraps of this model, for a progress that goes on.
    Watcher(size_t& done, Progress& progress) : done_(done), progress_(progress) {}
    template <class Wrapper, class Gate>
    void before_facet_treatment(const Wrapper&, const Gate&) {
        if (++steps_ > most_steps) throw TooFine();
        if (++done_ % 256 == 0) progress_.advance(0.2 + 0.6 * (1 - std::exp(-static_cast<double>(done_) / 3e5)));
    }
    template <class Wrapper, class Place>
    void before_Steiner_point_insertion(const Wrapper&, const Place&) {
        if (++vertices_ > most_vertices) throw TooFine();
    }

private:
    size_t& done_;
    Progress& progress_;
    size_t steps_ = 0, vertices_ = 0;
};

// A wrap has about 3 faces for each alpha^2 of area.
double faces_for(double alpha, double area) { return 3 * area / (alpha * alpha); }
double alpha_for(double faces, double area) { return std::sqrt(3 * area / faces); }

// How closely to wrap. First with a few faces for each of the source's, within these bounds: a wrap of a large model
// gets as many for its thin limbs as a body does, and that of a small one is quick. Gaps narrower than alpha are not
// entered, so where too much of the source is hidden it is done again with half of alpha, down to the least. What then
// is hidden still lies inside the solid. A few large triangles that cross hide something in the creases between them
// however fine the wrap, so the more faces it is to have for each of theirs, the more must be hidden.
constexpr double faces_for_each = 4, least_faces = 3000, usual_faces = 30000, most_faces = 40000;
constexpr double least_alpha = 1.0 / 400;  // relative to the diagonal
constexpr double much_hidden = 0.01;       // a share of the area, for a wrap of
constexpr double ample_for_each = 50;      // faces for each of the source's, or fewer; for one of more in proportion
constexpr double worth_while = 1.5;        // a wrap this much finer than the last, or none
constexpr double gain = 0.8;               // with more than this still hidden the coarser wrap is kept

// A sheet is covered on both sides, and the closer they are, the more faces that takes.
constexpr double sheet_alpha = 1.0 / 40;

Soup to_soup(const CgalMesh& mesh) {
    Soup soup;
    soup.points.assign(mesh.points().begin(), mesh.points().end());
    for (const auto f : mesh.faces()) {
        Corners& corners = soup.triangles.emplace_back();
        size_t k = 0;
        for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) corners[k++] = v;
    }
    return soup;
}

CgalMesh wrap_soup(const Soup& soup, double alpha, double offset_share, size_t& done, Progress& progress) {
    for (;; alpha *= 2) {
        try {
            Watcher watcher(done, progress);
            CgalMesh wrapped;
            CGAL::alpha_wrap_3(soup.points, soup.triangles, alpha, alpha * offset_share, wrapped,
                               CGAL::parameters::default_values(), CGAL::parameters::visitor(watcher));
            return wrapped;
        } catch (const TooFine&) {
            progress.advance(0);
        }
    }
}

}  // namespace

Surface wrap(const Surface& source, bool open_surfaces, double coarseness, Progress& progress) {
    const Mended mended = mend(source, progress);
    if (mended.solids == 0 && !open_surfaces)
        throw Error(PW_ERROR_NOT_SOLID,
                    "The mesh is a sheet, not a solid: it is open, and closing it would take as much new surface as "
                    "there is. Give it a thickness (Solidify), close it, or allow open surfaces, which are then taken "
                    "as thin solids.");
    const Soup soup = to_soup(mended.mesh);
    if (soup.triangles.empty()) throw Error(PW_ERROR_NOT_SOLID, "The mesh has no area at all: only edges and points.");
    const CGAL::Bbox_3 box = CGAL::bbox_3(soup.points.begin(), soup.points.end());
    const double diagonal = std::hypot(box.x_span(), box.y_span(), box.z_span());
    const double area = CGAL::Polygon_mesh_processing::area(mended.mesh);
    const bool sheet = mended.solids == 0;
    const auto count = static_cast<double>(soup.triangles.size());
    const double least = coarseness * std::max(diagonal * least_alpha, alpha_for(most_faces, area));
    const double first = alpha_for(std::clamp(faces_for_each * count, least_faces, usual_faces), area);
    double alpha = sheet ? coarseness * diagonal * sheet_alpha : std::max(least, coarseness * first);

    Surface surface;
    size_t done = 0;
    for (double hidden = HUGE_VAL;;) {
        Surface closer = to_surface(source, wrap_soup(soup, alpha, sheet ? 0.1 : 1.0 / 30, done, progress));
        const double still = attach(source, closer, progress).hidden;
        if (still < gain * hidden) {
            hidden = still;
            surface = std::move(closer);
        }
        const double finer = std::max(least, alpha / 2);
        const double much = much_hidden * std::max(1.0, faces_for(finer, area) / (ample_for_each * count));
        if (sheet || hidden < much || alpha < worth_while * least) break;
        alpha = finer;
    }
    Account account;
    mended.done.tell(account);
    surface.account = std::string(sheet ? "Wrapped as a thin solid, for the mesh is a sheet" : "Wrapped") +
                      (account.text().empty() ? "" : ", after this: " + account.text()) +
                      ". " + at_most_away(surface.deviation) + ".";
    return surface;
}

}  // namespace partwheel
