// Fuzzer of pw_build(): bytes are taken as a small mesh with coordinates on a grid, some of them wild, and indices that
// may lie beside; it is built, or refused by name, and what is built keeps what the header promises.
//
//   byte 0      fill_methods (0..7), then a bit each: open_surfaces, quality, polygons of two triangles, far away, tiny
//   byte 1      a bit: mode "paper"; 2: threads; a bit: fine, with edges halved until there are parts to merge and
//               noise can be measured, and not filled from points; 3: noise, in 1/20 of the longest edge;
//               a bit: more than four triangles are a large mesh
//   byte 2      number of vertices
//   3 a vertex, 3 a corner: see bytes.h
#include "bytes.h"
#include "support/built.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <utility>

using namespace partwheel;
using namespace partwheel::test;

namespace {

constexpr size_t most_triangles = 160;
constexpr size_t fine_vertices = 540;  // of fewer than 500 no surface is rough
constexpr double noise_step = 0.05;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Input {
    TriMesh mesh;
    pw_build_options options{};
};

struct Edge {
    int32_t a = 0, b = 0;
    double length = 0;
};

Edge longest_edge(const TriMesh& mesh) {
    Edge longest;
    for (const Triangle& t : mesh.triangles)
        for (size_t k = 0; k < 3; ++k) {
            const int32_t a = t[k], b = t[(k + 1) % 3];
            const double size = length(mesh.vertices[idx(a)] - mesh.vertices[idx(b)]);
            if (size > longest.length) longest = {a, b, size};
        }
    return longest;
}

// The longest edge halved, in all its triangles, until there are so many vertices.
void refine(TriMesh& mesh) {
    while (mesh.vertices.size() < fine_vertices) {
        const Edge edge = longest_edge(mesh);
        if (!std::isnormal(edge.length)) return;
        const auto middle = static_cast<int32_t>(mesh.vertices.size());
        mesh.vertices.push_back(0.5 * (mesh.vertices[idx(edge.a)] + mesh.vertices[idx(edge.b)]));
        for (size_t t = 0, count = mesh.triangles.size(); t < count; ++t)
            for (size_t k = 0; k < 3; ++k) {
                const int32_t from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
                if (std::minmax(from, to) != std::minmax(edge.a, edge.b)) continue;
                Triangle half = mesh.triangles[t];
                half[k] = mesh.triangles[t][(k + 1) % 3] = middle;
                mesh.triangles.push_back(half);
                mesh.faces.push_back(mesh.faces[t]);
                break;
            }
    }
}

void disturb(TriMesh& mesh, double deviation) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0, deviation * longest_edge(mesh).length);
    for (Point& p : mesh.vertices)
        for (double& c : p) c += normal(random);
}

bool indices_exist(const TriMesh& mesh) {
    const auto exists = [&](int32_t v) { return v >= 0 && idx(v) < mesh.vertices.size(); };
    return std::ranges::all_of(mesh.triangles, [&](const Triangle& t) { return std::ranges::all_of(t, exists); });
}

Input read(const uint8_t* data, size_t size) {
    Bytes bytes(data, size);
    const int flags = bytes.next(), more = bytes.next();
    const size_t vertices = bytes.next();
    Input input;
    input.options = {sizeof(pw_build_options), flags & 16 ? 1.4 : 0, static_cast<uint32_t>(flags & 7),
                     flags & 8 ? 1 : 0, more >> 1 & 3, more & 1 ? PW_MODE_PAPER : PW_MODE_LEARNED,
                     more & 128 ? 4 : 0, 0, 0, nullptr, 0};
    TriMesh& mesh = input.mesh;
    mesh = bytes.mesh(vertices, most_triangles, flags & 64 ? 1e5 : 0, flags & 128 ? 1e-60 : 1);
    if (flags & 32) pair_triangles(mesh);
    if (more & 8 && indices_exist(mesh)) {
        const bool polygons = !mesh.faces.empty();
        if (!polygons) mesh.faces.resize(mesh.triangles.size());
        refine(mesh);
        input.options.fill_methods = flags & 3 ? flags & 3U : PW_FILL_EXACT | PW_FILL_REPAIRED;
        if (!polygons) mesh.faces.clear(), mesh.face_count = mesh.triangles.size();
        disturb(mesh, noise_step * (more >> 4 & 7));
    }
    return input;
}

