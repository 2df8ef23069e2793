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
#define PW_ORIENT3D _Z25partwheel_tetgen_orient3dPdS_S_S_
#define PW_JOINED(a, b) a##b
#define PW_NAME(prefix, call) PW_JOINED(prefix, call)

namespace partwheel::test {
namespace {

size_t polls = 0, tetgen_calls = 0, tetgen_polls = 0, tetgen_steps = 0;  // since they were last set to 0
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
void __real_partwheel_tetgen_poll();
void __wrap_partwheel_tetgen_poll() {
    ++partwheel::test::tetgen_polls;
    __real_partwheel_tetgen_poll();
}
double PW_NAME(__real_, PW_ORIENT3D)(double*, double*, double*, double*);
double PW_NAME(__wrap_, PW_ORIENT3D)(double* a, double* b, double* c, double* d) {
    ++partwheel::test::tetgen_steps;
    return PW_NAME(__real_, PW_ORIENT3D)(a, b, c, d);
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

// Closed and clean, but thin and with needles: without a limit, TetGen would not end improving the mesh.
TEST(Work, ACleanModelDoesNotHang) {
    const std::string path = PARTWHEEL_MESHES "/../../../../shared/meshes/ring.off";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "the model that hangs is not there: " << path;
    const TriMesh ring = real_mesh("../../../../shared/meshes/ring.off");
    Progress progress;
    progress.begin();
    tetgen_calls = 0;
    const Solid solid = fill_solid(ring.view(), {0, PW_FILL_EXACT, {}}, progress);
    EXPECT_EQ(solid.surface.fill_method, PW_FILL_EXACT);
    EXPECT_EQ(tetgen_calls, 1U);
    double volume = 0;
    for (const auto& [a, b, c, d] : solid.mesh.tetrahedra) {
        const auto at = [&](int32_t v) { return solid.mesh.vertices[static_cast<size_t>(v)]; };
        volume += signed_volume6(at(a), at(b), at(c), at(d)) / 6;
    }
    EXPECT_NEAR(solid.surface.frame.volume_to_caller(volume), enclosed_volume(ring), 1e-9 * enclosed_volume(ring));
}

// With a mock: a call that does not terminate is followed by one with its input in another order.
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

// In no stage does the fraction stand still for long: there are few polls between two values.
TEST(Work, TheFractionMovesWithTheWork) {
    const TriMesh elk = real_mesh("elk.off");  // needs repair
    TriMesh hollow = torus(60, 40, 2, 0.6);
    hollow = together("hollow", hollow, inside_out(torus(60, 40, 2, 0.57)));
    for (const auto& [mesh, fill_methods] : {std::pair{elk, 0}, std::pair{elk, int{PW_FILL_POINTS}},
                                             std::pair{torus(60, 40, 2, 0.6), 0}, std::pair{hollow, 0}}) {
        pw_context* context = nullptr;
        ASSERT_EQ(pw_context_create(&context), PW_OK);
        double last = -1;
        size_t still = 0, longest = 0;
        polls = 0;
        at_poll = [&](pw_stage) {
            double fraction = 0;
            ASSERT_EQ(pw_context_progress(context, &fraction, nullptr), PW_OK);
            still = fraction == last ? still + 1 : 0;
            last = fraction;
            longest = std::max(longest, still);
        };
        pw_build_options options = PW_BUILD_OPTIONS_INIT;
        options.fill_methods = static_cast<uint32_t>(fill_methods);
        options.threads = 1;
        const pw_mesh_view view = mesh_view(mesh);
        pw_hierarchy* hierarchy = nullptr;
        EXPECT_EQ(pw_build(context, &view, &options, &hierarchy), PW_OK) << pw_error_message();
        at_poll = {};
        pw_hierarchy_free(hierarchy);
        pw_context_free(context);
        EXPECT_LT(static_cast<double>(longest), 0.2 * static_cast<double>(polls)) << mesh.name;
    }
}

// ---- Growth

// A closed cone: a fan around its tip, and one around the middle of its base.
TriMesh cone(int count) {
    TriMesh mesh = lathe("cone of " + std::to_string(count), {{1, 0}}, count);
    mesh.vertices.back()[2] = 1;
    return mesh;
}

// Of TetGen's loops without predicates; it looks for the facets at an edge among those of one end. The predicates are bounded: it
// can't fill a large cone, and gives up in all attempts.
TEST(Work, StepsOfTetGenGrowAsNLogN) {
    const auto count_polls = [](const TriMesh& mesh) {
        Progress progress;
        progress.begin();
        tetgen_polls = tetgen_steps = tetgen_calls = 0;
        try {
            (void)fill_solid(mesh.view(), {0, PW_FILL_EXACT, {}}, progress);
        } catch (const Error& error) {
            EXPECT_EQ(error.status(), PW_ERROR_TETRAHEDRA);
        }
        EXPECT_LE(tetgen_steps, tetgen_calls * (1 + 1000 * (mesh.vertices.size() + 100))) << mesh.name;
        return static_cast<double>(tetgen_polls) / static_cast<double>(tetgen_calls);
    };
    const auto coin = [](int count) { return lathe("coin of " + std::to_string(count), {{1, 0}, {1, 0.1}}, count); };
    const auto ball = [](int count) { return sphere(count / 16, 16); };
    for (const std::function<TriMesh(int)>& shape : std::vector<std::function<TriMesh(int)>>{cone, coin, ball}) {
        const double one = count_polls(shape(250)), two = count_polls(shape(500)), four = count_polls(shape(1000));
        EXPECT_LT(two, 2.5 * one) << shape(250).name;
        EXPECT_LT(four, 2.5 * two) << shape(250).name;
    }
}

// The steps at a vertex may compare all pairs of triangles around it.
TEST(Work, FansOfTooManyTrianglesAreDecimated) {
    const auto decimated_triangles = [](int count) {
        Progress progress;
        progress.begin();
        return static_cast<double>(fill_solid(cone(count).view(), {0, PW_FILL_SHEET, {}, 0, 200000}, progress).surface.proxy_triangles);
    };
    EXPECT_EQ(decimated_triangles(4000), 0);
    const double triangles = decimated_triangles(20000), pairs = triangles * triangles / 4;  // of two fans
    EXPECT_GT(triangles, 0);
    EXPECT_LT(pairs, 1e8 + 32 * 40000 * std::log2(40000));
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
