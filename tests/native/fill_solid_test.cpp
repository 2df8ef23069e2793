// fill_solid(): the fill method of each kind of mesh, and the validity of the surface it uses, by independent checks.
#include "fill/fill_solid.h"

#include "support/built.h"
#include "support/real_meshes.h"
#include "support/reference_surface.h"
#include "support/shapes.h"
#include "support/sizes.h"
#include "mesh/face_assignment.h"
#include "prepare/decimate.h"
#include "prepare/displace.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/assertions.h>
#include <CGAL/exceptions.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace partwheel::test {
namespace {

Solid fill(const TriMesh& mesh, uint32_t fill_methods = 0) {
    Progress progress;
    progress.begin();
    return fill_solid(mesh.view(), {0, fill_methods, {}}, progress);
}

// The surface that is filled.
TriMesh used_mesh(const Solid& solid) {
    TriMesh mesh;
    mesh.name = "used";
    mesh.vertices = solid.surface.vertices;
    mesh.triangles = solid.surface.triangles;
    return without_faces(mesh);
}

// What must hold on every fill method: a surface that is closed, manifold, oriented and free of self-intersection
// (from points parts of it may touch), each source face on it, source vertices where they were.
void expect_sound(const Solid& solid, const TriMesh& mesh, pw_fill_method fill_method) {
    SCOPED_TRACE(mesh.name);
    const Surface& surface = solid.surface;
    EXPECT_EQ(surface.fill_method, fill_method) << surface.notes;
    EXPECT_EQ(surface.notes.empty(), fill_method == PW_FILL_EXACT && surface.proxy_triangles == 0);
    const pw_status status = expected_status(used_mesh(solid));
    EXPECT_TRUE(status == PW_OK || (fill_method == PW_FILL_POINTS && status == PW_ERROR_NON_MANIFOLD)) << status;
    std::vector<double> area(mesh.face_count, 0), expected(mesh.face_count, 0);
    for (const FaceSample& piece : surface.samples) {
        ASSERT_LT(static_cast<size_t>(piece.triangle), surface.triangles.size());
        area[static_cast<size_t>(piece.face)] += piece.area;
    }
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto at = [&](size_t k) { return mesh.vertices[static_cast<size_t>(mesh.triangles[t][k])]; };
        expected[static_cast<size_t>(mesh.face_of(t))] += partwheel::area(at(0), at(1), at(2));
    }
    for (size_t f = 0; f < area.size(); ++f)
        EXPECT_NEAR(surface.frame.area_to_caller(area[f]), expected[f], 1e-9 * (1 + expected[f]));
    for (size_t v = 0; v < surface.vertices.size(); ++v) {
        const int32_t s = surface.source_vertex[v];
        if (s < 0) continue;
        EXPECT_EQ(surface.vertices[v], surface.frame.to_working(mesh.vertices[static_cast<size_t>(s)]));
    }
}

double used_volume(const Solid& solid) {
    return solid.surface.frame.volume_to_caller(std::fabs(enclosed_volume(used_mesh(solid))));
}

TriMesh without(TriMesh mesh, size_t triangle) {
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(triangle));
    return without_faces(std::move(mesh));
}

TEST(FillSolid, CleanSurfacesStayExact) {
    for (const TriMesh& mesh : {cube(), torus(9, 6, 2, 0.5), real_mesh("joint.off")}) {
        const Solid solid = fill(mesh);
        expect_sound(solid, mesh, PW_FILL_EXACT);
        EXPECT_EQ(solid.surface.deviation, 0);
        for (const int32_t s : solid.surface.source_vertex) EXPECT_GE(s, 0);
    }
}

TEST(FillSolid, AHoleIsFilled) {
    const TriMesh mesh = without(without_faces(cube()), 3);
    const Solid solid = fill(mesh);
    expect_sound(solid, mesh, PW_FILL_REPAIRED);
    EXPECT_NEAR(used_volume(solid), std::fabs(enclosed_volume(cube())), 1e-12);
    EXPECT_EQ(solid.surface.deviation, 0);
    EXPECT_NE(solid.surface.notes.find("1 hole filled"), std::string::npos) << solid.surface.notes;
}

