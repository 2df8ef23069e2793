// The C functions: arguments, capacities, messages, contexts, threads, and invalid input.
#include "support/alone.h"
#include "support/built.h"
#include "support/real_meshes.h"
#include "support/sizes.h"

#include <gtest/gtest.h>
#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <thread>

namespace partwheel::test {
namespace {

constexpr size_t huge = std::numeric_limits<size_t>::max();

struct FreeContext {
    void operator()(pw_context* context) const { pw_context_free(context); }
};
using Context = std::unique_ptr<pw_context, FreeContext>;

Context new_context() {
    pw_context* context = nullptr;
    EXPECT_EQ(pw_context_create(&context), PW_OK);
    return Context(context);
}

TriMesh some_shape() {
    return surface_of("U", block({0, 0, 0}, {5, 1, 2}) + block({0, 0, 0}, {1, 4, 2}) + block({4, 0, 0}, {5, 4, 2}));
}

void expect_argument_error(pw_status status) {
    EXPECT_EQ(status, PW_ERROR_ARGUMENT);
    EXPECT_STRNE(pw_error_message(), "");
}

// ---- Arguments ----

TEST(Api, NullsAreErrors) {
    const TriMesh mesh = cube();
    const Handle handle = build(mesh);
    const pw_hierarchy* h = handle.get();
    const Context context = new_context();
    double seconds[PW_STAGE_COUNT];
    size_t count = 0, start = 0;
    int32_t buffer[64];
    const int32_t* faces = nullptr;
    pw_arrays a{};
    pw_summary s{};
    pw_mesh* made = nullptr;
    pw_hierarchy* loaded = nullptr;

    expect_argument_error(pw_context_create(nullptr));
    expect_argument_error(pw_context_cancel(nullptr));
    expect_argument_error(pw_context_progress(nullptr, seconds, nullptr));
    expect_argument_error(pw_context_seconds(nullptr, seconds));
    expect_argument_error(pw_context_seconds(context.get(), nullptr));
    expect_argument_error(pw_context_fill_method(context.get(), nullptr));
    const pw_mesh_view whole = mesh_view(mesh), no_vertices = mesh_view(nullptr, 8, mesh.triangle_data(), 12),
                       no_triangles = mesh_view(mesh.vertex_data(), 8, nullptr, 12);
    expect_argument_error(pw_build(nullptr, &whole, nullptr, nullptr));
    expect_argument_error(pw_build(nullptr, nullptr, nullptr, &loaded));
    expect_argument_error(pw_build(nullptr, &no_vertices, nullptr, &loaded));
    expect_argument_error(pw_build(nullptr, &no_triangles, nullptr, &loaded));
    expect_argument_error(pw_error_details(nullptr));
    expect_argument_error(pw_hierarchy_arrays(nullptr, &a));
    expect_argument_error(pw_hierarchy_arrays(h, nullptr));
    expect_argument_error(pw_hierarchy_summary(nullptr, &s));
    expect_argument_error(pw_hierarchy_summary(h, nullptr));
    expect_argument_error(pw_hierarchy_path(nullptr, 0, buffer, 64, &count));
    expect_argument_error(pw_hierarchy_path(h, 0, nullptr, 64, &count));
    expect_argument_error(pw_hierarchy_path(h, 0, buffer, 64, nullptr));
    expect_argument_error(pw_hierarchy_wheel(nullptr, 0, 0, buffer, 64, &count, &start));
    expect_argument_error(pw_hierarchy_wheel(h, 0, 0, nullptr, 64, &count, &start));
    expect_argument_error(pw_hierarchy_wheel(h, 0, 0, buffer, 64, nullptr, &start));
    expect_argument_error(pw_hierarchy_wheel(h, 0, 0, buffer, 64, &count, nullptr));
    expect_argument_error(pw_hierarchy_faces(nullptr, 0, &faces, &count));
    expect_argument_error(pw_hierarchy_faces(h, 0, nullptr, &count));
    expect_argument_error(pw_hierarchy_faces(h, 0, &faces, nullptr));
    expect_argument_error(pw_hierarchy_cut_height(nullptr, 0, buffer, 64, &count));
    expect_argument_error(pw_hierarchy_cut_height(h, 0, nullptr, 64, &count));
    expect_argument_error(pw_hierarchy_cut_height(h, 0, buffer, 64, nullptr));
    expect_argument_error(pw_hierarchy_cut_parts(nullptr, 1, buffer, 64, &count));
    expect_argument_error(pw_hierarchy_cut_parts(h, 1, nullptr, 64, &count));
    expect_argument_error(pw_hierarchy_cut_parts(h, 1, buffer, 64, nullptr));
    expect_argument_error(pw_hierarchy_cut_least_concavity(nullptr, nullptr, 1, buffer, 64, &count));
    expect_argument_error(pw_hierarchy_cut_least_concavity(nullptr, h, 1, nullptr, 64, &count));
    expect_argument_error(pw_hierarchy_cut_least_concavity(nullptr, h, 1, buffer, 64, nullptr));
    expect_argument_error(pw_hierarchy_cut_automatic(nullptr, buffer, 64, &count));
    expect_argument_error(pw_hierarchy_cut_automatic(h, nullptr, 64, &count));
    expect_argument_error(pw_hierarchy_cut_automatic(h, buffer, 64, nullptr));
    expect_argument_error(pw_hierarchy_hull(nullptr, nullptr, 0, 1, &made));
    expect_argument_error(pw_hierarchy_hull(nullptr, h, 0, 1, nullptr));
    expect_argument_error(pw_hierarchy_save(nullptr, nullptr, nullptr, 0, &count));
    expect_argument_error(pw_hierarchy_save(nullptr, h, nullptr, 64, &count));
    expect_argument_error(pw_hierarchy_save(nullptr, h, nullptr, 0, nullptr));
    expect_argument_error(pw_hierarchy_load(nullptr, nullptr, 64, &loaded));
    expect_argument_error(pw_hierarchy_load(nullptr, reinterpret_cast<const uint8_t*>(buffer), 64, nullptr));
    EXPECT_EQ(pw_hierarchy_load(nullptr, nullptr, 0, &loaded), PW_ERROR_DATA);
    EXPECT_EQ(loaded, nullptr);

    ASSERT_EQ(pw_hierarchy_hull(nullptr, h, 0, 1, &made), PW_OK);
    const double* vertices = nullptr;
    const int32_t* triangles = nullptr;
    size_t n = 0, m = 0;
    expect_argument_error(pw_mesh_arrays(nullptr, &vertices, &n, &triangles, &m));
    expect_argument_error(pw_mesh_arrays(made, nullptr, &n, &triangles, &m));
    expect_argument_error(pw_mesh_arrays(made, &vertices, nullptr, &triangles, &m));
    expect_argument_error(pw_mesh_arrays(made, &vertices, &n, nullptr, &m));
    expect_argument_error(pw_mesh_arrays(made, &vertices, &n, &triangles, nullptr));
    pw_mesh_free(made);

    pw_context_free(nullptr);
    pw_hierarchy_free(nullptr);
    pw_mesh_free(nullptr);
    EXPECT_EQ(pw_context_progress(context.get(), nullptr, nullptr), PW_OK);
}

TEST(Api, OutOfRangeIsAnError) {
    const Handle handle = build(some_shape());
    const pw_arrays a = arrays(handle);
    const pw_hierarchy* h = handle.get();
    size_t count = 77, start = 77;
    int32_t buffer[8];
    const int32_t* faces = nullptr;
    pw_mesh* made = nullptr;
    for (const size_t face : {a.face_count, a.face_count + 1, size_t{1} << 40, huge}) {
        expect_argument_error(pw_hierarchy_path(h, face, buffer, 8, &count));
        expect_argument_error(pw_hierarchy_wheel(h, face, 0, buffer, 8, &count, &start));
    }
    for (const size_t node : {a.node_count, huge}) expect_argument_error(pw_hierarchy_faces(h, node, &faces, &count));
    for (const double height : {-1.0, -1e-300, std::nan(""), -HUGE_VAL})
        expect_argument_error(pw_hierarchy_cut_height(h, height, buffer, 8, &count));
    for (const size_t parts : {size_t{0}, a.tetrahedron_count + 1, size_t{4097}, huge}) {
        expect_argument_error(pw_hierarchy_cut_parts(h, parts, buffer, 8, &count));
        expect_argument_error(pw_hierarchy_cut_least_concavity(nullptr, h, parts, buffer, 8, &count));
    }
    for (const auto& [first, last] : std::vector<std::pair<size_t, size_t>>{{0, 0},
                                                                            {1, 0},
                                                                            {5, 5},
                                                                            {0, a.tetrahedron_count + 1},
                                                                            {a.tetrahedron_count, a.tetrahedron_count},
                                                                            {0, huge},
                                                                            {huge, huge}})
        expect_argument_error(pw_hierarchy_hull(nullptr, h, first, last, &made));
    // Nothing was written.
    EXPECT_EQ(count, 77U);
    EXPECT_EQ(start, 77U);
    EXPECT_EQ(faces, nullptr);
    EXPECT_EQ(made, nullptr);
    EXPECT_EQ(pw_hierarchy_cut_height(h, -0.0, nullptr, 0, &count), PW_OK);
    EXPECT_EQ(pw_hierarchy_cut_height(h, HUGE_VAL, nullptr, 0, &count), PW_OK);
    EXPECT_EQ(count, 2U);
}

TEST(Api, BuildChecksItsOptionsAndSizes) {
    const TriMesh mesh = cube();
    pw_hierarchy* made = nullptr;
    const auto status = [&](auto option, auto value) {
        pw_build_options options = PW_BUILD_OPTIONS_INIT;
        options.*option = value;
        const pw_mesh_view view = mesh_view(mesh);
        return pw_build(nullptr, &view, &options, &made);
    };
    for (const double quality : {-1.0, 0.5, 1.0, 1.0999, std::nan(""), HUGE_VAL, -HUGE_VAL, 5e-324})
        expect_argument_error(status(&pw_build_options::quality, quality));
    for (const uint32_t fill_methods : {16U, 31U, ~0U})
        expect_argument_error(status(&pw_build_options::fill_methods, fill_methods));
    for (const int32_t refuse : {-1, 2}) expect_argument_error(status(&pw_build_options::refuse_sheets, refuse));
    expect_argument_error(status(&pw_build_options::threads, -1));
    for (const int32_t keep : {-1, 2}) expect_argument_error(status(&pw_build_options::keep_inner_walls, keep));
    expect_argument_error(status(&pw_build_options::reserved, 1));
    for (const int32_t mode : {-1, 3}) expect_argument_error(status(&pw_build_options::mode, mode));
    const auto sized_build = [&](size_t vertices, size_t triangles, const int32_t* faces, size_t face_count) {
        const pw_mesh_view view =
            mesh_view(mesh.vertex_data(), vertices, mesh.triangle_data(), triangles, faces, face_count);
        return pw_build(nullptr, &view, nullptr, &made);
    };
    EXPECT_EQ(sized_build(0, 12, nullptr, 12), PW_ERROR_EMPTY);
    EXPECT_EQ(sized_build(8, 0, nullptr, 0), PW_ERROR_EMPTY);
    EXPECT_EQ(sized_build(7, 12, nullptr, 12), PW_ERROR_INDEX);
    expect_argument_error(sized_build(8, 12, nullptr, 11));
    expect_argument_error(sized_build(8, 12, nullptr, 13));
    for (const size_t large : {size_t{PW_MAX_COUNT} + 1, huge}) {  // detected before anything is read
        expect_argument_error(sized_build(large, 12, nullptr, 12));
        expect_argument_error(sized_build(8, large, nullptr, large));
        expect_argument_error(sized_build(8, 12, mesh.face_data(), large));
    }
    EXPECT_EQ(made, nullptr);
    ASSERT_EQ(status(&pw_build_options::quality, 1.1), PW_OK);
    pw_hierarchy_free(made);
}

TEST(Api, CapacityRules) {
    const Handle handle = build(some_shape());
    const pw_hierarchy* h = handle.get();
    size_t start = 0;
    const std::vector<std::function<pw_status(int32_t*, size_t, size_t*)>> questions{
        [&](int32_t* out, size_t capacity, size_t* count) { return pw_hierarchy_path(h, 3, out, capacity, count); },
        [&](int32_t* out, size_t capacity, size_t* count) {
            return pw_hierarchy_wheel(h, 3, 0, out, capacity, count, &start);
        },
        [&](int32_t* out, size_t capacity, size_t* count) {
            return pw_hierarchy_cut_height(h, 0, out, capacity, count);
        },
        [&](int32_t* out, size_t capacity, size_t* count) {
            return pw_hierarchy_cut_parts(h, 7, out, capacity, count);
        },
        [&](int32_t* out, size_t capacity, size_t* count) {
            return pw_hierarchy_cut_least_concavity(nullptr, h, 7, out, capacity, count);
        },
    };
    for (const auto& ask : questions) {
        size_t needed = 0, count = 0;
        start = 77;
        ASSERT_EQ(ask(nullptr, 0, &needed), PW_OK);
        ASSERT_GT(needed, 1U);
        std::vector<int32_t> buffer(needed + 3, -99);
        ASSERT_EQ(ask(buffer.data(), needed - 1, &count), PW_ERROR_CAPACITY);
        EXPECT_STRNE(pw_error_message(), "");
        EXPECT_EQ(count, needed);
        EXPECT_EQ(buffer, std::vector<int32_t>(needed + 3, -99)) << "written although it doesn't fit";
        ASSERT_EQ(ask(buffer.data(), needed, &count), PW_OK);
        for (size_t i = 0; i < needed; ++i) EXPECT_NE(buffer[i], -99);
        EXPECT_EQ(buffer[needed], -99) << "written past the end";
        ASSERT_EQ(ask(buffer.data(), needed + 3, &count), PW_OK);
        EXPECT_EQ(count, needed);
        EXPECT_EQ(buffer[needed], -99);
    }
    size_t needed = 0, count = 0;
    ASSERT_EQ(pw_hierarchy_save(nullptr, h, nullptr, 0, &needed), PW_OK);
    std::vector<uint8_t> bytes(needed, 0xab);
    ASSERT_EQ(pw_hierarchy_save(nullptr, h, bytes.data(), needed - 1, &count), PW_ERROR_CAPACITY);
    EXPECT_EQ(count, needed);
    EXPECT_EQ(bytes, std::vector<uint8_t>(needed, 0xab));
}

// ---- Mesh views ----

// Interleaved numbers, as in a vertex buffer; at odd addresses if odd.
template <class Number, size_t n, class Item>
std::vector<unsigned char> strided(const std::vector<Item>& items, size_t stride, size_t odd) {
    std::vector<unsigned char> bytes(items.size() * stride + odd, 0xee);
    for (size_t i = 0; i < items.size(); ++i) {
        Number numbers[n];
        for (size_t k = 0; k < n; ++k) {
            if constexpr (n == 1)
                numbers[k] = static_cast<Number>(items[i]);
            else
                numbers[k] = static_cast<Number>(items[i][k]);
        }
        std::memcpy(bytes.data() + odd + i * stride, numbers, sizeof numbers);
    }
    return bytes;
}

template <class Index>
void expect_same_in_any_layout(pw_index_type type) {
    const TriMesh mesh = some_shape();  // with integer coordinates, exact as floats
    const std::vector<uint8_t> expected = save(build(mesh));
    for (const size_t gap : {0U, 5U, 16U})
        for (const size_t odd : {0U, 1U}) {
            const size_t vertex = 3 * sizeof(float) + gap, triangle = 3 * sizeof(Index) + gap, face = sizeof(Index) + gap;
            const auto vertices = strided<float, 3>(mesh.vertices, vertex, odd);
            const auto triangles = strided<Index, 3>(mesh.triangles, triangle, odd);
            const auto faces = strided<Index, 1>(mesh.faces, face, odd);
            pw_mesh_view view = mesh_view(mesh);
            view.vertices = vertices.data() + odd, view.vertex_stride = vertex, view.vertex_type = PW_FLOAT;
            view.triangles = triangles.data() + odd, view.triangle_stride = triangle, view.index_type = type;
            view.faces = faces.data() + odd, view.face_stride = face;
            pw_hierarchy* made = nullptr;
            ASSERT_EQ(pw_build(nullptr, &view, nullptr, &made), PW_OK) << pw_error_message();
            EXPECT_EQ(save(Handle(made)), expected) << "gap " << gap << ", odd " << odd;
        }
}

TEST(Api, AnyMeshLayoutGivesTheSameResult) {
    expect_same_in_any_layout<int32_t>(PW_INT32);
    expect_same_in_any_layout<uint32_t>(PW_UINT32);
    expect_same_in_any_layout<int64_t>(PW_INT64);
}

TEST(Api, MeshViewsAreChecked) {
    const TriMesh mesh = cube();
    pw_hierarchy* made = nullptr;
    const auto status = [&](const auto& change) {
        pw_mesh_view view = mesh_view(mesh);
        change(view);
        return pw_build(nullptr, &view, nullptr, &made);
    };
    expect_argument_error(status([](pw_mesh_view& view) { view.struct_size = 0; }));
    expect_argument_error(status([](pw_mesh_view& view) { view.vertex_type = 2; }));
    expect_argument_error(status([](pw_mesh_view& view) { view.vertex_type = -1; }));
    expect_argument_error(status([](pw_mesh_view& view) { view.index_type = 3; }));
    expect_argument_error(status([](pw_mesh_view& view) { view.vertex_stride = 3 * sizeof(double) - 1; }));
    expect_argument_error(status([](pw_mesh_view& view) { view.triangle_stride = 1; }));
    expect_argument_error(status([](pw_mesh_view& view) { view.face_stride = 3; }));
    // An index beyond int32 is refused with its location, not truncated.
    std::vector<std::array<int64_t, 3>> wide;
    for (const Triangle& t : mesh.triangles) wide.push_back({t[0], t[1], t[2]});
    wide[5][1] += int64_t{1} << 32;
    const pw_status refused = status([&](pw_mesh_view& view) {
        view.triangles = wide.data(), view.index_type = PW_INT64, view.faces = nullptr, view.face_count = 0;
    });
    EXPECT_EQ(refused, PW_ERROR_INDEX);
    pw_error_info info = PW_ERROR_INFO_INIT;
    ASSERT_EQ(pw_error_details(&info), PW_OK);
    EXPECT_EQ(info.triangle, 5);
    EXPECT_EQ(made, nullptr);
}

// ---- Errors ----

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
bool limit_memory(rlim_t bytes) {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0) return false;
    limit.rlim_cur = bytes;
    return setrlimit(RLIMIT_AS, &limit) == 0 && getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur == bytes;
}

// In a child process that has used up all of its memory.
TEST(Api, TheOutOfMemoryMessageNeedsNoMemory) {
    if (!limit_memory(rlim_t{1} << 46)) GTEST_SKIP() << "Memory can't be limited here, as under qemu.";
    const auto child = [] {
        if (!limit_memory(rlim_t{1} << 28)) return 2;
        for (size_t size = size_t{1} << 26; size > 0; size -= size > 4096 ? size / 2 : 8)  // free lists are by size
            while (std::malloc(size)) {
            }
        pw_context* context = nullptr;
        if (const pw_status status = pw_context_create(&context); status != PW_ERROR_MEMORY) return 100 + status;
        return std::strstr(pw_error_message(), "not enough memory") ? 0 : 4;
    };
    EXPECT_EXIT(_exit(child()), testing::ExitedWithCode(0), "");
}
#endif

TEST(Api, MessagesBelongToTheirThread) {
    expect_argument_error(pw_context_create(nullptr));
    const std::string mine = pw_error_message();
    std::string before, after;
    std::thread([&] {
        before = pw_error_message();
        pw_hierarchy* made = nullptr;
        (void)pw_hierarchy_load(nullptr, nullptr, 0, &made);
        after = pw_error_message();
    }).join();
    EXPECT_EQ(before, "");
    EXPECT_NE(after, "");
    EXPECT_NE(after, mine);
    EXPECT_EQ(pw_error_message(), mine);
    (void)build(cube());  // a success leaves the message
    EXPECT_EQ(pw_error_message(), mine);
}

// ---- Contexts ----

// Every call with a context that was canceled before stops and writes nothing.
TEST(Api, SummaryReportsTheFillMethodOfTheProxy) {
    const TriMesh mesh = without_faces(torus(60, 40, 2, 0.5));
    TriMesh open = mesh;
    open.triangles.pop_back();
    open = without_faces(open);
    pw_build_options options = PW_BUILD_OPTIONS_INIT;
    options.exact_triangles = 2000;
    for (const auto& [given, allowed, expected] :
         {std::tuple(&mesh, 0, PW_FILL_EXACT), {&open, PW_FILL_REPAIRED, PW_FILL_REPAIRED}, {&open, PW_FILL_POINTS, PW_FILL_POINTS}}) {
        options.fill_methods = static_cast<uint32_t>(allowed);
        const pw_mesh_view view = mesh_view(*given);
        pw_hierarchy* made = nullptr;
        ASSERT_EQ(pw_build(nullptr, &view, &options, &made), PW_OK) << pw_error_message();
        const Handle handle(made);
        for (const pw_summary& s : {summary(handle), summary(try_load(save(handle)).handle)}) {
            EXPECT_EQ(s.fill_method, expected);
            EXPECT_TRUE(s.proxy_triangles >= 100 && s.proxy_triangles < 2000) << s.proxy_triangles;
        }
    }
}

TEST(Api, CancelStopsEveryCallWithAContext) {
    const TriMesh mesh = some_shape();
    const pw_mesh_view view = mesh_view(mesh);
    const Handle handle = build(mesh);
    const pw_hierarchy* h = handle.get();
    const size_t tets = arrays(handle).tetrahedron_count, n = mesh.vertices.size();
    const std::vector<uint8_t> saved = save(handle);
    const std::vector<uint8_t> inside(mesh.face_count, 1), from(n, 1);
    std::vector<int32_t> roles(n, PW_VERTEX_FREE);
    roles[0] = 0, roles[1] = PW_VERTEX_FIXED;
    const int32_t edges[] = {0, 1, 1, 2};
    const std::vector<double> points(12 * 300, 0.25);
    std::vector<double> unit_matrices(12 * 300);
    for (size_t i = 0; i < unit_matrices.size(); ++i) unit_matrices[i] = i % 12 % 5 == 0;
    const int32_t slice[] = {0, 1};
    pw_index* index = nullptr;
    ASSERT_EQ(pw_index_create(nullptr, h, nullptr, 0, 1, &index), PW_OK);
    pw_deformation* deformation = nullptr;
    ASSERT_EQ(pw_deformation_create(nullptr, &view, roles.data(), 1, &deformation), PW_OK) << pw_error_message();
    pw_convex_options hulls = PW_CONVEX_OPTIONS_INIT;
    hulls.hulls = 2;

    int untouched = 0;
    const auto mark = [&]<class... T>(T*&... outputs) { ((outputs = reinterpret_cast<T*>(&untouched)), ...); };
    const auto are_marked = [&](const auto*... outputs) { return ((static_cast<const void*>(outputs) == &untouched) && ...); };
    pw_hierarchy* hierarchy = nullptr;
    pw_mesh* made = nullptr;
    pw_creases* creases = nullptr;
    pw_deformation* deformed = nullptr;
    pw_ray_target* target = nullptr;
    pw_index* indexed = nullptr;
    pw_convex_parts* parts = nullptr;
    mark(hierarchy, made, creases, deformed, target, indexed, parts);
    size_t count = 77;
    std::vector<int32_t> numbers(tets + 600, -99);
    std::vector<double> places(12 * 300, -99);
    std::vector<uint8_t> bytes(saved.size(), 99), is_seam(3 * mesh.triangles.size(), 99);
    const std::vector<int32_t> labels(mesh.face_count, 0);
    const std::vector<double> uvs(6 * mesh.triangles.size(), 0);
    const std::vector<std::function<pw_status(pw_context*)>> calls{
        [&](pw_context* c) { return pw_build(c, &view, nullptr, &hierarchy); },
        [&](pw_context* c) { return pw_hierarchy_load(c, saved.data(), saved.size(), &hierarchy); },
        [&](pw_context* c) { return pw_hierarchy_save(c, h, bytes.data(), bytes.size(), &count); },
        [&](pw_context* c) { return pw_hierarchy_hull(c, h, 0, tets, &made); },
        [&](pw_context* c) { return pw_hierarchy_solid(c, h, 0, tets, &made); },
        [&](pw_context* c) { return pw_hierarchy_solid_of_slices(c, h, slice, 1, &made); },
        [&](pw_context* c) { return pw_hierarchy_solid_of_faces(c, h, 0, 1, inside.data(), inside.size(), &made); },
        [&](pw_context* c) { return pw_hierarchy_cut_least_concavity(c, h, 2, numbers.data(), numbers.size(), &count); },
        [&](pw_context* c) { return pw_hierarchy_with_part(c, h, slice, 2, &hierarchy); },
        [&](pw_context* c) { return pw_duplicate_faces(c, &view, numbers.data()); },
        [&](pw_context* c) { return pw_hierarchy_convex_parts(c, h, &hulls, &parts); },
        [&](pw_context* c) { return pw_creases_create(c, &view, &creases); },
        [&](pw_context* c) { return pw_deformation_create(c, &view, roles.data(), 1, &deformed); },
        [&](pw_context* c) { return pw_deformation_iterate(c, deformation, 3); },
        [&](pw_context* c) { return pw_surface_distances(c, &view, from.data(), places.data()); },
        [&](pw_context* c) {
            return pw_fair_vertices(c, mesh.vertex_data(), n, edges, 2, from.data(), places.data());
        },
        [&](pw_context* c) { return pw_hierarchy_seams(c, h, &view, labels.data(), 0, 1.09, is_seam.data()); },
        [&](pw_context* c) { return pw_hierarchy_refine_seams(c, h, &view, uvs.data(), 1.09, is_seam.data()); },
        [&](pw_context* c) { return pw_mirror_planes(c, &view, places.data(), &count); },
        [&](pw_context* c) { return pw_ray_target_create(c, &view, &target); },
        [&](pw_context* c) { return pw_index_create(c, h, nullptr, 0, 1, &indexed); },
        [&](pw_context* c) { return pw_index_locate(c, index, points.data(), 300, numbers.data()); },
        [&](pw_context* c) {
            return pw_index_first_hits(c, index, points.data(), points.data(), 300, numbers.data(), places.data());
        },
        [&](pw_context* c) {
            return pw_index_nearest(c, index, points.data(), 300, numbers.data(), places.data(), places.data());
        },
        [&](pw_context* c) {
            return pw_index_intersects(c, index, index, unit_matrices.data(), 300, numbers.data(), places.data());
        },
    };
    const Context context = new_context();
    for (size_t i = 0; i < calls.size(); ++i) {
        ASSERT_EQ(pw_context_cancel(context.get()), PW_OK);
        EXPECT_EQ(calls[i](context.get()), PW_ERROR_CANCELED) << "call " << i;
    }
    EXPECT_TRUE(are_marked(hierarchy, made, creases, deformed, target, indexed, parts));
    EXPECT_EQ(count, 77U);
    EXPECT_EQ(std::ranges::count(numbers, -99), static_cast<std::ptrdiff_t>(numbers.size()));
    EXPECT_EQ(std::ranges::count(places, -99), static_cast<std::ptrdiff_t>(places.size()));
    EXPECT_EQ(std::ranges::count(bytes, 99), static_cast<std::ptrdiff_t>(bytes.size()));
    EXPECT_EQ(std::ranges::count(is_seam, 99), static_cast<std::ptrdiff_t>(is_seam.size()));

    // The context can be reused, and ends at 1.
    double fraction = 0;
    ASSERT_EQ(pw_hierarchy_save(context.get(), h, bytes.data(), bytes.size(), &count), PW_OK) << pw_error_message();
    ASSERT_EQ(pw_context_progress(context.get(), &fraction, nullptr), PW_OK);
    EXPECT_EQ(fraction, 1);
    EXPECT_EQ(bytes, saved);
    pw_index_free(index);
    pw_deformation_free(deformation);
}

TEST(Api, CancelFromAnotherThreadWhileClustering) {
    // The clusters of the second model have many facets: each step is slow.
    const TriMesh bear = real_mesh(light() ? "hand.off" : "bear_bis.off"), cheese = real_mesh("cheese.off");
    for (const auto& run : {std::pair(&bear, 0.5), {&bear, 0.8}, {&bear, 0.95}, {&cheese, 0.5}}) {
        const TriMesh& mesh = *run.first;
        const double at = run.second;
        SCOPED_TRACE(mesh.name);
        const Context context = new_context();
        std::atomic<bool> done{false};
        pw_status status = PW_OK;
        std::thread builder([&] {
            status = try_build(mesh, 0, context.get()).status;
            done = true;
        });
        double fraction = 0, asked = 0;
        pw_stage stage = PW_STAGE_SURFACE;
        while (!done && !(stage == PW_STAGE_CLUSTER && fraction >= at)) {
            EXPECT_EQ(pw_context_progress(context.get(), &fraction, &stage), PW_OK);
            std::this_thread::yield();
        }
        EXPECT_EQ(pw_context_cancel(context.get()), PW_OK);
        EXPECT_EQ(pw_context_progress(context.get(), &asked, nullptr), PW_OK);
        builder.join();
        EXPECT_EQ(pw_context_progress(context.get(), &fraction, &stage), PW_OK);
        if (asked == 1) continue;  // this thread slept until the end of the build
        EXPECT_EQ(status, PW_ERROR_CANCELED) << "at " << at;
        // It has stopped at the next check: every 256 merges, of about as many as there are faces.
        if (stage == PW_STAGE_CLUSTER) {
            EXPECT_LE(fraction, asked + 256 / static_cast<double>(mesh.triangles.size())) << "at " << at;
        }
        // The context can be reused.
        EXPECT_EQ(try_build(cube(), 0, context.get()).status, PW_OK);
    }
}

// ---- Threads ----

TEST(Api, ConcurrentBuildsGiveTheSameBytes) {
    const std::vector<TriMesh> meshes{real_mesh("joint.off"), perturbed(torus(16, 8, 2, 0.6), 0.03, 1), some_shape(),
                                      surface_of("hollow", block({0, 0, 0}, {3, 3, 3}) - Cells{{1, 1, 1}})};
    std::vector<std::vector<uint8_t>> alone;
    for (const TriMesh& mesh : meshes) alone.push_back(save(build(mesh)));
    for (int round = 0; round < sized(5, 2); ++round) {
        std::vector<std::vector<uint8_t>> together(meshes.size());
        std::vector<std::thread> threads;
        for (size_t i = 0; i < meshes.size(); ++i)
            threads.emplace_back([&, i] {
                const Context context = new_context();
                const Built built = try_build(meshes[i], 0, context.get());
                if (built.status == PW_OK) together[i] = save(built.handle);
            });
        for (std::thread& t : threads) t.join();
        EXPECT_EQ(together, alone);
    }
}

// Solids of different sizes, a sheet, one that must be repaired, and one without area.
TriMesh assembly() {
    TriMesh sheet = moved(cube(), {0, 4, 0});
    sheet.triangles.resize(2);
    TriMesh flat = moved(tetrahedron(), {0, 0, 6});
    for (Point& p : flat.vertices) p = {p[0], 0, 6};
    TriMesh all = together("assembly", snowman(12, 16), together("", moved(snowman(8, 10), {0, 0.7, 0}), sheet));
    for (const TriMesh& shell : {flat, moved(hedgehog(12), {8, 0, 0}), moved(torus(16, 8, 2, 0.6), {-8, 0, 0}),
                                 moved(star_prism(7, 0.5, 1, 2), {0, -8, 0}), moved(inside_out(cube()), {5, 5, 5})})
        all = together("assembly", all, shell);
    return without_faces(all);
}

pw_status build_in_threads(const TriMesh& mesh, int32_t threads, pw_context* context, std::vector<uint8_t>& bytes) {
    pw_build_options options = PW_BUILD_OPTIONS_INIT;
    options.threads = threads;
    pw_hierarchy* built = nullptr;
    const pw_mesh_view view = mesh_view(mesh);
    const pw_status status = pw_build(context, &view, &options, &built);
    if (status == PW_OK) bytes = save(Handle(built));
    return status;
}

TEST(Api, ShellsInSeveralThreadsGiveTheSameBytes) {
    const TriMesh mesh = assembly();
    std::vector<uint8_t> alone;
    ASSERT_EQ(build_in_threads(mesh, 1, nullptr, alone), PW_OK) << pw_error_message();
    for (const int32_t threads : {2, 3, 16}) {
        const Context context = new_context();
        std::vector<uint8_t> bytes;
        std::atomic<bool> done{false};
        std::thread builder([&] {
            EXPECT_EQ(build_in_threads(mesh, threads, context.get(), bytes), PW_OK);
            done = true;
        });
        double before = 0, fraction = 0;
        while (!done) {
            EXPECT_EQ(pw_context_progress(context.get(), &fraction, nullptr), PW_OK);
            EXPECT_TRUE(before <= fraction && fraction <= 1) << before << " " << fraction;
            before = fraction;
            std::this_thread::yield();
        }
        builder.join();
        EXPECT_EQ(bytes, alone) << threads;
        EXPECT_EQ(pw_context_progress(context.get(), &fraction, nullptr), PW_OK);
        EXPECT_EQ(fraction, 1);
        std::array<double, PW_STAGE_COUNT> seconds{};
        EXPECT_EQ(pw_context_seconds(context.get(), seconds.data()), PW_OK);
        EXPECT_GT(seconds[PW_STAGE_CLUSTER], 0);
    }
}

TEST(Api, CancelWhileShellsAreBuiltInSeveralThreads) {
    const TriMesh mesh = assembly();
    for (const double at : {0.05, 0.3, 0.6, 0.9}) {
        const Context context = new_context();
        std::vector<uint8_t> bytes;
        std::atomic<bool> done{false};
        pw_status status = PW_OK;
        std::thread builder([&] {
            status = build_in_threads(mesh, 3, context.get(), bytes);
            done = true;
        });
        double fraction = 0;
        while (!done && fraction < at) {
            EXPECT_EQ(pw_context_progress(context.get(), &fraction, nullptr), PW_OK);
            std::this_thread::yield();
        }
        EXPECT_EQ(pw_context_cancel(context.get()), PW_OK);
        EXPECT_EQ(pw_context_progress(context.get(), &fraction, nullptr), PW_OK);
        builder.join();
        if (fraction == 1) continue;  // this thread slept until the end of the build
        EXPECT_EQ(status, PW_ERROR_CANCELED) << at;
    }
}

TEST(Api, BuildsWithoutFurtherThreads) {
    const TriMesh mesh = real_mesh("hand.off");
    pw_build_options options = PW_BUILD_OPTIONS_INIT;
    options.fill_methods = PW_FILL_EXACT;
    options.threads = 4;
    const auto built = [&] {
        pw_hierarchy* made = nullptr;
        const pw_mesh_view view = mesh_view(mesh);
        if (pw_build(nullptr, &view, &options, &made) != PW_OK) {
            std::fprintf(stderr, "%s\n", pw_error_message());
            return std::vector<uint8_t>();
        }
        return save(Handle(made));
    };
    const std::vector<uint8_t> with_threads = built();
    ASSERT_FALSE(with_threads.empty());
    expect_holds_alone([&] { return built() == with_threads; });
}

}  // namespace
}  // namespace partwheel::test
