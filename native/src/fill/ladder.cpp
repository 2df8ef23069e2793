// The ladder from the caller's mesh to a filled solid.
#include "fill/ladder.h"

#include "fill/points.h"
#include "surface/prepare/coarse.h"
#include "surface/prepare/displaced.h"
#include "surface/prepare/repair.h"

#include <CGAL/exceptions.h>

#include <algorithm>
#include <utility>

namespace partwheel {

namespace {

constexpr uint32_t all_rungs = PW_RUNG_EXACT | PW_RUNG_REPAIRED | PW_RUNG_POINTS;

// Whether a lower rung may do better.
bool may_go_on(const Error& error) {
    switch (error.status()) {
        case PW_ERROR_DEGENERATE:
        case PW_ERROR_OPEN:
        case PW_ERROR_NON_MANIFOLD:
        case PW_ERROR_ORIENTATION:
        case PW_ERROR_SELF_INTERSECTION:
        case PW_ERROR_NO_VOLUME:
        case PW_ERROR_TETRAHEDRA: return true;
        default: return false;
    }
}

Solid step(const Surface& source, pw_rung rung, const LadderOptions& options, Progress& progress) {
    if (options.trying) options.trying(rung);
    Solid solid;
    if (rung == PW_RUNG_EXACT) check_surface(source, progress);
    progress.enter(PW_STAGE_REPAIR);
    try {
        if (rung == PW_RUNG_POINTS) return from_points(source, options.open_surfaces, options.threads, progress);
        if (rung == PW_RUNG_EXACT) solid.surface = source;
        if (rung == PW_RUNG_REPAIRED) {
            std::optional<Surface> moved = displaced(source, progress);
            solid.surface = moved ? std::move(*moved) : repair(source, progress);
        }
    } catch (const CGAL::Failure_exception&) {
        throw Error(PW_ERROR_SELF_INTERSECTION, "The mesh is too broken to be repaired. Remesh it and try again.");
    }
    solid.surface.rung = rung;
    progress.enter(PW_STAGE_TETRAHEDRA);
    solid.mesh = tetrahedralize(solid.surface, options.quality, progress);
    return solid;
}

// The copy of a large surface has one triangle for so many that would be used exactly, and no fewer than the least. The
// measures that parts are joined by were fitted to models of some 25,000: with more of them parts are no better.
constexpr size_t exact_for_each = 4, least_triangles = 100;

Solid climb(const Surface& source, const LadderOptions& options, Progress& progress) {
    const uint32_t rungs = options.rungs == 0 ? all_rungs : options.rungs;
    for (const pw_rung rung : {PW_RUNG_EXACT, PW_RUNG_REPAIRED, PW_RUNG_POINTS}) {
        if (!(rungs & rung)) continue;
        try {
            return step(source, rung, options, progress);
        } catch (const Error& error) {
            const bool last = rungs < 2U * static_cast<uint32_t>(rung);
            if (last || !may_go_on(error)) throw;
        }
    }
    throw Error(PW_ERROR_INTERNAL, "No rung of the ladder was tried. Please report this.");
}

}  // namespace

Solid climb(const MeshView& mesh, const LadderOptions& options, Progress& progress) {
    progress.enter(PW_STAGE_SURFACE);
    Surface source = read_mesh(mesh);
    progress.advance(0.2);
    if (source.triangles.size() <= options.exact_triangles) return climb(source, options, progress);
    const size_t target = std::max(options.exact_triangles / exact_for_each, least_triangles);
    Coarse coarse = made_coarse(std::move(source), target, options.threads, progress);
    Solid solid = climb(coarse.surface, options, progress);
    carry_over(std::move(coarse), solid.surface);
    return solid;
}

}  // namespace partwheel
