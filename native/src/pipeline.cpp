// The whole flow: shells, tetrahedra, clusters, parts, tree; then the trees of all shells joined.
#include "pipeline.h"

#include "base/adjacency.h"
#include "base/parallel.h"
#include "base/predicates.h"
#include "fill/cavities.h"
#include "fill/sheet.h"
#include "mesh/duplicates.h"
#include "mesh/face_assignment.h"
#include "mesh/shells.h"
#include "parts/contacts.h"
#include "parts/transfer.h"
#include "prepare/double_walls.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

namespace partwheel {

namespace {

// A mesh of more shells is refused: its faces are probably split.
constexpr size_t max_shells = 20000;

// Sheets with more than this share of the area may wind around a solid together, as the patches of a CAD model do, if
// this share of their borders meets others.
constexpr double min_sheet_share = 0.3, min_matched_share = 0.8;

// Limit of the copies of a face that are compared, the lowest ones first.
constexpr size_t max_copies = 8;

// A group of fewer triangles is not examined for double walls.
constexpr size_t min_double_wall_triangles = 24;

// Least number of points on a shell that is filled from points.
constexpr size_t min_points_of_shell = 200;

// Whether the surface covers both sides of a wall, so that positions don't identify its triangles.
bool has_walls(const TetMesh& mesh) {
    std::vector<std::array<Point, 3>> places;
    for (const Triangle& f : boundary_facets(mesh)) {
        std::array<Point, 3>& corners = places.emplace_back();
        for (size_t k = 0; k < 3; ++k) corners[k] = mesh.vertices[idx(f[k])];
        std::ranges::sort(corners);
    }
    std::ranges::sort(places);
    return std::ranges::adjacent_find(places) != places.end();
}

// The patches of the whole mesh, and the patch of each face of a shell, or -1. Empty: it has none.
struct ShellPatches {
    const Patches& all;
    std::vector<int32_t> of_face;
};

// One solid: tetrahedra -> clusters -> parts -> tree. If the mesh is noisy or has added points, a proxy without them is
// clustered, and its parts are transferred.
Hierarchy build_shell(const MeshView& mesh, const ShellPatches& patches, const BuildOptions& options, Progress& progress) {
    const bool paper = options.mode == PW_MODE_PAPER;
    Solid solid = fill_solid(mesh, options.fill, progress);
    std::optional<TetMesh> proxy;
    if (!paper && !solid.surface_from_tetrahedra) proxy = fill_proxy(solid, options.fill.quality > 0, progress);
    const TetMesh& mesh_of_parts = proxy ? *proxy : solid.mesh;
    std::optional<Regions> regions;
    if (!patches.of_face.empty()) {
        const std::vector<int32_t> of_triangle = assign_patches(solid.surface, patches.of_face);
        divide_tetrahedra(solid.mesh, solid.surface, of_triangle, progress);
        if (proxy) divide_tetrahedra(*proxy, solid.surface, of_triangle, progress);
        regions.emplace(mesh_of_parts, solid.surface, patches.all, of_triangle, progress);
        if (regions->count == 1) regions.reset();
    }
    progress.enter(PW_STAGE_CLUSTER);
    ScoredTree tree{regions ? cluster_in_regions(mesh_of_parts, *regions, progress, options.fill.threads)
                            : cluster(mesh_of_parts, progress, options.fill.threads),
                    {}};
    progress.enter(PW_STAGE_DENDROGRAM);
    const double own = proxy ? 0.4 : 1;  // share of the stage, see Progress::Section
    if (!paper) {
        const Progress::Section first(progress, 0, own);
        std::vector<Plane> planes;
        const bool is_convex = tree.tree.merges.empty() || tree.tree.merges.back().concavity <= 0;  // that is one part
        if (options.find_symmetry && !is_convex && !regions && (!solid.surface_from_tetrahedra || !has_walls(solid.mesh)))
            planes = mirror_planes(mesh_of_parts.vertices, boundary_facets(mesh_of_parts), progress);
        tree = merge_parts(mesh_of_parts, tree.tree, planes, progress, {}, nullptr, regions ? &*regions : nullptr);
    }
    if (proxy) {
        const Progress::Section second(progress, own, 1);
        tree = transfer_parts(*proxy, tree, solid, progress, options.fill.threads);
    }
    progress.enter(PW_STAGE_HIERARCHY);
    Hierarchy hierarchy(solid.surface, solid.mesh, tree, mesh.vertices);
    progress.advance(1);
    return hierarchy;
}

// A copy of some triangles of a mesh, and the numbers that its vertices and faces have there.
struct SubMesh {
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;
    std::vector<int32_t> faces, vertex_numbers, face_numbers;
    double area = 0;
    size_t welded = 0;  // vertices that were merged with others

