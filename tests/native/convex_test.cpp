// Convex decomposition: hulls against exact predicates and CGAL, errors against brute-force distances.
#include "base/predicates.h"
#include "convex/convex_parts.h"
#include "convex/simplify.h"
#include "convex/search.h"
#include "convex/coarse_tets.h"
#include "support/built.h"
#include "support/real_meshes.h"
#include "support/reference_hull.h"
#include "support/shapes.h"
#include "support/sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>
#include <set>

namespace partwheel::test {
namespace {

using namespace convex;
using convex::ConvexPiece;
using partwheel::operator+;
using test::operator+;
using partwheel::operator-;

double volume(const TriangleMesh& mesh) {
    double volume6 = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        volume6 += signed_volume6({}, mesh.vertices[idx(a)], mesh.vertices[idx(b)], mesh.vertices[idx(c)]);
    return volume6 / 6;
}

double volume(std::span<const Tetrahedron> tetrahedra, const HullKernel& kernel) {
    double volume6 = 0;
    for (const auto& [a, b, c, d] : tetrahedra)
        volume6 += std::fabs(signed_volume6(kernel.point(a), kernel.point(b), kernel.point(c), kernel.point(d)));
    return volume6 / 6;
}

// Exact.
bool contains(const TriangleMesh& hull, const Point& p) {
    return std::ranges::all_of(hull.triangles, [&](const Triangle& t) {
        return orientation(hull.vertices[idx(t[0])], hull.vertices[idx(t[1])], hull.vertices[idx(t[2])], p) <= 0;
    });
}

// By barycentric coordinates and edges, unlike the library.
double distance_to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
    const auto to_segment = [&](const Point& u, const Point& v) {
        const double t = std::clamp(dot(p - u, v - u) / dot(v - u, v - u), 0.0, 1.0);
        return length(p - u - t * (v - u));
    };
    double best = std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
    const Point u = b - a, v = c - a, w = p - a;
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v), d = uu * vv - uv * uv;
    const double s = (vv * wu - uv * wv) / d, t = (uu * wv - uv * wu) / d;
    if (s >= 0 && t >= 0 && s + t <= 1) best = std::min(best, length(w - s * u - t * v));
    return best;
}

bool contains(const TriangleMesh& hull, const Point& p, double near) {
    return contains(hull, p) || std::ranges::any_of(hull.triangles, [&](const Triangle& t) {
               return distance_to_triangle(p, hull.vertices[idx(t[0])], hull.vertices[idx(t[1])],
                                           hull.vertices[idx(t[2])]) <= near;
           });
}

Hierarchy build_paper_tree(const TriMesh& mesh) {
    const Handle handle = build(mesh, 0, PW_MODE_PAPER);
    return Hierarchy::load(save(handle));
}

std::vector<ConvexPart> parts_of(const Hierarchy& hierarchy, const ConvexOptions& options) {
    Progress progress;
    return convex_parts(hierarchy, options, progress);
}

std::vector<TriMesh> models() {
    std::vector<TriMesh> meshes;
    for (const char* file : {"hand.off", "rotor.off", "elephant.off"}) meshes.push_back(real_mesh(file));
    if (light()) meshes.resize(1);
    return meshes;
}

// Each hull contains its part of the solid's volume, and random points of all tetrahedra are in some hull.
void expect_cover(const Hierarchy& hierarchy, const std::vector<ConvexPart>& parts) {
    double sum = 0;
    for (const ConvexPart& part : parts) {
        EXPECT_GE(volume(part.hull), part.volume * (1 - 1e-9));
        sum += part.volume;
    }
    EXPECT_NEAR(sum / hierarchy.summary().volume, 1, 1e-9);
    const auto vertices = hierarchy.vertices();
    const double near = 1e-9 * Box::around(vertices).diagonal();
    std::mt19937 random(1);
    std::exponential_distribution<double> share;
    size_t n_tested = 0;
    for (size_t i = 0; i < hierarchy.tetrahedron_count(); i += 1 + hierarchy.tetrahedron_count() / 2000) {
        double sum_of_shares = 0;
        Point p{};
        for (const int32_t v : hierarchy.tetrahedra()[i]) {
            const double s = share(random);
            p = p + s * vertices[idx(v)];
            sum_of_shares += s;
        }
        p = 1 / sum_of_shares * p;
        EXPECT_TRUE(std::ranges::any_of(parts, [&](const ConvexPart& part) { return contains(part.hull, p, near); }))
            << parts.size();
        ++n_tested;
    }
    EXPECT_GT(n_tested, 0u);
}

