// Seams: cuts to disks against counted Euler characteristics, paths against Bellman-Ford, scales and outlines of shapes that
// are known, and the amount of work.
#include "base/elementary.h"
#include "edit/border.h"
#include "edit/conformal_map.h"
#include "edit/patch.h"
#include "partwheel_edit.h"
#include "support/built.h"
#include "support/mesh_view.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>

// The constructor of ConformalMap and snap_border(), whose calls the linker sends here (--wrap in CMakeLists.txt).
#define PW_MAP _ZN9partwheel12ConformalMapC1ERKNS_5PatchESt4spanIKdLm18446744073709551615EERNS_8ProgressE
#define PW_SNAP _ZN9partwheel11snap_borderERKNS_7CreasesESt4spanIKhLm18446744073709551615EES3_IhLm18446744073709551615EE
#define PW_JOINED(a, b) a##b
#define PW_NAME(prefix, call) PW_JOINED(prefix, call)

namespace partwheel::test {
namespace {
std::atomic<size_t> mapped_triangles{0}, snapped_faces{0};
}
}  // namespace partwheel::test

extern "C" {
void PW_NAME(__real_, PW_MAP)(void*, const partwheel::Patch*, std::span<const double>, partwheel::Progress*);
void PW_NAME(__wrap_, PW_MAP)(void* map, const partwheel::Patch* patch, std::span<const double> guess,
                              partwheel::Progress* progress) {
    partwheel::test::mapped_triangles += patch->mesh.faces.size();
    PW_NAME(__real_, PW_MAP)(map, patch, guess, progress);
}
void PW_NAME(__real_, PW_SNAP)(const partwheel::Creases&, std::span<const uint8_t>, std::span<uint8_t>);
void PW_NAME(__wrap_, PW_SNAP)(const partwheel::Creases& creases, std::span<const uint8_t> inside, std::span<uint8_t> result) {
    partwheel::test::snapped_faces += creases.count();
    PW_NAME(__real_, PW_SNAP)(creases, inside, result);
}
}

namespace partwheel::test {
namespace {

using partwheel::operator-, partwheel::test::operator-;
using Edge = std::pair<int32_t, int32_t>;
using Place = std::function<Point(double, double)>;

size_t idx(int32_t i) { return static_cast<size_t>(i); }

Edge edge_of(int32_t a, int32_t b) { return std::minmax(a, b); }

// The Euler characteristic of each component of triangles that are cut along edges: the corners at a vertex are one vertex
// if triangles around it lead from one to the other.
std::multiset<int> characteristics(const TriMesh& mesh, const std::set<Edge>& cuts) {
    const size_t count = mesh.triangles.size();
    std::map<Edge, std::vector<size_t>> at;
    for (size_t t = 0; t < count; ++t)
        for (size_t k = 0; k < 3; ++k) at[edge_of(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3])].push_back(t);
    std::vector<size_t> island(count), corner(3 * count);
    for (size_t t = 0; t < count; ++t) island[t] = t;
    for (size_t c = 0; c < 3 * count; ++c) corner[c] = c;
    const auto lower = [](size_t& a, size_t& b) { return a == b ? false : (a = b = std::min(a, b), true); };
    for (bool changed = true; std::exchange(changed, false);)
        for (const auto& [edge, sides] : at) {
            if (sides.size() != 2 || cuts.contains(edge)) continue;
            changed |= lower(island[sides[0]], island[sides[1]]);
            for (const int32_t v : {edge.first, edge.second}) {
                const auto find = [&](size_t t) { return 3 * t + idx(static_cast<int32_t>(std::ranges::find(mesh.triangles[t], v) - mesh.triangles[t].begin())); };
                changed |= lower(corner[find(sides[0])], corner[find(sides[1])]);
            }
        }
    std::map<size_t, int> result;
    std::set<size_t> vertices;
    for (size_t c = 0; c < 3 * count; ++c)
        if (vertices.insert(corner[c]).second) ++result[island[c / 3]];
    for (size_t t = 0; t < count; ++t) ++result[island[t]];
    for (const auto& [edge, sides] : at) {
        const bool is_joined = sides.size() == 2 && !cuts.contains(edge);
        for (size_t i = 0; i < (is_joined ? 1 : sides.size()); ++i) --result[island[sides[i]]];
    }
    std::multiset<int> values;
    for (const auto& [number, value] : result) values.insert(value);
    return values;
}

Edge ends_of(const TriMesh& mesh, const SeamMesh::Edge& edge) {
    const auto vertex = [&](int32_t corner) { return mesh.triangles[idx(corner / 3)][idx(corner % 3)]; };
    return edge_of(vertex(edge.corners[0][0]), vertex(edge.corners[1][0]));
}

std::set<Edge> disk_cuts(const TriMesh& mesh) {
    const SeamMesh seam_mesh(mesh.view());
    const std::vector<uint8_t> is_cut = cut_to_disk(seam_mesh, std::vector<uint8_t>(seam_mesh.edges.size(), 0));
    std::set<Edge> cuts;
    for (size_t e = 0; e < is_cut.size(); ++e) {
        if (!is_cut[e]) continue;
        EXPECT_FALSE(seam_mesh.edges[e].is_diagonal);
        cuts.insert(ends_of(mesh, seam_mesh.edges[e]));
    }
    EXPECT_EQ(characteristics(mesh, cuts), std::multiset<int>{1}) << mesh.name;
    return cuts;
}

double total_length(const TriMesh& mesh, const std::set<Edge>& edges) {
    double sum = 0;
    for (const auto& [a, b] : edges) {
        const Point d = mesh.vertices[idx(a)] - mesh.vertices[idx(b)];
        sum += std::sqrt(dot(d, d));
    }
    return sum;
}

// A grid of quads, or of triangles: place(row, column). Closed: the last column is the first one.
TriMesh grid(int rows, int columns, bool closed, const Place& place, bool quads = true) {
    TriMesh mesh;
    const int width = closed ? columns : columns + 1;
    for (int i = 0; i <= rows; ++i)
        for (int j = 0; j < width; ++j) mesh.vertices.push_back(place(i, j));
    const auto at = [&](int i, int j) { return i * width + j % width; };
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
            for (int k = 0; k < 2; ++k) mesh.faces.push_back(static_cast<int32_t>(mesh.face_count));
            ++mesh.face_count;
        }
    return quads ? mesh : without_faces(mesh);
}

