// The amount of work of the layers, and how often they check for cancellation: counted, not timed. The linker sends
// their calls of Progress and of TetGen here (--wrap in CMakeLists.txt).
#include "partwheel.h"
#include "fill/fill_solid.h"
#include "fill/tetgen_host.h"
#include "support/mesh_view.h"
#include "support/real_meshes.h"
#include "support/shapes.h"
#include "support/sizes.h"
#include "mesh/face_assignment.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/exceptions.h>
#include <gtest/gtest.h>
#include <tetgen.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <numbers>
#include <stdexcept>
#include <vector>

// Symbols that the linker wraps.
#define PW_ADVANCE _ZN9partwheel8Progress7advanceEd
#define PW_TETGEN _Z14tetrahedralizeP14tetgenbehaviorP8tetgenioS2_S2_S2_
#define PW_JOINED(a, b) a##b
#define PW_NAME(prefix, call) PW_JOINED(prefix, call)

namespace partwheel::test {
namespace {

size_t polls = 0, tetgen_calls = 0;  // since they were last set to 0
std::function<void(pw_stage)> at_poll;  // called with each
std::function<void(const std::function<void()>&)> around_tetgen;  // wraps each call

}  // namespace
}  // namespace partwheel::test

extern "C" {
void PW_NAME(__real_, PW_ADVANCE)(partwheel::Progress*, double);
void PW_NAME(__wrap_, PW_ADVANCE)(partwheel::Progress* progress, double part) {
    using namespace partwheel::test;
    ++polls;
    if (at_poll) at_poll(progress->stage());
    PW_NAME(__real_, PW_ADVANCE)(progress, part);
}
void PW_NAME(__real_, PW_TETGEN)(tetgenbehavior*, tetgenio*, tetgenio*, tetgenio*, tetgenio*);
void PW_NAME(__wrap_, PW_TETGEN)(tetgenbehavior* how, tetgenio* in, tetgenio* out, tetgenio* added, tetgenio* sizes) {
    using namespace partwheel::test;
    ++tetgen_calls;
    const auto call = [=] { PW_NAME(__real_, PW_TETGEN)(how, in, out, added, sizes); };
    around_tetgen ? around_tetgen(call) : call();
}
}

