// The C functions of builds and hierarchies: argument checks and calls into the layers, nothing else.
#include "api_common.h"
#include "convex/convex_parts.h"
#include "edit/polygons.h"
#include "pipeline.h"
#include "tree/saved.h"

#include <cstdio>

using namespace partwheel;

struct pw_convex_parts {
    std::vector<ConvexPart> parts;
};

namespace {

constexpr double min_quality = 1.1;
constexpr size_t min_hull_vertices = 8;  // a box has 8
constexpr size_t default_exact_triangles = 200000;

// A solid from points that is farther from the mesh, relative to the diagonal, has lost surface that encloses nothing, such as open
// ground or a windscreen: a thin solid keeps it. Not in mode PAPER, where it would be the whole model.
constexpr double max_deviation_from_points = 0.03;

// The error of this thread's last call that failed. It allocates nothing, because memory may have run out.
struct LastError {
    char message[2048];  // a longer one is truncated
    ErrorLocation location;
};
constinit thread_local LastError last_error{};

// Copies the result of compute() to the caller's array and sets the count. If the array is null, sets the count only.
template <class T, class Compute>
void copy_out(const Compute& compute, T* out, size_t capacity, size_t* count) {
    require(out != nullptr || capacity == 0, "The array to fill is null, but its capacity is not 0.");
    const std::vector<T> values = compute();
    *count = values.size();
    if (!out) return;
    if (capacity < values.size())
        throw Error(PW_ERROR_CAPACITY, "The array to fill has " + std::to_string(capacity) + " elements, but " +
                                           std::to_string(values.size()) + " are required.");
    std::copy(values.begin(), values.end(), out);
}

void require_face(const Hierarchy& hierarchy, size_t face) {
    require(face < hierarchy.face_count(), "The hierarchy has no face of this index.");
}

void require_parts(const Hierarchy& hierarchy, size_t parts) {
    require(parts >= 1 && parts <= std::min(max_parts, hierarchy.tetrahedron_count()),
            "The number of parts must be at least 1, and at most the number of tetrahedra and 4096.");
}

// The slice [tet_first, tet_last) of the tetrahedra, or the complement of [tet_last, tet_first) if tet_first is larger.
void require_slice(const Hierarchy& hierarchy, size_t tet_first, size_t tet_last) {
    require(tet_first != tet_last && std::max(tet_first, tet_last) <= hierarchy.tetrahedron_count(),
            "The tetrahedra must be a slice that is not empty: tet_first and tet_last differ and are at most their "
            "number.");
}

// A program may be older or newer than the library, and its structs shorter or longer: see the header's conventions. No
// struct ends with padding, since a later version could have a member there.
static_assert(offsetof(pw_mesh_view, index_type) + sizeof(int32_t) == sizeof(pw_mesh_view));
static_assert(offsetof(pw_build_options, mark_count) + sizeof(size_t) == sizeof(pw_build_options));
static_assert(offsetof(pw_marks, reserved) + sizeof(int32_t) == sizeof(pw_marks));
static_assert(offsetof(pw_convex_options, threads) + sizeof(size_t) == sizeof(pw_convex_options));
static_assert(offsetof(pw_arrays, score) + sizeof(double*) == sizeof(pw_arrays));
static_assert(offsetof(pw_summary, sheets) + sizeof(size_t) == sizeof(pw_summary));
static_assert(offsetof(pw_error_info, triangle) + sizeof(int64_t) == sizeof(pw_error_info));

// Writes a struct of this version to the caller's struct, of any version.
template <class Struct>
void write_struct(Struct own, Struct& caller_struct) {
    const size_t size = own.struct_size = size_of(caller_struct);
    auto* bytes = reinterpret_cast<unsigned char*>(&caller_struct);
    std::memcpy(bytes, &own, std::min(size, sizeof own));
    std::fill(bytes + std::min(size, sizeof own), bytes + size, static_cast<unsigned char>(0));
}

// Slices of the hierarchy's tetrahedra in ascending order. Throws an Error unless they are disjoint and not empty.
std::vector<std::array<int32_t, 2>> sorted_slices(std::span<const std::array<int32_t, 2>> slices,
                                                  const pw_hierarchy& hierarchy) {
    std::vector<std::array<int32_t, 2>> sorted(slices.begin(), slices.end());
    std::sort(sorted.begin(), sorted.end());
    int64_t last = 0;
    for (const auto& [from, to] : sorted) {
        require(last <= from && from < to && static_cast<size_t>(to) <= hierarchy.tetrahedron_count(),
                "The slices must be disjoint and not empty: 0 <= first < last <= the number of tetrahedra.");
        last = to;
    }
    return sorted;
}

// The kinds of marked edges of a mesh. They refer to the caller's arrays.
std::vector<EdgeMarks> read_marks(const pw_build_options& options, const MeshView& mesh) {
    std::vector<EdgeMarks> kinds;
    require(options.marks || options.mark_count == 0, "marks is null, but mark_count is not 0.");
    for (size_t i = 0; i < options.mark_count; ++i) {
        // The stride is the size of the caller's struct, which may be of another version.
        const auto* bytes = reinterpret_cast<const unsigned char*>(options.marks) + i * size_of(options.marks[0]);
        const pw_marks marks = read_struct(*reinterpret_cast<const pw_marks*>(bytes));
        const std::string name = marks.name ? marks.name : "marks";
        require(std::ranges::all_of(name, is_printable), "The name of marks must be printable ASCII.");
        EdgeMarks kind{name, items<std::array<int32_t, 2>>(marks.edges, marks.edge_count, "marks.edges", "marks.edge_count"), {},
                       marks.chosen != 0};
        if (marks.strengths) kind.strengths = {marks.strengths, marks.edge_count};
        for (const auto& edge : kind.edges)
            for (const int32_t v : edge)
                if (v < 0 || idx(v) >= mesh.vertices.size())
                    throw Error(PW_ERROR_INDEX, "A marked edge refers to vertex " + std::to_string(v) + ", which does not exist.");
        require(std::ranges::all_of(kind.strengths, [](float s) { return s >= 0 && s <= 1; }),
                "The strengths of marks must be from 0 to 1.");
        kinds.push_back(std::move(kind));
    }
    return kinds;
}

// The name of an enum's value. A C program may pass any number, and reading an enum out of range is undefined, hence
// bit_cast.
template <typename Enum>
const char* name_of(std::span<const char* const> names, const Enum& value) {
    const auto number = std::bit_cast<int>(value);
    return number >= 0 && idx(number) < names.size() ? names[idx(number)] : "unknown";
}

}  // namespace