// 12 rings of 24 quads. radius: of each column. twist: each ring is turned by so many columns, backwards.
TriMesh tube(double twist = 0, bool quads = true, const std::function<double(int)>& radius = [](int) { return 1.0; }) {
    return grid(12, 24, true, [&](double i, double j) {
        const double angle = (j - twist * i) * std::numbers::pi / 12, r = radius(static_cast<int>(j));
        return Point{r * std::cos(angle), r * std::sin(angle), i / 4};
    }, quads);
}

TEST(Seams, TubesAreCutStraight) {
    const std::set<Edge> cuts = disk_cuts(tube());
    EXPECT_EQ(cuts.size(), 12U);
    for (const auto& [a, b] : cuts) EXPECT_EQ(a % 24, b % 24);
    // The diagonals of a twisted tube are straight and the shortest way, but only those of triangles can be cut.
    EXPECT_GT(total_length(tube(1), disk_cuts(tube(1))), 3.01);
    EXPECT_NEAR(total_length(tube(1, false), disk_cuts(tube(1, false))), 3, 1e-9);
}

TEST(Seams, ClosedSurfacesAreCutToDisksByShortWays) {
    const TriMesh ball = sphere(23, 48), ring = torus(48, 24, 2, 0.7);
    EXPECT_LT(total_length(ball, disk_cuts(ball)), 1.2 * std::numbers::pi);
    EXPECT_LT(total_length(ring, disk_cuts(ring)), 1.05 * 2 * std::numbers::pi * (0.7 + 1.3));
    const Cells frame = block({0, 0, 0}, {9, 5, 1}) - block({1, 1, 0}, {4, 4, 1}) - block({5, 1, 0}, {8, 4, 1});
    disk_cuts(surface_of("two handles", frame));
    // With one side: the last ring joins the first one upside down.
    TriMesh band = grid(39, 2, false, [](double i, double j) {
        const double turn = i * std::numbers::pi / 20, across = 0.3 * (j - 1);
        return Point{(1 + across * std::cos(turn / 2)) * std::cos(turn), (1 + across * std::cos(turn / 2)) * std::sin(turn),
                     across * std::sin(turn / 2)};
    }, false);
    for (const Triangle& t : {Triangle{117, 118, 2}, {118, 1, 2}, {118, 119, 1}, {119, 0, 1}}) band.triangles.push_back(t);
    band = without_faces(band);
    EXPECT_EQ(characteristics(band, {}), std::multiset<int>{0});
    disk_cuts(band);
}

