// The C functions that deform and mark a mesh: argument checks and calls into the layers, nothing else.
#include "api_common.h"
#include "edit/border.h"
#include "edit/deform.h"
#include "edit/fair.h"
#include "edit/seams.h"
#include "edit/surface_measures.h"
#include "mesh/duplicates.h"
#include "mesh/symmetry.h"

using namespace partwheel;

struct pw_deformation : Deformation {
    using Deformation::Deformation;
};

struct pw_creases : Creases {
    using Creases::Creases;
};

namespace {

void require_seam_arguments(const Hierarchy& hierarchy, const MeshView& mesh, double max_distortion) {
    require(max_distortion > 1 && std::isfinite(max_distortion), "max_distortion must be more than 1.");
    require(mesh.face_count == hierarchy.face_count(), "face_count is not the number of the hierarchy's faces.");
}

}  // namespace

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
                             const int32_t* labels, int32_t keep_borders, double max_distortion, uint8_t* is_seam) {
    const auto required = {RequiredPointer{"hierarchy", hierarchy}, {"mesh", mesh}, {"labels", labels}, {"is_seam", is_seam}};
    return with_progress(context, required, [&](Progress& progress) {
        const MeshInput input = mesh_input(*mesh);
        require_seam_arguments(*hierarchy, input, max_distortion);
        const std::span<const int32_t> parts(labels, hierarchy->face_count());
        require(std::ranges::all_of(parts, [&](int32_t part) { return part >= 0 && idx(part) < parts.size(); }),
                "labels must be from 0 to face_count - 1.");
        std::ranges::copy(find_seams(*hierarchy, input, parts, keep_borders != 0, max_distortion, progress), is_seam);
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
