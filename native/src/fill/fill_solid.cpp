// From the caller's mesh to a filled solid.
#include "fill/fill_solid.h"

#include "base/elementary.h"
#include "fill/cells.h"
#include "fill/points.h"
#include "fill/sheet.h"
#include "mesh/duplicates.h"
#include "prepare/decimate.h"
#include "prepare/displace.h"
#include "prepare/repair.h"

#include <CGAL/assertions.h>
#include <CGAL/exceptions.h>

#include <mutex>
#include <numbers>

namespace partwheel {

namespace {

// CGAL throws where its checks fail, and a clang build writes to stderr first unless it is silenced. The handlers are
// global, and builds run in several threads.
void silence_cgal() {
    static std::once_flag once;
    std::call_once(once, [] {
        const auto nothing = [](const char*, const char*, const char*, int, const char*) {};
        CGAL::set_error_handler(nothing);
        CGAL::set_warning_handler(nothing);
    });
}

constexpr uint32_t all_fill_methods = PW_FILL_EXACT | PW_FILL_REPAIRED | PW_FILL_POINTS | PW_FILL_SHEET;

// The source, and the source without duplicate faces.
struct Source {
    Surface given;
    std::optional<Surface> distinct;  // empty: there are no duplicates
    std::vector<int32_t> original;    // see Surface::original
    std::optional<Error> mesher_error;  // of filling it exactly: there is nothing to repair, but the mesher failed

