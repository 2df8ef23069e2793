// The binary tree against a brute-force Listing 1, merge for merge.
//
// At each step the reference determines the first merge from hulls that CGAL builds of all vertices. A different
// merge of the library must be a cheapest one within the tolerance of reference_cluster.h (the certificate). If all
// merges are the reference's, the trees are equal node for node.
#include "cluster/cluster.h"
#include "cluster/dual_graph.h"
#include "hull/hull.h"

#include "support/real_meshes.h"
#include "support/reference_cluster.h"
#include "support/sizes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

namespace partwheel::test {
namespace {

struct Named {
    std::string name;
    TetMesh mesh;
};

TetMesh filled(const TriMesh& mesh, double quality = 0) {
    Progress progress;
    progress.begin();
    return tetrahedralize(read_mesh(mesh.view()), quality, progress);
}

BinaryTree clustered(const TetMesh& mesh) {
    Progress progress;
    progress.begin();
    return cluster(mesh, progress);
}

// With one thread and with several.
void expect_same_bits(const TetMesh& mesh) {
    Progress progress;
    progress.begin();
    const BinaryTree one = cluster(mesh, progress, 1), many = cluster(mesh, progress, 5);
    EXPECT_EQ(one.components, many.components);
    ASSERT_EQ(one.merges.size(), many.merges.size());
    for (size_t m = 0; m < one.merges.size(); ++m) {
        ASSERT_EQ(one.merges[m].left, many.merges[m].left) << m;
        ASSERT_EQ(one.merges[m].right, many.merges[m].right) << m;
        ASSERT_EQ(one.merges[m].concavity, many.merges[m].concavity) << m;
        ASSERT_EQ(one.merges[m].hull_volume, many.merges[m].hull_volume) << m;
    }
}

// Compares and prints a line each; all must pass, and at least this many trees must be equal node for node.
void expect_same_as_reference(const std::vector<Named>& meshes, size_t least_equal) {
    size_t equal = 0, certified = 0;
    for (const auto& [name, mesh] : meshes) {
        SCOPED_TRACE(name);
        const Comparison result = compare_with_reference(mesh, clustered(mesh));
        EXPECT_EQ(result.failure, "");
        EXPECT_EQ(result.merges, mesh.tetrahedra.size() - 1);
        std::printf("%-40s %5zu tetrahedra: %s", name.c_str(), mesh.tetrahedra.size(),
                    result.failure.empty() ? "" : "WRONG ");
        if (result.parted == 0) {
            std::printf("equal\n");
            ++equal;
        } else {
            std::printf("certificate for %zu merges\n", result.parted);
            ++certified;
        }
        std::fflush(stdout);
    }
    std::printf("%zu meshes: %zu equal node for node, %zu by certificate\n", meshes.size(), equal, certified);
    EXPECT_GE(equal, least_equal);
}

Cells letter_l() { return block({0, 0, 0}, {4, 1, 1}) + block({0, 0, 0}, {1, 3, 1}); }
Cells letter_t() { return block({0, 2, 0}, {5, 3, 1}) + block({2, 0, 0}, {3, 3, 1}); }
Cells letter_u() { return block({0, 0, 0}, {5, 1, 2}) + block({0, 0, 0}, {1, 4, 2}) + block({4, 0, 0}, {5, 4, 2}); }
Cells comb() {
    Cells cells = block({0, 0, 0}, {9, 1, 1});
    for (int x = 0; x < 9; x += 2) cells = cells + block({x, 0, 0}, {x + 1, 4, 1});
    return cells;
}
Cells stairs(int steps) {
    Cells cells;
    for (int i = 0; i < steps; ++i) cells = cells + block({i, 0, 0}, {i + 1, 2, i + 1});
    return cells;
}
Cells jack() {
    return block({0, 2, 2}, {5, 3, 3}) + block({2, 0, 2}, {3, 5, 3}) + block({2, 2, 0}, {3, 3, 5});
}
Cells ring() { return block({0, 0, 0}, {4, 4, 1}) - block({1, 1, 0}, {3, 3, 1}); }
Cells hollow() { return block({0, 0, 0}, {3, 3, 3}) - block({1, 1, 1}, {2, 2, 2}); }
Cells apart(int count) {  // as many components, bars of three lengths in two rows
    Cells cells;
    for (int i = 0; i < count; ++i) {
        const int x = 4 * (i / 2), y = 3 * (i % 2);
        cells = cells + block({x, y, 0}, {x + 1 + i % 3, y + 1, 1});
    }
    return cells;
}
Cells box_in_box() {
    return (block({0, 0, 0}, {5, 5, 5}) - block({1, 1, 1}, {4, 4, 4})) + block({2, 2, 2}, {3, 3, 3});
}

// Equal tetrahedra along a diagonal, side by side in a grid, in no order: all their boxes overlap, so all distances are 0.
TetMesh needles(int columns) {
    std::vector<Point> points;
    std::vector<Tetrahedron> tetrahedra;
    const int count = columns * columns;
    for (int i = 0; i < count; ++i) {
        const int place = 37 * i % count, first = 4 * i;
        const double x = 0.1 * (place % columns), y = 0.1 * (place / columns);
        points.insert(points.end(), {{x, y, 0}, {x + 0.05, y, 0}, {x, y + 0.05, 0}, {x + 10, y + 10, 10}});
        tetrahedra.push_back({first, first + 1, first + 2, first + 3});
    }
    return tet_mesh(points, tetrahedra);
}

TEST(Cluster, GridsOfCubes) {
    std::vector<Named> meshes{
        {"one tetrahedron", tet_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}})},
        {"Figure 4", figure_4()},
        {"cube", tets_of(block({0, 0, 0}, {1, 1, 1}))},
        {"block 3x3x3", tets_of(block({0, 0, 0}, {3, 3, 3}))},
        {"block 5x4x2", tets_of(block({0, 0, 0}, {5, 4, 2}))},
        {"bar 12x1x1", tets_of(block({0, 0, 0}, {12, 1, 1}))},
        {"plate 6x6x1", tets_of(block({0, 0, 0}, {6, 6, 1}))},
        {"L", tets_of(letter_l())},
        {"T", tets_of(letter_t())},
        {"U", tets_of(letter_u())},
        {"comb", tets_of(comb())},
        {"stairs", tets_of(stairs(5))},
        {"jack", tets_of(jack())},
        {"ring", tets_of(ring())},
        {"box with a cavity", tets_of(hollow())},
        {"box in a box", tets_of(box_in_box())},
        {"2 components", tets_of(apart(2))},
        {"9 components", tets_of(apart(9))},
        {"64 components", tets_of(apart(64))},
        {"100 components at equal distances", needles(10)},
        {"L, uneven", tets_of(letter_l(), {0.1, 0.3, 0.7})},
        {"comb, uneven", tets_of(comb(), {0.1, 0.2, 0.3})},
        {"thin strip", tets_of(block({0, 0, 0}, {30, 2, 1}), {1, 0.1, 1e-3})},
        {"U, perturbed", perturbed(tets_of(letter_u()), 0.05, 1)},
        {"comb, perturbed", perturbed(tets_of(comb()), 0.05, 2)},
        {"block 3x3x3, perturbed", perturbed(tets_of(block({0, 0, 0}, {3, 3, 3})), 0.1, 3)},
        {"block 3x3x3, perturbed within the tolerance", perturbed(tets_of(block({0, 0, 0}, {3, 3, 3})), 1e-8, 4)},
        {"L, perturbed about the tolerance", perturbed(tets_of(letter_l()), 1e-6, 5)},
        {"9 components, perturbed", perturbed(tets_of(apart(9)), 0.05, 6)},
    };
    if (!light()) meshes.push_back({"block 8x6x6", tets_of(block({0, 0, 0}, {8, 6, 6}))});
    expect_same_as_reference(meshes, meshes.size() * 3 / 4);
}

