// Creases: counted by hand on shapes of unit squares; none on rounded shapes.
#include "support/shapes.h"
#include "mesh/creases.h"

#include <gtest/gtest.h>

#include <set>

namespace partwheel::test {
namespace {

using Edges = std::vector<std::array<int32_t, 2>>;

Edges creases_of(const TriMesh& mesh) { return find_creases(mesh.view(), find_shells(mesh.view())); }

// A wall with a window of 2 x 2 squares, one deep, and a knob of one cube.
TriMesh wall() {
    return surface_of("wall", block({0, 0, 0}, {10, 3, 4}) - block({2, 0, 1}, {4, 1, 3}) + block({7, -1, 1}, {8, 0, 2}));
}

// By their coordinates: the eight sides of the window's pane and the four edges from its corners outward; the sides of
// the square between knob and wall.
std::set<std::set<Point>> expected_on_wall() {
    std::set<std::set<Point>> edges;
    for (const double z : {1.0, 3.0})
        for (const double x : {2.0, 3.0}) edges.insert({{x, 1, z}, {x + 1, 1, z}});
    for (const double x : {2.0, 4.0}) {
        for (const double z : {1.0, 2.0}) edges.insert({{x, 1, z}, {x, 1, z + 1}});
        for (const double z : {1.0, 3.0}) edges.insert({{x, 0, z}, {x, 1, z}});
    }
    for (const double k : {0.0, 1.0}) {
        edges.insert({{7, 0, 1 + k}, {8, 0, 1 + k}});
        edges.insert({{7 + k, 0, 1}, {7 + k, 0, 2}});
    }
    return edges;
}

TEST(Creases, AreWhereAFlatSurfaceIsFoldedInward) {
    const TriMesh mesh = wall();
    std::set<std::set<Point>> found;
    for (const auto& [a, b] : creases_of(mesh)) found.insert({mesh.vertices[idx(a)], mesh.vertices[idx(b)]});
    EXPECT_EQ(found, expected_on_wall());
}

TEST(Creases, AreTheSameInAnyPosition) {
    const TriMesh mesh = wall();
    const Edges edges = creases_of(mesh);
    ASSERT_EQ(edges.size(), expected_on_wall().size());
    EXPECT_EQ(creases_of(inside_out(mesh)), edges);
    EXPECT_EQ(creases_of(moved(rotated(mesh, 0.7, {1, 2, 3}), {1000, -300, 20})), edges);
    EXPECT_EQ(creases_of(stretched(mesh, {1e-3, 1e-3, 1e-3})), edges);
}

TEST(Creases, AreOnlyOnShellsOfFlatPolygons) {
    EXPECT_TRUE(creases_of(torus(24, 10, 3, 1)).empty());
    EXPECT_TRUE(creases_of(snowman(12, 16)).empty());  // it is folded inward at the neck
    const TriMesh rough = perturbed(moved(wall(), {0, 20, 0}), 0.1, 1);
    EXPECT_TRUE(creases_of(rough).empty());
    EXPECT_EQ(creases_of(together("both", wall(), rough)), creases_of(wall()));
}

}  // namespace
}  // namespace partwheel::test
