// Meshes without area or volume: every function gives an error message or finite numbers.
#include "partwheel_edit.h"
#include "support/built.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

using namespace partwheel::test;
using partwheel::Point;
using partwheel::Triangle;

namespace {

TriMesh mesh_of(const std::string& name, std::vector<Point> vertices, std::vector<Triangle> triangles) {
    TriMesh mesh;
    mesh.name = name;
    mesh.vertices = std::move(vertices);
    mesh.triangles = std::move(triangles);
    mesh.face_count = mesh.triangles.size();
    return mesh;
}

// A cube with all vertices on a line, in a plane or at a point.
TriMesh flattened(const std::string& name, const Point& factors) { return named(stretched(cube(), factors), name); }

std::vector<TriMesh> degenerate_meshes() {
    const TriMesh sheet = mesh_of("two triangles in a plane", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
    std::vector<TriMesh> meshes = {
        mesh_of("a collinear triangle", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}),
        mesh_of("a collinear triangle across", {{0, 0, 0}, {1, 2, 3}, {3, 6, 9}}, {{0, 1, 2}}),
        mesh_of("a triangle with a corner twice", {{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}),
        mesh_of("a triangle of one corner", {{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}}),
        mesh_of("a triangle at one place", {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}),
        mesh_of("a triangle of which two corners coincide", {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}),
        mesh_of("a triangle thinner than numbers", {{0, 0, 0}, {1, 0, 0}, {0.5, 5e-324, 0}}, {{0, 1, 2}}),
        mesh_of("a triangle from both sides", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}),
        mesh_of("a triangle and a point", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}, {3, 3, 3}}),
        mesh_of("a flat tetrahedron", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 0}},
                {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}),
        sheet,
        named(moved(sheet, {1e15, 1e15, 1e15}), "a sheet far away"),
        named(stretched(sheet, {1e-79, 1e-79, 1}), "a tiny sheet"),
        named(stretched(sheet, {1e99, 1e99, 1}), "a huge sheet"),
        flattened("a cube in a plane", {1, 1, 0}),
        flattened("a cube along a line", {1, 0, 0}),
        flattened("a cube at one place", {0, 0, 0}),
        flattened("a cube thinner than rounding", {1, 1, 1e-17}),
        flattened("a cube like a needle", {1, 1e-9, 1e-9}),
    };
    // Many at once: shortcuts for a few do not apply.
    TriMesh line = mesh_of("many collinear triangles", {}, {});
    for (int32_t i = 0; i < 300; ++i) {
        line.vertices.push_back({static_cast<double>(i), 0, 0});
        if (i >= 2) line.triangles.push_back({i - 2, i - 1, i});
    }
    line.face_count = line.triangles.size();
    meshes.push_back(line);
    return meshes;
}

::testing::AssertionResult all_finite(const double* numbers, size_t count) {
    for (size_t i = 0; i < count; ++i)
        if (!std::isfinite(numbers[i])) return ::testing::AssertionFailure() << "number " << i << " is " << numbers[i];
    return ::testing::AssertionSuccess();
}

// Whether the call succeeded; otherwise checks its message.
bool is_ok(pw_status status, const TriMesh& mesh) {
    if (status != PW_OK) {
        EXPECT_NE(status, PW_ERROR_INTERNAL) << mesh.name << ": " << pw_error_message();
        EXPECT_TRUE(std::string(pw_error_message()).ends_with('.')) << mesh.name << ": " << pw_error_message();
    }
    return status == PW_OK;
}

const double* numbers(const TriMesh& mesh) { return mesh.vertices.data()->data(); }
// Of triangles that are faces of their own.
pw_mesh_view triangles_of(const TriMesh& mesh) {
    return mesh_view(numbers(mesh), mesh.vertices.size(), mesh.triangles.data()->data(), mesh.triangles.size());
}