TEST(Slice, SeparatesTheSidesAndKeepsTheVolume) {
    const TetMesh mesh = perturbed(tets_of(block({0, 0, 0}, {3, 2, 2})), 0.05, 1);
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 50; ++i) {
        HullKernel kernel(mesh.vertices);
        Point n{normal(random), normal(random), normal(random)};
        // Every other plane goes through a vertex.
        const Point through = i % 2 ? mesh.vertices[random() % mesh.vertices.size()] : Point{1.5, 1, 1};
        n = 1 / length(n) * n;
        const Plane plane{n, dot(n, through)};
        const SliceResult sides = slice(mesh.tetrahedra, plane, kernel);
        const double all = volume(mesh.tetrahedra, kernel);
        EXPECT_NEAR(volume(sides.below, kernel) + volume(sides.above, kernel), all, 1e-12 * all);
        for (const Tetrahedron& t : sides.below)
            for (const int32_t v : t) EXPECT_LE(plane.height(kernel.point(v)), 1e-8);
        for (const Tetrahedron& t : sides.above)
            for (const int32_t v : t) EXPECT_GE(plane.height(kernel.point(v)), -1e-8);
    }
}

TEST(PieceFactory, HullsContainTheirPointsExactly) {
    const TetMesh mesh = tets_of(block({0, 0, 0}, {6, 1, 1}) + block({0, 1, 0}, {1, 5, 1}) + block({0, 0, 1}, {1, 1, 4}));
    ThreadPool one(1);
    PieceFactory factory(mesh.vertices, one);
    std::vector<ConvexPiece> pieces;
    pieces.push_back(factory.build_piece(mesh.tetrahedra));
    for (size_t i = 0; i < 12; ++i) {
        const Division best = factory.find_best_division(pieces[i]);
        if (best.cost == HUGE_VAL) continue;
        auto [below, above] = factory.divide(pieces[i].tetrahedra, best.plane);
        if (below.tetrahedra.empty() || above.tetrahedra.empty()) continue;
        // The sweep predicts the volumes, up to the bulge.
        EXPECT_NEAR(below.cost() + above.cost(), best.cost, 1e-3 * best.cost);
        pieces.push_back(std::move(below));
        pieces.push_back(std::move(above));
    }
    ASSERT_GT(pieces.size(), 12u);
    pieces.push_back(factory.unite(pieces[5], pieces[6]));
    EXPECT_NEAR(pieces.back().cost(), factory.union_cost(pieces[5], pieces[6]), 1e-9);
    for (const ConvexPiece& piece : pieces) {
        const TriangleMesh hull = factory.kernel().surface(piece.hull);
        std::vector<Point> points;
        for (const Tetrahedron& t : piece.tetrahedra)
            for (const int32_t v : t) points.push_back(factory.kernel().point(v));
        for (const Point& p : points) ASSERT_TRUE(contains(hull, p));
        EXPECT_NEAR(piece.cost(), static_cast<double>(reference_hull_volume(points)), 1e-9);
    }
}

