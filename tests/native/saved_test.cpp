// Saved hierarchies with changed fields and a valid hash: the checks of the fields must refuse them.
#include "tree/saved.h"

#include "convex/distance.h"
#include "query/tree.h"
#include "support/built.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

using namespace partwheel;
using namespace partwheel::test;

namespace {

struct Forgery {
    const char* name;
    const char* message;
    std::function<void(SavedHierarchy&)> change;
};

SavedHierarchy saved_of(const TriMesh& mesh) { return SavedHierarchy::unpack(save(build(mesh))); }

// One tetrahedron, with a face for each of its facets.
SavedHierarchy single_tetrahedron() {
    SavedHierarchy saved;
    saved.summary.fill_method = PW_FILL_EXACT;
    saved.summary.components = 1;
    saved.summary.hull_volume = 1.0 / 6;
    saved.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    saved.source = {0, 1, 2, 3};
    saved.tetrahedra = {{0, 1, 2, 3}};
    saved.leaf = {0, 0, 0, 0};
    saved.face_area = {0.5, 0.5, 0.5, 0.8};
    saved.outer_faces = {0, 1, 2, 3};
    saved.shell_fills = {PW_FILL_EXACT};
    return saved;
}

// The boundary of a simplex of four dimensions: each facet belongs to two tetrahedra, so there is no surface.
SavedHierarchy without_surface() {
    SavedHierarchy saved = single_tetrahedron();
    saved.vertices.push_back({0.25, 0.25, 0.25});
    saved.source.push_back(4);
    saved.tetrahedra = {{0, 1, 2, 3}, {4, 1, 3, 2}, {4, 0, 2, 3}, {4, 0, 3, 1}, {4, 0, 1, 2}};
    saved.borders = {1, 2, 3, 4};
    saved.concavities = {0, 0, 0, 0};
    saved.outer_faces.clear();
    return saved;
}

void expect_refused(const SavedHierarchy& saved, const std::string& name, const std::string& message) {
    const Built loaded = try_load(saved.pack());
    EXPECT_EQ(loaded.status, PW_ERROR_DATA) << name;
    EXPECT_NE(loaded.message.find(message), std::string::npos) << name << ": " << loaded.message;
}

const Forgery forgeries[] = {
    {"all corners one vertex", "vertex twice", [](SavedHierarchy& s) { s.tetrahedra[0] = {0, 0, 0, 0}; }},
    {"two corners one vertex", "vertex twice", [](SavedHierarchy& s) { s.tetrahedra[0][3] = s.tetrahedra[0][0]; }},
    {"inside out", "inside out", [](SavedHierarchy& s) { std::swap(s.tetrahedra[0][0], s.tetrahedra[0][1]); }},
    {"missing vertex", "missing vertex", [](SavedHierarchy& s) { s.tetrahedra[0][2] = 1000; }},
    {"a facet of the surface too few", "surface", [](SavedHierarchy& s) { s.outer_faces.pop_back(); }},
    {"a facet of the surface too many", "surface", [](SavedHierarchy& s) { s.outer_faces.push_back(-1); }},
    {"one source of two vertices", "source", [](SavedHierarchy& s) { s.source[1] = s.source[0]; }},
    {"a coordinate that is no number", "out of range",
     [](SavedHierarchy& s) { s.vertices[0][1] = std::numeric_limits<double>::quiet_NaN(); }},
    {"an infinite coordinate", "out of range",
     [](SavedHierarchy& s) { s.vertices[0][1] = std::numeric_limits<double>::infinity(); }},
    {"too small to be measured", "one place",
     [](SavedHierarchy& s) {
         for (Point& p : s.vertices) p = 5e-324 * p;
     }},
    {"a negative area", "area", [](SavedHierarchy& s) { s.face_area[0] = -1; }},
    {"a score above 1", "score", [](SavedHierarchy& s) { s.scores.assign(1, 1.5); }},
    {"a missing leaf", "missing tetrahedron", [](SavedHierarchy& s) { s.leaf[0] = 1000; }},
    {"a missing face", "missing face", [](SavedHierarchy& s) { s.outer_faces[0] = 1000; }},
    {"a face below none", "missing face", [](SavedHierarchy& s) { s.outer_faces[0] = -2; }},
    {"no components", "counts", [](SavedHierarchy& s) { s.summary.components = 0; }},
    {"two fill methods", "fill method", [](SavedHierarchy& s) { s.summary.fill_method = static_cast<pw_fill_method>(3); }},
    {"another fill method", "fill method", [](SavedHierarchy& s) { s.summary.fill_method = PW_FILL_POINTS; }},
    {"no shells", "fill method", [](SavedHierarchy& s) { s.shell_fills.clear(); }},
    {"a shell filled in two ways", "a shell's fill method", [](SavedHierarchy& s) { s.shell_fills[0] = 3; }},
    {"a shell filled in no known way", "a shell's fill method", [](SavedHierarchy& s) { s.shell_fills[0] = 16; }},
    {"more shells than parts", "shells", [](SavedHierarchy& s) { s.shell_fills.resize(1000, PW_FILL_EXACT); }},
    {"a proxy of too many triangles", "counts", [](SavedHierarchy& s) { s.summary.proxy_triangles = uint64_t{PW_MAX_COUNT} + 1; }},
};

}  // namespace