pw_status partwheel::fail(pw_status status, const ErrorLocation& location, const char* format, const char* detail) noexcept {
    std::snprintf(last_error.message, sizeof last_error.message, format, detail);
    last_error.location = location;
    return status;
}

const char* pw_version(void) { return PW_VERSION; }

int32_t pw_edit_api_version(void) { return PW_EDIT_API_VERSION; }

const char* pw_status_name(pw_status status) {
    constexpr const char* names[] = {
        "ok", "argument", "empty", "not finite", "index", "degenerate", "open", "non-manifold", "orientation",
        "self-intersection", "no volume", "tetrahedra", "canceled", "memory", "data", "internal", "not solid", "capacity"};
    static_assert(std::size(names) == PW_ERROR_CAPACITY + 1);
    return name_of(names, status);
}

const char* pw_stage_name(pw_stage stage) {
    constexpr const char* names[] = {"surface", "repair", "tetrahedra", "cluster", "dendrogram", "hierarchy"};
    static_assert(std::size(names) == PW_STAGE_COUNT);
    return name_of(names, stage);
}

const char* pw_error_message(void) { return last_error.message; }

pw_status pw_error_details(pw_error_info* info) {
    return guarded({{"info", info}}, [&] {
        const auto& [faces, vertices, triangle] = last_error.location;
        write_struct(pw_error_info{0, {faces[0], faces[1]}, {vertices[0], vertices[1]}, triangle}, *info);
    });
}

