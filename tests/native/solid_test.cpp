// Surfaces around any subset of tetrahedra: closed, manifold, outward, of the right volume; broken input refused.
#include "base/error.h"
#include "edit/solid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>

namespace partwheel::test {
namespace {

struct Tets {
    std::vector<Point> vertices;
    std::vector<Tetrahedron> tetrahedra;
};

// A block of n^3 unit cells, each cut into six tetrahedra along its diagonal from its lowest to its highest corner.
Tets kuhn_block(int n) {
    Tets block;
    const auto number = [&](const std::array<int, 3>& p) { return (p[0] * (n + 1) + p[1]) * (n + 1) + p[2]; };
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j)
            for (int k = 0; k <= n; ++k) block.vertices.push_back({double(i), double(j), double(k)});
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k) {
                std::array<size_t, 3> axes = {0, 1, 2};
                do {
                    std::array<int, 3> p = {i, j, k};
                    Tetrahedron tet{number(p)};
                    for (size_t step = 0; step < 3; ++step) {
                        ++p[axes[step]];
                        tet[step + 1] = number(p);
                    }
                    const auto at = [&](size_t c) { return block.vertices[static_cast<size_t>(tet[c])]; };
                    if (signed_volume6(at(0), at(1), at(2), at(3)) < 0) std::swap(tet[2], tet[3]);
                    block.tetrahedra.push_back(tet);
                } while (std::next_permutation(axes.begin(), axes.end()));
            }
    return block;
}

size_t boundary_facets(const Tets& tets) {
    std::map<std::set<int32_t>, int> count;
    for (const Tetrahedron& t : tets.tetrahedra)
        for (size_t skip = 0; skip < 4; ++skip) {
            std::set<int32_t> facet(t.begin(), t.end());
            facet.erase(t[skip]);
            ++count[facet];
        }
    return static_cast<size_t>(std::count_if(count.begin(), count.end(), [](const auto& c) { return c.second == 1; }));
}

// Each directed edge once, and its opposite; one umbrella at each vertex.
void expect_closed_and_manifold(const TriangleMesh& mesh) {
    std::map<std::pair<int32_t, int32_t>, int32_t> third;
    std::map<int32_t, size_t> triangles_at;
    for (const Triangle& t : mesh.triangles)
        for (size_t k = 0; k < 3; ++k) {
            ASSERT_TRUE(third.emplace(std::pair(t[k], t[(k + 1) % 3]), t[(k + 2) % 3]).second);
            ++triangles_at[t[k]];
        }
    ASSERT_EQ(triangles_at.size(), mesh.vertices.size());
    for (const auto& [edge, unused] : third) ASSERT_TRUE(third.contains({edge.second, edge.first}));
    std::set<int32_t> seen;
    for (const auto& [edge, unused] : third) {
        if (!seen.insert(edge.first).second) continue;
        size_t steps = 0;
        int32_t v = edge.second;
        do {
            v = third.at({edge.first, v});
            ++steps;
        } while (v != edge.second);
        ASSERT_EQ(steps, triangles_at[edge.first]);
    }
}

double volume(const TriangleMesh& mesh) {
    double six = 0;
    for (const Triangle& t : mesh.triangles)
        six += signed_volume6({0, 0, 0}, mesh.vertices[static_cast<size_t>(t[0])],
                           mesh.vertices[static_cast<size_t>(t[1])], mesh.vertices[static_cast<size_t>(t[2])]);
    return six / 6;
}

// Of each tetrahedron, whether polygons stay whole there.
std::vector<uint8_t> all(const std::vector<Tetrahedron>& tetrahedra, bool exact) {
    return std::vector<uint8_t>(tetrahedra.size(), exact ? 1 : 0);
}