namespace partwheel::test {
namespace {

// The side of a cylinder, of long thin quads.
TriMesh open_cylinder(int segments) {
    TriMesh mesh;
    mesh.name = "open cylinder of " + std::to_string(segments);
    for (int i = 0; i < segments; ++i) {
        const double angle = 2 * std::numbers::pi * i / segments;
        const int32_t a = 2 * i, b = 2 * ((i + 1) % segments);
        for (const double z : {0.0, 4.0}) mesh.vertices.push_back({std::cos(angle), std::sin(angle), z});
        mesh.triangles.push_back({a, b, b + 1});
        mesh.triangles.push_back({a, b + 1, a + 1});
    }
    return without_faces(mesh);
}

struct Attaching {
    Surface source, surface;
    Assignment result;
};

Attaching attaching(const TriMesh& source, const TriMesh& surface) {
    Attaching a;
    a.source = read_mesh(source.view());
    a.surface = read_mesh(surface.view());
    for (Point& p : a.surface.vertices) p = a.source.frame.to_working(a.surface.frame.to_caller(p));
    Progress progress;
    progress.begin();
    polls = 0;
    a.result = assign_source_faces_by_distance(a.source, a.surface, progress);
    return a;
}

TEST(Work, SliversAreSampledAlongTheirLength) {
    const TriMesh cylinder = open_cylinder(sized(1000, 200));
    const Attaching a = attaching(cylinder, cylinder);
    const double along = std::ceil(4.001 / (std::hypot(2, 2, 4) * sample_spacing));
    EXPECT_LE(static_cast<double>(a.surface.samples.size()), along * static_cast<double>(cylinder.triangles.size()));
    EXPECT_EQ(a.surface.deviation, 0);
}

// Also for long, thin and many triangles.
TEST(Work, SamplesAreBounded) {
    for (const TriMesh& mesh :
         {open_cylinder(sized(20000, 10000)), stretched(torus(sized(300, 30), 90, 2, 0.6), {1, 1, 99})}) {
        const Attaching a = attaching(mesh, cube());
        EXPECT_LE(static_cast<double>(a.surface.samples.size()),
                  max_samples + static_cast<double>(mesh.triangles.size())) << mesh.name;
    }
}

// Also within one large triangle.
TEST(Work, SamplingChecksForCancellation) {
    for (const TriMesh& mesh : {tetrahedron(), cube(), open_cylinder(300)}) {
        const Attaching a = attaching(mesh, cube());
        EXPECT_GE(polls, a.surface.samples.size() / 500) << mesh.name << ", " << a.surface.samples.size() << " pieces";
        EXPECT_GT(a.surface.samples.size(), 1000U);
    }
}

// ---- Assignment of faces, against ten times as many samples and brute force

using Kernel = CGAL::Simple_cartesian<double>;

struct Nearest {
    double distance = HUGE_VAL;
    int32_t triangle = -1;
};

Nearest nearest(const Surface& surface, const Point& p) {
    Nearest best;
    for (size_t t = 0; t < surface.triangles.size(); ++t) {
        const auto at = [&](size_t k) {
            const Point& q = surface.vertices[static_cast<size_t>(surface.triangles[t][k])];
            return Kernel::Point_3(q[0], q[1], q[2]);
        };
        const Kernel::Triangle_3 triangle(at(0), at(1), at(2));
        const double d = std::sqrt(CGAL::squared_distance(Kernel::Point_3(p[0], p[1], p[2]), triangle));
        if (d < best.distance) best = {d, static_cast<int32_t>(t)};
    }
    return best;
}

TEST(Work, FacesAreAssignedToTheNearestTriangles) {
    // Surfaces around them: from outside, what is nearest is often an edge, which is two triangles'.
    const TriMesh box = stretched(moved(cube(), {-0.5, -0.5, -0.25}), {3, 3, 6});
    for (const auto& [mesh, used] :
         {std::pair{without_faces(sphere(7, 12)), stretched(sphere(5, 9), {2, 1.5, 1.3})},
          std::pair{open_cylinder(40), box}, std::pair{without_faces(cube()), moved(box, {0.2, 0.3, 0.1})}}) {
        SCOPED_TRACE(mesh.name);
        const Attaching a = attaching(mesh, used);
        double farthest = 0, wrong = 0, whole = 0;
        std::map<std::pair<int32_t, int32_t>, double> share;  // of the area, by face and triangle
        for (const FaceSample& piece : a.surface.samples) share[{piece.face, piece.triangle}] += piece.area;
        const double fine = sample_spacing / sized(3, 1);
        Point high{};
        for (const Point& p : a.source.vertices)
            for (size_t k = 0; k < 3; ++k) high[k] = std::max(high[k], p[k]);
        const double size = std::hypot(high[0], high[1], high[2]);
        for (size_t t = 0; t < a.source.triangles.size(); ++t) {
            const auto at = [&](size_t k) { return a.source.vertices[static_cast<size_t>(a.source.triangles[t][k])]; };
            const auto mix = [&](double x, double y) {
                Point p;
                for (size_t k = 0; k < 3; ++k) p[k] = at(0)[k] + x * (at(1)[k] - at(0)[k]) + y * (at(2)[k] - at(0)[k]);
                return p;
            };
            const double area = a.source.samples[t].area;
            const int n = std::max(3, static_cast<int>(std::ceil(std::sqrt(2 * area) / (fine * size))));
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {  // a square's middles, folded
                    double x = (i + 0.5) / n, y = (j + 0.25) / n;
                    if (x + y > 1) x = 1 - x, y = 1 - y;
                    const Nearest to = nearest(a.surface, mix(x, y));
                    farthest = std::max(farthest, to.distance);
                    share[{a.source.samples[t].face, to.triangle}] -= area / n / n;
                }
            for (size_t k = 0; k < 3; ++k) farthest = std::max(farthest, nearest(a.surface, at(k)).distance);
            whole += area;
        }
        for (const auto& [key, rest] : share) wrong += std::fabs(rest) / 2;
        // Each point is within half the diagonal of a sample.
        EXPECT_NEAR(a.surface.deviation, farthest / size, 0.75 * sample_spacing);
        EXPECT_LT(wrong, 0.05 * whole);
    }
}

// A triangle that is still there is its own nearest, without a search: of a fan, each point is in the boxes of many.
TEST(Work, UnchangedTrianglesAreAssignedToThemselves) {
    TriMesh leaves;  // in one plane, one above the other: all are equally near
    for (int32_t i = 0; i < 100; ++i) {
        for (const Point& p : {Point{0, 0, 0}, Point{1 + 0.01 * i, 0, 0}, Point{0, 2 - 0.01 * i, 0}}) leaves.vertices.push_back(p);
        leaves.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const TriMesh mesh = without_faces(leaves);
    const Attaching a = attaching(mesh, mesh);
    EXPECT_EQ(a.surface.deviation, 0);
    EXPECT_GT(a.surface.samples.size(), mesh.triangles.size());
    for (const FaceSample& sample : a.surface.samples) {
        size_t t = 0;
        while (a.source.samples[t].face != sample.face) ++t;
        for (size_t k = 0; k < 3; ++k) {
            const auto& corners = a.surface.triangles[idx(sample.triangle)];
            const Point& p = a.source.vertices[idx(a.source.triangles[t][k])];
            ASSERT_TRUE(std::ranges::any_of(corners, [&](int32_t v) { return a.surface.vertices[idx(v)] == p; }));
        }
    }
}

// ---- TetGen

// A few calls; models that it fails on use the next fill method.
TEST(Work, TetGenIsCalledRarely) {
    for (const int code : {2, 3}) {
        around_tetgen = [code](const auto&) { throw code; };
        tetgen_calls = 0;
        Progress progress;
        progress.begin();
        EXPECT_THROW((void)fill_solid(cube().view(), {0, PW_FILL_EXACT, {}}, progress), Error);
        EXPECT_GE(tetgen_calls, 3U);  // the third helps rotor.off
        EXPECT_LE(tetgen_calls, 4U);
        tetgen_calls = 0;
        progress.begin();
        EXPECT_EQ(fill_solid(cube().view(), {0, 0, {}}, progress).surface.fill_method, PW_FILL_POINTS);
        EXPECT_LE(tetgen_calls, 8U);
        around_tetgen = {};
    }
}

TEST(Work, AnotherVertexOrderHelps) {
    Progress progress;
    progress.begin();
    tetgen_calls = 0;
    const Solid solid = fill_solid(real_mesh("rotor.off").view(), {0, PW_FILL_EXACT, {}}, progress);
    EXPECT_EQ(solid.surface.fill_method, PW_FILL_EXACT);
    EXPECT_GT(tetgen_calls, 1U);
}

// Closed and clean, but thin and with needles: TetGen's mesh improvement does not terminate.
TEST(Work, ACleanModelDoesNotHang) {
    const std::string path = PARTWHEEL_MESHES "/../../../../shared/meshes/ring.off";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "the model that hangs is not there: " << path;
    const TriMesh ring = real_mesh("../../../../shared/meshes/ring.off");
    Progress progress;
    progress.begin();
    tetgen_calls = 0;
    const Solid solid = fill_solid(ring.view(), {0, PW_FILL_EXACT, {}}, progress);
    EXPECT_EQ(solid.surface.fill_method, PW_FILL_EXACT);
    EXPECT_EQ(tetgen_calls, 2U);
    double volume = 0;
    for (const auto& [a, b, c, d] : solid.mesh.tetrahedra) {
        const auto at = [&](int32_t v) { return solid.mesh.vertices[static_cast<size_t>(v)]; };
        volume += signed_volume6(at(a), at(b), at(c), at(d)) / 6;
    }
    EXPECT_NEAR(solid.surface.frame.volume_to_caller(volume), enclosed_volume(ring), 1e-9 * enclosed_volume(ring));
}

// The same with a mock: a call that does not terminate is followed by one without improvement.
TEST(Work, StepsOfTetGenAreBounded) {
    const TriMesh mesh = torus(16, 8, 2, 0.6);
    double steps = 0;
    tetgen_calls = 0;
    around_tetgen = [&](const std::function<void()>& call) {
        double a[] = {0, 0, 0}, b[] = {1, 0, 0}, c[] = {0, 1, 0}, d[] = {0, 0, 1};
        for (; tetgen_calls == 1; ++steps) partwheel_tetgen_orient3d(a, b, c, d);
        call();
    };
    Progress progress;
    progress.begin();
    EXPECT_EQ(fill_solid(mesh.view(), {0, PW_FILL_EXACT, {}}, progress).surface.fill_method, PW_FILL_EXACT);
    around_tetgen = {};
    EXPECT_EQ(tetgen_calls, 2U);
    EXPECT_GT(steps, 200 * static_cast<double>(mesh.vertices.size()));
    EXPECT_LT(steps, 5000 * static_cast<double>(mesh.vertices.size()));
}

// Requested after TetGen has started, honored before it returns.
TEST(Work, TetGenCanBeCanceledDuringItsCall) {
    Progress progress;
    progress.begin();
    bool returned = false;
    around_tetgen = [&](const std::function<void()>& call) {
        progress.cancel();
        call();
        returned = true;
    };
    try {
        (void)fill_solid(torus(60, 40, 2, 0.5).view(), {0, PW_FILL_EXACT, {}}, progress);
        ADD_FAILURE() << "built";
    } catch (const Error& error) {
        EXPECT_EQ(error.status(), PW_ERROR_CANCELED);
    }
    EXPECT_FALSE(returned);
    around_tetgen = {};
}

// Every long stage, including TetGen's passes, checks for cancellation several times per 10 ms, by count per face;
// and a build can be canceled at each check.
TEST(Work, EveryStageChecksForCancellation) {
    const TriMesh mesh = real_mesh("elk.off");  // needs repair
    const auto faces = static_cast<double>(mesh.triangles.size());
    std::map<pw_stage, double> looks;
    at_poll = [&](pw_stage stage) { ++looks[stage]; };
    pw_hierarchy* hierarchy = nullptr;
    const auto build = [&](pw_context* context) {
        const pw_mesh_view view = mesh_view(mesh.vertices[0].data(), mesh.vertices.size(), mesh.triangles[0].data(),
                                            mesh.triangles.size());
        return pw_build(context, &view, nullptr, &hierarchy);
    };
    ASSERT_EQ(build(nullptr), PW_OK);
    pw_hierarchy_free(hierarchy);
    EXPECT_GT(looks[PW_STAGE_SURFACE], faces / 500);
    EXPECT_GT(looks[PW_STAGE_TETRAHEDRA], faces / 50);
    EXPECT_GT(looks[PW_STAGE_CLUSTER], faces / 50);
    EXPECT_GT(looks[PW_STAGE_DENDROGRAM], 100);
    EXPECT_GT(looks[PW_STAGE_REPAIR], faces / 100);
    for (const pw_stage stage :
         {PW_STAGE_SURFACE, PW_STAGE_REPAIR, PW_STAGE_TETRAHEDRA, PW_STAGE_CLUSTER, PW_STAGE_DENDROGRAM}) {
        pw_context* context = nullptr;
        ASSERT_EQ(pw_context_create(&context), PW_OK);
        double later = 0, at = 0;
        at_poll = [&](pw_stage here) {
            later += here > stage;
            if (here == stage && ++at == std::floor(looks[stage] / 2)) pw_context_cancel(context);
        };
        EXPECT_EQ(build(context), PW_ERROR_CANCELED) << pw_stage_name(stage);
        EXPECT_EQ(later, 0) << pw_stage_name(stage);
        EXPECT_GE(at, std::floor(looks[stage] / 2));
        pw_context_free(context);
    }
    at_poll = {};
}

// With points inside, the parts are found in a filling without them, and the tetrahedra are clustered a second time.
// The fraction must advance meanwhile.
TEST(Work, TheSecondClusteringReportsProgress) {
    const TriMesh mesh = real_mesh("elephant.off");
    pw_context* context = nullptr;
    ASSERT_EQ(pw_context_create(&context), PW_OK);
    double last = 0;
    size_t looks = 0, standing = 0, longest = 0;
    at_poll = [&](pw_stage stage) {
        double fraction = 0;
        EXPECT_EQ(pw_context_progress(context, &fraction, nullptr), PW_OK);
        EXPECT_GE(fraction, last);
        if (stage != PW_STAGE_DENDROGRAM) return;
        ++looks;
        standing = fraction > last ? 0 : standing + 1;
        longest = std::max(longest, standing);
        last = fraction;
    };
    pw_build_options options = PW_BUILD_OPTIONS_INIT;
    options.quality = 1.4;
    const pw_mesh_view view = mesh_view(mesh);
    pw_hierarchy* hierarchy = nullptr;
    EXPECT_EQ(pw_build(context, &view, &options, &hierarchy), PW_OK) << pw_error_message();
    at_poll = {};
    pw_hierarchy_free(hierarchy);
    pw_context_free(context);
    EXPECT_LE(longest, looks / 4) << "of " << looks << " looks";
}

// ---- Growth

// Two intersecting cubes among many separate ones: only the two are compared.
TEST(Work, DistantPartsAreNotCompared) {
    TriMesh mesh = together("crossing", cube(), moved(cube(), {0.5, 0.5, 0.5}));
    const auto shells = static_cast<size_t>(sized(400, 100));
    for (size_t i = 0; i < shells; ++i)
        mesh = together("crossing and apart", mesh, moved(tetrahedron(), {10.0 + 5.0 * static_cast<double>(i % 20), 5.0 * static_cast<double>(i / 20), 0}));
    Progress progress;
    progress.begin();
    size_t looks = 0;
    at_poll = [&](pw_stage stage) { looks += stage == PW_STAGE_REPAIR; };
    const Solid solid = fill_solid(mesh.view(), {0, PW_FILL_REPAIRED, {}}, progress);
    at_poll = {};
    EXPECT_EQ(solid.surface.fill_method, PW_FILL_REPAIRED);
    EXPECT_LT(looks, 50 * shells);
}

// ---- Failures

TEST(Work, OnlyCgalAssertionsTriggerTheNextFillMethod) {
    const TriMesh mesh = without_faces(cube());
    const FillOptions repaired{0, PW_FILL_REPAIRED, {}};
    Progress progress;
    progress.begin();
    at_poll = [](pw_stage stage) {
        if (stage == PW_STAGE_REPAIR) throw CGAL::Assertion_exception("CGAL", "a == b", "file", 1, "message");
    };
    try {
        (void)fill_solid(mesh.view(), repaired, progress);
        ADD_FAILURE() << "built";
    } catch (const Error& error) {
        EXPECT_EQ(error.status(), PW_ERROR_SELF_INTERSECTION);
    }
    // The checks of the first fill method are CGAL's as well.
    const auto fail_in_checks = [calls = 0](pw_stage stage) mutable {  // the first is before any method is tried
        if (stage == PW_STAGE_SURFACE && ++calls == 3)
            throw CGAL::Precondition_exception("CGAL", "a == b", "file", 1, "message");
    };
    at_poll = fail_in_checks;
    EXPECT_THROW((void)fill_solid(mesh.view(), {0, PW_FILL_EXACT, {}}, progress), Error);
    at_poll = fail_in_checks;
    EXPECT_EQ(fill_solid(mesh.view(), {0, 0, {}}, progress).surface.fill_method, PW_FILL_REPAIRED);
    at_poll = [](pw_stage stage) {
        if (stage == PW_STAGE_REPAIR) throw std::out_of_range("our own");
    };
    EXPECT_THROW((void)fill_solid(mesh.view(), repaired, progress), std::out_of_range);
    at_poll = {};
}

}  // namespace
}  // namespace partwheel::test
