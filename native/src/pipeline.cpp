// The whole flow. Of each shell: surface -> tetrahedra -> merge tree -> parts -> hierarchy; then one tree of all
// shells.
#include "pipeline.h"

#include "base/corners.h"
#include "base/parallel.h"
#include "fill/cavities.h"
#include "fill/sheet.h"
#include "mesh/face_assignment.h"
#include "parts/boundary.h"
#include "parts/transfer.h"

namespace partwheel {

namespace {

// A mesh of more shells is refused: its faces are probably split.
constexpr size_t max_shells = 20000;

// Divides the tetrahedra behind several patches. Returns the regions of those that are clustered; none: there is only
// one.
std::optional<Regions> divide_by_patches(Solid& solid, std::optional<TetMesh>& proxy, const ShellPatches& patches,
                                         Progress& progress) {
    if (patches.of_face.empty()) return {};
    const std::vector<int32_t> of_triangle = assign_patches(solid.surface, patches.of_face);
    divide_tetrahedra(solid.mesh, solid.surface, of_triangle, progress);
    if (proxy) divide_tetrahedra(*proxy, solid.surface, of_triangle, progress);
    Regions regions(proxy ? *proxy : solid.mesh, solid.surface, patches.all, of_triangle, progress);
    if (regions.count == 1) return {};
    return regions;
}

// Whether the surface covers both sides of a wall, so that positions don't identify its triangles.
bool has_walls(const TetMesh& mesh, std::span<const Triangle> facets) {
    std::vector<std::array<Point, 3>> places;
    for (const Triangle& f : facets) {
        std::ranges::sort(places.emplace_back(corner_points(mesh.vertices, f)));
    }
    std::ranges::sort(places);
    return std::ranges::adjacent_find(places) != places.end();
}

std::vector<Plane> find_symmetry(const TetMesh& mesh, bool may_have_walls, Progress& progress) {
    const std::vector<Triangle> facets = BoundaryFacets(mesh).triangles;
    if (may_have_walls && has_walls(mesh, facets)) return {};
    return mirror_planes(mesh.vertices, facets, progress);
}

Hierarchy build_shell(const MeshView& mesh, const ShellPatches& patches, const BuildOptions& options, Progress& progress) {
    const bool is_learned = options.mode != PW_MODE_PAPER;

    // Prepare, fill: a surface, the tetrahedra in it, and a proxy of these if noise or points inside would mislead.
    Solid solid = fill_solid(mesh, options.fill, progress);
    std::optional<TetMesh> proxy;
    if (is_learned) proxy = fill_proxy(solid, options.fill.quality > 0, progress);
    const TetMesh& tets = proxy ? *proxy : solid.mesh;
    const std::optional<Regions> regions = divide_by_patches(solid, proxy, patches, progress);

    // Cluster: the paper's merge tree; beside it, the planes in which the solid is its own mirror image.
    progress.enter(PW_STAGE_CLUSTER);
    ScoredTree tree;
    std::vector<Plane> planes;
    const bool is_drawn = regions && regions->is_divided_by_hard_marks();  // on purpose, perhaps on one side only
    const size_t tasks = is_learned && options.find_symmetry && !is_drawn ? 2 : 1;
    ThreadPool(options.fill.threads, tasks).parallel_for(tasks, 1, [&](size_t task, size_t) {
        if (task == 0) {
            tree.tree = regions ? cluster_in_regions(tets, *regions, progress, options.fill.threads)
                                : cluster(tets, progress, options.fill.threads);
        } else {
            Progress beside = progress.beside();
            planes = find_symmetry(tets, solid.surface_from_tetrahedra, beside);
        }
    });

    // Parts: the top of the tree by the merge policy; then the tree of the solid with the parts of the proxy.
    progress.enter(PW_STAGE_DENDROGRAM);
    const double own = proxy ? 0.4 : 1;  // share of the stage, see Progress::Section
    if (is_learned) {
        const Progress::Section first(progress, 0, own);
        const bool is_convex = tree.tree.merges.empty() || tree.tree.merges.back().concavity <= 0;  // that is one part
        if (is_convex) planes.clear();
        tree = merge_parts(tets, tree.tree, planes, progress, {}, nullptr, regions ? &*regions : nullptr);
    }
    if (proxy) {
        const Progress::Section second(progress, own, 1);
        tree = transfer_parts(*proxy, tree, solid, progress, options.fill.threads);
    }

    // Tree: the dendrogram, and where each source face belongs.
    progress.enter(PW_STAGE_HIERARCHY);
    Hierarchy hierarchy(solid.surface, solid.mesh, tree, mesh.vertices);
    progress.advance(1);
    return hierarchy;
}

// Prepare: finds the shells and the marks between parts, and the faces that go with others, such as duplicates. Then each
// shell is built on its own.
Hierarchy build_shells(const MeshView& mesh, const BuildOptions& options, Progress& progress) {
    Shells shells = find_shells(mesh);
    if (shells.count > max_shells)
        throw Error(PW_ERROR_NOT_SOLID,
                    "The mesh has " + with_commas(shells.count) + " loose pieces, more than the limit of " +
                        with_commas(max_shells) + ". If its faces were split, merge vertices by distance. Otherwise delete "
                        "or separate what doesn't belong to the model.");
    const ShellNesting nesting = find_nesting(mesh, shells);
    std::vector<int32_t> inner_walls;
    if (options.find_inner_walls) {
        const Progress::Section section(progress, 0, 0.7);
        inner_walls = find_inner_walls(mesh, shells, nesting.enclosing, progress);
    }
    shells = join_cavities(mesh, shells, nesting);
    const Patches patches = find_patches(mesh, shells, options.marks);
    const bool is_assembly = shells.count > 1 || shells.is_welded || !inner_walls.empty();
    Hierarchy hierarchy =
        is_assembly ? build_assembly(mesh, divide_into_shells(mesh, shells, inner_walls), patches, options, build_shell, progress)
                    : build_shell(mesh, {patches, patches.of_face}, options, progress);
    hierarchy.add_note(patches.notes);
    return hierarchy;
}

}  // namespace

Hierarchy build_hierarchy(const MeshView& mesh, const BuildOptions& options, Progress& progress) {
    progress.enter(PW_STAGE_SURFACE);
    check_arrays(mesh);
    check_all_faces_used(mesh);
    Hierarchy hierarchy = options.mode == PW_MODE_PAPER ? build_shell(mesh, {{}, {}}, options, progress)
                                                        : build_shells(mesh, options, progress);
    if (options.refuse_sheets && hierarchy.is_sheet()) throw_sheet();
    return hierarchy;
}

}  // namespace partwheel