    MeshView view() const { return {vertices, triangles, faces, face_numbers.size()}; }
    // The triangle with the vertex numbers of the whole mesh.
    Triangle source_triangle(size_t t) const {
        const Triangle& c = triangles[t];
        return {vertex_numbers[idx(c[0])], vertex_numbers[idx(c[1])], vertex_numbers[idx(c[2])]};
    }
};

// Builds the hierarchy of an assembly.
class Assembly {
public:
    // inner_walls: of each triangle the outer one that it lies behind, or -1; none: there is no double wall.
    Assembly(const MeshView& mesh, Shells shells, const Patches& patches, const std::vector<int32_t>& inner_walls,
             const BuildOptions& options, Progress& progress)
        : mesh_(mesh), patches_(patches), options_(options), progress_(progress), shells_(std::move(shells)), original_(mesh.face_count),
          left_out_(mesh.triangles.size(), false) {
        std::iota(original_.begin(), original_.end(), 0);
        leave_out(inner_walls);
    }

    Hierarchy build() {
        find_duplicate_shells();
        std::vector<SubMesh> parts = split();
        for (const SubMesh& part : parts) {
            whole_area_ += part.area;
            whole_triangles_ += part.triangles.size();
        }
        std::vector<std::optional<Hierarchy>> built = build_all(parts);
        std::vector<SubMesh> degenerate;
        for (size_t s = 0; s < parts.size(); ++s) {
            if (!built[s] && !allows(PW_FILL_SHEET)) throw_error_of(parts[s]);
            if (built[s]) built_.push_back(std::move(*built[s]));
            (built[s] ? parts_ : degenerate).push_back(std::move(parts[s]));
        }
        if (built_.empty()) throw_error_of(degenerate.front());
        if (allows(PW_FILL_POINTS)) fill_sheets_together();
        attach(degenerate);
        return join();
    }

private:
    void leave_out(const std::vector<int32_t>& inner_walls);
    void find_duplicate_shells();
    std::vector<SubMesh> split() const;
    std::vector<std::optional<Hierarchy>> build_all(const std::vector<SubMesh>& parts);
    std::optional<Hierarchy> try_to_build(const SubMesh& part, uint32_t fill_methods, size_t threads, Progress& progress) const;
    void fill_sheets_together();
    void attach(const std::vector<SubMesh>& degenerate);
    Hierarchy join();
    [[noreturn]] void throw_error_of(const SubMesh& part) const;
    bool allows(pw_fill_method method) const {
        return options_.fill.fill_methods == 0 || (options_.fill.fill_methods & method) != 0;
    }
    int32_t face_of(size_t triangle) const {
        return mesh_.faces.empty() ? static_cast<int32_t>(triangle) : mesh_.faces[triangle];
    }