TEST(Solid, AnySubsetOfTetrahedraHasAClosedManifoldSurface) {
    std::mt19937 random(7);
    size_t copies = 0;
    for (int round = 0; round < 60; ++round) {
        Tets block = kuhn_block(1 + round % 4);
        std::shuffle(block.tetrahedra.begin(), block.tetrahedra.end(), random);
        const std::vector<int32_t> outer(boundary_facets(block), -1);
        const SolidBuilder facets(block.tetrahedra, block.vertices, outer, {}, all(block.tetrahedra, false));
        const size_t count = 1 + random() % block.tetrahedra.size();
        const TriangleMesh mesh = facets.build(facets.tets_of_slice(0, count));
        expect_closed_and_manifold(mesh);
        EXPECT_NEAR(volume(mesh), static_cast<double>(count) / 6, 1e-12 * static_cast<double>(count));
        const std::set<int32_t> distinct(mesh.source_vertices.begin(), mesh.source_vertices.end());
        copies += mesh.vertices.size() - distinct.size();
        const auto first = block.tetrahedra.begin();
        EXPECT_EQ(mesh.triangles.size(), boundary_facets({{}, {first, first + static_cast<std::ptrdiff_t>(count)}}));
    }
    EXPECT_GT(copies, 100U);
}

// Triangles as coordinates, starting at their smallest corner; turned: with reversed orientation.
std::multiset<std::array<Point, 3>> caps_of(const TriangleMesh& mesh, bool turned) {
    std::multiset<std::array<Point, 3>> caps;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (mesh.neighbor_tets[i] < 0) continue;
        std::array<Point, 3> cap;
        for (size_t k = 0; k < 3; ++k)
            cap[k] = mesh.vertices[static_cast<size_t>(mesh.triangles[i][turned ? 2 - k : k])];
        std::rotate(cap.begin(), std::min_element(cap.begin(), cap.end()), cap.end());
        caps.insert(cap);
    }
    return caps;
}

TEST(Solid, CapsOfBothSidesAgree) {
    std::mt19937 random(9);
    for (int round = 0; round < 60; ++round) {
        Tets block = kuhn_block(2 + round % 3);
        std::shuffle(block.tetrahedra.begin(), block.tetrahedra.end(), random);
        const std::vector<int32_t> outer(boundary_facets(block), -1);
        const SolidBuilder facets(block.tetrahedra, block.vertices, outer, {}, all(block.tetrahedra, false));
        const size_t count = 1 + random() % (block.tetrahedra.size() - 1);
        const auto solid = [&](bool rest) {
            const size_t last = rest ? block.tetrahedra.size() : count;
            return facets.build(facets.tets_of_slice(rest ? count : 0, last));
        };
        const TriangleMesh part = solid(false), rest = solid(true);
        EXPECT_EQ(caps_of(part, false), caps_of(rest, true));
        expect_closed_and_manifold(part);
        expect_closed_and_manifold(rest);
        EXPECT_NEAR(volume(part), static_cast<double>(count) / 6, 1e-12 * static_cast<double>(count));
    }
}

TEST(Solid, TheSurfaceStaysConnectedWhereTheRestReachesAnEdgeOfIt) {
    // Three wedges around an edge of the surface, of which the middle one is the rest. Below and above, the part goes around
    // that.
    const std::vector<Point> vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5}, {-1, 0, 0.5},
                                         {0, 2, -2}, {0, 2, 3}};
    std::vector<Tetrahedron> tetrahedra = {{0, 1, 2, 3}, {0, 1, 4, 5}, {0, 2, 3, 6}, {0, 3, 4, 6}, {0, 4, 5, 6},
                                           {1, 2, 3, 7}, {1, 3, 4, 7}, {1, 4, 5, 7}, {0, 1, 3, 4}};
    for (Tetrahedron& t : tetrahedra) {
        const auto at = [&](size_t k) { return vertices[idx(t[k])]; };
        if (signed_volume6(at(0), at(1), at(2), at(3)) < 0) std::swap(t[2], t[3]);
    }
    const std::vector<int32_t> outer(boundary_facets({vertices, tetrahedra}), -1);
    const SolidBuilder facets(tetrahedra, vertices, outer, {}, all(tetrahedra, false));
    const TriangleMesh part = facets.build(facets.tets_of_slice(0, 8));
    expect_closed_and_manifold(part);
    std::vector<std::set<int32_t>> ends;  // the edge's vertices in each triangle of the surface there
    for (size_t t = 0; t < part.triangles.size(); ++t) {
        std::set<int32_t> at_edge;
        for (const int32_t v : part.triangles[t])
            if (part.source_vertices[idx(v)] < 2) at_edge.insert(v);
        if (part.neighbor_tets[t] < 0 && at_edge.size() == 2) ends.push_back(at_edge);
    }
    ASSERT_EQ(ends.size(), 2U);
    EXPECT_EQ(ends[0], ends[1]);
}