TEST(Cluster, RealModels) {
    std::vector<std::string> files{
        "cube.off",      "cross.off",     "star.off",        "u.off",      "joint.off",    "part.off",  "tripod.off",
        "icosahedron.off", "ellipsoid.off", "blob-closed.off", "dragknob.off", "eight.off",
    };
    for (const char* file : {"helmet.off", "pinion_small.off", "anchor.off", "spool.off", "cactus.off", "rotor.off",
                             "oblong.off", "pipe.off", "cube-meshed.off", "larger_sphere.off", "geosphere.off"})
        if (!light()) files.push_back(file);
    std::vector<Named> meshes;
    for (const std::string& file : files) {
        try {
            Named next{file, filled(real_mesh(file))};
            ASSERT_LE(next.mesh.tetrahedra.size(), 3000U) << file;
            meshes.push_back(std::move(next));
        } catch (const Error& error) {
            ADD_FAILURE() << file << ": " << error.what();
        }
    }
    expect_same_as_reference(meshes, meshes.size() * 3 / 4);
}

TEST(Cluster, CostsAreHullVolumes) {
    // Large hulls, which are rare in the meshes above.
    std::vector<std::string> files{"hand.off"};
    if (!light()) files.push_back("rotor_small.off");
    for (const std::string& file : files) {
        SCOPED_TRACE(file);
        const TetMesh mesh = filled(real_mesh(file));
        std::vector<std::vector<int32_t>> vertices;
        for (const Tetrahedron& t : mesh.tetrahedra) vertices.emplace_back(t.begin(), t.end());
        HullKernel kernel(mesh.vertices);
        for (const Merge& merge : clustered(mesh).merges) {
            std::vector<int32_t> both = vertices[static_cast<size_t>(merge.left)];
            const auto& right = vertices[static_cast<size_t>(merge.right)];
            both.insert(both.end(), right.begin(), right.end());
            const Hull hull = kernel.build(both);
            ASSERT_NEAR(merge.hull_volume, hull.volume(), 1e-9 * hull.volume());
            vertices.emplace_back(hull.vertices().begin(), hull.vertices().end());
        }
    }
}