TEST(Saved, AValidHierarchyLoads) {
    EXPECT_EQ(try_load(single_tetrahedron().pack()).status, PW_OK) << pw_error_message();
    for (const TriMesh& mesh : {cube(), star_prism(5, 1, 2, 1)}) {
        const std::vector<uint8_t> bytes = save(build(mesh));
        EXPECT_EQ(SavedHierarchy::unpack(bytes).pack(), bytes);
    }
}

TEST(Saved, ChangedFieldsAreRefused) {
    for (const Forgery& forgery : forgeries)
        for (SavedHierarchy saved : {single_tetrahedron(), saved_of(cube()), saved_of(star_prism(5, 1, 2, 1))}) {
            forgery.change(saved);
            expect_refused(saved, forgery.name, forgery.message);
        }
}

TEST(Saved, AFacetOfThreeTetrahedraIsRefused) {
    SavedHierarchy saved = saved_of(cube());
    for (size_t t = 1; t < 3; ++t) saved.tetrahedra[t] = saved.tetrahedra[0];
    expect_refused(saved, "three alike", "share a facet");
}

TEST(Saved, TetrahedraWithoutASurfaceAreRefused) { expect_refused(without_surface(), "no surface", ""); }

// Like a thin sheet far from the origin, whose thickness vanishes in the caller's coordinates.
TEST(Saved, AFlatHierarchyLoadsAndAnswers) {
    SavedHierarchy saved = single_tetrahedron();
    for (Point& p : saved.vertices) p[2] = 0;
    const Built loaded = try_load(saved.pack());
    ASSERT_EQ(loaded.status, PW_OK) << loaded.message;
    pw_index* index = nullptr;
    ASSERT_EQ(pw_index_create(nullptr, loaded.handle.get(), nullptr, 0, 1, &index), PW_OK) << pw_error_message();
    const Point p = {0, 0, 3}, down = {0, 0, -1};
    int32_t part = -1;
    double distance = 0;
    Point nearest{};
    EXPECT_EQ(pw_index_nearest(nullptr, index, p.data(), 1, &part, &distance, nearest.data()), PW_OK);
    EXPECT_EQ(part, 0);
    EXPECT_EQ(distance, 3);
    EXPECT_EQ(pw_index_first_hits(nullptr, index, p.data(), down.data(), 1, &part, &distance), PW_OK);
    pw_index_free(index);
    const int32_t bounds[] = {0, 1};
    EXPECT_EQ(pw_index_create(nullptr, loaded.handle.get(), bounds, 2, 1, &index), PW_ERROR_NO_VOLUME);
    for (const size_t hulls : {size_t{0}, size_t{1}}) {
        const pw_convex_options options = {sizeof(pw_convex_options), hulls, hulls == 0 ? 0.1 : 0, 0, 0, nullptr, 0, 0};
        pw_convex_parts* parts = nullptr;
        EXPECT_EQ(pw_hierarchy_convex_parts(nullptr, loaded.handle.get(), &options, &parts), PW_OK) << pw_error_message();
        pw_convex_parts_free(parts);
    }
}

// Box trees must also work without items.
TEST(Saved, EmptyBoxTreesAnswer) {
    const convex::SolidDistance none({}, {}, unobserved_progress());
    EXPECT_EQ(none.max_distance({}, 0.1), 0);
    (void)none.nearest({1, 2, 3});
    EXPECT_TRUE(Bvh().empty());
    EXPECT_TRUE(index::PartBvh({}, {{0, 0, 0}, {{0, 1}}}).root.empty());
    const Box empty[10] = {};
    EXPECT_EQ(index::PartBvh(empty, {{0, 10}, {}}).order.size(), 10U);
}