TEST(Seams, PathsAreTheShortest) {
    const TriMesh mesh = perturbed(torus(20, 14, 2, 0.8), 0.05, 4);
    const SeamMesh seam_mesh(mesh.view());
    const Patch patch(seam_mesh, cut_to_disk(seam_mesh, std::vector<uint8_t>(seam_mesh.edges.size(), 0)));
    const ShortestPaths paths = patch.shortest_paths(patch.boundary_vertices());
    std::vector<double> expected(patch.vertex_count, std::numeric_limits<double>::infinity());
    for (const int32_t v : patch.boundary_vertices()) expected[idx(v)] = 0;
    for (size_t round = 0; round < patch.vertex_count; ++round)
        for (size_t k = 0; k < patch.uncut.size(); ++k) {
            if (seam_mesh.edges[idx(patch.uncut[k])].is_diagonal) continue;
            double &a = expected[idx(patch.uncut_ends[k][0])], &b = expected[idx(patch.uncut_ends[k][1])];
            a = std::min(a, b + seam_mesh.edges[idx(patch.uncut[k])].cost);
            b = std::min(b, a + seam_mesh.edges[idx(patch.uncut[k])].cost);
        }
    EXPECT_EQ(paths.distance, expected);
    for (size_t v = 0; v < patch.vertex_count; ++v) {
        EXPECT_EQ(paths.via[v] < 0, expected[v] == 0);
        if (paths.via[v] < 0) continue;
        const double cost = seam_mesh.edges[idx(patch.uncut[idx(paths.via[v])])].cost;
        EXPECT_EQ(paths.distance[idx(paths.previous[v])] + cost, paths.distance[v]);
    }
}

struct MappedGrid {
    SeamMesh mesh;
    Patch patch{mesh, std::vector<uint8_t>(mesh.edges.size(), 0)};
    ConformalMap map{patch, std::vector<double>(3 * mesh.faces.size(), 0)};

    explicit MappedGrid(const TriMesh& of) : mesh(of.view()) {}
};

TEST(Seams, SphericalCapsAreScaledAsByTheStereographicProjection) {
    for (const double polar_angle : {0.4, 1.0, 1.5}) {
        TriMesh cap;  // a fan in the middle
        std::vector<Ring> rings;
        for (int i = 1; i <= 24; ++i) rings.push_back({std::sin(polar_angle * i / 24), std::cos(polar_angle * i / 24)});
        cap = without_faces(lathe("cap", rings, 96));
        std::erase_if(cap.triangles, [&](const Triangle& t) {  // the fan that closes the lathe's other end
            return std::ranges::all_of(t, [&](int32_t v) {
                return cap.vertices[idx(v)][2] <= std::cos(polar_angle) + 1e-9;
            });
        });
        cap = without_faces(cap);
        // The middle of the fan is on the sphere.
        for (Point& p : cap.vertices)
            if (std::hypot(p[0], p[1]) < 1e-9 && p[2] > std::cos(polar_angle) + 1e-9) p[2] = 1;
        const MappedGrid grid(cap);
        const auto half_cosine = [](double angle) { return std::cos(angle / 2); };
        for (size_t c = 0; c < grid.patch.vertex.size(); ++c) {
            const double z = grid.mesh.faces[c / 3].corners[c % 3][2];
            const double expected = std::pow(half_cosine(polar_angle) / half_cosine(std::acos(std::min(z, 1.0))), 2);
            ASSERT_NEAR(std::exp(grid.map.log_scale()[idx(grid.patch.vertex[c])]) / expected, 1, 0.01);
        }
        // Areas are scaled by the square: the mean over the cap.
        double area = 0, mean = 0, distortion = 0;
        const auto integrate = [&](const std::function<void(double, double)>& visit) {
            for (int i = 0; i < 2000; ++i) {
                const double at = polar_angle * (i + 0.5) / 2000;
                visit(std::sin(at), std::pow(half_cosine(at), -4));
            }
        };
        integrate([&](double share, double factor) { area += share, mean += share * factor; });
        integrate([&](double share, double factor) {
            const double f = factor * area / mean;
            distortion += share * std::max(f, 1 / f) / area;
        });
        EXPECT_NEAR(grid.map.area_distortion() / distortion, 1, 0.01);
        EXPECT_EQ(grid.map.overlap_fraction(), 0);
    }
}

TEST(Seams, ARampThatGoesAroundMoreThanOnceCoversItself) {
    for (const auto& [turns, expected] : {std::pair(0.5, 0.0), {0.95, 0.0}, {1.5, 0.5}, {1.25, 0.25}}) {
        const MappedGrid ramp(grid(24, 96, false, [&, all = turns](double i, double j) {
            const double angle = all * j * std::numbers::pi / 48, radius = 1 + i / 24;
            return Point{radius * std::cos(angle), radius * std::sin(angle), 1e-3 * angle};
        }));
        EXPECT_NEAR(ramp.map.overlap_fraction(), expected, 0.01);
    }
}

