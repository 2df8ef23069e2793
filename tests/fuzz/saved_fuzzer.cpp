// Fuzzer of pw_hierarchy_load(): any bytes are refused, or every question about what was loaded has an answer that the
// header documents. The hash at the end of the bytes is not compared (see cmake/fuzzers.cmake), so forged ones get in.
// Most inputs are made by changing fields: they get behind the checks of the packed form, which changed bytes seldom do.
#include "base/error.h"
#include "support/built.h"
#include "tree/saved.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

using namespace partwheel::test;
using partwheel::SavedHierarchy;

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace {

// Changes fields of a saved hierarchy. The sizes of its arrays keep matching each other.
class FieldMutator {
public:
    FieldMutator(SavedHierarchy& saved, unsigned seed) : saved_(saved), random_(seed) {}

    void mutate() {
        for (size_t changes = 1 + below(3); changes > 0; --changes) change();
    }

private:
    void change() {
        switch (below(13)) {
            case 0: return change_tetrahedron();
            case 1: return change_vertices();
            case 2: return keep_tetrahedra(1 + below(std::min<size_t>(saved_.tetrahedra.size(), 4)));
            case 3: return change_index(saved_.borders, saved_.tetrahedra.size());
            case 4: return change_index(saved_.leaf, saved_.tetrahedra.size());
            case 5: return change_index(saved_.source, saved_.vertices.size());
            case 6: return change_index(saved_.outer_faces, saved_.leaf.size());
            case 7: return change_number(saved_.concavities);
            case 8: return change_number(saved_.face_area);
            case 9: return change_number(saved_.scores);
            case 10: return change_header();
            case 11: return change_shells();
            default: return change_sizes();
        }
    }

    size_t below(size_t count) { return random_() % count; }

    int32_t index(size_t count) {
        const auto size = static_cast<int32_t>(count);
        const int32_t wild[] = {-2, -1, 0, 1, size - 1, size, std::numeric_limits<int32_t>::max()};
        return below(4) ? static_cast<int32_t>(below(count)) : wild[below(std::size(wild))];
    }

    double number(double given) {
        const double infinity = std::numeric_limits<double>::infinity();
        const double wild[] = {0, -0.0, 1, -given, 2 * given, std::nextafter(given, infinity), 1e-300, 5e-324, 1e-81, 1e100, 1e300,
                               infinity, std::numeric_limits<double>::quiet_NaN()};
        return wild[below(std::size(wild))];
    }

    void change_index(std::vector<int32_t>& numbers, size_t count) {
        if (numbers.empty()) return;
        int32_t& changed = numbers[below(numbers.size())];
        if (below(2))
            changed = index(count);
        else
            std::swap(changed, numbers[below(numbers.size())]);
    }

    void change_number(std::vector<double>& numbers) {
        if (numbers.empty()) return;
        double& changed = numbers[below(numbers.size())];
        changed = number(changed);
    }

    void change_tetrahedron() {
        auto& t = saved_.tetrahedra[below(saved_.tetrahedra.size())];
        switch (below(5)) {
            case 0: t = saved_.tetrahedra[below(saved_.tetrahedra.size())]; break;
            case 1: t[below(4)] = t[below(4)]; break;
            case 2: std::swap(t[below(4)], t[below(4)]); break;
            case 3: t.fill(t[below(4)]); break;
            default: t[below(4)] = index(saved_.vertices.size());
        }
    }

    void change_vertices() {
        auto& p = saved_.vertices[below(saved_.vertices.size())];
        const size_t k = below(3);
        switch (below(4)) {
            case 0: p = saved_.vertices[below(saved_.vertices.size())]; break;
            case 1: p[k] = number(p[k]); break;
            case 2:  // in one plane
                for (auto& q : saved_.vertices) q[k] = p[k];
                break;
            default: {
                const double scale = number(1);
                for (auto& q : saved_.vertices)
                    for (double& c : q) c *= scale;
            }
        }
    }

    void keep_tetrahedra(size_t count) {
        const auto last = static_cast<int32_t>(count - 1);
        saved_.tetrahedra.resize(count);
        saved_.borders.resize(count - 1);
        std::iota(saved_.borders.begin(), saved_.borders.end(), 1);
        saved_.concavities.resize(count - 1);
        for (int32_t& l : saved_.leaf) l = std::min(l, last);
        saved_.scores.clear();
        saved_.summary.components = std::min<uint64_t>(saved_.summary.components, count);
        saved_.outer_faces.resize(below(4 * count + 1));
    }

    void change_header() {
        const uint64_t count = index(saved_.tetrahedra.size());
        switch (below(6)) {
            case 0: saved_.summary.components = count; break;
            case 1: saved_.summary.cavities = count; break;
            case 2: saved_.summary.added_vertices = count; break;
            case 3: saved_.summary.deviation = number(saved_.summary.deviation); break;
            case 4: saved_.summary.hull_volume = number(saved_.summary.hull_volume); break;
            default:
                saved_.summary.fill_method = static_cast<pw_fill_method>(1 << below(4));
                saved_.summary.proxy_triangles = below(2) ? below(1000) : 0;
                saved_.notes = saved_.summary.fill_method == PW_FILL_EXACT && saved_.summary.proxy_triangles == 0 ? "" : "Changed.";
        }
    }

    void change_shells() {
        saved_.shell_fills.resize(below(4));
        for (uint8_t& fill : saved_.shell_fills)
            if (below(2)) fill = static_cast<uint8_t>(1U << below(5));
    }

    void change_sizes() {
        const auto resize = [&](auto& array) { array.resize(1 + below(array.size() + 2)); };
        switch (below(4)) {
            case 0: resize(saved_.outer_faces); break;
            case 1: resize(saved_.scores); break;
            case 2:
                resize(saved_.leaf);
                saved_.face_area.resize(saved_.leaf.size());
                break;
            default:
                resize(saved_.vertices);
                saved_.source.resize(saved_.vertices.size());
        }
    }

    SavedHierarchy& saved_;
    std::mt19937 random_;
};

// The surface, and where it comes from: indices that exist, and finite coordinates.
void expect_solid(const Handle& handle, pw_status status, pw_mesh* made) {
    const std::unique_ptr<pw_mesh, void (*)(pw_mesh*)> solid(made, pw_mesh_free);
    EXPECT_TRUE(status == PW_OK || status == PW_ERROR_DATA || status == PW_ERROR_EMPTY) << pw_error_message();
    if (status != PW_OK) return;
    const pw_arrays a = arrays(handle);
    const double* vertices = nullptr;
    const int32_t *triangles = nullptr, *sources = nullptr, *faces = nullptr, *beyond = nullptr;
    size_t vertex_count = 0, triangle_count = 0;
    ASSERT_EQ(pw_mesh_arrays(made, &vertices, &vertex_count, &triangles, &triangle_count), PW_OK);
    ASSERT_EQ(pw_mesh_origins(made, &sources, &faces, &beyond), PW_OK);
    const auto below = [](int32_t i, size_t count) { return i >= 0 && static_cast<size_t>(i) < count; };
    for (size_t i = 0; i < 3 * triangle_count; ++i) EXPECT_TRUE(below(triangles[i], vertex_count));
    for (size_t i = 0; i < vertex_count; ++i) EXPECT_TRUE(below(sources[i], a.vertex_count));
    for (size_t i = 0; i < 3 * vertex_count; ++i) EXPECT_TRUE(std::isfinite(vertices[i]));
    for (size_t t = 0; t < triangle_count; ++t) {
        EXPECT_TRUE(faces[t] == -1 || below(faces[t], a.face_count));
        EXPECT_TRUE(beyond[t] == -1 || below(beyond[t], a.tetrahedron_count));
    }
}

// The slice, and the rest: by themselves, and with every other face.
void expect_solids(const Handle& handle, size_t first, size_t last) {
    const pw_hierarchy* h = handle.get();
    const pw_arrays a = arrays(handle);
    std::vector<uint8_t> inside(a.face_count);
    for (size_t f = 0; f < inside.size(); ++f) inside[f] = f % 2 == 0;
    pw_mesh* made = nullptr;
    pw_status status = pw_hierarchy_solid(nullptr, h, first, last, &made);
    expect_solid(handle, status, made);
    made = nullptr;
    status = pw_hierarchy_solid(nullptr, h, last, first, &made);
    expect_solid(handle, status, made);
    made = nullptr;
    status = pw_hierarchy_solid_of_faces(nullptr, h, first, last, inside.data(), inside.size(), &made);
    expect_solid(handle, status, made);
    made = nullptr;
    status = pw_hierarchy_solid_of_faces(nullptr, h, last, first, inside.data(), inside.size(), &made);
    expect_solid(handle, status, made);
}

// What an index of it says of its own vertices, exactly and by the hulls of a cut.
void expect_index(const Handle& handle, const int32_t* bounds, size_t bound_count) {
    pw_index* made = nullptr;
    const pw_status status = pw_index_create(nullptr, handle.get(), bounds, bound_count, 1, &made);
    if (bounds && status == PW_ERROR_NO_VOLUME) return;
    ASSERT_EQ(status, PW_OK) << pw_error_message();
    const std::unique_ptr<pw_index, decltype(&pw_index_free)> index(made, pw_index_free);
    const pw_arrays a = arrays(handle);
    const size_t count = std::min<size_t>(a.vertex_count, 50);
    constexpr double largest_query = 1e100;  // a vertex of a thickened sheet may be somewhat farther out
    if (std::any_of(a.vertices, a.vertices + 3 * count, [](double x) { return std::fabs(x) > largest_query; })) return;
    std::vector<int32_t> containing(count), parts(count);
    std::vector<double> distances(count), places(3 * count), directions;
    for (size_t k = 0; k < count; ++k) directions.insert(directions.end(), {1, 0.5, -0.25});
    EXPECT_EQ(pw_index_locate(nullptr, made, a.vertices, count, containing.data()), PW_OK) << pw_error_message();
    EXPECT_EQ(pw_index_nearest(nullptr, made, a.vertices, count, parts.data(), distances.data(), places.data()), PW_OK);
    for (size_t k = 0; k < count; ++k) {
        EXPECT_TRUE(parts[k] >= 0 && distances[k] >= 0 && std::isfinite(distances[k]));
        if (containing[k] >= 0) EXPECT_TRUE(parts[k] == containing[k] && distances[k] == 0);
    }
    EXPECT_EQ(pw_index_first_hits(nullptr, made, a.vertices, directions.data(), count, parts.data(), distances.data()), PW_OK);
    for (size_t k = 0; k < count; ++k) EXPECT_TRUE(parts[k] >= -1 && distances[k] >= 0 && std::isfinite(distances[k]));
    const double itself[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    int32_t pair[2] = {-1, -1};
    EXPECT_EQ(pw_index_intersects(nullptr, made, made, itself, 1, pair, places.data()), PW_OK) << pw_error_message();
    EXPECT_TRUE(pair[0] >= 0 && pair[1] >= 0);
}

// The cuts of every kind, each a division of all tetrahedra; returns the automatic one.
std::vector<int32_t> expect_cuts(const Handle& handle) {
    const pw_hierarchy* h = handle.get();
    const size_t tets = arrays(handle).tetrahedron_count, parts = std::min<size_t>(tets, 5);
    std::vector<int32_t> bounds(tets + 1);
    size_t count = 0;
    const auto expect_cut = [&](pw_status status) {
        EXPECT_EQ(status, PW_OK) << pw_error_message();
        EXPECT_TRUE(count >= 2 && count <= bounds.size());
        EXPECT_EQ(bounds[0], 0);
        EXPECT_EQ(static_cast<size_t>(bounds[count - 1]), tets);
        for (size_t k = 1; k < count; ++k) EXPECT_LT(bounds[k - 1], bounds[k]);
    };
    expect_cut(pw_hierarchy_cut_height(h, 0, bounds.data(), bounds.size(), &count));
    expect_cut(pw_hierarchy_cut_parts(h, parts, bounds.data(), bounds.size(), &count));
    expect_cut(pw_hierarchy_cut_least_concavity(nullptr, h, parts, bounds.data(), bounds.size(), &count));
    expect_cut(pw_hierarchy_cut_automatic(h, bounds.data(), bounds.size(), &count));
    bounds.resize(count);
    return bounds;
}

// Hulls whose vertices are finite.
void expect_convex_parts(const Handle& handle, const pw_convex_options& options) {
    pw_convex_parts* made = nullptr;
    const pw_status status = pw_hierarchy_convex_parts(nullptr, handle.get(), &options, &made);
    const std::unique_ptr<pw_convex_parts, decltype(&pw_convex_parts_free)> parts(made, pw_convex_parts_free);
    ASSERT_EQ(status, PW_OK) << pw_error_message();
    size_t count = 0;
    ASSERT_EQ(pw_convex_parts_count(made, &count), PW_OK);
    for (size_t i = 0; i < count; ++i) {
        const double* vertices = nullptr;
        const int32_t* triangles = nullptr;
        size_t vertex_count = 0, triangle_count = 0;
        double volume = 0, error = 0;
        ASSERT_EQ(pw_convex_parts_hull(made, i, &vertices, &vertex_count, &triangles, &triangle_count, &volume, &error), PW_OK);
        for (size_t k = 0; k < 3 * vertex_count; ++k) EXPECT_TRUE(std::isfinite(vertices[k]));
        EXPECT_TRUE(std::isfinite(volume) && std::isfinite(error));
    }
}

}  // namespace

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
    std::vector<uint8_t> bytes;
    if (seed % 8 != 0) {
        try {
            SavedHierarchy saved = SavedHierarchy::unpack({data, size});
            FieldMutator(saved, seed).mutate();
            bytes = saved.pack();
        } catch (const partwheel::Error&) {  // the bytes were changed before
            bytes.clear();
        }
    }
    if (bytes.empty() || bytes.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
    std::copy(bytes.begin(), bytes.end(), data);
    return bytes.size();
}

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
    if (std::getenv("PARTWHEEL_FUZZ_REPORT")) std::fputs("input: loaded\n", stderr);  // for the test of seeds
    const pw_arrays a = arrays(loaded.handle);
    const pw_summary s = summary(loaded.handle);
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_LT(a.volume[a.node_count - 1], infinity);
    EXPECT_LT(a.area[a.node_count - 1], infinity);
    EXPECT_TRUE(s.fill_method == PW_FILL_EXACT || s.fill_method == PW_FILL_REPAIRED || s.fill_method == PW_FILL_POINTS ||
                s.fill_method == PW_FILL_SHEET);
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
    const std::vector<int32_t> bounds = expect_cuts(loaded.handle);
    expect_index(loaded.handle, nullptr, 0);
    expect_index(loaded.handle, bounds.data(), bounds.size());
    constexpr size_t few_tetrahedra = 100;  // of more, convex parts take too long here
    if (a.tetrahedron_count <= few_tetrahedra) {
        double longest = 0;
        for (size_t i = 0; i < 3 * a.vertex_count; ++i) longest = std::max(longest, std::fabs(a.vertices[i] - a.vertices[i % 3]));
        expect_convex_parts(loaded.handle, {sizeof(pw_convex_options), 3, 0, 0, 0, nullptr, 0, 0});
        expect_convex_parts(loaded.handle, {sizeof(pw_convex_options), 0, 0.1 * longest, 0, 0, nullptr, 0, 0});
    }
    // What is saved loads, and is saved as the same again. (These bytes may have said it at greater length.)
    const std::vector<uint8_t> saved = save(loaded.handle);
    const Built again = try_load(saved);
    EXPECT_EQ(again.status, PW_OK) << again.message;
    EXPECT_EQ(save(again.handle), saved);
    return 0;
}