// For the test that seeds go the way they claim.
void tell(const Input& input, pw_status status, const Handle& handle) {
    if (!std::getenv("PARTWHEEL_FUZZ_REPORT")) return;
    const char* fill_methods[] = {"", "exact", "repaired", "", "points"};
    std::fprintf(stderr, "input: %s %s, %s, %s, %d threads, %s, %s\n", pw_status_name(status),
                 handle ? fill_methods[summary(handle).fill_method] : "not built",
                 input.options.mode == PW_MODE_PAPER ? "paper" : "learned",
                 input.mesh.faces.empty() ? "triangles" : "polygons", input.options.threads,
                 input.options.quality > 0 ? "points inside" : "no points inside",
                 input.mesh.vertices.size() >= fine_vertices ? "fine" : "coarse");
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
    // Merged vertices and faces that count once make a mesh PW_FILL_REPAIRED, whatever method filled it.
    const std::string_view notes = pw_hierarchy_notes(handle.get());
    const bool counts_once = notes.find("duplicate") != notes.npos || notes.find("inner wall") != notes.npos;
    const bool is_changed = counts_once || notes.find("merged with") != notes.npos;
    EXPECT_TRUE(input.options.fill_methods == 0 || is_changed || (s.fill_method & input.options.fill_methods) != 0) << notes;
    EXPECT_EQ(s.fill_method == PW_FILL_EXACT && s.proxy_triangles == 0, *pw_hierarchy_notes(handle.get()) == '\0');
    EXPECT_GT(s.volume, 0);
    EXPECT_GE(s.hull_volume, s.volume * (1 - 1e-9));
    // Beside a vertex that is far away all others have fewer digits: each is rounded by some 1e-16 of the extent.
    const double area = surface_area(input.mesh), extent = largest_extent(input.mesh);
    const double slack = 1e-9 * area + 1e-14 * extent * extent * static_cast<double>(input.mesh.triangles.size());
    EXPECT_LE(a.area[a.node_count - 1], area + slack);
    if (!counts_once) EXPECT_GE(a.area[a.node_count - 1], area - slack) << notes;
    for (size_t v = 0; v < a.vertex_count; ++v) {
        if (a.source[v] < 0) continue;
        ASSERT_LT(static_cast<size_t>(a.source[v]), input.mesh.vertices.size());
        for (size_t k = 0; k < 3; ++k)
            EXPECT_EQ(a.vertices[3 * v + k], input.mesh.vertices[static_cast<size_t>(a.source[v])][k]);
    }
    if (s.fill_method == PW_FILL_EXACT && s.proxy_triangles == 0) {
        EXPECT_EQ(s.deviation, 0);
        size_t strangers = 0;
        for (size_t v = 0; v < a.vertex_count; ++v) strangers += a.source[v] < 0;
        EXPECT_EQ(strangers, s.added_vertices);
    }
    expect_structure(handle);
    pw_mesh* solid = nullptr;
    EXPECT_EQ(pw_hierarchy_solid(nullptr, handle.get(), 0, a.tetrahedron_count, &solid), PW_OK) << pw_error_message();
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
    const pw_mesh_view view = mesh_view(mesh);
    pw_hierarchy* made = nullptr;
    const pw_status status = pw_build(nullptr, &view, &input.options, &made);
    const Handle handle(made);
    tell(input, status, handle);
    if (status == PW_OK) {
        expect_answer(handle, input);
        return 0;
    }
    const std::string message = pw_error_message();
    EXPECT_TRUE(status > PW_OK && status <= PW_ERROR_NOT_SOLID && status != PW_ERROR_ARGUMENT &&
                status != PW_ERROR_CANCELED && status != PW_ERROR_DATA && status != PW_ERROR_INTERNAL)
        << pw_status_name(status) << ": " << message;
    EXPECT_TRUE(message.ends_with('.')) << message;
    EXPECT_EQ(made, nullptr);
    return 0;
}
