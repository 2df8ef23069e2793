// The C functions: argument checks and calls into the layers, nothing else.
#include "partwheel_edit.h"

#include "base/parallel.h"
#include "pipeline.h"
#include "tree/saved.h"
#include "edit/border.h"
#include "convex/convex_parts.h"
#include "edit/deform.h"
#include "edit/fair.h"
#include "edit/seams.h"
#include "edit/surface_measures.h"
#include "query/part_index.h"
#include "edit/polygons.h"
#include "mesh/rays.h"
#include "edit/solid.h"
#include "mesh/duplicates.h"
#include "mesh/mesh_input.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <memory>
#include <new>
#include <span>
#include <string>

using namespace partwheel;

struct pw_context {
    Progress progress;
    std::atomic<pw_fill_method> fill_method{PW_FILL_EXACT};
};

struct pw_hierarchy : Hierarchy {
    explicit pw_hierarchy(Hierarchy&& hierarchy) : Hierarchy(std::move(hierarchy)) {}
    const Solids solids{*this};
};

struct pw_mesh : TriangleMesh {};

struct pw_convex_parts {
    std::vector<ConvexPart> parts;
};

struct pw_deformation : Deformation {
    using Deformation::Deformation;
};

struct pw_creases : Creases {
    using Creases::Creases;
};

struct pw_ray_target : RayTarget {
    using RayTarget::RayTarget;
};

struct pw_index {
    PartIndex parts;
    size_t threads;
};