void expect_sound_hierarchy(const Handle& handle, const TriMesh& mesh) {
    const pw_arrays a = arrays(handle);
    for (const double* values : {a.cost, a.height, a.volume, a.area, a.score})
        EXPECT_TRUE(all_finite(values, a.node_count)) << mesh.name;
    EXPECT_TRUE(all_finite(a.vertices, 3 * a.vertex_count)) << mesh.name;
    const Built again = try_load(save(handle));
    EXPECT_EQ(again.status, PW_OK) << mesh.name << ": " << again.message;
    pw_index* made = nullptr;
    ASSERT_EQ(pw_index_create(nullptr, handle.get(), nullptr, 0, 1, &made), PW_OK);
    const std::unique_ptr<pw_index, decltype(&pw_index_free)> index(made, pw_index_free);
    std::vector<int32_t> parts(a.vertex_count);
    std::vector<double> distances(a.vertex_count), places(3 * a.vertex_count), along(3 * a.vertex_count, 1);
    EXPECT_EQ(pw_index_nearest(nullptr, made, a.vertices, a.vertex_count, parts.data(), distances.data(), places.data()), PW_OK);
    EXPECT_TRUE(all_finite(distances.data(), distances.size()) && all_finite(places.data(), places.size())) << mesh.name;
    EXPECT_EQ(pw_index_first_hits(nullptr, made, a.vertices, along.data(), a.vertex_count, parts.data(), distances.data()), PW_OK);
    EXPECT_TRUE(all_finite(distances.data(), distances.size())) << mesh.name;
    pw_convex_options options{};
    options.struct_size = sizeof options;
    options.hulls = 2;
    pw_convex_parts* convex = nullptr;
    EXPECT_EQ(pw_hierarchy_convex_parts(nullptr, handle.get(), &options, &convex), PW_OK) << mesh.name;
    pw_convex_parts_free(convex);
}

}  // namespace

TEST(Degenerate, BuildingIsAnErrorOrFinite) {
    struct Way {
        int32_t refuse;
        int64_t exact_triangles;
        pw_mode mode;
    };
    for (const TriMesh& mesh : degenerate_meshes())
        for (const Way& way : {Way{0, 0, PW_MODE_LEARNED}, {0, 0, PW_MODE_PAPER}, {0, 1, PW_MODE_LEARNED}, {1, 0, PW_MODE_LEARNED}}) {
            pw_build_options options{};
            options.struct_size = sizeof options;
            options.refuse_sheets = way.refuse;
            options.exact_triangles = way.exact_triangles;
            options.mode = way.mode;
            pw_hierarchy* made = nullptr;
            const pw_mesh_view view = triangles_of(mesh);
            const pw_status status = pw_build(nullptr, &view, &options, &made);
            const Handle handle(made);
            if (is_ok(status, mesh)) expect_sound_hierarchy(handle, mesh);
        }
}

TEST(Degenerate, MirrorPlanesAreAnErrorOrFinite) {
    for (const TriMesh& mesh : degenerate_meshes()) {
        double planes[12] = {};
        size_t count = 0;
        const pw_mesh_view view = triangles_of(mesh);
        const pw_status status =
            pw_mirror_planes(nullptr, &view, planes, &count);
        if (is_ok(status, mesh)) {
            EXPECT_TRUE(all_finite(planes, 4 * count)) << mesh.name;
        }
    }
}

TEST(Degenerate, NormalsAndDistancesAreAnErrorOrFinite) {
    for (const TriMesh& mesh : degenerate_meshes()) {
        const size_t count = mesh.vertices.size();
        const pw_mesh_view view = triangles_of(mesh);
        std::vector<double> normals(3 * count), distance(count);
        if (is_ok(pw_vertex_normals(&view, normals.data()), mesh)) {
            EXPECT_TRUE(all_finite(normals.data(), normals.size())) << mesh.name;
        }
        const std::vector<uint8_t> start(count, 1);
        if (is_ok(pw_surface_distances(nullptr, &view, start.data(), distance.data()), mesh)) {
            EXPECT_TRUE(all_finite(distance.data(), count)) << mesh.name;
        }
        std::vector<uint8_t> first(count, 0);
        first[0] = 1;  // unreachable vertices are infinitely far; no NaN
        if (is_ok(pw_surface_distances(nullptr, &view, first.data(), distance.data()), mesh)) {
            for (const double d : distance) EXPECT_GE(d, 0) << mesh.name;
        }
    }
}