pw_status pw_context_create(pw_context** context) {
    return guarded({{"context", context}}, [&] { *context = new pw_context; });
}

void pw_context_free(pw_context* context) { delete context; }

pw_status pw_context_cancel(pw_context* context) {
    return guarded({{"context", context}}, [&] { context->progress.cancel(); });
}

pw_status pw_context_progress(const pw_context* context, double* fraction, pw_stage* stage) {
    return guarded({{"context", context}}, [&] {
        if (fraction) *fraction = context->progress.fraction();
        if (stage) *stage = context->progress.stage();
    });
}

pw_status pw_context_fill_method(const pw_context* context, pw_fill_method* fill_method) {
    return guarded({{"context", context}, {"fill_method", fill_method}}, [&] { *fill_method = context->fill_method; });
}

pw_status pw_context_seconds(const pw_context* context, double* seconds) {
    return guarded({{"context", context}, {"seconds", seconds}}, [&] {
        for (int s = 0; s < PW_STAGE_COUNT; ++s) seconds[s] = context->progress.seconds(static_cast<pw_stage>(s));
    });
}

pw_status pw_build(pw_context* context, const pw_mesh_view* mesh, const pw_build_options* options,
                   pw_hierarchy** hierarchy) {
    return with_progress(context, {{"mesh", mesh}, {"hierarchy", hierarchy}}, [&](Progress& progress) {
        const MeshInput input = mesh_input(*mesh);
        const pw_build_options chosen = options ? read_struct(*options) : pw_build_options{};
        require(chosen.quality == 0 || (chosen.quality >= min_quality && std::isfinite(chosen.quality)),
                "quality must be 0, or a number of at least 1.1.");
        require(chosen.fill_methods <= (PW_FILL_EXACT | PW_FILL_REPAIRED | PW_FILL_POINTS | PW_FILL_SHEET),
                "fill_methods must be a sum of 1 (exact), 2 (repaired), 4 (from points) and 8 (sheets), or 0 for all.");
        require(chosen.refuse_sheets == 0 || chosen.refuse_sheets == 1, "refuse_sheets must be 0 or 1.");
        require(chosen.threads >= 0, "threads must be 0 or more.");
        require(chosen.keep_inner_walls == 0 || chosen.keep_inner_walls == 1, "keep_inner_walls must be 0 or 1.");
        require(chosen.reserved == 0, "reserved must be 0.");
        require(chosen.mode == PW_MODE_LEARNED || chosen.mode == PW_MODE_PAPER,
                "mode must be 0 (learned) or 1 (the paper's).");
        BuildOptions build;
        build.mode = chosen.mode;
        build.refuse_sheets = chosen.refuse_sheets == 1;
        build.find_inner_walls = chosen.keep_inner_walls == 0;
        build.fill.quality = chosen.quality;
        build.marks = read_marks(chosen, input);
        build.fill.fill_methods = chosen.fill_methods;
        build.fill.on_attempt = [&](pw_fill_method fill_method) { if (context) context->fill_method = fill_method; };
        build.fill.threads = static_cast<size_t>(chosen.threads);
        if (chosen.exact_triangles >= 0 && chosen.mode != PW_MODE_PAPER && chosen.fill_methods != PW_FILL_EXACT)
            build.fill.exact_triangles =
                chosen.exact_triangles == 0 ? default_exact_triangles : static_cast<size_t>(chosen.exact_triangles);
        if (chosen.mode != PW_MODE_PAPER && !build.refuse_sheets)
            build.fill.max_deviation_from_points = max_deviation_from_points;
        *hierarchy = new pw_hierarchy(build_hierarchy(input, build, progress));
    });
}

void pw_hierarchy_free(pw_hierarchy* hierarchy) { delete hierarchy; }

pw_status pw_hierarchy_arrays(const pw_hierarchy* hierarchy, pw_arrays* arrays) {
    return guarded({{"hierarchy", hierarchy}, {"arrays", arrays}}, [&] { write_struct(hierarchy->arrays(), *arrays); });
}