namespace {

constexpr double min_quality = 1.1;
constexpr size_t min_hull_vertices = 8;  // a box has 8
constexpr size_t default_exact_triangles = 200000;
constexpr size_t max_struct_size = 4096;  // bytes; a larger struct_size was never set

// The error of this thread's last call that failed. It allocates nothing, because memory may have run out.
struct LastError {
    char message[2048];  // a longer one is truncated
    ErrorLocation location;
};
constinit thread_local LastError last_error{};

pw_status fail(pw_status status, const ErrorLocation& location, const char* format, const char* detail = "") noexcept {
    std::snprintf(last_error.message, sizeof last_error.message, format, detail);
    last_error.location = location;
    return status;
}

void require(bool condition, const std::string& message) {
    if (!condition) throw Error(PW_ERROR_ARGUMENT, message);
}

// An argument that must not be null.
struct RequiredPointer {
    const char* name;
    const void* pointer;
};

void require_all(std::initializer_list<RequiredPointer> required) {
    if (std::ranges::all_of(required, [](const RequiredPointer& argument) { return argument.pointer != nullptr; })) return;
    std::string names;
    for (const RequiredPointer& argument : required) {
        const bool first = &argument == required.begin(), last = &argument == required.end() - 1;
        names.append(first ? "" : last ? " and " : ", ").append(argument.name);
    }
    require(false, names + " must not be null.");
}

// Runs the body of a function if no required pointer is null; turns exceptions into a status and a message.
template <class Body>
pw_status guarded(std::initializer_list<RequiredPointer> required, Body&& body) noexcept {
    try {
        require_all(required);
        body();
        return PW_OK;
    } catch (const Error& e) {
        return fail(e.status(), e.location(), "%s", e.what());
    } catch (const std::bad_alloc&) {
        return fail(PW_ERROR_MEMORY, {}, "There is not enough memory. Close other programs, or decimate the mesh.");
    } catch (const std::exception& e) {
        return fail(PW_ERROR_INTERNAL, {}, "An unexpected error occurred (%s). Please report this mesh.", e.what());
    } catch (...) {
        return fail(PW_ERROR_INTERNAL, {}, "An unexpected error occurred. Please report this mesh.");
    }
}

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
    require(face < hierarchy.face_count(), "There is no face of this index in the hierarchy.");
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

// Runs the body of a function that takes a context, with the context's progress. Ignores a cancellation after the body
// has returned.
template <class Body>
pw_status with_progress(pw_context* context, std::initializer_list<RequiredPointer> required, Body&& body) noexcept {
    return guarded(required, [&] {
        Progress unobserved;
        Progress& progress = context ? context->progress : unobserved;
        struct Watch {
            Progress& progress;
            explicit Watch(Progress& watched_progress) : progress(watched_progress) { progress.begin(); }
            ~Watch() { progress.end(); }
        } watch(progress);
        body(progress);
        progress.finish();
    });
}

// A program may be older or newer than the library, and its structs shorter or longer: see the header's conventions. No
// struct ends with padding, since a later version could have a member there.
static_assert(offsetof(pw_mesh_view, index_type) + sizeof(int32_t) == sizeof(pw_mesh_view));
static_assert(offsetof(pw_build_options, mark_count) + sizeof(size_t) == sizeof(pw_build_options));
static_assert(offsetof(pw_marks, edge_count) + sizeof(size_t) == sizeof(pw_marks));
static_assert(offsetof(pw_convex_options, slice_count) + sizeof(size_t) == sizeof(pw_convex_options));
static_assert(offsetof(pw_arrays, score) + sizeof(double*) == sizeof(pw_arrays));
static_assert(offsetof(pw_summary, sheets) + sizeof(size_t) == sizeof(pw_summary));
static_assert(offsetof(pw_error_info, triangle) + sizeof(int64_t) == sizeof(pw_error_info));

template <class Struct>
size_t size_of(const Struct& caller_struct) {
    const size_t size = caller_struct.struct_size;
    require(size >= sizeof size && size <= max_struct_size && size % alignof(Struct) == 0,
            "struct_size must be the struct's sizeof. Set it before the call.");
    return size;
}

// Converts the caller's struct, of any version, to this version.
template <class Struct>
Struct read_struct(const Struct& caller_struct) {
    Struct own{};
    const size_t size = size_of(caller_struct);
    const auto* bytes = reinterpret_cast<const unsigned char*>(&caller_struct);
    std::memcpy(&own, bytes, std::min(size, sizeof own));
    require(std::all_of(bytes + std::min(size, sizeof own), bytes + size, [](unsigned char byte) { return byte == 0; }),
            "The call uses options of a later version of Partwheel's library. Install that version, or leave the new "
            "members at 0.");
    return own;
}

// Writes a struct of this version to the caller's struct, of any version.
template <class Struct>
void write_struct(Struct own, Struct& caller_struct) {
    const size_t size = own.struct_size = size_of(caller_struct);
    auto* bytes = reinterpret_cast<unsigned char*>(&caller_struct);
    std::memcpy(bytes, &own, std::min(size, sizeof own));
    std::fill(bytes + std::min(size, sizeof own), bytes + size, static_cast<unsigned char>(0));
}

// The caller's array as `count` items of several numbers each.
template <class Item, class Number>
std::span<const Item> items(const Number* numbers, size_t count, const char* name, const char* count_name) {
    if (!numbers && count != 0)
        throw Error(PW_ERROR_ARGUMENT, std::string(name) + " is null, but " + count_name + " is not 0.");
    require_countable(count, count_name);
    return {reinterpret_cast<const Item*>(numbers), count};
}

std::span<const Point> as_points(const double* vertices, size_t count) {
    return items<Point>(vertices, count, "vertices", "vertex_count");
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

// The mesh with each triangle as a face of its own.
MeshView without_faces(const MeshView& mesh) { return {mesh.vertices, mesh.triangles, {}, mesh.triangles.size()}; }

// The caller's mesh, of any version.
MeshInput mesh_input(const pw_mesh_view& mesh) { return MeshInput(read_struct(mesh)); }

void require_seam_arguments(const Hierarchy& hierarchy, const MeshView& mesh, double max_distortion) {
    require(max_distortion > 1 && std::isfinite(max_distortion), "max_distortion must be more than 1.");
    require(mesh.face_count == hierarchy.face_count(), "face_count is not the number of the hierarchy's faces.");
}

// The kinds of marked edges of a mesh. They refer to the caller's arrays.
std::vector<EdgeMarks> read_marks(const pw_build_options& options, const MeshView& mesh) {
    std::vector<EdgeMarks> kinds;
    require(options.marks || options.mark_count == 0, "marks is null, but mark_count is not 0.");
    for (size_t i = 0; i < options.mark_count; ++i) {
        // An array of a caller's structs is as far apart as their own size says.
        const auto* bytes = reinterpret_cast<const unsigned char*>(options.marks) + i * size_of(options.marks[0]);
        const pw_marks marks = read_struct(*reinterpret_cast<const pw_marks*>(bytes));
        const std::string name = marks.name ? marks.name : "marks";
        require(std::ranges::all_of(name, is_printable), "The name of marks must be printable ASCII.");
        EdgeMarks kind{name, items<std::array<int32_t, 2>>(marks.edges, marks.edge_count, "marks.edges", "marks.edge_count"), {}};
        if (marks.strengths) kind.strengths = {marks.strengths, marks.edge_count};
        for (const auto& edge : kind.edges)
            for (const int32_t v : edge)
                if (v < 0 || idx(v) >= mesh.vertices.size())
                    throw Error(PW_ERROR_INDEX, "A marked edge has vertex " + std::to_string(v) + ", which does not exist.");
        require(std::ranges::all_of(kind.strengths, [](float s) { return s >= 0 && s <= 1; }),
                "The strengths of marks must be from 0 to 1.");
        kinds.push_back(std::move(kind));
    }
    return kinds;
}

// Calls answer(i) for queries 0 to count - 1 in parallel. Each call must write only its own result.
template <class Answer>
void answer_all(const pw_index& index, size_t count, Progress& progress, const Answer& answer) {
    constexpr size_t chunk_size = 256;
    std::atomic<size_t> done{0};
    ThreadPool(index.threads, count / chunk_size).parallel_for(count, chunk_size, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i) {
            if (i % 16 == 0) progress.reach(static_cast<double>(done) / static_cast<double>(count));
            answer(i);
        }
        done += last - first;
    });
}

