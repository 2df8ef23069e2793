// The search for crossings: it finds all, ends at the first if that is enough, and takes about n log n steps, also in fans.
#include "mesh/crossings.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>

namespace partwheel::test {
namespace {

using partwheel::operator+;
using partwheel::operator*;

// With corners on a sphere, so that nearly every two intersect.
TriMesh crossing_triangles(size_t count) {
    TriMesh mesh;
    mesh.name = "crossing triangles";
    std::mt19937 random(1);
    std::normal_distribution<double> any;
    for (int32_t n = 0; mesh.triangles.size() < count; n += 3) {
        for (int k = 0; k < 3; ++k) {
            const Point p{any(random), any(random), any(random)};
            mesh.vertices.push_back(1 / length(p) * p);
        }
        mesh.triangles.push_back({n, n + 1, n + 2});
    }
    return without_faces(mesh);
}

// All triangles around one vertex: a disk, or a cone.
TriMesh fan(int count, double height) {
    TriMesh mesh;
    mesh.name = "fan of " + std::to_string(count);
    mesh.vertices.push_back({0, 0, height});
    for (int32_t i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count;
        mesh.vertices.push_back({std::cos(angle), std::sin(angle), 0});
        mesh.triangles.push_back({0, i + 1, (i + 1) % count + 1});
    }
    return without_faces(mesh);
}

// Triangles that share an edge.
TriMesh book(int count) {
    TriMesh mesh;
    mesh.name = "book of " + std::to_string(count);
    mesh.vertices = {{0, 0, 0}, {0, 0, 1}};
    for (int32_t i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count;
        mesh.vertices.push_back({std::cos(angle), std::sin(angle), 0.5});
        mesh.triangles.push_back({0, 1, i + 2});
    }
    return without_faces(mesh);
}

// A thin coin: two fans that lie on each other, and the ring between them.
TriMesh coin(int count) { return lathe("coin of " + std::to_string(count), {{1, 0}, {1, 0.001}}, count); }

TriMesh copies_at_one_place(size_t count) {
    TriMesh mesh = tetrahedron();
    while (mesh.triangles.size() < 4 * count) mesh = together("copies", mesh, mesh);
    return mesh;
}

// Pages of two triangles each; twist: of the outer corner, as an angle.
TriMesh book_of_quads(int count, double twist = 0) {
    TriMesh mesh = named(book(count), "book of " + std::to_string(count) + " quads");
    for (int32_t i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count + twist * (i % 3);
        mesh.vertices.push_back({2 * std::cos(angle), 2 * std::sin(angle), 0});
        mesh.triangles.push_back({0, i + 2, count + 2 + i});
    }
    return without_faces(mesh);
}

TriMesh nested_spheres(int count) {
    TriMesh mesh;
    for (int i = 0; i < count; ++i) mesh = together("nested", mesh, stretched(sphere(6, 8), std::pow(1.01, i) * Point{1, 1, 1}));
    return named(mesh, std::to_string(count) + " nested spheres");
}

// Boxes whose facing sides are almost at one place.
TriMesh stack(int count) {
    TriMesh mesh;
    for (int i = 0; i < count; ++i) mesh = together("stack", mesh, moved(cube(), {0, 0, (1 + 1e-9) * i}));
    return named(mesh, "stack of " + std::to_string(count));
}

// Two parallel sheets of squares and the sides between them.
TriMesh thin_grid(int side) {
    return surface_of("thin grid of " + std::to_string(side), block({0, 0, 0}, {side, side, 1}), {1, 1, 1e-3});
}

struct Search {
    size_t steps = 0, crossings = 0;
};

Search search(const TriMesh& mesh, bool first_only) {
    Progress progress;
    progress.begin();
    CrossingSearch all(mesh.vertices, mesh.triangles);
    Search found;
    all.for_each_crossing(progress, [&](size_t, size_t) {
        ++found.crossings;
        return !first_only;
    });
    found.steps = all.steps();
    return found;
}

TEST(Crossings, StepsGrowAsNLogN) {
    for (const auto& [small, large] :
         {std::pair{sphere(16, 32), sphere(32, 64)}, std::pair{fan(1000, 0), fan(4000, 0)}, std::pair{fan(1000, 1), fan(4000, 1)},
          std::pair{together("two cones", fan(500, 1), fan(500, -1)), together("two cones", fan(2000, 1), fan(2000, -1))},
          std::pair{coin(500), coin(2000)}, std::pair{book(1000), book(4000)}, std::pair{book_of_quads(1000), book_of_quads(4000)},
          std::pair{nested_spheres(50), nested_spheres(200)}, std::pair{stack(250), stack(1000)}, std::pair{thin_grid(32), thin_grid(64)}}) {
        SCOPED_TRACE(large.name);
        const Search one = search(small, false), other = search(large, false);
        EXPECT_EQ(one.crossings, other.crossings > 0 ? one.crossings : 0);
        EXPECT_LT(other.steps, 6 * one.steps);  // of four times as many triangles
        const auto n = static_cast<double>(large.triangles.size());
        EXPECT_LT(static_cast<double>(other.steps), 20 * n * std::log2(n));
    }
}

TEST(Crossings, ASearchCanEndAtTheFirst) {
    for (const TriMesh& mesh : {crossing_triangles(20000), copies_at_one_place(4096)}) {
        const Search found = search(mesh, true);
        EXPECT_EQ(found.crossings, 1U) << mesh.name;
        EXPECT_LT(found.steps, 10 * mesh.triangles.size()) << mesh.name;
    }
}

// Long parallel triangles, in a direction between those of the bounds: all bounds overlap.
TEST(Crossings, StepsAreBounded) {
    TriMesh mesh;
    for (int32_t i = 0; i < 8000; ++i) {
        const Point begin = 1e-4 * i * Point{1, 1, -1}, end = begin + Point{300, 600, 900};
        mesh.vertices.insert(mesh.vertices.end(), {begin, end, end + Point{0.01, 0, 0}});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    Progress progress;
    progress.begin();
    CrossingSearch all(mesh.vertices, mesh.triangles);
    try {
        all.for_each_crossing(progress, [](size_t, size_t) { return true; });
        ADD_FAILURE() << all.steps() << " steps";
    } catch (const Error& error) {
        EXPECT_EQ(error.status(), PW_ERROR_SELF_INTERSECTION);
    }
    EXPECT_EQ(all.steps(), all.max_steps() + 1);
}

// The same pairs as every two triangles by themselves.
TEST(Crossings, AllCrossingsAreFound) {
    for (const TriMesh& mesh :
         {crossing_triangles(60), together("two spheres", sphere(5, 8), moved(sphere(5, 8), {0.3, 0.2, 0.1})), fan(40, 0.5),
          together("two fans", fan(40, 0.5), moved(fan(40, 0.25), {0.01, 0.02, 0})), book(40), book_of_quads(40, 0.7),
          book_of_quads(40, std::numbers::pi - 0.01), copies_at_one_place(4)}) {
        size_t crossings = 0;
        for (size_t t = 0; t < mesh.triangles.size(); ++t)
            for (size_t u = 0; u < t; ++u) {
                TriMesh pair = mesh;
                pair.triangles = {mesh.triangles[t], mesh.triangles[u]};
                crossings += search(pair, false).crossings;
            }
        EXPECT_EQ(search(mesh, false).crossings, crossings) << mesh.name;
    }
}

}  // namespace
}  // namespace partwheel::test