pw_status pw_hierarchy_summary(const pw_hierarchy* hierarchy, pw_summary* summary) {
    return guarded({{"hierarchy", hierarchy}, {"summary", summary}}, [&] {
        write_struct(hierarchy->summary(), *summary);
    });
}

const char* pw_hierarchy_notes(const pw_hierarchy* hierarchy) {
    return hierarchy ? hierarchy->notes().c_str() : "";
}

pw_status pw_hierarchy_path(const pw_hierarchy* hierarchy, size_t face, int32_t* nodes, size_t capacity,
                            size_t* count) {
    return guarded({{"hierarchy", hierarchy}, {"count", count}}, [&] {
        require_face(*hierarchy, face);
        copy_out([&] { return hierarchy->path(face); }, nodes, capacity, count);
    });
}

pw_status pw_hierarchy_wheel(const pw_hierarchy* hierarchy, size_t face, double view, int32_t* nodes, size_t capacity,
                             size_t* count, size_t* start) {
    return guarded({{"hierarchy", hierarchy}, {"count", count}, {"start", start}}, [&] {
        require_face(*hierarchy, face);
        const WheelStops wheel = hierarchy->wheel(face, view);
        copy_out([&] { return wheel.stops; }, nodes, capacity, count);
        *start = wheel.start;
    });
}

pw_status pw_hierarchy_faces(const pw_hierarchy* hierarchy, size_t node, const int32_t** faces, size_t* count) {
    return guarded({{"hierarchy", hierarchy}, {"faces", faces}, {"count", count}}, [&] {
        require(node < hierarchy->node_count(), "The hierarchy has no node of this index.");
        const std::span<const int32_t> slice = hierarchy->faces(node);
        *faces = slice.data();
        *count = slice.size();
    });
}

pw_status pw_hierarchy_with_part(pw_context* context, const pw_hierarchy* hierarchy, const int32_t* faces, size_t face_count,
                                 pw_hierarchy** result) {
    return with_progress(context, {{"hierarchy", hierarchy}, {"faces", faces}, {"result", result}}, [&](Progress& progress) {
        const std::span<const int32_t> part(faces, face_count);
        for (const int32_t f : part) {
            require(f >= 0, "Face indices must not be negative.");
            require_face(*hierarchy, static_cast<size_t>(f));
        }
        *result = new pw_hierarchy(hierarchy->with_part(part, progress));
    });
}

pw_status pw_hierarchy_cut_height(const pw_hierarchy* hierarchy, double height, int32_t* bounds, size_t capacity,
                                  size_t* count) {
    return guarded({{"hierarchy", hierarchy}, {"count", count}}, [&] {
        require(height >= 0, "height must be a number of at least 0.");
        copy_out([&] { return hierarchy->cut_height(height); }, bounds, capacity, count);
    });
}

pw_status pw_hierarchy_cut_parts(const pw_hierarchy* hierarchy, size_t parts, int32_t* bounds, size_t capacity,
                                 size_t* count) {
    return guarded({{"hierarchy", hierarchy}, {"count", count}}, [&] {
        require_parts(*hierarchy, parts);
        copy_out([&] { return hierarchy->cut_parts(parts); }, bounds, capacity, count);
    });
}

pw_status pw_hierarchy_cut_least_concavity(pw_context* context, const pw_hierarchy* hierarchy, size_t parts,
                                           int32_t* bounds, size_t capacity, size_t* count) {
    return with_progress(context, {{"hierarchy", hierarchy}, {"count", count}}, [&](Progress& progress) {
        require_parts(*hierarchy, parts);
        copy_out([&] { return hierarchy->cut_least_concavity(parts, progress); }, bounds, capacity, count);
    });
}

pw_status pw_hierarchy_cut_automatic(const pw_hierarchy* hierarchy, int32_t* bounds, size_t capacity, size_t* count) {
    return guarded({{"hierarchy", hierarchy}, {"count", count}}, [&] {
        copy_out([&] { return hierarchy->cut_automatic(); }, bounds, capacity, count);
    });
}

