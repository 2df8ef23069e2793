// Filling from points, and winding numbers, against solid angles and volumes.
#include "fill/points.h"

#include "fill/fill_solid.h"
#include "fill/winding_surface.h"
#include "fill/winding.h"
#include "support/built.h"
#include "support/real_meshes.h"
#include "support/shapes.h"
#include "support/sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>

namespace partwheel::test {
namespace {

using partwheel::operator+, partwheel::operator-, test::operator+;

// Every triangle's solid angle, by the standard library.
double every_angle(const TriMesh& mesh, const Point& p) {
    double sum = 0;
    for (const Triangle& t : mesh.triangles) {
        const auto way = [&](size_t k) { return mesh.vertices[idx(t[k])] - p; };
        const Point a = way(0), b = way(1), c = way(2);
        const double x = length(a), y = length(b), z = length(c);
        sum += 2 * std::atan2(dot(a, cross(b, c)), x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y);
    }
    return sum / (4 * std::numbers::pi);
}

Solid filled(const TriMesh& mesh, size_t threads = 0) {
    Progress progress;
    progress.begin();
    return fill_solid(mesh.view(), {0, PW_FILL_POINTS, {}, threads}, progress);
}

double volume(const Solid& solid) {
    double sum = 0;
    for (const auto& [a, b, c, d] : solid.mesh.tetrahedra) {
        const auto point = [&](int32_t v) { return solid.mesh.vertices[idx(v)]; };
        sum += signed_volume6(point(a), point(b), point(c), point(d)) / 6;
    }
    return solid.surface.frame.volume_to_caller(sum);
}

// Tetrahedra that share facets.
size_t pieces(const TetMesh& mesh) {
    std::vector<bool> seen(mesh.tetrahedra.size(), false);
    size_t count = 0;
    for (size_t start = 0; start < seen.size(); ++start) {
        if (seen[start]) continue;
        ++count;
        std::vector<int32_t> open(1, static_cast<int32_t>(start));
        seen[start] = true;
        while (!open.empty()) {
            const int32_t t = open.back();
            open.pop_back();
            for (const int32_t next : mesh.neighbors[idx(t)])
                if (next >= 0 && !seen[idx(next)]) seen[idx(next)] = true, open.push_back(next);
        }
    }
    return count;
}

// Each triangle of the surface is the facet of the tetrahedron behind it that has no neighbor, and these are all.
void expect_fits(const Solid& solid) {
    const TetMesh& mesh = solid.mesh;
    std::map<Triangle, size_t> bare;
    for (size_t t = 0; t < mesh.tetrahedra.size(); ++t)
        for (size_t k = 0; k < 4; ++k) {
            Triangle f = facet(mesh.tetrahedra[t], k);
            std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
            if (mesh.neighbors[t][k] < 0) {
                EXPECT_TRUE(bare.emplace(f, t).second);
            }
        }
    ASSERT_EQ(bare.size(), solid.surface.triangles.size());
    for (size_t i = 0; i < solid.surface.triangles.size(); ++i) {
        const auto found = bare.find(solid.surface.triangles[i]);
        ASSERT_NE(found, bare.end());
        EXPECT_EQ(static_cast<int32_t>(found->second), mesh.tet_of_triangle[i]);
    }
    EXPECT_TRUE(std::equal(solid.surface.vertices.begin(), solid.surface.vertices.end(), mesh.vertices.begin()));
}

TriMesh damaged(TriMesh mesh, const std::string& name, const std::function<bool(size_t)>& keep,
                const std::function<bool(size_t)>& turn) {
    std::vector<Triangle> kept;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (turn(t)) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
        if (keep(t)) kept.push_back(mesh.triangles[t]);
    }
    mesh.triangles = kept;
    mesh.name += ", " + name;
    return without_faces(mesh);
}

TEST(Winding, IsTheSumOfAllSolidAngles) {
    const auto none = [](size_t) { return false; };
    const TriMesh open = damaged(snowman(20, 24), "open", [](size_t t) { return t % 5 != 0; }, none);
    for (const TriMesh& mesh : {cube(), without_faces(snowman(20, 24)), open, real_mesh("hand.off")}) {
        const WindingNumber winding(mesh.vertices, mesh.triangles);
        std::mt19937 random(1);
        const auto share = [&] { return 1.4 * static_cast<double>(random()) / 4294967296.0 - 0.2; };
        Point low = mesh.vertices[0], high = low;
        for (const Point& p : mesh.vertices)
            for (size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
        for (int i = 0; i < sized(300, 50); ++i) {
            Point p;
            for (size_t k = 0; k < 3; ++k) p[k] = low[k] + (high[k] - low[k]) * share();
            EXPECT_NEAR(winding.at(p), every_angle(mesh, p), 0.05) << mesh.name;
        }
    }
}

TEST(Points, APolyhedronIsFilledExactly) {
    for (const TriMesh& mesh : {cube(), together("apart", cube(), moved(cube(), {3, 0, 0}))}) {
        const Solid solid = filled(mesh);
        expect_fits(solid);
        EXPECT_NEAR(volume(solid), std::fabs(enclosed_volume(mesh)), 1e-9);
        EXPECT_EQ(pieces(solid.mesh), mesh.triangles.size() / 12);
        EXPECT_EQ(std::ranges::count_if(solid.surface.source_vertex, [](int32_t s) { return s >= 0; }),
                  static_cast<std::ptrdiff_t>(mesh.vertices.size()));
    }
}

// Holes, flipped, duplicate and intersecting faces, faces without shared vertices.
TEST(Points, BrokenModelsAreFilledLikeTheOriginals) {
    const TriMesh whole = without_faces(snowman(24, 32));
    const double expected = std::fabs(enclosed_volume(whole));
    const auto none = [](size_t) { return false; };
    const auto all = [](size_t) { return true; };
    TriMesh doubled = whole, loose = whole;
    doubled.name = "doubled";
    for (size_t t = 0; t < whole.triangles.size(); t += 3) doubled.triangles.push_back(whole.triangles[t]);
    loose.name = "loose";
    loose.vertices.clear();
    for (Triangle& t : loose.triangles)
        for (int32_t& v : t) {
            loose.vertices.push_back(whole.vertices[idx(v)]);
            v = static_cast<int32_t>(loose.vertices.size() - 1);
        }
    std::vector<TriMesh> broken = {damaged(whole, "holes", [](size_t t) { return t % 9 != 0; }, none),
                                   without_faces(loose)};
    if (!light())
        broken.insert(broken.end(), {damaged(whole, "turned", all, [](size_t t) { return t % 4 == 0; }),
                                     without_faces(doubled),
                                     together("within itself", whole, stretched(whole, {0.5, 0.5, 0.5}))});
    for (const TriMesh& mesh : broken) {
        const Solid solid = filled(mesh);
        expect_fits(solid);
        EXPECT_NEAR(volume(solid), expected, 0.02 * expected) << mesh.name;
        EXPECT_EQ(pieces(solid.mesh), 1U) << mesh.name;
    }
    const Solid crossing = filled(together("crossing", whole, moved(whole, {0.4, 0, 0})));
    EXPECT_GT(volume(crossing), 1.1 * expected);
    EXPECT_LT(volume(crossing), 1.9 * expected);
    EXPECT_EQ(pieces(crossing.mesh), 1U);
}

// Inverted parts beside others, as from mirroring, and cavities.
TEST(Points, InvertedPartsAreFilledAndCavitiesAreNot) {
    const TriMesh ball = without_faces(snowman(24, 32));
    TriMesh turned = ball;
    for (Triangle& t : turned.triangles) std::swap(t[1], t[2]);
    const double one = std::fabs(enclosed_volume(ball));
    const TriMesh hollow = stretched(turned, {0.5, 0.5, 0.5});
    std::vector<std::pair<TriMesh, double>> cases = {
        {together("both", moved(turned, {9, 0, 0}), together("hollow", ball, hollow)), 2 - 0.125}};
    if (!light())
        cases.insert(cases.end(), {{together("turned", moved(ball, {9, 0, 0}), turned), 2.0},
                                   {together("hollow", ball, hollow), 1 - 0.125},
                                   {together("within another", stretched(ball, {3, 3, 3}), turned), 26.0}});
    for (const auto& [mesh, volumes] : cases)
        EXPECT_NEAR(volume(filled(without_faces(mesh))), volumes * one, 0.03 * volumes * one) << mesh.name;
}

TEST(Points, OrderAndThreadsDoNotMatter) {
    const TriMesh mesh = damaged(real_mesh("bull.off"), "holes", [](size_t t) { return t % 50 != 0; },
                                 [](size_t t) { return t % 30 == 0; });
    const Solid one = filled(mesh, 1);
    EXPECT_GT(one.mesh.tetrahedra.size(), 5000U);
    for (const Solid& other : {filled(mesh, 3), filled(shuffled(mesh, 5).mesh, 2)}) {
        EXPECT_EQ(other.mesh.tetrahedra, one.mesh.tetrahedra);
        EXPECT_EQ(other.mesh.vertices, one.mesh.vertices);
        EXPECT_EQ(other.mesh.neighbors, one.mesh.neighbors);
        EXPECT_EQ(other.surface.triangles, one.surface.triangles);
    }
}

}  // namespace
}  // namespace partwheel::test