TEST(ConvexParts, OneHullIsTheConvexHull) {
    for (const TriMesh& model : models()) {
        // Of coordinates of which no difference is rounded.
        const TriMesh mesh = snapped(model, std::ldexp(1.0, std::ilogb(Box::around(model.vertices).diagonal()) - 20));
        const auto parts = parts_of(build_paper_tree(mesh), {.hulls = 1});
        ASSERT_EQ(parts.size(), 1u);
        const ReferenceHull hull = reference_hull(mesh.vertices);
        std::set<Point> expected;
        for (const int32_t v : hull.extreme) expected.insert(mesh.vertices[idx(v)]);
        EXPECT_EQ(std::set<Point>(parts[0].hull.vertices.begin(), parts[0].hull.vertices.end()), expected);
        EXPECT_NEAR(volume(parts[0].hull) / static_cast<double>(hull.volume), 1, 1e-9);
        EXPECT_LT(parts[0].error, 0);
    }
}

TEST(ConvexParts, CoverTheSolidWithLittleExcess) {
    for (const TriMesh& mesh : models()) {
        const Hierarchy hierarchy = build_paper_tree(mesh);
        double before = HUGE_VAL;
        for (const size_t hulls : sized<std::vector<size_t>>({2, 8, 24}, {2, 24})) {
            const auto parts = parts_of(hierarchy, {.hulls = hulls});
            EXPECT_LE(parts.size(), hulls);
            expect_cover(hierarchy, parts);
            double sum = 0;
            for (size_t i = 0; i < parts.size(); ++i) {
                EXPECT_LE(volume(parts[i].hull), volume(parts[i > 0 ? i - 1 : 0].hull) * (1 + 1e-12));
                sum += volume(parts[i].hull);
            }
            EXPECT_LT(sum, before);
            before = sum;
        }
        // Less than the parts of the paper, as the hierarchy has them.
        double papers = 0;
        const auto cut = hierarchy.cut_least_concavity(24);
        for (size_t k = 0; k + 1 < cut.size(); ++k)
            papers += volume(hierarchy.hull(static_cast<size_t>(cut[k]), static_cast<size_t>(cut[k + 1])));
        EXPECT_LT(before, papers) << mesh.name;
    }
}

TEST(ConvexParts, BlocksAreFound) {
    const TriMesh mesh = surface_of("jack", block({-1, 0, 0}, {2, 1, 1}) + block({0, -1, 0}, {1, 0, 1}) +
                                                block({0, 1, 0}, {1, 2, 1}) + block({0, 0, -1}, {1, 1, 0}));
    const auto parts = parts_of(build_paper_tree(mesh), {.hulls = 16});
    double sum = 0;
    for (const ConvexPart& part : parts) sum += volume(part.hull);
    EXPECT_LE(sum, 1.05 * 6) << parts.size();
    // What is convex is one, however many may be factory.
    EXPECT_EQ(parts_of(build_paper_tree(cube()), {.hulls = 16}).size(), 1u);
}

TEST(SimplifyOuterHull, ContainsTheHullExactly) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (const Point& stretch : {Point{1, 1, 1}, Point{1, 10, 0.1}, Point{1e-3, 1e-3, 1}}) {
        std::vector<Point> points;
        for (int i = 0; i < 400; ++i) {
            Point p{normal(random), normal(random), normal(random)};
            p = 1 / length(p) * p;
            points.push_back({5 + stretch[0] * p[0], stretch[1] * p[1], -7 + stretch[2] * p[2]});
        }
        const TriangleMesh hull = convex_hull(points);
        double before = HUGE_VAL;
        for (const size_t most : {8u, 16u, 32u, 64u, 255u, 1000u}) {
            const TriangleMesh fewer = simplify_outer_hull(hull, most);
            EXPECT_LE(fewer.vertices.size(), most);
            for (const Point& p : points) ASSERT_TRUE(contains(fewer, p)) << most << " " << stretch[1];
            EXPECT_LT(volume(fewer), before);
            before = volume(fewer);
        }
        EXPECT_EQ(before, volume(hull));
        // A ball's: the best polytopes of so many corners around one have about as much.
        EXPECT_LT(volume(simplify_outer_hull(hull, 64)) / before, 1.2);
    }
}