    const Surface& distinct_surface() const { return distinct ? *distinct : given; }
    Surface& distinct_surface() { return distinct ? *distinct : given; }
};

// Finds duplicates, unless that has been done.
void remove_duplicates(Source& source) {
    if (!source.original.empty()) return;
    source.original = find_duplicates(source.given);
    if (count_duplicates(source.original) > 0) source.distinct = without_duplicates(source.given, source.original);
}

void note_duplicates(const Source& source, Surface& surface) {
    if (!source.distinct) return;
    std::vector<int32_t> original = source.original;
    if (!surface.original.empty())  // the surface has left out faces itself
        for (int32_t& face : original) face = surface.original[idx(face)];
    surface.original = std::move(original);
    surface.face_counts.duplicates = count_duplicates(source.original);
    add_face_notes({surface.face_counts.duplicates}, surface.notes);
}

Solid fill_exactly(const Surface& surface, pw_fill_method method, double quality, Progress& progress) {
    progress.enter(PW_STAGE_TETRAHEDRA);
    const Progress::Section first(progress, 0, quality > 0 ? 0.6 : 0.9);  // see fill_proxy()
    Solid solid{surface, tetrahedralize(surface, quality, progress)};
    solid.surface.fill_method = method;
    return solid;
}

// The gentlest repair that succeeds. A duplicate may be the wall of another closed shell: then the shells are moved
// apart.
Solid fill_repaired(const Source& source, const FillOptions& options, Progress& progress) {
    const auto filled = [&](const Surface& surface) {
        return fill_exactly(surface, PW_FILL_REPAIRED, options.quality, progress);
    };
    std::optional<Solid> solid;
    if (source.distinct && surface_status(*source.distinct, progress) == PW_OK) {
        solid = filled(*source.distinct);
    } else {
        if (const std::optional<Surface> moved = displace_vertices(source.given, progress)) return filled(*moved);
        if (source.mesher_error) throw *source.mesher_error;  // it would fail again
        solid = fill_cells(source.distinct_surface(), options.quality, progress);
        if (!solid) {
            progress.enter(PW_STAGE_REPAIR);
            solid = filled(repair(source.distinct_surface(), progress));
        }
    }
    note_duplicates(source, solid->surface);
    return std::move(*solid);
}

Solid fill(Source& source, pw_fill_method method, const FillOptions& options, Progress& progress) {
    if (method == PW_FILL_EXACT) check_surface(source.given, progress);
    progress.enter(PW_STAGE_REPAIR);
    if (method == PW_FILL_EXACT) return fill_exactly(source.given, method, options.quality, progress);
    remove_duplicates(source);
    if (method == PW_FILL_REPAIRED) return fill_repaired(source, options, progress);
    const Surface& surface = source.distinct_surface();
    Solid solid = method == PW_FILL_SHEET ? fill_sheet(surface, progress)
                                          : from_points(surface, options.least_points, options.threads, progress);
    note_duplicates(source, solid.surface);
    return solid;
}

Solid try_fill_method(Source& source, pw_fill_method fill_method, const FillOptions& options, Progress& progress) {
    if (options.on_attempt) options.on_attempt(fill_method);
    try {
        return fill(source, fill_method, options, progress);
    } catch (const CGAL::Failure_exception&) {
        throw Error(PW_ERROR_SELF_INTERSECTION, "The mesh is too broken for this. Remesh it and try again.");
    }
}

// A mesh of more than exact_triangles triangles is decimated to exact_triangles / decimation_factor, but at least
// min_triangles. The merge policy was fitted to models of about 25,000 triangles; more don't give better parts.
constexpr size_t decimation_factor = 4, min_triangles = 100;

// Steps at a vertex may compare all pairs of triangles around it. A mesh with more of these pairs in all is decimated,
// too: the time of the other steps grows as n log n. Ordinary meshes have 8 pairs per triangle; 14,000 triangles around
// one vertex are within the limit.
constexpr double max_pairs_of_any_mesh = 1e8, max_pairs_per_triangle_and_level = 32;

double limit_pairs(size_t triangles) {
    const auto n = static_cast<double>(triangles);
    return max_pairs_of_any_mesh + max_pairs_per_triangle_and_level * n * log_of(n) / std::numbers::ln2;
}

double count_pairs_at_vertices(const Surface& surface) {
    std::vector<double> degree(surface.vertices.size(), 0);
    for (const Triangle& t : surface.triangles)
        for (const int32_t v : t) ++degree[idx(v)];
    double pairs = 0;
    for (const double d : degree) pairs += d * (d - 1) / 2;
    return pairs;
}

// The number of triangles that the mesh is decimated to, or its own.
size_t target_triangles(const Surface& surface, size_t exact_triangles) {
    const size_t count = surface.triangles.size();
    if (exact_triangles == FillOptions{}.exact_triangles) return count;  // never
    size_t target = count > exact_triangles ? exact_triangles / decimation_factor : count;
    const double pairs = count_pairs_at_vertices(surface), limit = limit_pairs(count);
    if (pairs > limit) target = std::min(target, static_cast<size_t>(limit / pairs * static_cast<double>(count)));
    return target == count ? count : std::max(target, min_triangles);
}

// The mesh as a thin solid, if that is closer to it than the solid from points.
Solid closer_sheet(Solid from_points, Source& source, const FillOptions& options, Progress& progress) {
    try {
        Solid sheet = try_fill_method(source, PW_FILL_SHEET, options, progress);
        if (sheet.surface.deviation < from_points.surface.deviation) return sheet;
    } catch (const Error& error) {
        if (!is_about_shape(error.status())) throw;
    }
    return from_points;
}

Solid fill_solid(Source source, const FillOptions& options, Progress& progress) {
    const uint32_t fill_methods = options.fill_methods == 0 ? all_fill_methods : options.fill_methods;
    bool is_sheet = false;
    for (const pw_fill_method fill_method : {PW_FILL_EXACT, PW_FILL_REPAIRED, PW_FILL_POINTS, PW_FILL_SHEET}) {
        if (!(fill_methods & fill_method)) continue;
        if (fill_method == PW_FILL_POINTS && is_sheet && (fill_methods & PW_FILL_SHEET)) continue;
        try {
            Solid solid = try_fill_method(source, fill_method, options, progress);
            const bool may_be_thin = fill_method == PW_FILL_POINTS && (fill_methods & PW_FILL_SHEET);
            if (!may_be_thin || solid.surface.deviation <= options.max_deviation_from_points) return solid;
            return closer_sheet(std::move(solid), source, options, progress);
        } catch (const Error& error) {
            const bool last = fill_methods < 2U * static_cast<uint32_t>(fill_method);
            if (last || !is_about_shape(error.status())) throw;
            if (fill_method == PW_FILL_EXACT && error.status() == PW_ERROR_TETRAHEDRA) source.mesher_error = error;
            is_sheet = fill_method == PW_FILL_REPAIRED && error.status() == PW_ERROR_OPEN &&
                       !has_non_manifold_edges(source.distinct_surface());
        }
    }
    throw Error(PW_ERROR_INTERNAL, "No fill method was tried. Please report this.");
}

}  // namespace

bool is_about_shape(pw_status status) {
    switch (status) {
        case PW_ERROR_DEGENERATE:
        case PW_ERROR_OPEN:
        case PW_ERROR_NON_MANIFOLD:
        case PW_ERROR_ORIENTATION:
        case PW_ERROR_SELF_INTERSECTION:
        case PW_ERROR_NO_VOLUME:
        case PW_ERROR_TETRAHEDRA:
        case PW_ERROR_NOT_SOLID: return true;
        default: return false;
    }
}

Solid fill_solid(const MeshView& mesh, const FillOptions& options, Progress& progress) {
    silence_cgal();
    progress.enter(PW_STAGE_SURFACE);
    Source source{read_mesh(mesh), {}, {}, {}};
    progress.advance(0.2);
    const size_t target = target_triangles(source.given, options.exact_triangles);
    if (target == source.given.triangles.size()) return fill_solid(std::move(source), options, progress);
    remove_duplicates(source);
    Decimated coarse = decimate(std::move(source.distinct_surface()), target, options.threads, progress);
    Solid solid = fill_solid(Source{coarse.surface, {}, {}, {}}, options, progress);
    restore_source_faces(std::move(coarse), solid.surface);
    note_duplicates(source, solid.surface);
    return solid;
}

}  // namespace partwheel