pw_status pw_hierarchy_hull(pw_context* context, const pw_hierarchy* hierarchy, size_t tet_first, size_t tet_last,
                            pw_mesh** mesh) {
    return with_progress(context, {{"hierarchy", hierarchy}, {"mesh", mesh}}, [&](Progress& progress) {
        require(tet_first < tet_last && tet_last <= hierarchy->tetrahedron_count(),
                "The tetrahedra must be a slice that is not empty: tet_first < tet_last <= their number.");
        *mesh = new pw_mesh{hierarchy->hull(tet_first, tet_last, progress)};
    });
}

pw_status pw_hierarchy_solid(pw_context* context, const pw_hierarchy* hierarchy, size_t tet_first, size_t tet_last,
                             pw_mesh** mesh) {
    return with_progress(context, {{"hierarchy", hierarchy}, {"mesh", mesh}}, [&](Progress& progress) {
        require_slice(*hierarchy, tet_first, tet_last);
        const SolidBuilder& solids = hierarchy->solids(progress);
        *mesh = new pw_mesh{solids.build(solids.tets_of_slice(tet_first, tet_last), progress)};
    });
}

pw_status pw_hierarchy_solid_of_slices(pw_context* context, const pw_hierarchy* hierarchy, const int32_t* slices,
                                       size_t slice_count, pw_mesh** mesh) {
    return with_progress(context, {{"hierarchy", hierarchy}, {"mesh", mesh}}, [&](Progress& progress) {
        const auto unsorted = items<std::array<int32_t, 2>>(slices, slice_count, "slices", "slice_count");
        const auto sorted = sorted_slices(unsorted, *hierarchy);
        const SolidBuilder& solids = hierarchy->solids(progress);
        *mesh = new pw_mesh{solids.build(solids.tets_of_slices(sorted), progress)};
    });
}

pw_status pw_hierarchy_solid_of_faces(pw_context* context, const pw_hierarchy* hierarchy, size_t tet_first,
                                      size_t tet_last, const uint8_t* inside, size_t face_count, pw_mesh** mesh) {
    return with_progress(context, {{"hierarchy", hierarchy}, {"inside", inside}, {"mesh", mesh}}, [&](Progress& progress) {
        require_slice(*hierarchy, tet_first, tet_last);
        require(face_count == hierarchy->face_count(), "face_count is not the number of the hierarchy's source faces.");
        const SolidBuilder& solids = hierarchy->solids(progress);
        *mesh = new pw_mesh{solids.build(solids.tets_of_faces(tet_first, tet_last, {inside, face_count}, progress), progress)};
    });
}

pw_status pw_polygon_faults(const int32_t* corners, size_t corner_count, const int32_t* begin, size_t polygon_count,
                            size_t vertex_count, size_t* non_manifold_edges, size_t* inconsistent_edges,
                            size_t* non_manifold_vertices) {
    return guarded({{"non_manifold_edges", non_manifold_edges}, {"inconsistent_edges", inconsistent_edges},
                    {"non_manifold_vertices", non_manifold_vertices}}, [&] {
        require_countable(vertex_count, "vertex_count");
        const PolygonFaults faults =
            polygon_faults(items<int32_t>(corners, corner_count, "corners", "corner_count"),
                           items<int32_t>(begin, polygon_count, "begin", "polygon_count"), vertex_count);
        *non_manifold_edges = faults.non_manifold_edges;
        *inconsistent_edges = faults.inconsistent_edges;
        *non_manifold_vertices = faults.non_manifold_vertices;
    });
}

pw_status pw_mesh_origins(const pw_mesh* mesh, const int32_t** vertices, const int32_t** faces,
                          const int32_t** neighbor_tets) {
    return guarded({{"mesh", mesh}, {"vertices", vertices}, {"faces", faces}, {"neighbor_tets", neighbor_tets}}, [&] {
        require(mesh->source_faces.size() == mesh->triangles.size(), "Only the mesh of a solid has origins; a hull has none.");
        *vertices = mesh->source_vertices.data();
        *faces = mesh->source_faces.data();
        *neighbor_tets = mesh->neighbor_tets.data();
    });
}