// Of points all over the hulls, by every triangle of the surface and, inside, by the sum of angles.
double sampled_error(const ConvexPart& part, const TriMesh& mesh, size_t samples) {
    double most = 0;
    std::mt19937 random(4);
    std::exponential_distribution<double> share;
    std::vector<double> areas;
    for (const auto& [a, b, c] : part.hull.triangles)
        areas.push_back(area(part.hull.vertices[idx(a)], part.hull.vertices[idx(b)], part.hull.vertices[idx(c)]));
    std::discrete_distribution<size_t> triangle(areas.begin(), areas.end());
    for (size_t i = 0; i < samples; ++i) {
        const Triangle& t = part.hull.triangles[triangle(random)];
        const double x = share(random), y = share(random), z = share(random);
        const Point p = 1 / (x + y + z) * (x * part.hull.vertices[idx(t[0])] + y * part.hull.vertices[idx(t[1])] +
                                           z * part.hull.vertices[idx(t[2])]);
        double nearest = HUGE_VAL, angle = 0;
        for (const auto& [i0, i1, i2] : mesh.triangles) {
            const Point &a = mesh.vertices[idx(i0)], &b = mesh.vertices[idx(i1)], &c = mesh.vertices[idx(i2)];
            nearest = std::min(nearest, distance_to_triangle(p, a, b, c));
            const Point u = a - p, v = b - p, w = c - p;
            const double lu = length(u), lv = length(v), lw = length(w);
            angle += 2 * std::atan2(dot(u, cross(v, w)), lu * lv * lw + dot(u, v) * lw + dot(v, w) * lu + dot(w, u) * lv);
        }
        if (angle < 2 * 3.14159265) most = std::max(most, nearest);
    }
    return most;
}

TEST(ConvexParts, TheErrorBoundIsRespected) {
    const TriMesh mesh = real_mesh("hand.off");
    const Hierarchy hierarchy = build_paper_tree(mesh);
    const double size = Box::around(mesh.vertices).diagonal();
    size_t before = 0;
    for (const double error : {0.1 * size, 0.03 * size}) {
        for (const size_t most : {size_t{0}, size_t{24}}) {
            const auto parts = parts_of(hierarchy, {.error = error, .max_vertices = most});
            EXPECT_GT(parts.size(), most ? 0 : before);
            if (!most) before = parts.size();
            expect_cover(hierarchy, parts);
            double largest = 0, found = 0;
            for (const ConvexPart& part : parts) {
                EXPECT_GE(part.error, 0);
                EXPECT_LE(part.error, error);
                EXPECT_LE(part.hull.vertices.size(), most ? most : hierarchy.vertices().size());
                const double sampled = sampled_error(part, mesh, sized<size_t>(150, 60));
                EXPECT_LE(sampled, part.error * (1 + 1e-9));
                largest = std::max(largest, part.error);
                found = std::max(found, sampled);
            }
            EXPECT_GT(found, 0.4 * largest);  // the reported bound is not far too high
        }
    }
}

// A closed surface of revolution, of a profile of (radius, height) from its lowest to its last point, both on the axis or
// the same.
TriMesh turned_profile(const std::vector<std::array<double, 2>>& profile, int sides) {
    TriMesh mesh;
    std::vector<int> first;
    for (const auto& [radius, height] : profile) {
        first.push_back(static_cast<int>(mesh.vertices.size()));
        for (int i = 0; i < (radius > 0 ? sides : 1); ++i) {
            const double angle = 2 * std::numbers::pi * i / sides;
            mesh.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), height});
        }
    }
    for (size_t k = 0; k + 1 < profile.size(); ++k)
        for (int i = 0; i < sides; ++i) {
            const auto vertex = [&](size_t ring, int at) {
                return first[ring] + (profile[ring][0] > 0 ? at % sides : 0);
            };
            if (profile[k + 1][0] > 0) mesh.triangles.push_back({vertex(k, i), vertex(k + 1, i + 1), vertex(k + 1, i)});
            if (profile[k][0] > 0) mesh.triangles.push_back({vertex(k, i), vertex(k, i + 1), vertex(k + 1, i + 1)});
        }
    return mesh;
}

