// Hierarchies through the C API: saving and loading, and the same bytes every time. Their invariants: tests/core/test_hierarchy.py.
#include "fill/cavities.h"
#include "support/built.h"
#include "support/real_meshes.h"
#include "support/reference_surface.h"
#include "support/sizes.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <random>
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

}  // namespace
}  // namespace partwheel::test
