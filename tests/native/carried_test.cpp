// Parts carried over: those of a mesh without its noise, and without the points that were added inside.
#include "support/built.h"
#include "support/real_meshes.h"
#include "support/sizes.h"
#include "surface/prepare/rough.h"
#include "tree/carried.h"
#include "tree/hierarchy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace partwheel::test {
namespace {

std::vector<TriMesh> models() {
    std::vector<TriMesh> meshes{real_mesh("elephant.off")};
    if (!light()) meshes.push_back(real_mesh("hand.off"));
    return meshes;
}

double mean_edge(const TriMesh& mesh) {
    double sum = 0;
    for (const Triangle& t : mesh.triangles)
        for (size_t k = 0; k < 3; ++k) {
            const Point &a = mesh.vertices[static_cast<size_t>(t[k])],
                        &b = mesh.vertices[static_cast<size_t>(t[(k + 1) % 3])];
            sum += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
        }
    return sum / (3 * static_cast<double>(mesh.triangles.size()));
}

// Rough, but not so that it passes through itself.
TriMesh noisy(const TriMesh& mesh) { return named(perturbed(mesh, 0.2 * mean_edge(mesh), 3), mesh.name + ", noisy"); }

// The faces of each node at or above the parts that has at least this share of the area.
std::vector<std::vector<bool>> scored_nodes(const pw_arrays& a, double least) {
    std::vector<std::vector<bool>> nodes;
    for (size_t n = 0; n < a.node_count; ++n) {
        if (a.score[n] == 0 || a.area[n] < least * a.area[a.node_count - 1]) continue;
        nodes.emplace_back(a.face_count, false);
        for (int32_t i = a.first[n]; i < a.last[n]; ++i) nodes.back()[static_cast<size_t>(a.order[i])] = true;
    }
    return nodes;
}

// The mean over the nodes of one of the best overlap (intersection over union, by number of faces) with one of another.
double agreement(const std::vector<std::vector<bool>>& wanted, const std::vector<std::vector<bool>>& found) {
    double sum = 0;
    for (const auto& w : wanted) {
        double best = 0;
        for (const auto& f : found) {
            size_t both = 0, any = 0;
            for (size_t i = 0; i < w.size(); ++i) {
                both += w[i] && f[i];
                any += w[i] || f[i];
            }
            best = std::max(best, static_cast<double>(both) / static_cast<double>(any));
        }
        sum += best;
    }
    return sum / static_cast<double>(wanted.size());
}

TEST(Carried, PointsInsideLeaveThePartsAsTheyAre) {
    for (const TriMesh& mesh : models()) {
        SCOPED_TRACE(mesh.name);
        const Handle plain = build(mesh), filled = build(mesh, 1.4);
        ASSERT_GT(summary(filled).added_vertices, summary(plain).added_vertices);
        expect_invariants(filled, mesh, enclosed_volume(mesh));
        EXPECT_GT(agreement(scored_nodes(arrays(plain), 0.01), scored_nodes(arrays(filled), 0)), 0.999);
    }
}

TEST(Carried, ARoughSurfaceHasThePartsOfTheSmoothOne) {
    const TriMesh rough = noisy(real_mesh("elephant.off"));
    Progress progress;
    progress.begin();
    Solid solid;
    solid.surface = check_surface(rough.view(), progress);
    solid.mesh = tetrahedralize(solid.surface, 0, progress);
    ASSERT_GT(roughness(solid.surface.vertices, solid.surface.triangles), 0);
    const std::optional<TetMesh> plain = plain_filling(solid, false, progress);
    ASSERT_TRUE(plain);
    EXPECT_EQ(roughness(plain->vertices, solid.surface.triangles), 0);

    const Regrouped parts = regroup(*plain, cluster(*plain, progress), {}, progress);
    const Hierarchy smooth(solid.surface, *plain, parts, rough.vertices);
    const Handle handle = build(rough), paper = build(rough, 0, PW_MODE_PAPER);
    EXPECT_EQ(arrays(handle).tetrahedron_count, arrays(paper).tetrahedron_count);
    expect_invariants(handle, rough, enclosed_volume(rough));
    // Not all: a tetrahedron behind triangles of two parts is of one. Without carrying it is some 0.7.
    EXPECT_GT(agreement(scored_nodes(smooth.arrays(), 0.01), scored_nodes(arrays(handle), 0)), 0.95);
}

TEST(Carried, InvariantsOfSmallAndManyBodies) {
    for (const TriMesh& mesh :
         {cube(), torus(12, 6, 2, 0.6), hedgehog(12),
          surface_of("4 components", Cells{{0, 0, 0}, {3, 0, 0}, {0, 5, 0}, {9, 9, 9}}),
          surface_of("hollow", block({0, 0, 0}, {3, 3, 3}) - Cells{{1, 1, 1}})})
        expect_invariants(build(mesh, 1.2), mesh, enclosed_volume(mesh));
    const TriMesh ring = noisy(torus(60, 24, 2, 0.5)), apart = together("rough apart", ring, moved(ring, {6, 0, 0}));
    expect_invariants(build(apart), apart, enclosed_volume(apart));
}

TEST(Carried, OrderOfTheInputDoesNotMatter) {
    struct Case {
        TriMesh mesh;
        double quality;
    };
    for (const Case& c : {Case{noisy(real_mesh("elephant.off")), 0}, {real_mesh("hand.off"), 1.4}}) {
        SCOPED_TRACE(c.mesh.name);
        const Handle first = build(c.mesh, c.quality);
        const pw_arrays a = arrays(first);
        const Shuffled other = shuffled(c.mesh, 5);
        const Handle second = build(other.mesh, c.quality);
        const pw_arrays b = arrays(second);
        ASSERT_EQ(a.tetrahedron_count, b.tetrahedron_count);
        ASSERT_EQ(a.node_count, b.node_count);
        EXPECT_TRUE(std::equal(a.merges, a.merges + 2 * (a.tetrahedron_count - 1), b.merges));
        EXPECT_TRUE(std::equal(a.score, a.score + a.node_count, b.score));
        for (size_t f = 0; f < b.face_count; ++f)
            EXPECT_EQ(a.leaf[static_cast<size_t>(other.face[f])], b.leaf[f]);
    }
}

}  // namespace
}  // namespace partwheel::test