// Throws an Error unless all numbers are finite and at most 1e100 in size.
template <class Item>
void require_measurable(std::span<const Item> rows, const char* name) {
    constexpr double largest = 1e100;
    for (size_t i = 0; i < rows.size(); ++i)
        if (!std::ranges::all_of(rows[i], [](double x) { return std::fabs(x) <= largest; }))
            throw Error(PW_ERROR_NOT_FINITE, std::string(name) + ", row " + std::to_string(i) +
                                                 ", has a number that is NaN, infinite, or beyond 1e100.");
}

// The name of an enum's value. A C program may pass any number, and reading an enum out of range is undefined, hence
// bit_cast.
template <typename Enum>
const char* name_of(std::span<const char* const> names, const Enum& value) {
    const auto number = std::bit_cast<int>(value);
    return number >= 0 && idx(number) < names.size() ? names[idx(number)] : "unknown";
}

}  // namespace

const char* pw_version(void) { return PW_VERSION; }

int32_t pw_version_number(void) { return PW_VERSION_NUMBER; }

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
        require(node < hierarchy->node_count(), "There is no node of this index in the hierarchy.");
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
            require(f >= 0, "There is no face of a negative number.");
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
                             const int32_t* middles, size_t middle_count, pw_mesh** mesh) {
    return with_progress(context, {{"hierarchy", hierarchy}, {"mesh", mesh}}, [&](Progress& progress) {
        (void)items<std::array<int32_t, 2>>(middles, middle_count, "middles", "middle_count");  // nothing has midpoints
        require_slice(*hierarchy, tet_first, tet_last);
        *mesh = new pw_mesh{hierarchy->solids.solid(tet_first, tet_last, progress)};
    });
}

pw_status pw_hierarchy_solid_of_slices(pw_context* context, const pw_hierarchy* hierarchy, const int32_t* slices,
                                       size_t slice_count, const int32_t* middles, size_t middle_count,
                                       pw_mesh** mesh) {
    return with_progress(context, {{"hierarchy", hierarchy}, {"mesh", mesh}}, [&](Progress& progress) {
        const auto unsorted = items<std::array<int32_t, 2>>(slices, slice_count, "slices", "slice_count");
        (void)items<std::array<int32_t, 2>>(middles, middle_count, "middles", "middle_count");  // nothing has midpoints
        *mesh = new pw_mesh{hierarchy->solids.solid(sorted_slices(unsorted, *hierarchy), progress)};
    });
}