    const MeshView& mesh_;
    const Patches& patches_;
    const BuildOptions& options_;
    Progress& progress_;
    Shells shells_;
    std::vector<int32_t> original_;  // of each face, the one that it goes with
    std::vector<bool> left_out_;       // of each triangle: its face goes with another
    std::vector<int32_t> duplicates_;  // faces of shells that are copies
    std::vector<int32_t> inner_;       // faces of inner walls
    std::vector<SubMesh> parts_;       // those that are built
    std::vector<Hierarchy> built_;
    double whole_area_ = 0;
    size_t whole_triangles_ = 0;
};

// Faces whose triangles all belong to an inner wall go with the outer wall.
void Assembly::leave_out(const std::vector<int32_t>& inner_walls) {
    if (inner_walls.empty()) return;
    std::vector<bool> is_outer(mesh_.face_count, false);
    for (size_t t = 0; t < inner_walls.size(); ++t)
        if (inner_walls[t] < 0) is_outer[idx(face_of(t))] = true;
    for (size_t t = 0; t < inner_walls.size(); ++t) {
        const auto face = idx(face_of(t));
        if (is_outer[face]) continue;
        left_out_[t] = true;
        if (original_[face] == static_cast<int32_t>(face)) inner_.push_back(static_cast<int32_t>(face));
        original_[face] = face_of(idx(inner_walls[t]));
    }
}

// Shells that are copies of another one, or of faces of it: their faces go with the other's.
void Assembly::find_duplicate_shells() {
    if (shells_.count == 1) return;
    const std::vector<int32_t> original = find_duplicates(read_mesh(mesh_));
    if (count_duplicates(original) == 0) return;
    std::vector<bool> left_out(shells_.count, false), is_copy(shells_.count, false);
    for (size_t t = 0; t < left_out_.size(); ++t)
        if (left_out_[t]) left_out[idx(shells_.of_triangle[t])] = true;  // not whole
    std::vector<int32_t> shell(mesh_.face_count);
    for (size_t t = 0; t < mesh_.triangles.size(); ++t) shell[idx(face_of(t))] = shells_.of_triangle[t];
    const auto by = [&](size_t keys, const std::vector<int32_t>& key) {
        return CsrArray<int32_t>(keys, [&](const auto& put) {
            for (size_t f = 0; f < key.size(); ++f) put(idx(key[f]), static_cast<int32_t>(f));
        });
    };
    const CsrArray<int32_t> equals = by(mesh_.face_count, original), faces = by(shells_.count, shell);
    for (size_t s = shells_.count; s-- > 0;) {
        std::vector<int32_t> others, common;  // shells that have a copy of each face so far
        for (const int32_t f : faces.row(s)) {
            const bool is_first = f == faces.row(s).front();
            std::vector<int32_t> of_face;
            for (const int32_t g : equals.row(idx(original[idx(f)]))) {
                if (of_face.size() == max_copies) break;
                if (const int32_t other = shell[idx(g)]; idx(other) != s && !left_out[idx(other)]) of_face.push_back(other);
            }
            std::ranges::sort(of_face);
            common.clear();
            std::ranges::set_intersection(is_first ? of_face : others, of_face, std::back_inserter(common));
            others.swap(common);
            if (others.empty()) break;
        }
        if (others.empty()) continue;
        left_out[s] = is_copy[s] = true;
        for (const int32_t f : faces.row(s))
            for (const int32_t g : equals.row(idx(original[idx(f)]))) {
                if (shell[idx(g)] != others.front()) continue;
                original_[idx(f)] = g;
                break;
            }
        duplicates_.insert(duplicates_.end(), faces.row(s).begin(), faces.row(s).end());
    }
    for (size_t t = 0; t < left_out_.size(); ++t)
        if (is_copy[idx(shells_.of_triangle[t])]) left_out_[t] = true;
}

// A sub-mesh for each shell. Vertices and faces keep their order.
std::vector<SubMesh> Assembly::split() const {
    std::vector<SubMesh> parts(shells_.count);
    std::vector<int32_t> shell_of_vertex(mesh_.vertices.size(), -1), shell_of_face(mesh_.face_count, -1);
    for (size_t t = 0; t < mesh_.triangles.size(); ++t) {
        const int32_t shell = shells_.of_triangle[t];
        if (left_out_[t]) continue;
        shell_of_face[idx(face_of(t))] = shell;
        for (const int32_t v : mesh_.triangles[t]) shell_of_vertex[idx(shells_.vertex[idx(v)])] = shell;
    }
    for (size_t v = 0; v < shells_.vertex.size(); ++v) {
        const int32_t merged = shells_.vertex[v];
        const int32_t shell = shell_of_vertex[idx(merged)];
        if (merged != static_cast<int32_t>(v) && shell >= 0) ++parts[idx(shell)].welded;
    }
    const auto number = [&](std::span<const int32_t> shell, auto numbers) {
        std::vector<int32_t> local(shell.size(), -1);
        for (size_t i = 0; i < shell.size(); ++i) {
            if (shell[i] < 0) continue;
            std::vector<int32_t>& of_part = parts[idx(shell[i])].*numbers;
            local[i] = static_cast<int32_t>(of_part.size());
            of_part.push_back(static_cast<int32_t>(i));
        }
        return local;
    };
    const std::vector<int32_t> vertex = number(shell_of_vertex, &SubMesh::vertex_numbers);
    const std::vector<int32_t> face = number(shell_of_face, &SubMesh::face_numbers);
    for (SubMesh& part : parts)
        for (const int32_t v : part.vertex_numbers) part.vertices.push_back(mesh_.vertices[idx(v)]);
    for (size_t t = 0; t < mesh_.triangles.size(); ++t) {
        if (left_out_[t]) continue;
        SubMesh& part = parts[idx(shells_.of_triangle[t])];
        Triangle corners = mesh_.triangles[t];
        for (int32_t& v : corners) v = vertex[idx(shells_.vertex[idx(v)])];
        part.triangles.push_back(corners);
        part.faces.push_back(face[idx(face_of(t))]);
        part.area += area(part.vertices[idx(corners[0])], part.vertices[idx(corners[1])], part.vertices[idx(corners[2])]);
    }
    std::erase_if(parts, [](const SubMesh& part) { return part.triangles.empty(); });
    return parts;
}

// Builds the shells, the largest ones first, so that no thread waits long for another. Each shell gets its share of the
// threads, rounded up.
std::vector<std::optional<Hierarchy>> Assembly::build_all(const std::vector<SubMesh>& parts) {
    std::vector<size_t> by_size(parts.size());
    std::iota(by_size.begin(), by_size.end(), size_t{0});
    std::ranges::stable_sort(by_size, std::greater(), [&](size_t s) { return parts[s].triangles.size(); });
    std::vector<std::optional<Hierarchy>> built(parts.size());
    const auto all_threads = static_cast<double>(thread_count(options_.fill.threads));
    Progress::Pieces pieces(progress_);
    ThreadPool(options_.fill.threads, parts.size()).parallel_for(parts.size(), 1, [&](size_t i, size_t) {
        const size_t s = by_size[i];
        const double share = static_cast<double>(parts[s].triangles.size()) / static_cast<double>(whole_triangles_);
        const auto threads = static_cast<size_t>(std::ceil(share * all_threads));
        Progress progress = pieces.piece(share);
        built[s] = try_to_build(parts[s], options_.fill.fill_methods, threads, progress);
    });
    return built;
}

// Builds a shell; returns nothing if none of these fill methods can fill it. A sheet can be filled unless it has no area.
std::optional<Hierarchy> Assembly::try_to_build(const SubMesh& part, uint32_t fill_methods, size_t threads, Progress& progress) const {
    BuildOptions options = options_;
    options.fill.fill_methods = fill_methods;
    options.fill.threads = threads;
    const double area_share = whole_area_ > 0 ? part.area / whole_area_ : 1;
    options.find_symmetry = area_share >= small_shell;  // else it is not worth its time
    const double points = std::sqrt(area_share) * static_cast<double>(options.fill.least_points);
    options.fill.least_points = std::max(min_points_of_shell, static_cast<size_t>(points));
    if (whole_triangles_ > options.fill.exact_triangles)  // a shell's proxy has its share of the whole's
        options.fill.exact_triangles =
            std::max<size_t>(1, options.fill.exact_triangles * part.triangles.size() / whole_triangles_);
    try {
        ShellPatches patches{patches_, {}};
        if (!patches_.of_face.empty())
            for (const int32_t f : part.face_numbers) patches.of_face.push_back(patches_.of_face[idx(f)]);
        return build_shell(part.view(), patches, options, progress);
    } catch (const Error& error) {
        if (!is_about_shape(error.status()) && error.status() != PW_ERROR_NOT_FINITE) throw;  // that one: too small
        return {};
    }
}

// Fills the shell again, with the caller's numbers of faces and vertices, so that the error names these.
void Assembly::throw_error_of(const SubMesh& part) const {
    std::vector<Triangle> triangles;
    std::vector<int32_t> faces;
    for (size_t t = 0; t < part.triangles.size(); ++t) triangles.push_back(part.source_triangle(t));
    for (const int32_t f : part.faces) faces.push_back(part.face_numbers[idx(f)]);
    (void)fill_solid({mesh_.vertices, triangles, faces, mesh_.face_count, true}, options_.fill, progress_);
    throw Error(PW_ERROR_INTERNAL, "A shell could not be filled the first time. Please report this mesh.");
}

// Sheets may be the patches of one surface: then that is one shell, filled from points.
void Assembly::fill_sheets_together() {
    SubMesh all;
    std::vector<size_t> sheets;
    std::vector<int32_t> of_triangle;
    for (size_t s = 0; s < built_.size(); ++s)
        if (built_[s].summary().fill_method == PW_FILL_SHEET) sheets.push_back(s);
    for (const size_t s : sheets) {
        const SubMesh& part = parts_[s];
        const auto vertex = static_cast<int32_t>(all.vertices.size()), face = static_cast<int32_t>(all.face_numbers.size());
        all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
        for (const Triangle& t : part.triangles) all.triangles.push_back({t[0] + vertex, t[1] + vertex, t[2] + vertex});
        of_triangle.resize(all.triangles.size(), static_cast<int32_t>(s));
        for (const int32_t f : part.faces) all.faces.push_back(f + face);
        all.vertex_numbers.insert(all.vertex_numbers.end(), part.vertex_numbers.begin(), part.vertex_numbers.end());
        all.face_numbers.insert(all.face_numbers.end(), part.face_numbers.begin(), part.face_numbers.end());
        all.area += part.area;
        all.welded += part.welded;
    }
    if (sheets.size() < 2 || all.area < min_sheet_share * whole_area_) return;
    if (matched_border_share(all.vertices, all.triangles, of_triangle) < min_matched_share) return;
    std::optional<Hierarchy> filled = try_to_build(all, PW_FILL_POINTS, options_.fill.threads, progress_);
    if (!filled) return;
    std::vector<SubMesh> parts;
    std::vector<Hierarchy> built;
    for (size_t s = 0; s < built_.size(); ++s) {
        if (std::ranges::binary_search(sheets, s)) continue;
        parts.push_back(std::move(parts_[s]));
        built.push_back(std::move(built_[s]));
    }
    parts.push_back(std::move(all));
    built.push_back(std::move(*filled));
    parts_ = std::move(parts);
    built_ = std::move(built);
}

// Faces of shells without area go with the nearest face.
void Assembly::attach(const std::vector<SubMesh>& degenerate) {
    if (degenerate.empty()) return;
    std::vector<Triangle> triangles;
    std::vector<int32_t> faces;
    for (const SubMesh& part : parts_)
        for (size_t t = 0; t < part.triangles.size(); ++t) {
            const Triangle corners = part.source_triangle(t);
            const auto point = [&](size_t k) -> const Point& { return mesh_.vertices[idx(corners[k])]; };
            if (collinear(point(0), point(1), point(2))) continue;
            triangles.push_back(corners);
            faces.push_back(part.face_numbers[idx(part.faces[t])]);
        }
    NearestTriangle nearest(mesh_.vertices, triangles);
    for (const SubMesh& part : degenerate) {
        const int32_t face = faces[idx(nearest(part.vertices.front()).triangle)];
        for (const int32_t f : part.face_numbers) original_[idx(f)] = face;
    }
}

Hierarchy Assembly::join() {
    for (int32_t& f : original_)  // that face may itself go with another
        while (original_[idx(f)] != f) f = original_[idx(f)];
    std::vector<Triangle> triangles;
    std::vector<int32_t> of_triangle;
    std::vector<ShellHierarchy> shells;
    for (size_t s = 0; s < parts_.size(); ++s) {
        for (size_t t = 0; t < parts_[s].triangles.size(); ++t) triangles.push_back(parts_[s].source_triangle(t));
        of_triangle.resize(triangles.size(), static_cast<int32_t>(s));
        shells.push_back({std::move(built_[s]), std::move(parts_[s].face_numbers), std::move(parts_[s].vertex_numbers), 0, 0,
                          parts_[s].welded});
    }
    std::vector<int32_t> shell(mesh_.face_count, -1);
    for (size_t s = 0; s < shells.size(); ++s)
        for (const int32_t f : shells[s].faces) shell[idx(f)] = static_cast<int32_t>(s);
    for (const int32_t f : duplicates_) ++shells[idx(shell[idx(original_[idx(f)])])].duplicates;
    for (const int32_t f : inner_) ++shells[idx(shell[idx(original_[idx(f)])])].inner_faces;
    const ShellJoins joins = join_by_contact(mesh_.vertices, triangles, of_triangle, shells.size(), progress_);
    return Hierarchy::assemble(std::move(shells), joins, mesh_.face_count, original_, progress_);
}

// For each triangle, the outer triangle that it lies behind, or -1; empty if there is no double wall. Examines each
// outermost shell together with all shells inside it.
std::vector<int32_t> find_inner_walls(const MeshView& mesh, const Shells& shells, const std::vector<int32_t>& enclosing,
                                      Progress& progress) {
    std::vector<int32_t> outermost(shells.count), inner_walls;
    for (size_t s = 0; s < shells.count; ++s) {
        outermost[s] = static_cast<int32_t>(s);
        while (enclosing[idx(outermost[s])] >= 0) outermost[s] = enclosing[idx(outermost[s])];
    }
    const CsrArray<int32_t> groups(shells.count, [&](const auto& put) {
        for (size_t t = 0; t < mesh.triangles.size(); ++t)
            put(idx(outermost[idx(shells.of_triangle[t])]), static_cast<int32_t>(t));
    });
    std::vector<int32_t> number(mesh.vertices.size(), -1);  // of each vertex in its group
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;
    for (size_t s = 0; s < shells.count; ++s) {
        const std::span<const int32_t> group = groups.row(s);
        if (group.size() < min_double_wall_triangles) continue;
        vertices.clear();
        triangles.clear();
        for (const int32_t t : group) {
            Triangle corners = mesh.triangles[idx(t)];
            for (int32_t& v : corners) {
                int32_t& n = number[idx(shells.vertex[idx(v)])];
                if (n < 0) {
                    n = static_cast<int32_t>(vertices.size());
                    vertices.push_back(mesh.vertices[idx(v)]);
                }
                v = n;
            }
            triangles.push_back(corners);
        }
        const std::vector<int32_t> outer = find_inner_walls(vertices, triangles, progress);
        if (outer.empty()) continue;
        inner_walls.resize(mesh.triangles.size(), -1);
        for (size_t i = 0; i < outer.size(); ++i)
            if (outer[i] >= 0) inner_walls[idx(group[i])] = group[idx(outer[i])];
    }
    return inner_walls;
}

Hierarchy build_assembly(const MeshView& mesh, const BuildOptions& options, Progress& progress) {
    Shells shells = find_shells(mesh);
    if (shells.count > max_shells)
        throw Error(PW_ERROR_NOT_SOLID,
                    "The mesh falls into " + with_commas(shells.count) + " loose pieces, but no more than " +
                        with_commas(max_shells) + " can be handled. If its faces were split, merge vertices by distance; "
                        "else delete or separate what doesn't belong to the model.");
    const ShellNesting nesting = find_nesting(mesh, shells);
    std::vector<int32_t> inner_walls;
    if (options.find_inner_walls) inner_walls = find_inner_walls(mesh, shells, nesting.enclosing, progress);
    shells = join_cavities(mesh, shells, nesting);
    const Patches patches = find_patches(mesh, shells, options.marks);
    Hierarchy hierarchy = shells.count == 1 && !shells.is_welded && inner_walls.empty()
                              ? build_shell(mesh, {patches, patches.of_face}, options, progress)
                              : Assembly(mesh, std::move(shells), patches, inner_walls, options, progress).build();
    hierarchy.add_note(patches.notes);
    return hierarchy;
}

}  // namespace

Hierarchy build_hierarchy(const MeshView& mesh, const BuildOptions& options, Progress& progress) {
    progress.enter(PW_STAGE_SURFACE);
    check_arrays(mesh);
    check_all_faces_used(mesh);
    Hierarchy hierarchy = options.mode == PW_MODE_PAPER ? build_shell(mesh, {{}, {}}, options, progress)
                                                        : build_assembly(mesh, options, progress);
    if (options.refuse_sheets && hierarchy.is_sheet()) throw_sheet();
    return hierarchy;
}

}  // namespace partwheel
