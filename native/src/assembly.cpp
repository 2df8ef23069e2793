// Shells that can't be filled, sheets that are one surface together, and the joined tree.
#include "assembly.h"

#include "base/corners.h"
#include "base/parallel.h"
#include "base/predicates.h"
#include "mesh/nearest.h"
#include "parts/contacts.h"
#include "prepare/congruent.h"
#include "tree/place.h"

namespace partwheel {

namespace {

// Sheets with more than this share of the area may wind around a solid together, as the patches of a CAD model do, if
// this share of their borders meets others.
constexpr double min_sheet_share = 0.3, min_matched_share = 0.8;

// Least number of points on a shell that is filled from points.
constexpr size_t min_points_of_shell = 200;

// Builds the shells of an assembly, and joins them.
class AssemblyBuilder {
public:
    AssemblyBuilder(const MeshView& mesh, Assembly assembly, const Patches& patches, const BuildOptions& options,
                    const BuildShell& build_shell, Progress& progress)
        : mesh_(mesh), assembly_(std::move(assembly)), patches_(patches), options_(options), build_shell_(build_shell),
          progress_(progress) {}

    Hierarchy build() {
        for (const SubMesh& shell : assembly_.shells) {
            whole_area_ += shell.area;
            whole_triangles_ += shell.triangles.size();
        }
        std::vector<SubMesh>& shells = assembly_.shells;
        std::vector<std::optional<Hierarchy>> hierarchies = build_all(shells);
        std::vector<SubMesh> degenerate;
        for (size_t s = 0; s < shells.size(); ++s) {
            if (hierarchies[s]) {
                built_.push_back({std::move(shells[s]), std::move(*hierarchies[s])});
            } else {
                if (!allows(PW_FILL_SHEET)) throw_error_of(shells[s]);
                degenerate.push_back(std::move(shells[s]));
            }
        }
        if (built_.empty()) throw_error_of(degenerate.front());
        if (allows(PW_FILL_POINTS)) fill_sheets_together();
        attach(degenerate);
        return join();
    }

private:
    struct Built {
        SubMesh mesh;
        Hierarchy hierarchy;
    };

    // Builds the shells, the largest ones first, so that no thread waits long for another; then those that are copies.
    // Each shell gets its share of the threads, rounded up.
    std::vector<std::optional<Hierarchy>> build_all(const std::vector<SubMesh>& shells) const {
        const std::vector<std::optional<Congruence>> copies = find_congruent_shells(shells, patches_, progress_);
        const auto is_copy = [&](size_t s) { return copies[s].has_value(); };
        const auto size_of = [&](size_t s) { return static_cast<double>(shells[s].triangles.size()); };
        std::vector<size_t> by_size(shells.size());
        std::iota(by_size.begin(), by_size.end(), size_t{0});
        std::ranges::stable_sort(by_size, std::greater(), size_of);
        const auto first_copy = std::stable_partition(by_size.begin(), by_size.end(), std::not_fn(is_copy));
        const std::span<const size_t> originals(by_size.begin(), first_copy), others(first_copy, by_size.end());
        double work = 0;
        for (const size_t s : originals) work += size_of(s);

        std::vector<std::optional<Hierarchy>> built(shells.size());
        const auto all_threads = static_cast<double>(thread_count(options_.fill.threads));
        Progress::Pieces pieces(progress_);
        for (const std::span<const size_t> group : {originals, others})
            ThreadPool(options_.fill.threads, group.size()).parallel_for(group.size(), 1, [&](size_t i, size_t) {
                const size_t s = group[i];
                const double share = size_of(s) / static_cast<double>(whole_triangles_);
                const auto threads = static_cast<size_t>(std::ceil(share * all_threads));
                Progress progress = pieces.piece(is_copy(s) ? 0 : size_of(s) / work);
                if (is_copy(s)) {
                    progress.enter(PW_STAGE_HIERARCHY);
                    const size_t original = copies[s]->original;
                    if (built[original]) built[s] = place_copy(*built[original], *copies[s], shells[original], shells[s]);
                }
                if (!built[s]) built[s] = try_to_build(shells[s], options_.fill.fill_methods, threads, progress);
            });
        return built;
    }

    // Builds a shell; returns nothing if none of these fill methods can fill it. A sheet can be filled unless it has no
    // area.
    std::optional<Hierarchy> try_to_build(const SubMesh& shell, uint32_t fill_methods, size_t threads,
                                                           Progress& progress) const {
        ShellPatches patches{patches_, {}};
        if (!patches_.of_face.empty())
            for (const int32_t f : shell.face_numbers) patches.of_face.push_back(patches_.of_face[idx(f)]);
        try {
            return build_shell_(shell.view(), patches, options_of_shell(shell, fill_methods, threads), progress);
        } catch (const Error& error) {
            if (!is_about_shape(error.status()) && error.status() != PW_ERROR_NOT_FINITE) throw;  // that one: too small
            return {};
        }
    }

