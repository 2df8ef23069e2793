// Impossible counts: every function refuses them by name before it reads or allocates anything.
#include "support/built.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>

namespace partwheel::test {
namespace {

constexpr size_t most = std::numeric_limits<size_t>::max();
constexpr size_t impossible[] = {size_t{PW_MAX_COUNT} + 1, size_t{1} << 31, (size_t{1} << 32) + 1, most / 24 + 1,
                                 most / 12 + 1, most / 3 + 1, most / 2 + 1, most - 1, most};

struct Call {
    const char* what;
    std::function<pw_status(size_t)> run;  // with this count
};

// The arrays are those of a cube: reading as much as the count says would crash.
class Counts : public testing::Test {
protected:
    TriMesh mesh = without_faces(cube());
    const double* v = mesh.vertex_data();
    const int32_t* t = mesh.triangle_data();
    std::array<uint8_t, 12> bytes{1};
    std::array<int32_t, 12> numbers{};
    std::array<double, 36> places{};
    Handle handle = build(mesh);
    const pw_hierarchy* h = handle.get();
    pw_hierarchy* built = nullptr;
    pw_mesh* made = nullptr;
    pw_creases* creases = nullptr;
    pw_deformation* deformation = nullptr;
    pw_ray_target* target = nullptr;
    size_t unused_count = 77, inconsistent_edges = 77, non_manifold_vertices = 77;

