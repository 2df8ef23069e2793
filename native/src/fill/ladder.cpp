// The ladder from the caller's mesh to a filled solid.
#include "fill/ladder.h"

#include "fill/cells.h"
#include "fill/points.h"
#include "surface/attach.h"
#include "surface/duplicates.h"
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

// The source, and what of it is there once.
struct Source {
    Surface given;
    std::optional<Surface> distinct;  // none: all are
    std::vector<int32_t> original;    // see Surface::original

    const Surface& once() const { return distinct ? *distinct : given; }
    Surface& once() { return distinct ? *distinct : given; }
};

// Looks for duplicates, unless that has been done.
void make_distinct(Source& source) {
    if (!source.original.empty()) return;
    source.original = find_duplicates(source.given);
    if (count_duplicates(source.original) > 0) source.distinct = without_duplicates(source.given, source.original);
}

void tell_duplicates(const Source& source, Surface& surface) {
    if (!source.distinct) return;
    surface.original = source.original;
    surface.account += (surface.account.empty() ? "Repaired: " : " ") +
                       counted_faces(count_duplicates(source.original), "is a duplicate of another, and was",
                                     "are duplicates of others, and were") +
                       " counted once.";
}

Solid fill_exactly(const Surface& surface, pw_rung rung, double quality, Progress& progress) {
    progress.enter(PW_STAGE_TETRAHEDRA);
    Solid solid{surface, tetrahedralize(surface, quality, progress)};
    solid.surface.rung = rung;
    return solid;
}

// The gentlest way that holds. A duplicate may be the wall of another closed shell: then these are set apart.
Solid repaired(const Source& source, const LadderOptions& options, Progress& progress) {
    const auto filled = [&](const Surface& surface) {
        return fill_exactly(surface, PW_RUNG_REPAIRED, options.quality, progress);
    };
    std::optional<Solid> solid;
    if (source.distinct && verdict(*source.distinct, progress) == PW_OK) {
        solid = filled(*source.distinct);
    } else {
        if (const std::optional<Surface> moved = displaced(source.given, progress)) return filled(*moved);
        solid = fill_cells(source.once(), options.quality, progress);
        if (!solid) {
            progress.enter(PW_STAGE_REPAIR);
            solid = filled(repair(source.once(), progress));
        }
    }
    tell_duplicates(source, solid->surface);
    return std::move(*solid);
}

Solid step(Source& source, pw_rung rung, const LadderOptions& options, Progress& progress) {
    if (options.trying) options.trying(rung);
    if (rung == PW_RUNG_EXACT) check_surface(source.given, progress);
    progress.enter(PW_STAGE_REPAIR);
    if (rung == PW_RUNG_EXACT) return fill_exactly(source.given, rung, options.quality, progress);
    make_distinct(source);
    try {
        if (rung == PW_RUNG_REPAIRED) return repaired(source, options, progress);
        Solid solid = from_points(source.once(), options.open_surfaces, options.threads, progress);
        tell_duplicates(source, solid.surface);
        return solid;
    } catch (const CGAL::Failure_exception&) {
        throw Error(PW_ERROR_SELF_INTERSECTION, "The mesh is too broken to be repaired. Remesh it and try again.");
    }
}

// The copy of a large surface has one triangle for so many that would be used exactly, and no fewer than the least. The
// measures that parts are joined by were fitted to models of some 25,000: with more of them parts are no better.
constexpr size_t exact_for_each = 4, least_triangles = 100;

Solid climb(Source source, const LadderOptions& options, Progress& progress) {
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
    Source source{read_mesh(mesh), {}, {}};
    progress.advance(0.2);
    if (source.given.triangles.size() <= options.exact_triangles) return climb(std::move(source), options, progress);
    make_distinct(source);
    const size_t target = std::max(options.exact_triangles / exact_for_each, least_triangles);
    Coarse coarse = made_coarse(std::move(source.once()), target, options.threads, progress);
    Solid solid = climb(Source{coarse.surface, {}, {}}, options, progress);
    carry_over(std::move(coarse), solid.surface);
    tell_duplicates(source, solid.surface);
    return solid;
}

}  // namespace partwheel
