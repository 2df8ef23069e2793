// The tetrahedra: they fill the solid exactly, keep every triangle of the surface, and know their neighbors.
#include "fill/tetrahedra.h"

#include "base/predicates.h"
#include "support/real_meshes.h"
#include "support/reference_hull.h"
#include "support/sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace partwheel::test {
namespace {

struct Filled {
    Surface surface;
    TetMesh mesh;
};

Filled filled(const TriMesh& shape, double quality = 0) {
    Progress progress;
    progress.begin();
    Filled result;
    result.surface = read_mesh(shape.view());
    result.mesh = tetrahedralize(result.surface, quality, progress);
    return result;
}

std::set<int32_t> as_set(const Triangle& t) { return {t.begin(), t.end()}; }

double total_volume(const TetMesh& mesh) {
    long double sum = 0;
    for (const auto& [a, b, c, d] : mesh.tetrahedra) {
        const auto at = [&](int32_t v) -> const Point& { return mesh.vertices[static_cast<size_t>(v)]; };
        sum += signed_volume6(at(a), at(b), at(c), at(d));
    }
    return static_cast<double>(sum / 6);
}

// What must hold of every surface, `volume` being that of its solid in the caller's unit.
void expect_filled(const Filled& f, double volume) {
    const Surface& surface = f.surface;
    const TetMesh& mesh = f.mesh;
    const auto at = [&](int32_t v) -> const Point& { return mesh.vertices[static_cast<size_t>(v)]; };
    ASSERT_FALSE(mesh.tetrahedra.empty());
    ASSERT_EQ(mesh.neighbors.size(), mesh.tetrahedra.size());

    // The surface's vertices come first, unmoved; every vertex is used.
    ASSERT_GE(mesh.vertices.size(), surface.vertices.size());
    EXPECT_TRUE(std::equal(surface.vertices.begin(), surface.vertices.end(), mesh.vertices.begin()));
    std::set<int32_t> used;
    for (const Tetrahedron& t : mesh.tetrahedra) used.insert(t.begin(), t.end());
    EXPECT_EQ(used.size(), mesh.vertices.size());
    EXPECT_EQ(*used.begin(), 0);
    EXPECT_EQ(static_cast<size_t>(*used.rbegin()), mesh.vertices.size() - 1);

    // Orientation by an exact predicate that isn't the engine's.
    for (const auto& [a, b, c, d] : mesh.tetrahedra) ASSERT_EQ(reference_orientation(at(a), at(b), at(c), at(d)), 1);

    // Facets: at most two tetrahedra each; neighbors across the facet opposite each corner, in both directions.
    std::map<std::set<int32_t>, std::vector<int32_t>> owners;
    for (size_t t = 0; t < mesh.tetrahedra.size(); ++t)
        for (size_t corner = 0; corner < 4; ++corner) {
            std::set<int32_t> facet(mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end());
            facet.erase(mesh.tetrahedra[t][corner]);
            ASSERT_EQ(facet.size(), 3U);
            owners[facet].push_back(static_cast<int32_t>(t));
        }
    for (size_t t = 0; t < mesh.tetrahedra.size(); ++t)
        for (size_t corner = 0; corner < 4; ++corner) {
            std::set<int32_t> facet(mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end());
            facet.erase(mesh.tetrahedra[t][corner]);
            const auto& pair = owners[facet];
            ASSERT_LE(pair.size(), 2U);
            const int32_t other = pair.size() == 1 ? -1 : pair[0] == static_cast<int32_t>(t) ? pair[1] : pair[0];
            ASSERT_EQ(mesh.neighbors[t][corner], other);
        }

    // Every triangle is a facet, of the tetrahedron that it says; facets of one tetrahedron are all triangles.
    std::set<std::set<int32_t>> triangles;
    ASSERT_EQ(mesh.tet_of_triangle.size(), surface.triangles.size());
    for (size_t i = 0; i < surface.triangles.size(); ++i) {
        triangles.insert(as_set(surface.triangles[i]));
        const auto owner = owners.find(as_set(surface.triangles[i]));
        ASSERT_NE(owner, owners.end()) << "triangle " << i << " is no facet";
        EXPECT_TRUE(std::count(owner->second.begin(), owner->second.end(), mesh.tet_of_triangle[i]) == 1);
    }
    for (const auto& [facet, pair] : owners)
        EXPECT_TRUE(pair.size() == 2 || triangles.contains(facet)) << "a boundary facet that isn't of the surface";

    EXPECT_NEAR(surface.frame.volume_to_caller(total_volume(mesh)), volume, 1e-9 * volume);
}

// The tetrahedron of each triangle lies on its inner side.
void expect_behind(const Filled& f) {
    for (size_t i = 0; i < f.surface.triangles.size(); ++i) {
        const Triangle& tri = f.surface.triangles[i];
        const auto at = [&](int32_t v) -> const Point& { return f.mesh.vertices[static_cast<size_t>(v)]; };
        for (const int32_t v : f.mesh.tetrahedra[static_cast<size_t>(f.mesh.tet_of_triangle[i])]) {
            const int side = as_set(tri).contains(v) ? 0 : -1;
            ASSERT_EQ(reference_orientation(at(tri[0]), at(tri[1]), at(tri[2]), at(v)), side);
        }
    }
}

TEST(Tetrahedra, FillRealModels) {
    std::vector<const char*> files{"cross.off", "star.off", "joint.off", "part.off", "eight.off", "mpi_triang.off"};
    for (const char* file : {"helmet.off", "anchor.off", "rotor.off", "hand.off", "cube-meshed.off", "triceratops.off"})
        if (!light()) files.push_back(file);
    for (const char* file : files) {
        SCOPED_TRACE(file);
        const TriMesh shape = real_mesh(file);
        const Filled f = filled(shape);
        expect_filled(f, std::fabs(enclosed_volume(shape)));
        expect_behind(f);
    }
}

TEST(Tetrahedra, CavitiesStayEmpty) {
    const TriMesh hollow = surface_of("hollow", block({0, 0, 0}, {3, 3, 3}) - block({1, 1, 1}, {2, 2, 2}));
    Filled f = filled(hollow);
    expect_filled(f, 26);
    expect_behind(f);
    EXPECT_EQ(f.mesh.cavities, 1U);

    f = filled(surface_of("two cavities", block({0, 0, 0}, {5, 3, 3}) - Cells{{1, 1, 1}, {3, 1, 1}}));
    expect_filled(f, 43);
    EXPECT_EQ(f.mesh.cavities, 2U);

    // A solid inside a cavity, with a cavity of its own.
    const TriMesh nested = surface_of("nested", (block({0, 0, 0}, {7, 7, 7}) - block({1, 1, 1}, {6, 6, 6})) +
                                                    (block({2, 2, 2}, {5, 5, 5}) - Cells{{3, 3, 3}}));
    f = filled(nested);
    expect_filled(f, 343 - 125 + 27 - 1);
    expect_behind(f);
    EXPECT_EQ(f.mesh.cavities, 2U);

    // Round ones, that touch the outside nowhere.
    const TriMesh shell = together("shell", sphere(8, 14), inside_out(stretched(sphere(6, 9), {0.6, 0.6, 0.6})));
    f = filled(shell);
    expect_filled(f, enclosed_volume(shell));
    EXPECT_EQ(f.mesh.cavities, 1U);
}

TEST(Tetrahedra, SolidIsWhereTheWindingNumberIsNotZero) {
    const TriMesh outer = stretched(cube(), {5, 5, 5}), inner = moved(cube(), {2, 2, 2});
    Filled f = filled(together("one in the other, both outward", outer, inner));
    expect_filled(f, 125);
    EXPECT_EQ(f.mesh.cavities, 0U);
    f = filled(together("a cavity", outer, inside_out(inner)));
    expect_filled(f, 124);
    EXPECT_EQ(f.mesh.cavities, 1U);
    f = filled(inside_out(together("a cavity, all turned", outer, inside_out(inner))));
    expect_filled(f, 124);
    EXPECT_EQ(f.mesh.cavities, 1U);
    f = filled(together("two, one of them turned", outer, inside_out(moved(inner, {9, 0, 0}))));
    expect_filled(f, 126);
    EXPECT_EQ(f.mesh.cavities, 0U);
}

TEST(Tetrahedra, QualityAddsPointsInsideOnly) {
    const TriMesh long_thin = surface_of("bar", block({0, 0, 0}, {6, 2, 2}));
    const TriMesh hollow = surface_of("hollow", block({0, 0, 0}, {6, 6, 6}) - block({1, 1, 1}, {5, 5, 5}));
    size_t added = 0;
    for (const TriMesh& shape : {torus(16, 8, 2, 0.6), snowman(6, 10), long_thin, hollow, real_mesh("joint.off")}) {
        SCOPED_TRACE(shape.name);
        const Filled plain = filled(shape), good = filled(shape, 1.2);
        expect_filled(good, enclosed_volume(shape));
        expect_behind(good);
        EXPECT_EQ(good.surface.triangles, plain.surface.triangles);
        EXPECT_GE(good.mesh.vertices.size(), plain.mesh.vertices.size());
        added += good.mesh.vertices.size() - plain.mesh.vertices.size();
        // Points inside: no triangle of the surface has them, and no tetrahedron that they belong to is flat on it.
        for (const Triangle& t : good.surface.triangles)
            for (const int32_t v : t) ASSERT_LT(static_cast<size_t>(v), good.surface.vertices.size());
    }
    EXPECT_GT(added, 10U);
}

}  // namespace
}  // namespace partwheel::test