    pw_status make(size_t vertices, size_t triangles, const int32_t* faces, size_t face_count) {
        const pw_mesh_view view = mesh_view(v, vertices, t, triangles, faces, face_count);
        return pw_build(nullptr, &view, nullptr, &built);
    }
    pw_status crease(size_t vertices, size_t triangles, const int32_t* faces, size_t face_count) {
        const pw_mesh_view view = mesh_view(v, vertices, t, triangles, faces, face_count);
        return pw_creases_create(nullptr, &view, &creases);
    }
    pw_status make(const pw_mesh_view& view) { return pw_build(nullptr, &view, nullptr, &built); }
    pw_status crease(const pw_mesh_view& view) { return pw_creases_create(nullptr, &view, &creases); }
    pw_status deform(const pw_mesh_view& view, const int32_t* roles) {
        return pw_deformation_create(nullptr, &view, roles, 1, &deformation);
    }
    pw_status normals(const pw_mesh_view& view) { return pw_vertex_normals(&view, places.data()); }
    pw_status distances(const pw_mesh_view& view) {
        return pw_surface_distances(nullptr, &view, bytes.data(), places.data());
    }
    pw_status rays(const pw_mesh_view& view) { return pw_ray_target_create(nullptr, &view, &target); }
    pw_status seam(const pw_mesh_view& view) {
        return pw_hierarchy_seams(nullptr, h, &view, numbers.data(), 0, 1.09, bytes.data());
    }
    pw_status refine(const pw_mesh_view& view) {
        return pw_hierarchy_refine_seams(nullptr, h, &view, places.data(), 1.09, bytes.data());
    }
    pw_status mirrors(const pw_mesh_view& view) { return pw_mirror_planes(nullptr, &view, places.data(), &unused_count); }
    pw_status faults(const int32_t* corners, size_t corner_count, const int32_t* begin, size_t polygons,
                     size_t vertices) {
        return pw_polygon_faults(corners, corner_count, begin, polygons, vertices, &unused_count,
                                 &inconsistent_edges, &non_manifold_vertices);
    }
};

TEST_F(Counts, ImpossibleCountsAreRefusedByName) {
    numbers = {0, 1, 2, 0, 2, 1, 3, 4, 5, 5, 4, 3};
    const Call calls[] = {
        {"build: vertices", [&](size_t n) { return make(n, 12, nullptr, 12); }},
        {"build: triangles", [&](size_t n) { return make(8, n, nullptr, n); }},
        {"build: faces", [&](size_t n) { return make(8, 12, numbers.data(), n); }},
        {"creases: vertices", [&](size_t n) { return crease(n, 12, nullptr, 12); }},
        {"creases: triangles", [&](size_t n) { return crease(8, n, nullptr, n); }},
        {"creases: faces", [&](size_t n) { return crease(8, 12, numbers.data(), n); }},
        {"solid: slice", [&](size_t n) { return pw_hierarchy_solid(nullptr, h, 0, n, &made); }},
        {"solid of faces: slice",
         [&](size_t n) { return pw_hierarchy_solid_of_faces(nullptr, h, n, 0, bytes.data(), 12, &made); }},
        {"solid of faces: faces",
         [&](size_t n) { return pw_hierarchy_solid_of_faces(nullptr, h, 0, 1, bytes.data(), n, &made); }},
        {"hull: slice", [&](size_t n) { return pw_hierarchy_hull(nullptr, h, 0, n, &made); }},
        {"cut: parts", [&](size_t n) { return pw_hierarchy_cut_parts(h, n, numbers.data(), 12, &unused_count); }},
        {"polygons: nothing but vertices", [&](size_t n) { return faults(nullptr, 0, nullptr, 0, n); }},
        {"polygons: vertices", [&](size_t n) { return faults(t, 36, numbers.data(), 1, n); }},
        {"polygons: corners", [&](size_t n) { return faults(t, n, numbers.data(), 1, 8); }},
        {"polygons: polygons", [&](size_t n) { return faults(t, 36, numbers.data(), n, 8); }},
        {"faired: vertices", [&](size_t n) { return pw_fair_vertices(nullptr, v, n, t, 6, bytes.data(), places.data()); }},
        {"faired: edges", [&](size_t n) { return pw_fair_vertices(nullptr, v, 8, t, n, bytes.data(), places.data()); }},
        {"faired: edges of no vertices", [&](size_t n) { return pw_fair_vertices(nullptr, nullptr, 0, t, n, nullptr, nullptr); }},
        {"deformation: vertices",
         [&](size_t n) { return deform(mesh_view(v, n, t, 12), numbers.data()); }},
        {"deformation: triangles",
         [&](size_t n) { return deform(mesh_view(v, 8, t, n), numbers.data()); }},
        {"normals: vertices", [&](size_t n) { return normals(mesh_view(v, n, t, 12)); }},
        {"normals: triangles", [&](size_t n) { return normals(mesh_view(v, 8, t, n)); }},
        {"distances: vertices",
         [&](size_t n) { return distances(mesh_view(v, n, t, 12)); }},
        {"distances: triangles",
         [&](size_t n) { return distances(mesh_view(v, 8, t, n)); }},
        {"rays: vertices", [&](size_t n) { return rays(mesh_view(v, n, t, 12)); }},
        {"rays: triangles", [&](size_t n) { return rays(mesh_view(v, 8, t, n)); }},
        {"seams: vertices", [&](size_t n) { return seam(mesh_view(v, n, t, 12)); }},
        {"seams: triangles", [&](size_t n) { return seam(mesh_view(v, 8, t, n)); }},
        {"refined seams: triangles", [&](size_t n) { return refine(mesh_view(v, 8, t, n)); }},
        {"mirror planes: vertices", [&](size_t n) { return mirrors(mesh_view(v, n, t, 12)); }},
        {"mirror planes: triangles", [&](size_t n) { return mirrors(mesh_view(v, 8, t, n)); }},
    };
    for (const Call& call : calls)
        for (const size_t count : impossible) {
            EXPECT_EQ(call.run(count), PW_ERROR_ARGUMENT) << call.what << ", " << count;
            EXPECT_TRUE(std::string(pw_error_message()).ends_with('.')) << pw_error_message();
        }
    EXPECT_TRUE(!built && !made && !creases && !deformation);
    EXPECT_EQ(unused_count + inconsistent_edges + non_manifold_vertices, 3 * 77U);
}

TEST_F(Counts, CountsMustMatchTheObject) {
    ASSERT_EQ(crease(8, 12, nullptr, 12), PW_OK);
    const int32_t roles[] = {0, 0, 0, 0, PW_VERTEX_FREE, -2, -2, -2};
    ASSERT_EQ(deform(mesh_view(v, 8, t, 12), roles), PW_OK);
    const Call calls[] = {
        {"creases", [&](size_t n) { return pw_creases_snap(creases, bytes.data(), n, bytes.data()); }},
        {"positions", [&](size_t n) { return pw_deformation_positions(deformation, places.data(), n); }},
        {"handle", [&](size_t n) { return pw_deformation_move(deformation, n, places.data()); }},
        {"face", [&](size_t n) { return pw_hierarchy_path(h, n, numbers.data(), 12, &unused_count); }},
        {"node", [&](size_t n) {
             const int32_t* faces = nullptr;
             return pw_hierarchy_faces(h, n, &faces, &unused_count);
         }},
    };
    for (const Call& call : calls)
        for (const size_t count : impossible)
            EXPECT_EQ(call.run(count), PW_ERROR_ARGUMENT) << call.what << ", " << count;
    pw_creases_free(creases);
    pw_deformation_free(deformation);
}

// Any capacity is valid.
TEST_F(Counts, CapacitiesMayBeLarge) {
    std::vector<int32_t> buffer(64);
    size_t start = 0;
    EXPECT_EQ(pw_hierarchy_path(h, 0, buffer.data(), most, &unused_count), PW_OK);
    EXPECT_EQ(pw_hierarchy_wheel(h, 0, 0, buffer.data(), most, &unused_count, &start), PW_OK);
    EXPECT_EQ(pw_hierarchy_cut_height(h, 0, buffer.data(), most, &unused_count), PW_OK);
    EXPECT_EQ(pw_hierarchy_cut_parts(h, 2, buffer.data(), most, &unused_count), PW_OK);
    EXPECT_EQ(pw_hierarchy_cut_automatic(h, buffer.data(), most, &unused_count), PW_OK);
    std::vector<uint8_t> saved = save(handle);
    EXPECT_EQ(pw_hierarchy_save(nullptr, h, saved.data(), most, &unused_count), PW_OK);
    EXPECT_EQ(saved, save(handle));
}

}  // namespace
}  // namespace partwheel::test
