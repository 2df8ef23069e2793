// Input checks by small examples; the canonical order.
#include "partwheel.h"
#include "mesh/surface.h"

#include "support/real_meshes.h"
#include "support/reference_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace partwheel::test {
namespace {

struct Outcome {
    pw_status status = PW_OK;
    std::string message;
    Surface surface;
};

Outcome checked(const MeshView& view) {
    Progress progress;
    progress.begin();
    Outcome outcome;
    try {
        outcome.surface = read_mesh(view);
        check_surface(outcome.surface, progress);
    } catch (const Error& error) {
        outcome.status = error.status();
        outcome.message = error.what();
    }
    return outcome;
}
Outcome checked(const TriMesh& mesh) { return checked(mesh.view()); }

// Whether the message contains this number as a word.
bool names(const std::string& message, int64_t number) {
    const std::string digits = std::to_string(number);
    for (size_t at = message.find(digits); at != std::string::npos; at = message.find(digits, at + 1)) {
        const bool starts = at == 0 || std::isdigit(static_cast<unsigned char>(message[at - 1])) == 0;
        const size_t end = at + digits.size();
        const bool ends = end == message.size() || std::isdigit(static_cast<unsigned char>(message[end])) == 0;
        if (starts && ends) return true;
    }
    return false;
}

TriMesh block_surface() { return without_faces(surface_of("block", block({0, 0, 0}, {3, 2, 2}))); }

// ---- Each error, by a small example ----

TEST(Surface, ValidShapesPass) {
    for (const TriMesh& mesh : {tetrahedron(), cube(), octahedron(), block_surface(), sphere(5, 8), torus(8, 5, 2, 0.5),
                                stacked_cylinders(8), star_prism(5, 0.4, 1, 1), snowman(5, 8), hedgehog(5),
                                together("two", cube(), moved(cube(), {2, 0, 0})),
                                together("nested", stretched(cube(), {9, 9, 9}), moved(cube(), {3, 3, 3})),
                                inside_out(cube())}) {
        SCOPED_TRACE(mesh.name);
        ASSERT_EQ(expected_status(mesh), PW_OK);
        const Outcome outcome = checked(mesh);
        EXPECT_EQ(outcome.status, PW_OK) << outcome.message;
        EXPECT_EQ(outcome.surface.triangles.size(), mesh.triangles.size());
    }
}

TEST(Surface, SelfIntersection) {
    const TriMesh a = without_faces(cube());
    const auto faces = [](int32_t first, int32_t last, const std::string& message) {
        for (int32_t f = first; f < last; ++f)
            if (names(message, f)) return true;
        return false;
    };
    for (const auto& [what, other] : std::map<std::string, TriMesh>{
             {"overlapping", moved(a, {0.5, 0.25, 0.125})},
             {"face on face", moved(a, {1, 0.25, 0.25})},
             {"edge on edge", moved(a, {1, 1, 0})},
             {"corner on corner", moved(a, {1, 1, 1})},
             {"turned about a corner", rotated(a, 0.7, {1, 2, 3})},
             {"the same again", a}}) {
        SCOPED_TRACE(what);
        const TriMesh both = together(what, a, other);
        ASSERT_EQ(expected_status(both), PW_ERROR_SELF_INTERSECTION);
        const Outcome outcome = checked(both);
        EXPECT_EQ(outcome.status, PW_ERROR_SELF_INTERSECTION) << outcome.message;
        EXPECT_TRUE(faces(0, 12, outcome.message) && faces(12, 24, outcome.message)) << outcome.message;
    }
    // A spike pushed through the other side.
    TriMesh pierced = without_faces(sphere(7, 10));
    for (double& x : pierced.vertices[20]) x *= -3;
    EXPECT_EQ(checked(pierced).status, PW_ERROR_SELF_INTERSECTION);
}

TEST(Surface, FoldsInOnePlane) {
    // A triangle split at a point of its plane: inside it, on an edge, or outside, where the new triangles fold over.
    std::map<pw_status, int> seen;
    for (int i = -2; i <= 6; ++i)
        for (int j = -2; j <= 6; ++j)
            for (const size_t t : {size_t{0}, size_t{5}, size_t{11}}) {
                TriMesh mesh = without_faces(cube());
                const Triangle split = mesh.triangles[t];
                const auto corner = [&](size_t k) { return mesh.vertices[static_cast<size_t>(split[k])]; };
                Point p;
                for (size_t k = 0; k < 3; ++k)
                    p[k] = corner(0)[k] + i / 4.0 * (corner(1)[k] - corner(0)[k]) +
                           j / 4.0 * (corner(2)[k] - corner(0)[k]);
                const auto v = static_cast<int32_t>(mesh.vertices.size());
                mesh.vertices.push_back(p);
                mesh.triangles[t] = {split[0], split[1], v};
                mesh.triangles.push_back({split[1], split[2], v});
                mesh.triangles.push_back({split[2], split[0], v});
                mesh.face_count = mesh.triangles.size();
                const Outcome outcome = checked(mesh);
                EXPECT_EQ(outcome.status, expected_status(mesh)) << outcome.message << " " << i << " " << j << " " << t;
                ++seen[outcome.status];
            }
    EXPECT_EQ(seen.size(), 3U);
    EXPECT_GT(seen[PW_OK], 0);
    EXPECT_GT(seen[PW_ERROR_SELF_INTERSECTION], 0);
}

// ---- Order, frame, faces ----

// Whether a is in an earlier cell than b on Morton's curve, or in the same one and before it by x, y, z. The grid is
// halved again and again until the two are in different halves.
constexpr double part_of_grid = 0.7390851332151607;

bool before_on_curve(const Frame& box, const Point& a, const Point& b) {
    Point p, q;  // in the grid, as a unit cube
    for (size_t k = 0; k < 3; ++k) {
        p[k] = (a[k] - box.origin[k]) / box.longest * part_of_grid;
        q[k] = (b[k] - box.origin[k]) / box.longest * part_of_grid;
    }
    for (int level = 0; level < 21; ++level)
        for (size_t k = 0; k < 3; ++k) {
            const bool high_p = p[k] >= 0.5, high_q = q[k] >= 0.5;
            if (high_p != high_q) return high_q;
            p[k] = 2 * p[k] - high_p;
            q[k] = 2 * q[k] - high_q;
        }
    return a < b;
}

TEST(Surface, CanonicalOrder) {
    for (const TriMesh& mesh :
         {cube(), block_surface(), torus(9, 6, 2, 0.5), real_mesh("joint.off"), real_mesh("cross_quad.off")}) {
        SCOPED_TRACE(mesh.name);
        const Surface first = checked(mesh).surface;
        ASSERT_FALSE(first.triangles.empty());
        const Frame box = Frame::around(first.vertices);
        EXPECT_TRUE(std::is_sorted(first.vertices.begin(), first.vertices.end(),
                                   [&](const Point& a, const Point& b) { return before_on_curve(box, a, b); }));
        EXPECT_TRUE(std::is_sorted(first.triangles.begin(), first.triangles.end()));
        for (const Triangle& t : first.triangles) EXPECT_EQ(t[0], *std::min_element(t.begin(), t.end()));
        for (unsigned seed = 0; seed < 5; ++seed) {
            const Shuffled other = shuffled(mesh, seed);
            const Outcome outcome = checked(other.mesh);
            ASSERT_EQ(outcome.status, PW_OK) << outcome.message;
            const Surface& s = outcome.surface;
            EXPECT_EQ(s.vertices, first.vertices);
            EXPECT_EQ(s.triangles, first.triangles);
            EXPECT_EQ(s.face_count, first.face_count);
            EXPECT_EQ(s.frame.origin, first.frame.origin);
            EXPECT_EQ(s.frame.scale, first.frame.scale);
            std::vector<int32_t> vertex, face;
            for (const int32_t v : s.source_vertex) vertex.push_back(other.vertex[static_cast<size_t>(v)]);
            for (const FaceSample& p : s.samples) face.push_back(other.face[static_cast<size_t>(p.face)]);
            EXPECT_EQ(vertex, first.source_vertex);
            std::vector<int32_t> first_face;
            for (const FaceSample& p : first.samples) first_face.push_back(p.face);
            EXPECT_EQ(face, first_face);
        }
    }
}

}  // namespace
}  // namespace partwheel::test