// Planes and unions that are evaluated: each advances the progress by 1/200 of the rest.
TEST(ConvexParts, TheWorkForThinWallsIsBounded) {
    for (const int sides : {16, 64}) {
        const std::vector<std::array<double, 2>> beaker = {{0, 0}, {1, 0}, {1, 2}, {0.9, 2}, {0.9, 0.1}, {0, 0.1}};
        std::vector<std::array<double, 2>> bowl;
        for (const double radius : {1.0, 0.9})
            for (int i = 0; i <= sides / 4; ++i) {
                const double angle = std::numbers::pi / 2 * (radius == 1 ? i : sides / 4 - i) / (sides / 4);
                const bool is_on_axis = i == (radius == 1 ? 0 : sides / 4);
                bowl.push_back({is_on_axis ? 0 : radius * std::sin(angle), -radius * std::cos(angle)});
            }
        for (const auto& profile : {beaker, bowl})
            for (const double error : {0.2, 0.05}) {
                Progress progress;
                const auto parts = convex_parts(build_paper_tree(turned_profile(profile, sides)), {.error = error}, progress);
                const double n_steps = std::log1p(-progress.fraction()) / std::log1p(-1.0 / 200);
                const auto n = static_cast<double>(parts.size());
                EXPECT_LT(n_steps, 20 * n * std::log2(n + 1)) << sides << " " << error << " " << n;
                for (const ConvexPart& part : parts) EXPECT_LE(part.error, error);
            }
    }
}

// The turbine's blades have walls in more than a hundred directions.
TEST(ConvexParts, TheWorkForWallsIsBounded) {
    const TriMesh mesh = real_mesh("turbine.off");
    const Hierarchy hierarchy = build_paper_tree(mesh);
    const auto vertices = hierarchy.vertices();
    const Frame frame = Frame::around(vertices);
    std::vector<Point> points;
    for (const Point& p : vertices) points.push_back(frame.to_working(p));
    const ConcaveEdges concave(points, hierarchy.tetrahedra());
    ASSERT_GT(concave.walls.size(), 100u);
    std::vector<Tetrahedron> tetrahedra(hierarchy.tetrahedra().begin(), hierarchy.tetrahedra().end());
    tetrahedra = coarsen(tetrahedra, cluster_vertices(points, 2000));
    ThreadPool one(1);
    PieceFactory factory(points, one, concave.walls);
    const auto first_point = [&](const ConvexPiece& piece) { return factory.kernel().point(piece.hull.vertices()[0]); };
    size_t n_pieces = 1, n_steps = 0;
    Search search(factory, {tetrahedra}, [&] { ++n_steps; }, first_point);
    search.divide_at_walls(concave, 32);
    n_pieces += search.steps().size();
    EXPECT_LE(n_pieces, 32u);
    // A piece is evaluated once, in as many directions as without walls, before and after it is out of concave edges.
    EXPECT_LE(n_steps, 2 * n_pieces);
    EXPECT_LE(factory.sweep_count(), 32 * n_steps);
    const size_t n_sweeps = factory.sweep_count();
    factory.find_best_division(factory.build_piece(tetrahedra));
    EXPECT_LE(factory.sweep_count() - n_sweeps, 40u);  // 16 directions, 2 of them again, and 16 of walls
}

// It takes longer than a user waits after Esc.
TEST(ConvexParts, PreparingTheSearchCanBeCanceled) {
    const TriMesh mesh = real_mesh("turbine.off");
    const Hierarchy hierarchy = build_paper_tree(mesh);
    Progress canceled;
    canceled.cancel();
    const auto expect_canceled = [](const auto& prepare) {
        try {
            prepare();
            ADD_FAILURE();
        } catch (const Error& error) {
            EXPECT_EQ(error.status(), PW_ERROR_CANCELED);
        }
    };
    expect_canceled([&] { ConcaveEdges(hierarchy.vertices(), hierarchy.tetrahedra(), canceled); });
    expect_canceled([&] { (void)cluster_vertices(hierarchy.vertices(), 2000, canceled); });
}