    // A shell has its share of the whole's points and triangles.
    BuildOptions options_of_shell(const SubMesh& shell, uint32_t fill_methods, size_t threads) const {
        BuildOptions options = options_;
        options.fill.fill_methods = fill_methods;
        options.fill.threads = threads;
        const double area_share = whole_area_ > 0 ? shell.area / whole_area_ : 1;
        options.find_symmetry = area_share >= small_shell;  // else it is not worth its time
        const double points = std::sqrt(area_share) * static_cast<double>(options.fill.least_points);
        options.fill.least_points = std::max(min_points_of_shell, static_cast<size_t>(points));
        if (whole_triangles_ > options.fill.exact_triangles)
            options.fill.exact_triangles =
                std::max<size_t>(1, options.fill.exact_triangles * shell.triangles.size() / whole_triangles_);
        return options;
    }

    // Sheets may be the patches of one surface: then that is one shell, filled from points.
    void fill_sheets_together() {
        const auto is_sheet = [](const Built& built) { return built.hierarchy.is_sheet(); };
        SubMesh all;
        std::vector<int32_t> sheet_of_triangle;
        int32_t sheets = 0;
        for (const Built& built : built_) {
            if (!is_sheet(built)) continue;
            all.append(built.mesh);
            sheet_of_triangle.resize(all.triangles.size(), sheets++);
        }
        if (sheets < 2 || all.area < min_sheet_share * whole_area_) return;
        if (matched_border_share(all.vertices, all.triangles, sheet_of_triangle) < min_matched_share) return;
        std::optional<Hierarchy> hierarchy = try_to_build(all, PW_FILL_POINTS, options_.fill.threads, progress_);
        if (!hierarchy) return;
        std::erase_if(built_, is_sheet);
        built_.push_back({std::move(all), std::move(*hierarchy)});
    }

    // Faces of shells without area go with the nearest face.
    void attach(const std::vector<SubMesh>& degenerate) {
        if (degenerate.empty()) return;
        std::vector<Triangle> triangles;
        std::vector<int32_t> faces;
        for (const auto& [shell, hierarchy] : built_)
            for (size_t t = 0; t < shell.triangles.size(); ++t) {
                const Triangle corners = shell.source_triangle(t);
                const auto [a, b, c] = corner_points(mesh_.vertices, corners);
                if (collinear(a, b, c)) continue;
                triangles.push_back(corners);
                faces.push_back(shell.source_face(t));
            }
        NearestTriangle nearest(mesh_.vertices, triangles);
        for (const SubMesh& shell : degenerate) {
            const int32_t face = faces[idx(nearest(shell.vertices.front()).triangle)];
            for (const int32_t f : shell.face_numbers) assembly_.original[idx(f)] = face;
        }
    }

    Hierarchy join() {
        std::vector<int32_t>& original = assembly_.original;
        for (int32_t& f : original)  // that face may itself go with another
            while (original[idx(f)] != f) f = original[idx(f)];
        std::vector<Triangle> triangles;
        std::vector<int32_t> of_triangle, of_face(mesh_.face_count, -1);
        std::vector<ShellHierarchy> shells;
        for (auto& [shell, hierarchy] : built_) {
            const auto number = static_cast<int32_t>(shells.size());
            for (size_t t = 0; t < shell.triangles.size(); ++t) triangles.push_back(shell.source_triangle(t));
            of_triangle.resize(triangles.size(), number);
            for (const int32_t f : shell.face_numbers) of_face[idx(f)] = number;
            shells.push_back({.hierarchy = std::move(hierarchy), .faces = std::move(shell.face_numbers),
                              .vertices = std::move(shell.vertex_numbers), .welded = shell.welded});
        }
        const auto shell_with = [&](int32_t face) -> ShellHierarchy& { return shells[idx(of_face[idx(original[idx(face)])])]; };
        for (const int32_t f : assembly_.duplicates) ++shell_with(f).duplicates;
        for (const int32_t f : assembly_.inner_faces) ++shell_with(f).inner_faces;
        const ShellJoins joins = join_by_contact(mesh_.vertices, triangles, of_triangle, shells.size(), progress_);
        return Hierarchy::assemble(std::move(shells), joins, mesh_.face_count, original, progress_);
    }

    // Fills the shell again, with the caller's numbers of faces and vertices, so that the error names these.
    [[noreturn]] void throw_error_of(const SubMesh& shell) const {
        std::vector<Triangle> triangles;
        std::vector<int32_t> faces;
        for (size_t t = 0; t < shell.triangles.size(); ++t) {
            triangles.push_back(shell.source_triangle(t));
            faces.push_back(shell.source_face(t));
        }
        (void)fill_solid({mesh_.vertices, triangles, faces, mesh_.face_count, true}, options_.fill, progress_);
        throw Error(PW_ERROR_INTERNAL, "A shell could not be filled the first time. Please report this mesh.");
    }

    bool allows(pw_fill_method method) const {
        return options_.fill.fill_methods == 0 || (options_.fill.fill_methods & method) != 0;
    }

    const MeshView& mesh_;
    Assembly assembly_;
    const Patches& patches_;
    const BuildOptions& options_;
    const BuildShell& build_shell_;
    Progress& progress_;
    std::vector<Built> built_;
    double whole_area_ = 0;
    size_t whole_triangles_ = 0;
};

}  // namespace

Hierarchy build_assembly(const MeshView& mesh, Assembly assembly, const Patches& patches, const BuildOptions& options,
                         const BuildShell& build_shell, Progress& progress) {
    return AssemblyBuilder(mesh, std::move(assembly), patches, options, build_shell, progress).build();
}

}  // namespace partwheel