// Two fins at each edge, which cross those of others: neither cells nor a repair find the box, but winding numbers do.
TEST(FillSolid, ABoxWithFinsIsNoSheet) {
    using partwheel::operator+, partwheel::operator-, partwheel::operator*;
    TriMesh mesh = cube();
    Point middle{};
    for (const Point& p : mesh.vertices) middle = middle + 1 / static_cast<double>(mesh.vertices.size()) * p;
    std::set<std::pair<int32_t, int32_t>> edges;
    for (const auto& [a, b, c] : mesh.triangles) edges.insert({std::minmax(a, b), std::minmax(b, c), std::minmax(c, a)});
    for (const auto& [a, b] : edges) {
        const Point on_edge = 0.5 * (mesh.vertices[idx(a)] + mesh.vertices[idx(b)]), outward = on_edge - middle;
        for (const double turn : {0.4, -0.3}) {
            mesh.triangles.push_back({a, b, static_cast<int32_t>(mesh.vertices.size())});
            mesh.vertices.push_back(on_edge + 0.3 * outward + turn * Point{outward[2], outward[0], outward[1]});
        }
    }
    const Solid solid = fill(without_faces(mesh));
    EXPECT_EQ(solid.surface.fill_method, PW_FILL_POINTS) << solid.surface.notes;
    const double volume = std::fabs(enclosed_volume(cube()));
    EXPECT_NEAR(used_volume(solid), volume, 0.1 * volume);
}

TEST(FillSolid, FlippedTrianglesAreReoriented) {
    TriMesh mesh = torus(9, 6, 2, 0.5);
    for (size_t t = 0; t < mesh.triangles.size(); t += 7) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
    const Solid solid = fill(mesh);
    expect_sound(solid, mesh, PW_FILL_REPAIRED);
    EXPECT_NEAR(used_volume(solid), std::fabs(enclosed_volume(torus(9, 6, 2, 0.5))), 1e-9);
}

TEST(FillSolid, TriangleSoupIsStitched) {
    const TriMesh whole = without_faces(real_mesh("joint.off"));
    TriMesh soup = whole;
    soup.vertices.clear();
    soup.triangles.clear();
    for (const Triangle& t : whole.triangles) {
        const auto n = static_cast<int32_t>(soup.vertices.size());
        for (const int32_t v : t) soup.vertices.push_back(whole.vertices[static_cast<size_t>(v)]);
        soup.triangles.push_back({n, n + 1, n + 2});
    }
    const Solid solid = fill(soup);
    expect_sound(solid, soup, PW_FILL_REPAIRED);
    EXPECT_NEAR(used_volume(solid), std::fabs(enclosed_volume(whole)), 1e-9 * std::fabs(enclosed_volume(whole)));
}

TEST(FillSolid, OverlappingPartsAreUnited) {
    const TriMesh both = together("both", cube(), moved(cube(), {0.5, 0.25, 0.125}));
    const Solid solid = fill(both);
    expect_sound(solid, both, PW_FILL_REPAIRED);
    const double side = std::cbrt(std::fabs(enclosed_volume(cube())));
    const double overlap = (side - 0.5) * (side - 0.25) * (side - 0.125);
    EXPECT_NEAR(used_volume(solid), 2 * side * side * side - overlap, 1e-9);
}

// Four faces of the union meet in an edge. CGAL 5.5 starts to build it all the same, and then loops forever, or crashes.
TEST(FillSolid, PartsWhoseUnionIsNotManifoldAreFilledFromPoints) {
    const TriMesh notched = surface_of("notched", Cells{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}});
    const TriMesh on_top = moved(surface_of("box", Cells{{0, 0, 0}}, {1, 1, 0.5}), {2, 0.5, 1});
    const TriMesh tree = surface_of("tree", block({0, 0, 0}, {2, 2, 1}) + block({0, 2, 0}, {1, 4, 1}) + Cells{{0, 0, 1}});
    const TriMesh corner = moved(surface_of("corner", Cells{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 1, 0}}, {1, 1.5, 1}), {-1, 0.5, 1});
    for (const TriMesh& both : {together("four faces at an edge", notched, on_top), together("tree and corner", tree, corner)}) {
        const Solid solid = fill(without_faces(both));
        expect_sound(solid, without_faces(both), PW_FILL_POINTS);
    }
}

TEST(FillSolid, TouchingPartsAreSeparated) {
    for (const Cells& cells : {Cells{{0, 0, 0}, {1, 1, 1}}, Cells{{0, 0, 0}, {1, 1, 0}}}) {
        const TriMesh mesh = without_faces(surface_of("touching", cells));
        const Solid solid = fill(mesh, PW_FILL_EXACT | PW_FILL_REPAIRED);
        expect_sound(solid, mesh, PW_FILL_REPAIRED);
        EXPECT_NEAR(used_volume(solid), 2, 0.01);
        EXPECT_LT(solid.surface.deviation, 1e-3);
    }
}