TEST(Seams, ElementaryFunctionsAreThoseOfTheLibrary) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int i = 0; i < 20000; ++i) {
        const double x = number(random) * std::pow(10, 2 * number(random)), y = std::fabs(number(random));
        EXPECT_NEAR(exp_of(x) / std::exp(x), 1, 1e-14);
        EXPECT_NEAR(angle_of(y, x), std::atan2(y, x), 1e-14);
        EXPECT_NEAR(unit_vector(x).cosine, std::cos(x), 1e-14);
        EXPECT_NEAR(unit_vector(x).sine, std::sin(x), 1e-14);
        const double any_size = std::ldexp(1 + y, static_cast<int>(10 * x));
        EXPECT_NEAR(log_of(any_size), std::log(any_size), 1e-15 * std::max(1.0, std::fabs(std::log(any_size))));
        EXPECT_NEAR(log_of(1 + 1e-9 * x), std::log(1 + 1e-9 * x), 1e-14 * std::fabs(1e-9 * x));
    }
    EXPECT_EQ(log_of(0), -HUGE_VAL);
    EXPECT_EQ(log_of(HUGE_VAL), HUGE_VAL);
    EXPECT_TRUE(std::isnan(log_of(-1)));
    for (const double degrees : {0.0, 5.0, 15.0, 135.0, 170.0, 174.9, 175.0, 179.0, 179.9, 180.0})  // TetGen's tolerances
        EXPECT_EQ(unit_vector(degrees / 180 * std::numbers::pi).cosine, std::cos(degrees / 180 * std::numbers::pi)) << degrees;
    EXPECT_EQ(angle_of(0, 0), 0);
    EXPECT_EQ(angle_of(0, -1), std::numbers::pi);
    EXPECT_EQ(angle_of(1, 0), std::numbers::pi / 2);
}

// A ball with spikes. Each may need a cut, and patches with many spikes can't be merged. Without bounds the work would grow
// with the square of the number of spikes.
TEST(Seams, WorkForFurIsBounded) {
    for (const int spikes : {40, 80}) {
        TriMesh ball = without_faces(sphere(49, 60));
        std::mt19937 random(1);
        std::vector<Point> tips;
        for (int i = 0; i < spikes; ++i) tips.push_back(ball.vertices[random() % ball.vertices.size()]);
        for (Point& p : ball.vertices) {
            double nearest = 9;
            for (const Point& tip : tips) nearest = std::min(nearest, std::acos(std::clamp(dot(p, tip), -1.0, 1.0)));
            const double height = 1 + 0.5 * std::max(1 - nearest / 0.12, 0.0);
            p = {height * p[0], height * p[1], height * p[2]};
        }
        const Handle hierarchy = build(ball);
        const pw_mesh_view view = mesh_view(ball);
        const std::vector<int32_t> labels(ball.face_count, 0);
        std::vector<uint8_t> is_seam(3 * ball.triangles.size(), 2);
        mapped_triangles = 0;
        ASSERT_EQ(pw_hierarchy_seams(nullptr, hierarchy.get(), &view, labels.data(), 0, 1.09, is_seam.data()), PW_OK);
        EXPECT_GT(mapped_triangles, ball.triangles.size());
        EXPECT_LT(mapped_triangles, 100 * ball.triangles.size()) << spikes;
        std::set<Edge> cuts;
        for (size_t side = 0; side < is_seam.size(); ++side) {
            ASSERT_LE(is_seam[side], 1);
            const Triangle& t = ball.triangles[side / 3];
            if (is_seam[side]) cuts.insert(edge_of(t[side % 3], t[(side % 3 + 1) % 3]));
        }
        for (const int characteristic : characteristics(ball, cuts)) EXPECT_EQ(characteristic, 1);
    }
}

// Each of hundreds of shells a part, two of them divided into two: only these have borders to snap.
TEST(Seams, WholeShellsAreNotSnapped) {
    constexpr int shells = 300;
    TriMesh mesh = cube();
    for (int i = 1; i < shells; ++i) mesh = together("cubes", mesh, moved(cube(), {2.0 * i, 0, 0}));
    const Handle hierarchy = build(mesh);
    std::vector<int32_t> labels;
    for (size_t f = 0; f < mesh.face_count; ++f) {
        const auto shell = static_cast<int32_t>(f / cube().face_count);
        labels.push_back(shell < 2 && f % 2 ? shells + shell : shell);
    }
    const pw_mesh_view view = mesh_view(mesh);
    std::vector<uint8_t> is_seam(3 * mesh.triangles.size(), 2);
    snapped_faces = 0;
    ASSERT_EQ(pw_hierarchy_seams(nullptr, hierarchy.get(), &view, labels.data(), 0, 1.09, is_seam.data()), PW_OK);
    EXPECT_GE(snapped_faces, 2 * mesh.face_count);
    EXPECT_LE(snapped_faces, 4 * mesh.face_count);
}

}  // namespace
}  // namespace partwheel::test
