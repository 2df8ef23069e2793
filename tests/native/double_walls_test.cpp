// Double walls: models whose inner wall is known, made from closed surfaces; and models that have none.
#include "support/real_meshes.h"
#include "prepare/double_walls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace partwheel::test {
namespace {

using partwheel::operator+, partwheel::operator-, test::operator-;

std::vector<int32_t> inner_walls(const TriMesh& mesh) {
    return find_double_wall(mesh.vertices, mesh.triangles, unobserved_progress());
}

// Twice as many triangles: those of the mesh, then the same ones moved inward by a share of the diagonal.
TriMesh hollow(const TriMesh& mesh, double thickness, bool inward) {
    std::vector<Point> normals(mesh.vertices.size());
    for (const Triangle& t : mesh.triangles) {
        const Point& a = mesh.vertices[idx(t[0])];
        const Point normal = cross(mesh.vertices[idx(t[1])] - a, mesh.vertices[idx(t[2])] - a);
        for (const int32_t v : t) normals[idx(v)] = normals[idx(v)] + normal;
    }
    TriMesh inner = without_faces(inward ? inside_out(mesh) : mesh);
    const double distance = thickness * Box::around(mesh.vertices).diagonal();
    for (size_t v = 0; v < normals.size(); ++v)
        inner.vertices[v] = mesh.vertices[v] - distance / length(normals[v]) * normals[v];
    return together("hollow " + mesh.name, without_faces(mesh), inner);
}

// The triangles at each of these vertices of the outer wall and at the same ones of the inner wall make way for a band
// that joins the rims.
TriMesh leaky(TriMesh mesh, const std::vector<int32_t>& leaks) {
    const auto shift = static_cast<int32_t>(mesh.vertices.size() / 2);
    const auto has = [](const Triangle& t, int32_t v) { return std::find(t.begin(), t.end(), v) != t.end(); };
    for (const int32_t leak : leaks) {
        std::vector<Triangle> kept, band;
        for (Triangle t : mesh.triangles) {
            if (!has(t, leak) && !has(t, leak + shift)) kept.push_back(t);
            if (!has(t, leak)) continue;
            std::rotate(t.begin(), std::find(t.begin(), t.end(), leak), t.end());
            band.push_back({t[1], t[2], t[2] + shift});
            band.push_back({t[1], t[2] + shift, t[1] + shift});
        }
        kept.insert(kept.end(), band.begin(), band.end());
        mesh.triangles = std::move(kept);
    }
    return mesh;
}

// Which share of the area is taken for what it is: a triangle of the second half of the vertices is of the inner wall.
// The bands count for neither.
double right_share(const TriMesh& mesh, const std::vector<int32_t>& behind) {
    if (behind.empty()) return 0;
    const auto half = static_cast<int32_t>(mesh.vertices.size() / 2);
    double right = 0, all = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        const auto [low, high] = std::minmax({t[0], t[1], t[2]});
        if (low < half && high >= half) continue;
        const double a = area(mesh.vertices[idx(t[0])], mesh.vertices[idx(t[1])], mesh.vertices[idx(t[2])]);
        all += a;
        if ((behind[i] >= 0) == (low >= half)) right += a;
    }
    return right / all;
}

TEST(DoubleWalls, InnerWallsAreFoundAtAnyThicknessAndOrientation) {
    const TriMesh homer = real_mesh("homer.off"), box = rotated(stretched(cube(), {1, 0.5, 0.3}), 1, {0.3, 1, 0.2});
    const auto check = [](const TriMesh& solid, double thickness, bool inward) {
        const TriMesh mesh = hollow(solid, thickness, inward);
        EXPECT_GT(right_share(mesh, inner_walls(mesh)), 0.99) << mesh.name << ", " << thickness << ", " << inward;
    };
    for (const bool inward : {true, false})
        for (const double thickness : {0.005, 0.015}) check(homer, thickness, inward);
    check(box, 0.005, true);
    check(sphere(20, 40), 0.015, false);
    check(torus(48, 24, 2, 0.7), 0.005, false);
}