// Two coincident vertices, as remain where a part was cut off: nothing else moves, every face stays.
TEST(FillSolid, CoincidentVerticesAreSeparated) {
    const TriMesh mesh = together("corner to corner", cube(), moved(cube(), {1, 1, 1}));
    ASSERT_EQ(expected_status(mesh), PW_ERROR_SELF_INTERSECTION);
    const Solid solid = fill(mesh);
    expect_sound(solid, mesh, PW_FILL_REPAIRED);
    EXPECT_EQ(solid.surface.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(std::count(solid.surface.source_vertex.begin(), solid.surface.source_vertex.end(), -1), 2);
    EXPECT_NEAR(used_volume(solid), 2 * std::fabs(enclosed_volume(cube())), 0.01);
    Progress progress;
    progress.begin();
    EXPECT_TRUE(displace_vertices(read_mesh(mesh.view()), progress)) << "other repairs give the same, but may fail";
}

// Noise makes neighboring triangles of a fine mesh intersect.
TEST(FillSolid, NoiseIsSmoothed) {
    const TriMesh clean = without_faces(torus(90, 40, 2, 0.5));
    const TriMesh mesh = named(perturbed(clean, 0.06, 7), "noisy torus");
    ASSERT_EQ(expected_status(mesh), PW_ERROR_SELF_INTERSECTION);
    const Solid solid = fill(mesh);
    expect_sound(solid, mesh, PW_FILL_REPAIRED);
    ASSERT_EQ(solid.surface.triangles.size(), mesh.triangles.size());
    for (const FaceSample& piece : solid.surface.samples) EXPECT_GT(piece.area, 0);
    EXPECT_GT(solid.surface.deviation, 0);
    EXPECT_LT(solid.surface.deviation, 0.06 * std::sqrt(3.0) / 5);
    EXPECT_NEAR(used_volume(solid), std::fabs(enclosed_volume(clean)), 0.02 * std::fabs(enclosed_volume(clean)));
}

// Also with few triangles, thin limbs and the gaps between them remain.
TEST(FillSolid, ThinLimbsSurviveFillingFromPoints) {
    Cells cells = block({0, 0, 0}, {5, 2, 1});
    for (const int x : {0, 2, 4}) cells = cells + block({x, 0, 1}, {x + 1, 1, 2});
    const TriMesh fork = without_faces(surface_of("fork", cells, {1, 1, 40}));
    ASSERT_LT(fork.triangles.size(), 100U);
    const Solid solid = fill(fork, PW_FILL_POINTS);
    expect_sound(solid, fork, PW_FILL_POINTS);
    EXPECT_LT(solid.surface.deviation, 0.02);
    EXPECT_NEAR(used_volume(solid), enclosed_volume(fork), 0.05 * enclosed_volume(fork));
}

// Compilers differ in what CGAL's own handlers write, but a warning is written by all.
TEST(FillSolid, CgalPrintsNothing) {
    (void)fill(cube());
    testing::internal::CaptureStderr();
    CGAL::warning_fail("expression", "file", 1, "message");
    EXPECT_THROW(CGAL::assertion_fail("expression", "file", 1, "message"), CGAL::Failure_exception);
    EXPECT_THROW(CGAL::precondition_fail("expression", "file", 1, "message"), CGAL::Failure_exception);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(FillSolid, FillingFromPointsCanBeCanceled) {
    pw_context* context = nullptr;
    ASSERT_EQ(pw_context_create(&context), PW_OK);
    (void)pw_context_cancel(context);
    EXPECT_EQ(try_build(cube(), 0, context, PW_FILL_POINTS).status, PW_ERROR_CANCELED);
    pw_context_free(context);
}

// To the nearest triangle, by brute force.
double squared_distance(const Surface& surface, const Point& p) {
    using Kernel = CGAL::Simple_cartesian<double>;
    const auto given = [](const Point& q) { return Kernel::Point_3(q[0], q[1], q[2]); };
    double least = HUGE_VAL;
    for (const Triangle& t : surface.triangles) {
        const auto at = [&](size_t k) { return given(surface.vertices[static_cast<size_t>(t[k])]); };
        least = std::min(least, CGAL::squared_distance(given(p), Kernel::Triangle_3(at(0), at(1), at(2))));
    }
    return least;
}

Solid fill_as_proxy(const TriMesh& mesh, size_t exact_triangles, size_t threads = 0) {
    FillOptions options;
    options.exact_triangles = exact_triangles;
    options.threads = threads;
    Progress progress;
    progress.begin();
    return fill_solid(mesh.view(), options, progress);
}

TEST(FillSolid, LargeSurfacesUseACloseAndClosedProxy) {
    std::vector<TriMesh> meshes{torus(60, 40, 2, 0.5), real_mesh("joint.off")};
    if (!light()) meshes.push_back(real_mesh("elephant.off"));
    for (const TriMesh& mesh : meshes) {
        const size_t large = mesh.triangles.size() - 1;
        Progress progress;
        progress.begin();
        const Solid solid = fill_as_proxy(mesh, large);
        EXPECT_NE(solid.surface.fill_method, PW_FILL_POINTS);
        expect_sound(solid, mesh, solid.surface.fill_method);
        EXPECT_EQ(solid.surface.proxy_triangles, decimate(read_mesh(mesh.view()), std::max(large / 4, size_t{100}), 0,
                                                             progress).surface.triangles.size());
        EXPECT_LE(solid.surface.triangles.size(), std::max(large / 4, size_t{100}));
        double max_squared = 0;
        for (const Point& p : mesh.vertices)
            max_squared = std::max(max_squared, squared_distance(solid.surface, solid.surface.frame.to_working(p)));
        const double deviation = std::sqrt(max_squared) / diagonal(read_mesh(mesh.view()));
        EXPECT_NEAR(solid.surface.deviation, deviation, 1e-9);
        EXPECT_LT(solid.surface.deviation, 0.05);
        EXPECT_NEAR(used_volume(solid), std::fabs(enclosed_volume(mesh)), 0.1 * std::fabs(enclosed_volume(mesh)));
        for (const int32_t s : solid.surface.source_vertex) EXPECT_GE(s, 0);
        EXPECT_EQ(fill_as_proxy(mesh, large + 1).surface.fill_method, PW_FILL_EXACT);
        EXPECT_EQ(fill_as_proxy(mesh, large + 1).surface.proxy_triangles, 0U);
        const Solid alone = fill_as_proxy(mesh, large, 1);
        EXPECT_EQ(alone.surface.vertices, solid.surface.vertices);
        EXPECT_EQ(alone.surface.triangles, solid.surface.triangles);
        EXPECT_EQ(alone.surface.samples, solid.surface.samples);
    }
}

// Twice V - E + F of a copy of so many triangles, each side of which is there once: edges that have two count once.
int64_t twice_euler(const TriMesh& mesh, size_t target, bool open) {
    Progress progress;
    progress.begin();
    const Surface copy = decimate(read_mesh(mesh.view()), target, 0, progress).surface;
    std::set<std::pair<int32_t, int32_t>> sides;
    for (const Triangle& t : copy.triangles)
        for (size_t k = 0; k < 3; ++k) EXPECT_TRUE(sides.insert({t[k], t[(k + 1) % 3]}).second);
    const auto border = std::ranges::count_if(sides, [&](const auto& s) { return !sides.contains({s.second, s.first}); });
    EXPECT_EQ(border > 0, open);
    const auto faces = static_cast<int64_t>(copy.triangles.size());
    EXPECT_LT(copy.triangles.size(), mesh.triangles.size());
    return 2 * static_cast<int64_t>(copy.vertices.size()) - (3 * faces + border) + 2 * faces;
}

TEST(FillSolid, TheProxyIsNeitherPinchedNorClosed) {
    EXPECT_EQ(twice_euler(torus(300, 3, 2, 0.01), 100, false), 0);  // so thin that cheaper collapses would pinch it
    TriMesh disk = without_faces(sphere(30, 40));
    std::erase_if(disk.triangles, [&](const Triangle& t) {
        return std::ranges::all_of(t, [&](int32_t v) { return disk.vertices[static_cast<size_t>(v)][2] > 0.9; });
    });
    EXPECT_EQ(twice_euler(without_faces(disk), 200, true), 2);
}

TEST(FillSolid, ALargeMeshOfDegenerateTrianglesIsRefused) {
    TriMesh mesh = without_faces(cube());
    for (Triangle& t : mesh.triangles) t[2] = t[1];
    FillOptions options;
    options.exact_triangles = 4;
    Progress progress;
    progress.begin();
    try {
        (void)fill_solid(mesh.view(), options, progress);
        ADD_FAILURE() << "it was filled";
    } catch (const Error& error) {
        EXPECT_EQ(error.status(), PW_ERROR_NOT_SOLID);
    }
}

}  // namespace
}  // namespace partwheel::test
