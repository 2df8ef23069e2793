// Parts transferred from a proxy: a mesh without noise, or without added points inside.
#include "support/built.h"
#include "support/real_meshes.h"
#include "support/sizes.h"
#include "prepare/noise.h"
#include "parts/transfer.h"
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

// Noisy, but without self-intersections.
TriMesh noisy(const TriMesh& mesh) { return named(perturbed(mesh, 0.2 * mean_edge(mesh), 3), mesh.name + ", noisy"); }

// The mean over the nodes at or above the parts, of a hundredth of the area at least, of each one's best overlap
// (intersection over union, by number of faces) with a node of another hierarchy of the same faces.
double agreement(const pw_arrays& wanted, const pw_arrays& found) {
    double sum = 0;
    int count = 0;
    for (size_t n = 0; n < wanted.node_count; ++n) {
        if (wanted.score[n] == 0 || wanted.area[n] < 0.01 * wanted.area[wanted.node_count - 1]) continue;
        std::vector<int32_t> mine(found.face_count, 0);
        for (int32_t i = wanted.first[n]; i < wanted.last[n]; ++i) mine[static_cast<size_t>(wanted.order[i])] = 1;
        std::vector<int32_t> inside(found.face_count + 1, 0);  // so many of them come before, in the other's order
        for (size_t i = 0; i < found.face_count; ++i)
            inside[i + 1] = inside[i] + mine[static_cast<size_t>(found.order[i])];
        double best = 0;
        for (size_t m = 0; m < found.node_count; ++m) {
            if (found.score[m] == 0) continue;
            const int32_t first = found.first[m], last = found.last[m];
            const int32_t both = inside[static_cast<size_t>(last)] - inside[static_cast<size_t>(first)];
            const int32_t any = wanted.last[n] - wanted.first[n] + last - first - both;
            best = std::max(best, static_cast<double>(both) / static_cast<double>(any));
        }
        sum += best;
        ++count;
    }
    return sum / count;
}

TEST(TransferParts, PointsInsideDoNotChangeTheParts) {
    for (const TriMesh& mesh : models()) {
        SCOPED_TRACE(mesh.name);
        const Handle proxy = build(mesh), filled = build(mesh, 1.4);
        ASSERT_GT(summary(filled).added_vertices, summary(proxy).added_vertices);
        expect_structure(filled);
        EXPECT_GT(agreement(arrays(proxy), arrays(filled)), 0.999);
    }
}

TEST(TransferParts, ANoisySurfaceHasThePartsOfTheSmoothOne) {
    const TriMesh noisy_mesh = noisy(real_mesh("elephant.off"));
    Progress progress;
    progress.begin();
    Solid solid;
    solid.surface = read_mesh(noisy_mesh.view());
    solid.mesh = tetrahedralize(solid.surface, 0, progress);
    ASSERT_GT(estimate_noise(solid.surface.vertices, solid.surface.triangles), 0);
    const std::optional<TetMesh> proxy = fill_proxy(solid, false, progress);
    ASSERT_TRUE(proxy);
    EXPECT_EQ(estimate_noise(proxy->vertices, solid.surface.triangles), 0);

    const ScoredTree parts = merge_parts(*proxy, cluster(*proxy, progress), {}, progress);
    const Hierarchy smooth(solid.surface, *proxy, parts, noisy_mesh.vertices);
    const Handle handle = build(noisy_mesh), paper = build(noisy_mesh, 0, PW_MODE_PAPER);
    EXPECT_EQ(arrays(handle).tetrahedron_count, arrays(paper).tetrahedron_count);
    expect_structure(handle);
    // Not all: a tetrahedron behind triangles of two parts is of one. Without the transfer it is about 0.7.
    EXPECT_GT(agreement(smooth.arrays(), arrays(handle)), 0.95);
}

}  // namespace
}  // namespace partwheel::test