TEST(Cluster, MoreThreadsChangeNoBit) {
    std::vector<std::string> files{"hand.off", "elephant.off"};
    if (!light()) files.push_back("fandisk.off");
    for (const std::string& file : files) {
        SCOPED_TRACE(file);
        expect_same_bits(filled(real_mesh(file)));
    }
    expect_same_bits(tets_of(block({0, 0, 0}, {12, 10, 8})));
}

TEST(Cluster, RankedConcavity) {
    EXPECT_EQ(ranked_concavity(1, 1), 0);
    EXPECT_EQ(ranked_concavity(1, 1 - 0.99e-6), 0);
    EXPECT_NEAR(ranked_concavity(1, 1 - 1.01e-6), 1.01e-6, 1e-14);
    EXPECT_EQ(ranked_concavity(1, 2), 0);  // rounding can make a hull smaller than its contents
    EXPECT_EQ(ranked_concavity(3, 2.5), 0.5);
    // Rounding by far less than a part in 2^28 makes no difference, a part in 2^20 does.
    EXPECT_EQ(ranked_concavity(1 + 1e-13, 1 - 0.3), ranked_concavity(1, 1 - 0.3));
    EXPECT_LT(ranked_concavity(1, 1 - 0.3), ranked_concavity(1 + 1e-6, 1 - 0.3));
}

TEST(Cluster, LeafIdsBreakExactTies) {
    // Two separate cubes: by symmetry, only the lowest tetrahedra decide which merge comes first.
    const TetMesh mesh = tets_of(block({0, 0, 0}, {1, 1, 1}) + block({5, 0, 0}, {6, 1, 1}));
    const BinaryTree tree = clustered(mesh);
    EXPECT_EQ(tree.components, 2U);
    ASSERT_EQ(tree.merges.size(), 11U);
    EXPECT_EQ(tree.merges[0].left, 0);
    for (const Merge& m : tree.merges) EXPECT_LT(m.left, static_cast<int32_t>(mesh.tetrahedra.size() * 2 - 1));
    // The last merge unites the cubes: the hull is the box from one end to the other.
    EXPECT_NEAR(tree.merges.back().hull_volume, 6, 1e-12);
    EXPECT_NEAR(tree.merges.back().concavity, 4, 1e-7);
}

TEST(Cluster, ComponentsMergeByConcavityNotDistance) {
    // A long bar, a cube near its middle, and another cube farther away but in line with the bar.
    const Cells bar = block({0, 0, 0}, {10, 1, 1}), near = block({4, 0, 2}, {5, 1, 3}),
                far = block({12, 0, 0}, {13, 1, 1});
    const TetMesh mesh = tets_of(bar + near + far);
    const BinaryTree tree = clustered(mesh);
    ASSERT_EQ(tree.components, 3U);
    const size_t last = tree.merges.size() - 1;
    // With the far cube the hull is 13 long, 2 of it empty; with the near one it is a wedge, more of it empty.
    EXPECT_NEAR(tree.merges[last - 1].concavity, 2, 1e-6);
    EXPECT_NEAR(tree.merges[last - 1].hull_volume, 13, 1e-12);
}

TEST(Cluster, CancelIsHonored) {
    const TetMesh mesh = tets_of(block({0, 0, 0}, {6, 6, 6}));
    Progress progress;
    progress.begin();
    progress.cancel();
    try {
        (void)cluster(mesh, progress);
        FAIL() << "not canceled";
    } catch (const Error& error) {
        EXPECT_EQ(error.status(), PW_ERROR_CANCELED);
    }
}

}  // namespace
}  // namespace partwheel::test