TEST(ConvexParts, AnyNumberOfThreadsGivesTheSameHulls) {
    for (const TriMesh& mesh : models()) {
        const Hierarchy hierarchy = build_paper_tree(mesh);
        const double error = 0.02 * Box::around(hierarchy.vertices()).diagonal();
        for (ConvexOptions options : {ConvexOptions{.hulls = 9, .max_vertices = 16}, ConvexOptions{.error = error}}) {
            options.threads = 1;
            const auto expected = parts_of(hierarchy, options);
            for (options.threads = 2; options.threads < 5; ++options.threads) {
                const auto parts = parts_of(hierarchy, options);
                ASSERT_EQ(parts.size(), expected.size());
                for (size_t i = 0; i < parts.size(); ++i) {
                    EXPECT_EQ(parts[i].hull.vertices, expected[i].hull.vertices);
                    EXPECT_EQ(parts[i].hull.triangles, expected[i].hull.triangles);
                    EXPECT_EQ(parts[i].error, expected[i].error);
                }
            }
        }
    }
}

struct FreeParts {
    void operator()(pw_convex_parts* parts) const { pw_convex_parts_free(parts); }
};

TEST(ConvexParts, InvalidOptionsAreRefused) {
    const Handle handle = build(cube());
    pw_convex_parts* made = nullptr;
    const auto status = [&](pw_convex_options options) {
        return pw_hierarchy_convex_parts(nullptr, handle.get(), &options, &made);
    };
    const size_t size = sizeof(pw_convex_options);
    for (const pw_convex_options& options :
         {pw_convex_options{size, 0, 0, 0, 0, nullptr, 0, 0}, pw_convex_options{size, 4, 0.1, 0, 0, nullptr, 0, 0},
          pw_convex_options{size, 4097, 0, 0, 0, nullptr, 0, 0}, pw_convex_options{size, 0, -1, 0, 0, nullptr, 0, 0},
          pw_convex_options{size, 0, HUGE_VAL, 0, 0, nullptr, 0, 0}, pw_convex_options{size, 0, std::nan(""), 0, 0, nullptr, 0, 0},
          pw_convex_options{size, 4, 0, 7, 0, nullptr, 0, 0}, pw_convex_options{0, 4, 0, 0, 0, nullptr, 0, 0}, pw_convex_options{size, 4, 0, 0, -1, nullptr, 0, 0},
          pw_convex_options{size, 4, 0, 0, std::nan(""), nullptr, 0, 0}}) {
        EXPECT_EQ(status(options), PW_ERROR_ARGUMENT);
        EXPECT_EQ(made, nullptr);
    }
    ASSERT_EQ(status({size, 4, 0, 8, 0, nullptr, 0, 0}), PW_OK);
    const std::unique_ptr<pw_convex_parts, FreeParts> parts(made);
    const double* vertices;
    const int32_t* triangles;
    size_t count, vertex_count, triangle_count;
    double of_part, error;
    ASSERT_EQ(pw_convex_parts_count(made, &count), PW_OK);
    EXPECT_EQ(count, 1u);
    const auto hull = [&](size_t index) {
        return pw_convex_parts_hull(made, index, &vertices, &vertex_count, &triangles, &triangle_count, &of_part, &error);
    };
    EXPECT_EQ(hull(1), PW_ERROR_ARGUMENT);
    ASSERT_EQ(hull(0), PW_OK);
    EXPECT_EQ(vertex_count, 8u);
    EXPECT_EQ(triangle_count, 12u);
    EXPECT_EQ(of_part, 1);
    EXPECT_LT(error, 0);
}

}  // namespace
}  // namespace partwheel::test