TEST(Solid, APolygonOwnsTetrahedraWithoutOtherSurface) {
    const Tets block = kuhn_block(1);  // six tetrahedra, each with two outer facets, of different sides of the cube
    std::vector<int32_t> outer(12);
    std::iota(outer.begin(), outer.end(), 0);
    const std::vector<int32_t> own = {0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5};
    const SolidBuilder triangles(block.tetrahedra, block.vertices, outer, own, all(block.tetrahedra, true));
    // Tetrahedron 1's two triangles and one of tetrahedron 0's are face 0, whose leaf is 0.
    const std::vector<int32_t> faces = {0, 1, 0, 0, 2, 3, 4, 5, 6, 7, 8, 9};
    const std::vector<int32_t> leaf = {0, 0, 2, 2, 3, 3, 4, 4, 5, 5};
    const SolidBuilder polygons(block.tetrahedra, block.vertices, faces, leaf, all(block.tetrahedra, true)),
        cut(block.tetrahedra, block.vertices, faces, leaf, all(block.tetrahedra, false));
    for (size_t t = 0; t < 6; ++t) {
        EXPECT_EQ(triangles.tets_of_slice(t, t + 1), std::vector<int32_t>{static_cast<int32_t>(t)});
        EXPECT_EQ(cut.tets_of_slice(t, t + 1), std::vector<int32_t>{static_cast<int32_t>(t)});
    }
    EXPECT_EQ(polygons.tets_of_slice(0, 1), (std::vector<int32_t>{0, 1}));
    EXPECT_TRUE(polygons.tets_of_slice(1, 2).empty());
    EXPECT_EQ(polygons.tets_of_slice(1, 6).size(), 4U);
    EXPECT_EQ(polygons.tets_of_slice(0, 6).size(), 6U);
    EXPECT_THROW(polygons.build(polygons.tets_of_slice(1, 2)), Error);
}

// A hash can be forged: saved tetrahedra may be anything.
TEST(Solid, InconsistentTetrahedraAreRefused) {
    const auto refused = [](const std::vector<Tetrahedron>& tets, size_t outer) {
        try {
            const std::vector<Point> vertices(6, Point{});
            const SolidBuilder facets(tets, vertices, std::vector<int32_t>(outer, -1), {}, all(tets, false));
            for (size_t t = 0; t < tets.size(); ++t) facets.build(facets.tets_of_slice(0, t + 1));
        } catch (const Error& error) {
            return error.status() == PW_ERROR_DATA;
        }
        return false;
    };
    EXPECT_FALSE(refused({{0, 1, 2, 3}}, 4));
    EXPECT_FALSE(refused({{0, 1, 2, 3}, {1, 0, 2, 4}}, 6));
    EXPECT_TRUE(refused({{0, 1, 2, 3}}, 3));
    EXPECT_TRUE(refused({{0, 1, 2, 3}}, 5));
    EXPECT_TRUE(refused({{0, 0, 2, 3}}, 4));
    EXPECT_TRUE(refused({{0, 1, 2, 3}, {1, 0, 2, 4}, {0, 1, 2, 5}}, 9));  // three tetrahedra at one facet
    EXPECT_FALSE(refused({{0, 1, 2, 3}, {0, 1, 2, 3}}, 0));               // duplicates, but closed
    EXPECT_TRUE(refused({{0, 1, 2, 3}, {0, 1, 2, 4}}, 6));                // inconsistent orientation
}

}  // namespace
}  // namespace partwheel::test