TEST(DoubleWalls, LeaksBetweenTheWallsAreClosed) {
    const TriMesh homer = real_mesh("homer.off");
    const auto n = static_cast<int32_t>(homer.vertices.size());
    for (const double thickness : {0.005, 0.015}) {
        const TriMesh mesh = leaky(hollow(homer, thickness, true), {n / 7, n / 3, n / 2, 2 * n / 3, 4 * n / 5});
        EXPECT_GT(right_share(mesh, inner_walls(mesh)), 0.99) << thickness;
    }
}

TEST(DoubleWalls, AWallInASmallShareOfTheSurfaceIsNoDoubleWall) {
    const TriMesh part = moved(stretched(hollow(sphere(20, 40), 0.01, true), {0.8, 0.8, 0.8}), {3, 0, 0});
    EXPECT_FALSE(inner_walls(part).empty());
    EXPECT_TRUE(inner_walls(together("hollow in part", without_faces(sphere(20, 40)), part)).empty());
}

TEST(DoubleWalls, CavitiesThatAreSeenFromOutsideAreNoDoubleWalls) {
    const std::vector<Ring> bowl{{0.3, 0}, {1, 0.4}, {1.3, 1}, {1.25, 1}, {0.95, 0.45}, {0.3, 0.05}};
    const std::vector<Ring> vase{{0.5, 0}, {1, 1}, {0.25, 2}, {0.3, 2.3}, {0.25, 2.3}, {0.2, 2}, {0.95, 1}, {0.45, 0.05}};
    const Cells room = block({0, 0, 0}, {40, 40, 30}) - block({1, 1, 1}, {39, 39, 29});
    const Cells open_box = block({0, 0, 0}, {40, 40, 30}) - block({1, 1, 1}, {39, 39, 30});
    for (const TriMesh& mesh : {lathe("bowl", bowl, 64), lathe("vase", vase, 64), surface_of("open box", open_box),
                                surface_of("room with a door", room - block({0, 17, 1}, {1, 22, 12}))})
        EXPECT_TRUE(inner_walls(mesh).empty()) << mesh.name;
    EXPECT_FALSE(inner_walls(surface_of("closed room", room)).empty());
}

// The space between them is enclosed, and close to the outside on both sides.
TEST(DoubleWalls, ABossSunkIntoAShieldIsNoInnerWall) {
    const TriMesh shield = surface_of("shield", block({0, 0, 0}, {80, 80, 7}) - block({10, 10, 2}, {70, 70, 7}));
    const TriMesh boss = surface_of("boss", block({6, 6, 6}, {74, 74, 9}));
    EXPECT_TRUE(inner_walls(together("shield and boss", shield, boss)).empty());
}

TEST(DoubleWalls, ThinSolidsAndThickWallsAreNoDoubleWalls) {
    const TriMesh ball = sphere(20, 40);
    const auto scaled = [&](double s) { return stretched(inside_out(ball), {s, s, s}); };
    const TriMesh box = moved(stretched(inside_out(cube()), {0.9, 0.9, 0.9}), {0.02, 0.02, 0.02});  // three walls are thin
    for (const TriMesh& mesh : {stretched(ball, {1, 1, 0.01}), stretched(cube(), {1, 0.2, 0.004}), torus(60, 30, 2, 0.02),
                                together("a thick wall", ball, scaled(0.8)), together("a ball in a ball", ball, scaled(0.3)), together("a box in a corner", cube(), box),
                                together("nested boxes", cube(), stretched(cube(), {0.5, 0.5, 0.5})), ball, cube(),
                                star_prism(30, 0.2, 1, 0.5), hedgehog(20)})
        EXPECT_TRUE(inner_walls(mesh).empty()) << mesh.name;
}

// Long thin triangles: the second ball has 40 times as many, which would cover more voxels than the work's bound.
TEST(DoubleWalls, TrianglesThatCoverTooManyVoxelsAreNotSearched) {
    EXPECT_FALSE(inner_walls(hollow(sphere(3, 400), 0.015, true)).empty());
    EXPECT_TRUE(inner_walls(hollow(sphere(3, 16000), 0.015, true)).empty());
}

}  // namespace
}  // namespace partwheel::test
