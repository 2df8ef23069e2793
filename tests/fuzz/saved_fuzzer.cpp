// Fuzzer of pw_hierarchy_load(): any bytes are refused, or every question about what was loaded has an answer that the
// header documents. The hash at the end of the bytes is not compared (see cmake/fuzzers.cmake), so forged ones get in.
#include "support/built.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <vector>

using namespace partwheel::test;

namespace {

// The surface, and where it comes from: indices that exist, and coordinates that are the hierarchy's or between them.
void expect_solid(const Handle& handle, pw_status status, pw_mesh* made) {
    const std::unique_ptr<pw_mesh, void (*)(pw_mesh*)> solid(made, pw_mesh_free);
    EXPECT_TRUE(status == PW_OK || status == PW_ERROR_DATA || status == PW_ERROR_EMPTY) << pw_error_message();
    if (status != PW_OK) return;
    const pw_arrays a = arrays(handle);
    const double* vertices = nullptr;
    const int32_t *triangles = nullptr, *ends = nullptr, *faces = nullptr, *beyond = nullptr;
    size_t vertex_count = 0, triangle_count = 0;
    ASSERT_EQ(pw_mesh_arrays(made, &vertices, &vertex_count, &triangles, &triangle_count), PW_OK);
    ASSERT_EQ(pw_mesh_origins(made, &ends, &faces, &beyond), PW_OK);
    const auto below = [](int32_t i, size_t count) { return i >= 0 && static_cast<size_t>(i) < count; };
    for (size_t i = 0; i < 3 * triangle_count; ++i) EXPECT_TRUE(below(triangles[i], vertex_count));
    for (size_t i = 0; i < 2 * vertex_count; ++i) EXPECT_TRUE(below(ends[i], a.vertex_count));
    for (size_t i = 0; i < 3 * vertex_count; ++i) EXPECT_TRUE(std::isfinite(vertices[i]));
    for (size_t t = 0; t < triangle_count; ++t) {
        EXPECT_TRUE(faces[t] == -1 || below(faces[t], a.face_count));
        EXPECT_TRUE(beyond[t] == -1 || below(beyond[t], a.tetrahedron_count));
    }
}

// The slice, and the rest: by themselves, with a vertex in the middle of edges, and with every other face.
void expect_solids(const Handle& handle, size_t first, size_t last) {
    const pw_hierarchy* h = handle.get();
    const pw_arrays a = arrays(handle);
    const int32_t* tetrahedron = a.tetrahedra + 4 * first;
    const std::array<int32_t, 8> middles = {tetrahedron[0], tetrahedron[1], -1, 0, 1 << 30, 1, 0, 0};
    std::vector<uint8_t> inside(a.face_count);
    for (size_t f = 0; f < inside.size(); ++f) inside[f] = f % 2 == 0;
    pw_mesh* made = nullptr;
    pw_status status = pw_hierarchy_solid(h, first, last, nullptr, 0, &made);
    expect_solid(handle, status, made);
    made = nullptr;
    status = pw_hierarchy_solid(h, last, first, middles.data(), middles.size() / 2, &made);
    expect_solid(handle, status, made);
    made = nullptr;
    status = pw_hierarchy_solid_of_faces(h, first, last, inside.data(), inside.size(), &made);
    expect_solid(handle, status, made);
    made = nullptr;
    status = pw_hierarchy_solid_of_faces(h, last, first, inside.data(), inside.size(), &made);
    expect_solid(handle, status, made);
}

// What an index of it says of its own vertices, exactly and by the hulls of a cut.
void expect_index(const Handle& handle, const int32_t* bounds, size_t bound_count) {
    pw_index* made = nullptr;
    ASSERT_EQ(pw_index_create(handle.get(), bounds, bound_count, 1, &made), PW_OK) << pw_error_message();
    const std::unique_ptr<pw_index, decltype(&pw_index_free)> index(made, pw_index_free);
    const pw_arrays a = arrays(handle);
    const size_t count = std::min<size_t>(a.vertex_count, 50);
    std::vector<int32_t> holding(count), parts(count);
    std::vector<double> distances(count), places(3 * count), directions;
    for (size_t k = 0; k < count; ++k) directions.insert(directions.end(), {1, 0.5, -0.25});
    EXPECT_EQ(pw_index_holding(made, a.vertices, count, holding.data()), PW_OK) << pw_error_message();
    EXPECT_EQ(pw_index_nearest(made, a.vertices, count, parts.data(), distances.data(), places.data()), PW_OK);
    for (size_t k = 0; k < count; ++k) {
        EXPECT_TRUE(parts[k] >= 0 && distances[k] >= 0 && std::isfinite(distances[k]));
        if (holding[k] >= 0) EXPECT_TRUE(parts[k] == holding[k] && distances[k] == 0);
    }
    EXPECT_EQ(pw_index_first_hits(made, a.vertices, directions.data(), count, parts.data(), distances.data()), PW_OK);
    for (size_t k = 0; k < count; ++k) EXPECT_TRUE(parts[k] >= -1 && distances[k] >= 0 && std::isfinite(distances[k]));
    const double itself[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    int32_t pair[2] = {-1, -1};
    EXPECT_EQ(pw_index_touching(made, made, itself, 1, pair, places.data()), PW_OK) << pw_error_message();
    EXPECT_TRUE(pair[0] >= 0 && pair[1] >= 0);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    GTEST_FLAG_SET(throw_on_failure, true);  // out of the fuzzer: a crash for libFuzzer
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const Built loaded = try_load({data, data + size});
    if (loaded.status != PW_OK) {
        EXPECT_EQ(loaded.status, PW_ERROR_DATA) << loaded.message;
        EXPECT_TRUE(loaded.message.ends_with('.')) << loaded.message;
        return 0;
    }
    if (std::getenv("PARTWHEEL_FUZZ_TELL")) std::fputs("told: loaded\n", stderr);  // for the test of seeds
    const pw_arrays a = arrays(loaded.handle);
    const pw_summary s = summary(loaded.handle);
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_LT(a.volume[a.node_count - 1], infinity);
    EXPECT_LT(a.area[a.node_count - 1], infinity);
    EXPECT_TRUE(s.rung == PW_RUNG_EXACT || s.rung == PW_RUNG_REPAIRED || s.rung == PW_RUNG_POINTS);
    expect_structure(loaded.handle);
    for (size_t t = 0; t < a.tetrahedron_count; t += 1 + a.tetrahedron_count / 20) {
        const HullMesh part = hull(loaded.handle, t, t + 1), rest = hull(loaded.handle, t, a.tetrahedron_count);
        EXPECT_GE(rest.vertices.size(), part.vertices.empty() ? 0U : 1U);
        expect_solids(loaded.handle, t, t + 1);
    }
    for (size_t n = a.tetrahedron_count; n < a.node_count; n += 1 + a.node_count / 20) {
        const auto first = static_cast<size_t>(a.tet_first[n]), last = static_cast<size_t>(a.tet_last[n]);
        (void)hull(loaded.handle, first, last);
        expect_solids(loaded.handle, first, last);
    }
    std::vector<int32_t> bounds(a.tetrahedron_count + 1);
    size_t count = 0;
    EXPECT_EQ(pw_hierarchy_cut_automatic(loaded.handle.get(), bounds.data(), bounds.size(), &count), PW_OK);
    EXPECT_TRUE(count >= 2 && count <= bounds.size());
    EXPECT_EQ(bounds[0], 0);
    EXPECT_EQ(static_cast<size_t>(bounds[count - 1]), a.tetrahedron_count);
    for (size_t k = 1; k < count; ++k) EXPECT_LT(bounds[k - 1], bounds[k]);
    expect_index(loaded.handle, nullptr, 0);
    expect_index(loaded.handle, bounds.data(), count);
    // What is saved loads, and is saved as the same again. (These bytes may have said it at greater length.)
    const std::vector<uint8_t> saved = save(loaded.handle);
    const Built again = try_load(saved);
    EXPECT_EQ(again.status, PW_OK) << again.message;
    EXPECT_EQ(save(again.handle), saved);
    return 0;
}