pw_status pw_hierarchy_convex_parts(pw_context* context, const pw_hierarchy* hierarchy,
                                    const pw_convex_options* options, pw_convex_parts** parts) {
    return with_progress(context, {{"hierarchy", hierarchy}, {"options", options}, {"parts", parts}}, [&](Progress& progress) {
        const pw_convex_options chosen = read_struct(*options);
        require(chosen.error >= 0 && std::isfinite(chosen.error), "error must be 0 or a length.");
        require(chosen.keep_open >= 0 && std::isfinite(chosen.keep_open), "keep_open must be 0 or a radius.");
        require((chosen.hulls > 0) != (chosen.error > 0), "Set either hulls or error to more than 0, and the other to 0.");
        require(chosen.hulls <= max_parts, "hulls must be at most 4096.");
        require(chosen.max_vertices == 0 || chosen.max_vertices >= min_hull_vertices,
                "max_vertices must be 0 for any number, or at least 8.");
        const auto slices =
            sorted_slices(items<std::array<int32_t, 2>>(chosen.slices, chosen.slice_count, "slices", "slice_count"), *hierarchy);
        *parts = new pw_convex_parts{convex_parts(
            *hierarchy, {chosen.hulls, chosen.error, chosen.max_vertices, chosen.keep_open, slices, chosen.threads}, progress)};
    });
}

void pw_convex_parts_free(pw_convex_parts* parts) { delete parts; }

pw_status pw_convex_parts_count(const pw_convex_parts* parts, size_t* count) {
    return guarded({{"parts", parts}, {"count", count}}, [&] { *count = parts->parts.size(); });
}

pw_status pw_convex_parts_hull(const pw_convex_parts* parts, size_t index, const double** vertices,
                               size_t* vertex_count, const int32_t** triangles, size_t* triangle_count, double* volume,
                               double* error) {
    return guarded({{"parts", parts}, {"vertices", vertices}, {"vertex_count", vertex_count}, {"triangles", triangles},
                    {"triangle_count", triangle_count}, {"volume", volume}, {"error", error}},
                   [&] {
                       require(index < parts->parts.size(), "There is no hull of this index.");
                       const ConvexPart& part = parts->parts[index];
                       *vertices = part.hull.vertices.data()->data();
                       *vertex_count = part.hull.vertices.size();
                       *triangles = part.hull.triangles.data()->data();
                       *triangle_count = part.hull.triangles.size();
                       *volume = part.volume;
                       *error = part.error;
                   });
}

void pw_mesh_free(pw_mesh* mesh) { delete mesh; }

pw_status pw_mesh_arrays(const pw_mesh* mesh, const double** vertices, size_t* vertex_count, const int32_t** triangles,
                         size_t* triangle_count) {
    return guarded({{"mesh", mesh}, {"vertices", vertices}, {"vertex_count", vertex_count}, {"triangles", triangles},
                    {"triangle_count", triangle_count}}, [&] {
        *vertices = reinterpret_cast<const double*>(mesh->vertices.data());
        *vertex_count = mesh->vertices.size();
        *triangles = reinterpret_cast<const int32_t*>(mesh->triangles.data());
        *triangle_count = mesh->triangles.size();
    });
}

pw_status pw_hierarchy_save(pw_context* context, const pw_hierarchy* hierarchy, uint8_t* bytes, size_t capacity,
                            size_t* count) {
    return with_progress(context, {{"hierarchy", hierarchy}, {"count", count}}, [&](Progress& progress) {
        copy_out([&] { return hierarchy->save(progress); }, bytes, capacity, count);
    });
}

int32_t pw_saved_format(void) { return partwheel::saved_format; }

pw_status pw_hierarchy_load(pw_context* context, const uint8_t* bytes, size_t count, pw_hierarchy** hierarchy) {
    return with_progress(context, {{"hierarchy", hierarchy}}, [&](Progress& progress) {
        require(bytes != nullptr || count == 0, "bytes is null, but count is not 0.");
        require(count <= PTRDIFF_MAX, "count is more bytes than any memory has.");
        *hierarchy = new pw_hierarchy(Hierarchy::load({bytes, count}, progress));
    });
}
