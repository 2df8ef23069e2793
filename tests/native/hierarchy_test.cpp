// Hierarchies through the C API: the invariants on every test mesh, saving and loading, independence of order, unit and
// position.
#include "fill/cavities.h"
#include "support/built.h"
#include "support/real_meshes.h"
#include "support/reference_surface.h"
#include "support/sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <random>
#include <set>
#include <string>

namespace partwheel::test {
namespace {

Cells u_shape() { return block({0, 0, 0}, {5, 1, 2}) + block({0, 0, 0}, {1, 4, 2}) + block({4, 0, 0}, {5, 4, 2}); }

// In general position: no ties that rounding could break.
TriMesh rough_torus() { return named(snapped(perturbed(torus(16, 8, 2, 0.6), 0.03, 1), 0x1p-16), "rough torus"); }
TriMesh rough_snowman() { return named(snapped(perturbed(snowman(7, 12), 0.02, 2), 0x1p-16), "rough snowman"); }

// In each mode.
class Hierarchies : public testing::TestWithParam<pw_mode> {
protected:
    static Handle build(const TriMesh& mesh, double quality = 0) { return test::build(mesh, quality, GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Mode, Hierarchies, testing::ValuesIn(all_modes), [](const auto& mode) {
    return mode_name(mode.param);
});

// ---- Invariants ----

TEST_P(Hierarchies, InvariantsOfConvexShapes) {
    for (const TriMesh& mesh :
         {tetrahedron(), cube(), octahedron(), surface_of("block", block({0, 0, 0}, {4, 3, 2})),
          surface_of("bar", block({0, 0, 0}, {12, 1, 1}), {0.1, 0.3, 0.7}),
          surface_of("thin strip", block({0, 0, 0}, {20, 2, 1}), {1, 0.1, 1e-3}), sphere(8, 14),
          rotated(surface_of("block, turned", block({0, 0, 0}, {4, 3, 2})), 1, {3, 1, 2}),
          stretched(named(sphere(6, 10), "ellipsoid"), {3, 1, 0.5}), real_mesh("icosahedron.off")})
        expect_invariants(build(mesh), mesh, enclosed_volume(mesh), true);
}

TEST_P(Hierarchies, InvariantsOfParametricShapes) {
    for (const TriMesh& mesh :
         {surface_of("L", block({0, 0, 0}, {4, 1, 1}) + block({0, 0, 0}, {1, 3, 1})), surface_of("U", u_shape()),
          rotated(surface_of("U, turned", u_shape()), 0.7, {1, 2, 3}), torus(16, 8, 2, 0.6), snowman(7, 12),
          stacked_cylinders(12), star_prism(7, 0.4, 1.5, 0.5), hedgehog(12), rough_torus(), rough_snowman(),
          without_faces(torus(12, 6, 2, 0.6)), surface_of("hollow", block({0, 0, 0}, {3, 3, 3}) - Cells{{1, 1, 1}}),
          surface_of("box in a box", (block({0, 0, 0}, {5, 5, 5}) - block({1, 1, 1}, {4, 4, 4})) + Cells{{2, 2, 2}}),
          surface_of("4 components", Cells{{0, 0, 0}, {3, 0, 0}, {0, 5, 0}, {9, 9, 9}}),
          together("sphere beside a torus", sphere(5, 8), moved(torus(10, 6, 1, 0.3), {4, 0.5, 0})),
          moved(rough_snowman(), {1e5, -1e5, 1e5})})
        expect_invariants(build(mesh), mesh, enclosed_volume(mesh));
    const TriMesh turned = inside_out(torus(12, 6, 2, 0.6));
    expect_invariants(build(turned), turned, -enclosed_volume(turned));
}

TEST_P(Hierarchies, InvariantsWithPointsInside) {
    for (const TriMesh& mesh : {torus(14, 7, 2, 0.7), surface_of("bar", block({0, 0, 0}, {6, 2, 2})),
                                surface_of("hollow", block({0, 0, 0}, {6, 6, 6}) - block({1, 1, 1}, {5, 5, 5}))}) {
        const Handle handle = build(mesh, 1.2);
        expect_invariants(handle, mesh, enclosed_volume(mesh));
    }
    EXPECT_GT(summary(build(surface_of("bar", block({0, 0, 0}, {6, 3, 3})), 1.2)).added_vertices, 0U);
}

TEST(Hierarchy, SummaryCountsComponentsAndCavities) {
    const auto counts = [](const TriMesh& mesh) {
        const pw_summary s = summary(build(mesh));
        return std::pair(s.components, s.cavities);
    };
    using P = std::pair<size_t, size_t>;
    EXPECT_EQ(counts(cube()), P(1, 0));
    EXPECT_EQ(counts(surface_of("a", Cells{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}})), P(3, 0));
    EXPECT_EQ(counts(surface_of("b", block({0, 0, 0}, {5, 3, 3}) - Cells{{1, 1, 1}, {3, 1, 1}})), P(1, 2));
    EXPECT_EQ(counts(surface_of("c", (block({0, 0, 0}, {5, 5, 5}) - block({1, 1, 1}, {4, 4, 4})) + Cells{{2, 2, 2}})),
              P(2, 1));
}

// Its shells, each on the vertices that find_shells() welds: what is checked is how they are filled.
std::vector<TriMesh> shells_of(const TriMesh& mesh) {
    const MeshView view{mesh.vertices, mesh.triangles, {}, mesh.triangles.size()};
    const Shells found = find_shells(view), shells = join_cavities(view, found, find_nesting(view, found));
    std::vector<TriMesh> parts(shells.count, mesh);
    for (TriMesh& part : parts) part.triangles.clear();
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        Triangle corners = mesh.triangles[t];
        for (int32_t& v : corners) v = shells.vertex[static_cast<size_t>(v)];
        parts[static_cast<size_t>(shells.of_triangle[t])].triangles.push_back(corners);
    }
    for (TriMesh& part : parts) part = without_faces(part);
    return parts;
}

// Every model that is closed, manifold and free of self-intersection builds and satisfies the invariants; all others
// get the expected error.
TEST_P(Hierarchies, RealModels) {
    std::map<std::string, int> count;
    for (const TriMesh& mesh : real_meshes(sized<size_t>(6000, 500))) {
        SCOPED_TRACE(mesh.name);
        const Built built = try_build(mesh, 0, nullptr, PW_FILL_EXACT, GetParam());
        ++count[pw_status_name(built.status)];
        const std::vector<TriMesh> shells = GetParam() == PW_MODE_PAPER ? std::vector{mesh} : shells_of(mesh);
        std::set<std::string> statuses;
        double volume = 0;
        for (const TriMesh& shell : shells) {
            statuses.insert(pw_status_name(expected_status(shell)));
            volume += std::fabs(enclosed_volume(shell));
        }
        if (statuses.size() > 1) statuses.erase("ok");
        EXPECT_TRUE(statuses.contains(pw_status_name(built.status))) << pw_status_name(built.status) << ": " << built.message;
        if (built.status != PW_OK) continue;
        EXPECT_NEAR(summary(built.handle).volume, volume, 1e-9 * volume);
        if (shells.size() == 1 && shells[0].triangles == mesh.triangles) expect_invariants(built.handle, mesh, volume);
    }
    for (const auto& [status, n] : count) std::printf("%d models: %s\n", n, status.c_str());
    EXPECT_GT(count["ok"], sized(40, 25));
}

// ---- Saving ----

void expect_same(const Handle& x, const Handle& y) {
    const pw_arrays a = arrays(x), b = arrays(y);
    ASSERT_EQ(a.face_count, b.face_count);
    ASSERT_EQ(a.node_count, b.node_count);
    ASSERT_EQ(a.tetrahedron_count, b.tetrahedron_count);
    ASSERT_EQ(a.vertex_count, b.vertex_count);
    const auto same = [](const auto* p, const auto* q, size_t n) {
        return n == 0 || std::memcmp(p, q, n * sizeof *p) == 0;
    };
    const size_t f = a.face_count, n = a.node_count, t = a.tetrahedron_count, v = a.vertex_count;
    EXPECT_TRUE(same(a.order, b.order, f));
    EXPECT_TRUE(same(a.leaf, b.leaf, f));
    EXPECT_TRUE(same(a.parent, b.parent, n));
    EXPECT_TRUE(same(a.first, b.first, n));
    EXPECT_TRUE(same(a.last, b.last, n));
    EXPECT_TRUE(same(a.tet_first, b.tet_first, n));
    EXPECT_TRUE(same(a.tet_last, b.tet_last, n));
    EXPECT_TRUE(same(a.cost_class, b.cost_class, n));
    EXPECT_TRUE(same(a.cost, b.cost, n));
    EXPECT_TRUE(same(a.height, b.height, n));
    EXPECT_TRUE(same(a.volume, b.volume, n));
    EXPECT_TRUE(same(a.area, b.area, n));
    EXPECT_TRUE(same(a.vertices, b.vertices, 3 * v));
    EXPECT_TRUE(same(a.source, b.source, v));
    EXPECT_TRUE(same(a.tetrahedra, b.tetrahedra, 4 * t));
    EXPECT_TRUE(same(a.merges, b.merges, 2 * (t - 1)));
    EXPECT_TRUE(same(a.score, b.score, n));
    const pw_summary s = summary(x), u = summary(y);
    EXPECT_EQ(s.components, u.components);
    EXPECT_EQ(s.cavities, u.cavities);
    EXPECT_EQ(s.added_vertices, u.added_vertices);
    EXPECT_EQ(s.volume, u.volume);
    EXPECT_EQ(s.hull_volume, u.hull_volume);
}

TEST_P(Hierarchies, LoadingRestoresTheSavedHierarchy) {
    std::vector<TriMesh> meshes{tetrahedron(), cube(), surface_of("U", u_shape()), rough_torus(), hedgehog(8),
                                surface_of("hollow", block({0, 0, 0}, {3, 3, 3}) - Cells{{1, 1, 1}}),
                                stretched(rough_snowman(), {1e-80, 1e-80, 1e-80}),
                                stretched(rough_snowman(), {1e90, 1e90, 1e90})};
    for (const char* file : {"joint.off", "rotor.off", "cross_quad.off"}) meshes.push_back(real_mesh(file));
    for (const TriMesh& mesh : meshes) {
        SCOPED_TRACE(mesh.name);
        const Handle handle = build(mesh);
        const std::vector<uint8_t> bytes = save(handle);
        const Built loaded = try_load(bytes);
        ASSERT_EQ(loaded.status, PW_OK) << loaded.message;
        expect_same(handle, loaded.handle);
        EXPECT_EQ(save(loaded.handle), bytes);
        const HullMesh a = hull(handle, 0, arrays(handle).tetrahedron_count),
                       b = hull(loaded.handle, 0, arrays(handle).tetrahedron_count);
        EXPECT_EQ(a.vertices, b.vertices);
        EXPECT_EQ(a.triangles, b.triangles);
    }
}

TEST(Hierarchy, TinyModelsAreRefused) {
    // Where volumes would underflow, there is an error; down to there a hierarchy can be saved and loaded.
    const TriMesh mesh = surface_of("U", u_shape());
    for (const double scale : {1e-82, 1e-100, 1e-109, 1e-150, 1e-300, 1e-308}) {
        const Built built = try_build(stretched(mesh, {scale, scale, scale}));
        EXPECT_EQ(built.status, PW_ERROR_NOT_FINITE) << scale << ": " << built.message;
    }
    for (const double scale : {1e-79, 1e-80}) {
        const Handle handle = build(stretched(mesh, {scale, scale, scale}));
        EXPECT_GT(summary(handle).volume, 0);
        const Built loaded = try_load(save(handle));
        ASSERT_EQ(loaded.status, PW_OK) << loaded.message;
        expect_same(handle, loaded.handle);
    }
}

TEST_P(Hierarchies, EveryFlippedByteIsRefused) {
    const std::vector<uint8_t> bytes = save(build(surface_of("L", Cells{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})));
    std::mt19937 random(1);
    for (size_t i = 0; i < bytes.size(); ++i)
        for (const int flip : {0x01, 0x80, 0xff, static_cast<int>(1 + random() % 255)}) {
            std::vector<uint8_t> damaged = bytes;
            damaged[i] = static_cast<uint8_t>(damaged[i] ^ flip);
            ASSERT_EQ(try_load(damaged).status, PW_ERROR_DATA) << "byte " << i << " by " << flip;
        }
}

TEST(Hierarchy, TooShortOrTooLongIsRefused) {
    const std::vector<uint8_t> bytes = save(build(surface_of("L", Cells{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})));
    for (size_t size = 0; size < bytes.size(); ++size) {
        const Built cut = try_load({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)});
        ASSERT_EQ(cut.status, PW_ERROR_DATA) << size << " bytes";
        ASSERT_FALSE(cut.message.empty());
    }
    for (size_t more = 1; more < 40; ++more)
        for (const uint8_t value : {uint8_t{0}, uint8_t{0xff}, bytes.back()}) {
            std::vector<uint8_t> longer = bytes;
            longer.insert(longer.end(), more, value);
            ASSERT_EQ(try_load(longer).status, PW_ERROR_DATA) << more << " bytes more";
        }
    std::vector<uint8_t> twice = bytes;
    twice.insert(twice.end(), bytes.begin(), bytes.end());
    EXPECT_EQ(try_load(twice).status, PW_ERROR_DATA);
}

TEST(Hierarchy, ForeignBytesAreRefused) {
    std::mt19937 random(2);
    for (int i = 0; i < sized(2000, 200); ++i) {
        std::vector<uint8_t> noise(random() % 500);
        for (uint8_t& byte : noise) byte = static_cast<uint8_t>(random());
        ASSERT_EQ(try_load(noise).status, PW_ERROR_DATA);
    }
    const std::string text = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    EXPECT_EQ(try_load({text.begin(), text.end()}).status, PW_ERROR_DATA);
}

// ---- The same result every time ----

TEST_P(Hierarchies, BytesAreDeterministic) {
    for (const TriMesh& mesh : {surface_of("U", u_shape()), rough_torus(), real_mesh("joint.off")}) {
        const auto bytes = save(build(mesh));
        for (unsigned i = 0; i < 3; ++i) {
            std::srand(i);  // the state of rand() must not matter
            EXPECT_EQ(save(build(mesh)), bytes) << mesh.name;
        }
    }
}

// The same tetrahedra, tree and measures; vertices and faces after mapping.
TEST_P(Hierarchies, InputOrderDoesNotMatter) {
    for (const TriMesh& mesh :
         {surface_of("U", u_shape()), rough_torus(), sphere(7, 10), real_mesh("joint.off"), real_mesh("cross_quad.off"),
          surface_of("4 components", Cells{{0, 0, 0}, {3, 0, 0}, {0, 5, 0}, {9, 9, 9}})}) {
        SCOPED_TRACE(mesh.name);
        const Handle first = build(mesh);
        const pw_arrays a = arrays(first);
        for (unsigned seed = 0; seed < 4; ++seed) {
            const Shuffled other = shuffled(mesh, seed);
            const Handle second = build(other.mesh);
            const pw_arrays b = arrays(second);
            ASSERT_EQ(a.tetrahedron_count, b.tetrahedron_count);
            ASSERT_EQ(a.node_count, b.node_count);
            ASSERT_EQ(a.vertex_count, b.vertex_count);
            const auto same = [](const auto* p, const auto* q, size_t n) { return std::equal(p, p + n, q); };
            EXPECT_TRUE(same(a.vertices, b.vertices, 3 * a.vertex_count));
            EXPECT_TRUE(same(a.tetrahedra, b.tetrahedra, 4 * a.tetrahedron_count));
            EXPECT_TRUE(same(a.merges, b.merges, 2 * (a.tetrahedron_count - 1)));
            EXPECT_TRUE(same(a.parent, b.parent, a.node_count));
            EXPECT_TRUE(same(a.height, b.height, a.node_count));
            EXPECT_TRUE(same(a.cost, b.cost, a.node_count));
            EXPECT_TRUE(same(a.score, b.score, a.node_count));
            EXPECT_TRUE(same(a.volume, b.volume, a.node_count));
            EXPECT_TRUE(same(a.first, b.first, a.node_count));
            EXPECT_TRUE(same(a.last, b.last, a.node_count));
            for (size_t n = 0; n < a.node_count; ++n) EXPECT_NEAR(a.area[n], b.area[n], 1e-12 * a.area[n]);
            for (size_t v = 0; v < a.vertex_count; ++v)
                EXPECT_EQ(a.source[v], b.source[v] < 0 ? -1 : other.vertex[static_cast<size_t>(b.source[v])]);
            for (size_t f = 0; f < b.face_count; ++f)
                EXPECT_EQ(a.leaf[other.face[f]], b.leaf[f]);
        }
    }
}

// Dimensionless values must be equal, others must scale.
void expect_scaled(const Handle& x, const Handle& y, double scale, double tolerance) {
    const pw_arrays a = arrays(x), b = arrays(y);
    ASSERT_EQ(a.tetrahedron_count, b.tetrahedron_count);
    ASSERT_EQ(a.node_count, b.node_count);
    EXPECT_TRUE(std::equal(a.tetrahedra, a.tetrahedra + 4 * a.tetrahedron_count, b.tetrahedra));
    EXPECT_TRUE(std::equal(a.merges, a.merges + 2 * (a.tetrahedron_count - 1), b.merges));
    EXPECT_TRUE(std::equal(a.parent, a.parent + a.node_count, b.parent));
    EXPECT_TRUE(std::equal(a.order, a.order + a.face_count, b.order));
    const double cube_of = scale * scale * scale;
    for (size_t n = 0; n < a.node_count; ++n) {
        EXPECT_NEAR(b.volume[n], cube_of * a.volume[n], tolerance * cube_of * a.volume[n]);
        EXPECT_NEAR(b.height[n], cube_of * a.height[n], tolerance * cube_of * a.height[n]);
        EXPECT_NEAR(b.area[n], scale * scale * a.area[n], tolerance * scale * scale * a.area[n]);
        EXPECT_NEAR(b.score[n], a.score[n], tolerance);
    }
}

TEST_P(Hierarchies, PowersOfTwoScaleExactly) {
    for (const TriMesh& mesh :
         {surface_of("U", u_shape()), rough_torus(), real_mesh("joint.off"), real_mesh("rotor.off")}) {
        SCOPED_TRACE(mesh.name);
        const Handle first = build(mesh);
        for (const double scale : {0.5, 2.0, 0x1p-40, 0x1p60}) {
            SCOPED_TRACE(scale);
            expect_scaled(first, build(stretched(mesh, {scale, scale, scale})), scale, 0);
        }
    }
}

TEST_P(Hierarchies, AnyUnitGivesTheSameTree) {
    for (const TriMesh& mesh :
         {rough_torus(), rough_snowman(), named(perturbed(hedgehog(10), 0.01, 3), "rough hedgehog")})
        for (const double scale : {1e-4, 1e4, 3.7}) {
            SCOPED_TRACE(mesh.name);
            SCOPED_TRACE(scale);
            expect_scaled(build(mesh), build(stretched(mesh, {scale, scale, scale})), scale, 1e-6);
        }
}

TEST_P(Hierarchies, AnyPositionGivesTheSameTree) {
    // Coordinates are multiples of 2^-16, so that translations are exact.
    for (const TriMesh& mesh : {surface_of("U", u_shape()), rough_torus(), rough_snowman()})
        for (const Point& by : {Point{1e6, 0, 0}, Point{-1e6, 1e6, 123456}, Point{0.5, -2, 7}}) {
            SCOPED_TRACE(mesh.name);
            expect_scaled(build(mesh), build(moved(mesh, by)), 1, 1e-15);
        }
}

}  // namespace
}  // namespace partwheel::test