pw_status pw_hierarchy_solid_of_faces(pw_context* context, const pw_hierarchy* hierarchy, size_t tet_first,
                                      size_t tet_last, const uint8_t* inside, size_t face_count, pw_mesh** mesh) {
    return with_progress(context, {{"hierarchy", hierarchy}, {"inside", inside}, {"mesh", mesh}}, [&](Progress& progress) {
        require_slice(*hierarchy, tet_first, tet_last);
        require(face_count == hierarchy->face_count(), "face_count is not the number of the hierarchy's source faces.");
        *mesh = new pw_mesh{hierarchy->solids.solid_of_faces(tet_first, tet_last, {inside, face_count}, progress)};
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

pw_status pw_mesh_origins(const pw_mesh* mesh, const int32_t** ends, const int32_t** faces, const int32_t** beyond) {
    return guarded({{"mesh", mesh}, {"ends", ends}, {"faces", faces}, {"beyond", beyond}}, [&] {
        require(mesh->source_faces.size() == mesh->triangles.size(), "Only the mesh of a solid has origins, not a hull.");
        *ends = mesh->source_edges.data()->data();
        *faces = mesh->source_faces.data();
        *beyond = mesh->neighbor_tets.data();
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
            *hierarchy, {chosen.hulls, chosen.error, chosen.max_vertices, chosen.keep_open, slices}, progress)};
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

pw_status pw_hierarchy_load(pw_context* context, const uint8_t* bytes, size_t count, pw_hierarchy** hierarchy) {
    return with_progress(context, {{"hierarchy", hierarchy}}, [&](Progress& progress) {
        require(bytes != nullptr || count == 0, "bytes is null, but count is not 0.");
        require(count <= PTRDIFF_MAX, "count is more bytes than any memory has.");
        *hierarchy = new pw_hierarchy(Hierarchy::load({bytes, count}, progress));
    });
}

pw_status pw_deformation_create(pw_context* context, const pw_mesh_view* mesh, const int32_t* roles, int32_t threads,
                                pw_deformation** deformation) {
    return with_progress(context, {{"mesh", mesh}, {"deformation", deformation}}, [&](Progress& progress) {
        const MeshInput input = mesh_input(*mesh);
        const MeshView& view = input;
        require(roles != nullptr || view.vertices.empty(), "roles is null, but vertex_count is not 0.");
        require(threads >= 0, "threads must be 0 or more.");
        *deformation = new pw_deformation(view.vertices, view.triangles, std::span(roles, view.vertices.size()),
                                          static_cast<size_t>(threads), progress);
    });
}

void pw_deformation_free(pw_deformation* deformation) { delete deformation; }

pw_status pw_deformation_move(pw_deformation* deformation, size_t handle, const double* matrix) {
    return guarded({{"deformation", deformation}, {"matrix", matrix}}, [&] {
        require(handle < deformation->handle_count(), "There is no handle of this number.");
        Affine rows;
        std::copy_n(matrix, rows.size(), rows.begin());
        deformation->move(handle, rows);
    });
}

pw_status pw_deformation_iterate(pw_context* context, pw_deformation* deformation, size_t iterations) {
    return with_progress(context, {{"deformation", deformation}}, [&](Progress& progress) {
        for (size_t i = 0; i < iterations; ++i) {
            progress.reach(static_cast<double>(i) / static_cast<double>(iterations));
            deformation->iterate(1);
        }
    });
}

pw_status pw_deformation_energy(pw_deformation* deformation, double* energy) {
    return guarded({{"deformation", deformation}, {"energy", energy}}, [&] { *energy = deformation->energy(); });
}

pw_status pw_deformation_positions(const pw_deformation* deformation, double* positions, size_t vertex_count) {
    return guarded({{"deformation", deformation}, {"positions", positions}}, [&] {
        require(vertex_count == deformation->vertex_count(),
                "vertex_count is not the deformation's number of vertices.");
        deformation->positions({reinterpret_cast<Point*>(positions), vertex_count});
    });
}

pw_status pw_deformation_reset(pw_deformation* deformation) {
    return guarded({{"deformation", deformation}}, [&] { deformation->reset(); });
}

pw_status pw_duplicate_faces(pw_context* context, const pw_mesh_view* mesh, int32_t* original) {
    return with_progress(context, {{"mesh", mesh}, {"original", original}}, [&](Progress& progress) {
        const MeshInput input = mesh_input(*mesh);
        progress.reach(0.1);
        const Surface surface = read_mesh(input);
        progress.reach(0.4);
        const std::vector<int32_t> duplicates = find_duplicates(surface);
        progress.reach(0.9);
        std::ranges::copy(duplicates, original);
    });
}

pw_status pw_vertex_normals(const pw_mesh_view* mesh, double* normals) {
    return guarded({{"mesh", mesh}}, [&] {
        const MeshInput input = mesh_input(*mesh);
        const MeshView& view = input;
        require(normals != nullptr || view.vertices.empty(), "normals must not be null.");
        vertex_normals(view.vertices, view.triangles, {reinterpret_cast<Point*>(normals), view.vertices.size()});
    });
}

pw_status pw_surface_distances(pw_context* context, const pw_mesh_view* mesh, const uint8_t* start, double* distance) {
    return with_progress(context, {{"mesh", mesh}}, [&](Progress& progress) {
        const MeshInput input = mesh_input(*mesh);
        const MeshView& view = input;
        const size_t count = view.vertices.size();
        require((start != nullptr && distance != nullptr) || count == 0, "start and distance must not be null.");
        std::ranges::copy(surface_distances(view.vertices, view.triangles, {start, count}, progress), distance);
    });
}

pw_status pw_fair_vertices(pw_context* context, const double* vertices, size_t vertex_count, const int32_t* edges,
                           size_t edge_count, const uint8_t* free, double* result) {
    return with_progress(context, {}, [&](Progress& progress) {
        require((vertices != nullptr && free != nullptr && result != nullptr) || vertex_count == 0,
                "vertices, free and result must not be null.");
        const auto pairs = items<std::array<int32_t, 2>>(edges, edge_count, "edges", "edge_count");
        std::ranges::copy(fair_vertices(as_points(vertices, vertex_count), pairs, {free, vertex_count}, progress),
                          reinterpret_cast<Point*>(result));
    });
}

pw_status pw_creases_create(pw_context* context, const pw_mesh_view* mesh, pw_creases** creases) {
    return with_progress(context, {{"mesh", mesh}, {"creases", creases}}, [&](Progress& progress) {
        *creases = new pw_creases(mesh_input(*mesh), progress);
    });
}

void pw_creases_free(pw_creases* creases) { delete creases; }

pw_status pw_creases_snap(const pw_creases* creases, const uint8_t* inside, size_t face_count, uint8_t* result) {
    return guarded({{"creases", creases}, {"inside", inside}, {"result", result}}, [&] {
        require(face_count == creases->count(), "face_count is not the number of the surface's faces.");
        snap_border(*creases, {inside, face_count}, {result, face_count});
    });
}

pw_status pw_hierarchy_seams(pw_context* context, const pw_hierarchy* hierarchy, const pw_mesh_view* mesh,
                             const int32_t* labels, double max_distortion, uint8_t* is_seam) {
    const auto required = {RequiredPointer{"hierarchy", hierarchy}, {"mesh", mesh}, {"labels", labels}, {"is_seam", is_seam}};
    return with_progress(context, required, [&](Progress& progress) {
        const MeshInput input = mesh_input(*mesh);
        require_seam_arguments(*hierarchy, input, max_distortion);
        const std::span<const int32_t> parts(labels, hierarchy->face_count());
        require(std::ranges::all_of(parts, [&](int32_t part) { return part >= 0 && idx(part) < parts.size(); }),
                "labels must be from 0 to face_count - 1.");
        std::ranges::copy(find_seams(*hierarchy, input, parts, max_distortion, progress), is_seam);
    });
}

pw_status pw_hierarchy_refine_seams(pw_context* context, const pw_hierarchy* hierarchy, const pw_mesh_view* mesh,
                                    const double* uvs, double max_distortion, uint8_t* is_seam) {
    const auto required = {RequiredPointer{"hierarchy", hierarchy}, {"mesh", mesh}, {"uvs", uvs}, {"is_seam", is_seam}};
    return with_progress(context, required, [&](Progress& progress) {
        const MeshInput input = mesh_input(*mesh);
        require_seam_arguments(*hierarchy, input, max_distortion);
        const size_t count = input.view().triangles.size();
        refine_seams(*hierarchy, input, {reinterpret_cast<const TriangleUvs*>(uvs), count}, max_distortion,
                     {is_seam, 3 * count}, progress);
    });
}

pw_status pw_mirror_planes(pw_context* context, const pw_mesh_view* mesh, double* planes, size_t* count) {
    return with_progress(context, {{"mesh", mesh}, {"planes", planes}, {"count", count}}, [&](Progress& progress) {
        const MeshInput input = mesh_input(*mesh);
        const Surface surface = read_mesh(without_faces(input));
        const std::vector<Plane> found_planes = mirror_planes(surface.vertices, surface.triangles, progress);
        for (const Plane& plane : found_planes) {
            const Point on_plane = surface.frame.to_caller(plane.offset * plane.normal);
            planes = std::copy(plane.normal.begin(), plane.normal.end(), planes);
            *planes++ = dot(plane.normal, on_plane);
        }
        *count = found_planes.size();
    });
}

pw_status pw_ray_target_create(pw_context* context, const pw_mesh_view* mesh, pw_ray_target** target) {
    return with_progress(context, {{"mesh", mesh}, {"target", target}}, [&](Progress& progress) {
        const MeshInput input = mesh_input(*mesh);
        *target = new pw_ray_target(without_faces(input), progress);
    });
}

void pw_ray_target_free(pw_ray_target* target) { delete target; }

pw_status pw_ray_target_first(const pw_ray_target* target, const double* origin, const double* direction, double beyond,
                              int32_t* triangle, double* distance) {
    return guarded({{"target", target}, {"origin", origin}, {"direction", direction}, {"triangle", triangle},
                    {"distance", distance}}, [&] {
        const Point from = *as_points(origin, 1).data(), along = *as_points(direction, 1).data();
        const double size = length(along);
        if (!std::isfinite(length(from)) || !std::isfinite(size) || size == 0 || std::isnan(beyond))
            throw Error(PW_ERROR_NOT_FINITE, "The ray has no origin or no direction.");
        const RayHit hit = target->first_hit(from, along, beyond);
        *triangle = hit.triangle;
        *distance = hit.distance;
    });
}

pw_status pw_index_create(pw_context* context, const pw_hierarchy* hierarchy, const int32_t* bounds,
                          size_t bound_count, int32_t threads, pw_index** index) {
    return with_progress(context, {{"hierarchy", hierarchy}, {"index", index}}, [&](Progress& progress) {
        require(threads >= 0, "threads must be 0 or more.");
        *index = new pw_index{PartIndex(*hierarchy, items<int32_t>(bounds, bound_count, "bounds", "bound_count"),
                                        progress),
                              static_cast<size_t>(threads)};
    });
}

void pw_index_free(pw_index* index) { delete index; }

pw_status pw_index_locate(pw_context* context, const pw_index* index, const double* points, size_t count,
                          int32_t* parts) {
    return with_progress(context, {{"index", index}}, [&](Progress& progress) {
        const auto queries = items<Point>(points, count, "points", "count");
        require(parts || count == 0, "parts must not be null.");
        require_measurable(queries, "points");
        answer_all(*index, count, progress, [&](size_t i) { parts[i] = index->parts.locate(queries[i]); });
    });
}

pw_status pw_index_first_hits(pw_context* context, const pw_index* index, const double* origins, const double* directions,
                              size_t count, int32_t* parts, double* distances) {
    return with_progress(context, {{"index", index}}, [&](Progress& progress) {
        const auto from = items<Point>(origins, count, "origins", "count");
        const auto along = items<Point>(directions, count, "directions", "count");
        require((parts && distances) || count == 0, "parts and distances must not be null.");
        require_measurable(from, "origins");
        require_measurable(along, "directions");
        for (const Point& d : along)
            if (d == Point{}) throw Error(PW_ERROR_NOT_FINITE, "A ray has the direction 0, 0, 0.");
        answer_all(*index, count, progress, [&](size_t i) {
            const RayHit hit = index->parts.first_hit(from[i], along[i]);
            parts[i] = hit.triangle;
            distances[i] = hit.distance;
        });
    });
}

pw_status pw_index_nearest(pw_context* context, const pw_index* index, const double* points, size_t count, int32_t* parts,
                           double* distances, double* nearest) {
    return with_progress(context, {{"index", index}}, [&](Progress& progress) {
        const auto queries = items<Point>(points, count, "points", "count");
        require((parts && distances && nearest) || count == 0, "parts, distances and nearest must not be null.");
        require_measurable(queries, "points");
        answer_all(*index, count, progress, [&](size_t i) {
            const NearestPart near = index->parts.nearest(queries[i]);
            parts[i] = near.part;
            distances[i] = near.distance;
            std::ranges::copy(near.point, nearest + 3 * i);
        });
    });
}

pw_status pw_index_intersects(pw_context* context, const pw_index* index, const pw_index* other, const double* matrices,
                              size_t count, int32_t* parts, double* points) {
    return with_progress(context, {{"index", index}, {"other", other}}, [&](Progress& progress) {
        const auto transforms = items<Affine>(matrices, count, "matrices", "count");
        require((parts && points) || count == 0, "parts and points must not be null.");
        require_measurable(transforms, "matrices");
        for (const Affine& m : transforms)
            if (!is_finite(compose_with_inverse(identity, m)))
                throw Error(PW_ERROR_NOT_FINITE, "A matrix leaves the other hierarchy no volume.");
        answer_all(*index, count, progress, [&](size_t i) {
            const IntersectingParts contact = index->parts.intersect(other->parts, transforms[i]);
            std::ranges::copy(contact.parts, parts + 2 * i);
            std::ranges::copy(contact.point, points + 3 * i);
        });
    });
}