TEST(Degenerate, FairingIsAnErrorOrFinite) {
    for (const TriMesh& mesh : degenerate_meshes()) {
        std::vector<int32_t> edges;
        for (const Triangle& t : mesh.triangles)
            for (size_t k = 0; k < 3; ++k) edges.insert(edges.end(), {t[k], t[(k + 1) % 3]});
        std::vector<uint8_t> free(mesh.vertices.size(), 1);
        free[0] = 0;
        std::vector<double> result(3 * mesh.vertices.size());
        if (is_ok(pw_fair_vertices(nullptr, numbers(mesh), mesh.vertices.size(), edges.data(), edges.size() / 2, free.data(), result.data()), mesh)) {
            EXPECT_TRUE(all_finite(result.data(), result.size())) << mesh.name;
        }
    }
}

TEST(Degenerate, DeformingIsAnErrorOrFinite) {
    const double turned[12] = {0, -1, 0, 0.5, 1, 0, 0, 0, 0, 0, 1, 0.25}, crushed[12] = {};
    for (const TriMesh& mesh : degenerate_meshes()) {
        const size_t count = mesh.vertices.size();
        std::vector<int32_t> roles(count, PW_VERTEX_FREE);
        roles.front() = PW_VERTEX_FIXED;
        roles.back() = 0;
        pw_deformation* made = nullptr;
        const pw_mesh_view view = triangles_of(mesh);
        const pw_status status = pw_deformation_create(nullptr, &view, roles.data(), 0, &made);
        const std::unique_ptr<pw_deformation, decltype(&pw_deformation_free)> deformation(made, pw_deformation_free);
        if (!is_ok(status, mesh)) continue;
        std::vector<double> positions(3 * count);
        for (const double* matrix : {turned, crushed}) {
            EXPECT_EQ(pw_deformation_move(made, 0, matrix), PW_OK) << mesh.name;
            EXPECT_EQ(pw_deformation_iterate(nullptr, made, 3), PW_OK) << mesh.name;
            EXPECT_EQ(pw_deformation_positions(made, positions.data(), count), PW_OK) << mesh.name;
            EXPECT_TRUE(all_finite(positions.data(), positions.size())) << mesh.name;
            double energy = 0;
            EXPECT_EQ(pw_deformation_energy(made, &energy), PW_OK) << mesh.name;
            EXPECT_TRUE(all_finite(&energy, 1)) << mesh.name;
        }
    }
}

TEST(Degenerate, SnappingIsAnErrorOrAnAnswer) {
    for (const TriMesh& mesh : degenerate_meshes()) {
        pw_creases* made = nullptr;
        const pw_mesh_view view = triangles_of(mesh);
        const pw_status status = pw_creases_create(nullptr, &view, &made);
        const std::unique_ptr<pw_creases, decltype(&pw_creases_free)> creases(made, pw_creases_free);
        if (!is_ok(status, mesh)) continue;
        std::vector<uint8_t> inside(mesh.triangles.size(), 0), result(mesh.triangles.size(), 2);
        inside[0] = 1;
        if (!is_ok(pw_creases_snap(made, inside.data(), inside.size(), result.data()), mesh)) continue;
        for (const uint8_t in : result) EXPECT_LE(in, 1) << mesh.name;
    }
}

TEST(Degenerate, RaysHitNothingOrAtADistance) {
    for (const TriMesh& mesh : degenerate_meshes()) {
        pw_ray_target* made = nullptr;
        const pw_mesh_view view = triangles_of(mesh);
        const pw_status status = pw_ray_target_create(nullptr, &view, &made);
        const std::unique_ptr<pw_ray_target, decltype(&pw_ray_target_free)> target(made, pw_ray_target_free);
        if (!is_ok(status, mesh)) continue;
        for (const Point& direction : {Point{0, 0, -1}, Point{1, 0, 0}, Point{-1, -2, -3}}) {
            const Point origin = {0.25, 0.25, 5};
            int32_t triangle = 0;
            double distance = 0;
            ASSERT_EQ(pw_ray_target_first(made, origin.data(), direction.data(), 0, &triangle, &distance), PW_OK);
            EXPECT_TRUE(all_finite(&distance, 1)) << mesh.name;
        }
    }
}
