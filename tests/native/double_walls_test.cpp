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
    return find_inner_walls(mesh.vertices, mesh.triangles, unobserved_progress());
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

Point center(const TriMesh& mesh, int32_t triangle) {
    const Triangle& t = mesh.triangles[idx(triangle)];
    return 1.0 / 3 * (mesh.vertices[idx(t[0])] + mesh.vertices[idx(t[1])] + mesh.vertices[idx(t[2])]);
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

TEST(DoubleWalls, InnerTrianglesLieBehindTheOuterOnesInFront) {
    const TriMesh mesh = hollow(sphere(40, 80), 0.015, true);
    const std::vector<int32_t> behind = inner_walls(mesh);
    ASSERT_EQ(behind.size(), mesh.triangles.size());
    for (size_t t = 0; t < behind.size(); ++t) {
        if (behind[t] < 0) continue;
        ASSERT_EQ(behind[idx(behind[t])], -1);
        const Point inner = center(mesh, static_cast<int32_t>(t)), outer = center(mesh, behind[t]);
        EXPECT_GT(dot(inner, outer) / length(inner) / length(outer), 0.99) << t;
    }
}

TEST(DoubleWalls, TheOrderOfTrianglesDoesNotMatter) {
    const TriMesh mesh = hollow(real_mesh("homer.off"), 0.015, true);
    const std::vector<int32_t> behind = inner_walls(mesh);
    std::vector<size_t> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    TriMesh other = mesh;
    std::vector<int32_t> place(order.size());
    for (size_t t = 0; t < order.size(); ++t) {
        other.triangles[t] = mesh.triangles[order[t]];
        std::rotate(other.triangles[t].begin(), other.triangles[t].begin() + t % 3, other.triangles[t].end());
        place[order[t]] = static_cast<int32_t>(t);
    }
    const std::vector<int32_t> result = inner_walls(other);
    ASSERT_EQ(result.size(), behind.size());
    for (size_t t = 0; t < order.size(); ++t)
        EXPECT_EQ(result[t], behind[order[t]] < 0 ? -1 : place[idx(behind[order[t]])]) << t;
}

TEST(DoubleWalls, ScaleAndPositionDoNotMatter) {
    const TriMesh mesh = hollow(snowman(20, 40), 0.01, true);
    const std::vector<int32_t> behind = inner_walls(mesh);
    EXPECT_FALSE(behind.empty());
    for (const double scale : {0x1p-300, 0x1p300})
        EXPECT_EQ(inner_walls(stretched(mesh, {scale, scale, scale})), behind) << scale;
    EXPECT_GT(right_share(mesh, inner_walls(moved(mesh, {1000, -2000, 0.3}))), 0.99);
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

TEST(DoubleWalls, ThinSolidsAndThickWallsAreNoDoubleWalls) {
    const TriMesh ball = sphere(20, 40);
    const auto scaled = [&](double s) { return stretched(inside_out(ball), {s, s, s}); };
    for (const TriMesh& mesh : {stretched(ball, {1, 1, 0.01}), stretched(cube(), {1, 0.2, 0.004}), torus(60, 30, 2, 0.02),
                                together("a thick wall", ball, scaled(0.8)), together("a ball in a ball", ball, scaled(0.3)),
                                together("nested boxes", cube(), stretched(cube(), {0.5, 0.5, 0.5})), ball, cube(),
                                star_prism(30, 0.2, 1, 0.5), hedgehog(20)})
        EXPECT_TRUE(inner_walls(mesh).empty()) << mesh.name;
}

TEST(DoubleWalls, RealModelsHaveNone) {
    for (const TriMesh& mesh : real_meshes(3000)) EXPECT_TRUE(inner_walls(mesh).empty()) << mesh.name;
}

TEST(DoubleWalls, AnyTrianglesAreAnswered) {
    EXPECT_TRUE(find_inner_walls({}, {}, unobserved_progress()).empty());
    const std::vector<Point> point(3, Point{1, 2, 3});
    EXPECT_TRUE(find_inner_walls(point, std::vector<Triangle>{{0, 1, 2}, {0, 0, 0}}, unobserved_progress()).empty());
    std::mt19937 random(1);
    std::uniform_real_distribution<double> anywhere(0, 1);
    std::vector<Point> vertices;
    std::vector<Triangle> soup;
    for (int32_t v = 0; v < 3000; v += 3) {
        for (int k = 0; k < 3; ++k) vertices.push_back({anywhere(random), anywhere(random), anywhere(random)});
        soup.push_back({v, v + 1, v + 2});
    }
    EXPECT_NO_THROW(find_inner_walls(vertices, soup, unobserved_progress()));
}

// Long thin triangles: the second ball has 40 times as many, which would cover more voxels than the work's bound.
TEST(DoubleWalls, TrianglesThatCoverTooManyVoxelsAreNotSearched) {
    EXPECT_FALSE(inner_walls(hollow(sphere(3, 400), 0.015, true)).empty());
    EXPECT_TRUE(inner_walls(hollow(sphere(3, 16000), 0.015, true)).empty());
}

TEST(DoubleWalls, CanBeCanceled) {
    const TriMesh mesh = hollow(sphere(40, 80), 0.01, true);
    Progress progress;
    progress.begin();
    progress.cancel();
    EXPECT_THROW(find_inner_walls(mesh.vertices, mesh.triangles, progress), Error);
}

}  // namespace
}  // namespace partwheel::test
