// Fuzzer of pw_build(): bytes are taken as a small mesh with coordinates on a grid, some of them wild, and indices that
// may lie beside; it is built, or refused by name, and what is built keeps what the header promises.
//
//   byte 0      rungs (0..7), then a bit each: open_surfaces, quality, polygons of two triangles, far away, tiny
//   byte 1      number of vertices
//   3 a vertex  coordinates: byte - 120, or from 240 on one of the wild ones
//   3 a corner  vertices: modulo their number, or from 240 on one that does not exist
#include "support/built.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using namespace partwheel;
using namespace partwheel::test;

namespace {

constexpr size_t most_triangles = 160;
constexpr int first_wild = 240;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::array<double, 16> wild = {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity, 1e308, -1e101,
                                         1e100, 1e20, 0.5, 1.0 / 3, 1e-9, -1e-16, 1e-80, 1e-300, 5e-324, -0.0, 119.99999};
constexpr std::array<int32_t, 16> missing = {-1, -2, std::numeric_limits<int32_t>::min(),
                                             std::numeric_limits<int32_t>::max(), 1000, 70000, 256, 255,
                                             -255, 1 << 30, 12345, 999999999, 1000000000, 1 << 16, -(1 << 16), 300};

struct Input {
    TriMesh mesh;
    pw_build_options options{};
};

Input read(const uint8_t* data, size_t size) {
    size_t at = 0;
    const auto next = [&] { return at < size ? data[at++] : uint8_t{0}; };
    const int flags = next();
    const size_t vertices = next();
    Input input;
    input.options = {sizeof(pw_build_options), flags & 16 ? 1.4 : 0, static_cast<uint32_t>(flags & 7),
                     flags & 8 ? 1 : 0, 1, flags & 32 ? PW_MODE_PAPER : PW_MODE_REGROUPED};
    const double unit = flags & 128 ? 1e-60 : 1, shift = flags & 64 ? 1e5 : 0;
    for (size_t v = 0; v < vertices; ++v) {
        Point& p = input.mesh.vertices.emplace_back();
        for (double& c : p) {
            const int byte = next();
            c = byte < first_wild ? (byte - 120 + shift) * unit : wild[static_cast<size_t>(byte - first_wild)];
        }
    }
    while (at + 3 <= size && input.mesh.triangles.size() < most_triangles) {
        Triangle& t = input.mesh.triangles.emplace_back();
        for (int32_t& corner : t) {
            const int byte = next();
            corner = byte >= first_wild ? missing[static_cast<size_t>(byte - first_wild)]
                     : vertices == 0    ? 0
                                        : byte % static_cast<int>(vertices);
        }
        if (flags & 32) input.mesh.faces.push_back(static_cast<int32_t>(input.mesh.triangles.size() - 1) / 2);
    }
    input.mesh.name = "fuzzed";
    input.mesh.face_count = flags & 32 ? (input.mesh.triangles.size() + 1) / 2 : input.mesh.triangles.size();
    return input;
}

bool sound(const TriMesh& mesh) {
    const auto count = static_cast<int32_t>(mesh.vertices.size());
    return std::ranges::all_of(mesh.vertices, [](const Point& p) {
               return std::ranges::all_of(p, [](double c) { return std::fabs(c) <= 1e100; });
           }) && std::ranges::all_of(mesh.triangles, [&](const Triangle& t) {
               return std::ranges::all_of(t, [&](int32_t v) { return v >= 0 && v < count; });
           }) && !mesh.triangles.empty() && count > 0;
}

// Of the bounding box of the vertices in use.
double largest_extent(const TriMesh& mesh) {
    double extent = 0;
    for (size_t k = 0; k < 3; ++k) {
        double low = infinity, high = -infinity;
        for (const Triangle& t : mesh.triangles)
            for (const int32_t v : t) {
                low = std::min(low, mesh.vertices[static_cast<size_t>(v)][k]);
                high = std::max(high, mesh.vertices[static_cast<size_t>(v)][k]);
            }
        extent = std::max(extent, high - low);
    }
    return extent;
}

void expect_answer(const Handle& handle, const Input& input) {
    const pw_arrays a = arrays(handle);
    const pw_summary s = summary(handle);
    EXPECT_TRUE(sound(input.mesh));
    EXPECT_EQ(a.face_count, input.mesh.face_count);
    EXPECT_TRUE(input.options.rungs == 0 || (s.rung & input.options.rungs) != 0);
    EXPECT_EQ(s.rung == PW_RUNG_EXACT, *pw_hierarchy_account(handle.get()) == '\0');
    EXPECT_GT(s.volume, 0);
    EXPECT_GE(s.hull_volume, s.volume * (1 - 1e-9));
    // Beside a vertex that is far away all others have fewer digits: each is rounded by some 1e-16 of the extent.
    const double area = surface_area(input.mesh), extent = largest_extent(input.mesh);
    const double slack = 1e-9 * area + 1e-14 * extent * extent * static_cast<double>(input.mesh.triangles.size());
    EXPECT_NEAR(a.area[a.node_count - 1], area, slack);
    for (size_t v = 0; v < a.vertex_count; ++v) {
        if (a.source[v] < 0) continue;
        ASSERT_LT(static_cast<size_t>(a.source[v]), input.mesh.vertices.size());
        for (size_t k = 0; k < 3; ++k)
            EXPECT_EQ(a.vertices[3 * v + k], input.mesh.vertices[static_cast<size_t>(a.source[v])][k]);
    }
    if (s.rung == PW_RUNG_EXACT) {
        EXPECT_EQ(s.deviation, 0);
        size_t strangers = 0;
        for (size_t v = 0; v < a.vertex_count; ++v) strangers += a.source[v] < 0;
        EXPECT_EQ(strangers, s.added_vertices);
    }
    expect_structure(handle);
    pw_mesh* solid = nullptr;
    EXPECT_EQ(pw_hierarchy_solid(handle.get(), 0, a.tetrahedron_count, nullptr, 0, &solid), PW_OK) << pw_error_message();
    pw_mesh_free(solid);
    const std::vector<uint8_t> bytes = save(handle);
    const Built loaded = try_load(bytes);
    ASSERT_EQ(loaded.status, PW_OK) << loaded.message;
    EXPECT_EQ(save(loaded.handle), bytes);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    GTEST_FLAG_SET(throw_on_failure, true);  // out of the fuzzer: a crash for libFuzzer
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const Input input = read(data, size);
    const TriMesh& mesh = input.mesh;
    const double* vertices = mesh.vertices.empty() ? nullptr : mesh.vertex_data();
    const int32_t* triangles = mesh.triangles.empty() ? nullptr : mesh.triangle_data();
    pw_hierarchy* made = nullptr;
    const pw_status status = pw_build(nullptr, vertices, mesh.vertices.size(), triangles, mesh.triangles.size(),
                                      mesh.face_data(), mesh.face_count, &input.options, &made);
    const Handle handle(made);
    if (status == PW_OK) {
        expect_answer(handle, input);
        return 0;
    }
    const std::string message = pw_error_message();
    EXPECT_TRUE(status > PW_OK && status <= PW_ERROR_NOT_SOLID && status != PW_ERROR_ARGUMENT &&
                status != PW_ERROR_CANCELLED && status != PW_ERROR_DATA && status != PW_ERROR_INTERNAL)
        << pw_status_name(status) << ": " << message;
    EXPECT_TRUE(message.ends_with('.')) << message;
    EXPECT_EQ(made, nullptr);
    return 0;
}
