// Border snapping: cuts against brute force, costs against an independent formula, grooves, order and unit.
#include "edit/border.h"

#include "base/error.h"
#include "partwheel_edit.h"
#include "support/mesh_view.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

namespace partwheel::test {
namespace {

using partwheel::operator-;
using Part = std::vector<uint8_t>;

size_t idx(int32_t i) { return static_cast<size_t>(i); }
double length(const Point& p) { return std::sqrt(dot(p, p)); }

Part snap(const TriMesh& mesh, const Part& inside) {
    Part result(mesh.face_count, 7);
    snap_border(Creases(mesh.view()), inside, result);
    return result;
}

std::vector<Point> face_centers(const TriMesh& mesh) {
    std::vector<Point> sum(mesh.face_count, Point{});
    std::vector<double> count(mesh.face_count, 0);
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (const int32_t v : mesh.triangles[t]) {
            for (size_t k = 0; k < 3; ++k) sum[idx(mesh.face_of(t))][k] += mesh.vertices[idx(v)][k];
            ++count[idx(mesh.face_of(t))];
        }
    for (size_t f = 0; f < mesh.face_count; ++f)
        for (double& x : sum[f]) x /= count[f];
    return sum;
}

Part where(const TriMesh& mesh, const std::function<bool(const Point&)>& holds) {
    Part part;
    for (const Point& center : face_centers(mesh)) part.push_back(holds(center));
    return part;
}

// What the border costs between two faces, by angles, as partwheel_edit.h documents it: (lower face, higher face) ->
// cost. For closed surfaces that are manifold.
std::map<std::pair<int32_t, int32_t>, double> plain_costs(const TriMesh& mesh) {
    std::vector<Point> normals(mesh.face_count, Point{});
    std::map<std::pair<int32_t, int32_t>, int32_t> face_at;  // of each directed edge
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [i, j, k] = mesh.triangles[t];
        const Point n = cross(mesh.vertices[idx(j)] - mesh.vertices[idx(i)], mesh.vertices[idx(k)] - mesh.vertices[idx(i)]);
        for (size_t x = 0; x < 3; ++x) normals[idx(mesh.face_of(t))][x] += n[x];
        for (const auto& side : {std::pair{i, j}, std::pair{j, k}, std::pair{k, i}}) face_at[side] = mesh.face_of(t);
    }
    std::map<std::pair<int32_t, int32_t>, double> costs;
    for (const auto& [side, face] : face_at) {
        const int32_t other = face_at.at({side.second, side.first});
        if (other <= face) continue;
        const Point &n = normals[idx(face)], &m = normals[idx(other)];
        const Point along = mesh.vertices[idx(side.second)] - mesh.vertices[idx(side.first)];
        const double angle = std::atan2(length(cross(n, m)), dot(n, m));
        const double weight = 1 - std::sin(angle / 2);
        costs[{face, other}] += length(along) * std::pow(weight, dot(cross(n, m), along) > 0 ? 1 : 10);
    }
    return costs;
}

double cost_of(const std::map<std::pair<int32_t, int32_t>, double>& costs, const Part& part) {
    double sum = 0;
    for (const auto& [faces, cost] : costs)
        if (part[idx(faces.first)] != part[idx(faces.second)]) sum += cost;
    return sum;
}

// The number of connected components of the part (1) or of the rest (0).
size_t pieces(const std::map<std::pair<int32_t, int32_t>, double>& costs, const Part& part, uint8_t side) {
    std::vector<int32_t> leader(part.size());
    std::iota(leader.begin(), leader.end(), 0);
    const auto find = [&](int32_t f) {
        while (leader[idx(f)] != f) f = leader[idx(f)] = leader[idx(leader[idx(f)])];
        return f;
    };
    for (const auto& [faces, cost] : costs)
        if (part[idx(faces.first)] == side && part[idx(faces.second)] == side)
            leader[idx(find(faces.first))] = find(faces.second);
    std::set<int32_t> leaders;
    for (size_t f = 0; f < part.size(); ++f)
        if (part[f] == side) leaders.insert(find(static_cast<int32_t>(f)));
    return leaders.size();
}

// The faces within radius of some of the faces.
Part random_part(const TriMesh& mesh, std::mt19937& random, size_t balls, double radius) {
    const std::vector<Point> center = face_centers(mesh);
    std::vector<Point> middle;
    for (size_t i = 0; i < balls; ++i) middle.push_back(center[random() % center.size()]);
    return where(mesh, [&](const Point& p) {
        return std::any_of(middle.begin(), middle.end(), [&](const Point& m) { return length(p - m) < radius; });
    });
}

bool both_sides(const Part& part) {
    return std::set<uint8_t>(part.begin(), part.end()).size() == 2;
}

// A rod with a groove around z = 0.
TriMesh grooved_rod(double groove = 0.8, int segments = 16) {
    std::vector<Ring> rings;
    for (int i = -20; i <= 20; ++i) rings.push_back({i == 0 ? groove : 1.0, 0.25 * i});
    return lathe("grooved rod", rings, segments);
}

TEST(Border, CutsAreMinimal) {
    std::mt19937 random(1);
    const auto cost_up_to_six = [&] { return static_cast<int64_t>(1 + random() % 6); };
    for (int round = 0; round < 300; ++round) {
        BorderBand band;
        const size_t count = 1 + random() % 9;
        band.faces.resize(count);
        for (size_t n = 0; n < count; ++n) {
            const auto sometimes = [&] { return random() % 3 == 0 ? cost_up_to_six() : int64_t{0}; };
            band.to_part.push_back(sometimes());
            band.to_rest.push_back(sometimes());
        }
        for (size_t i = 0; count > 1 && i < 2 * count; ++i) {
            const size_t one = random() % count, other = (one + 1 + random() % (count - 1)) % count;
            band.edges.push_back({static_cast<int32_t>(one), static_cast<int32_t>(other), cost_up_to_six()});
        }
        const auto cost = [&](uint32_t cut) {
            int64_t sum = 0;
            for (const CutEdge& e : band.edges) sum += (cut >> e.one & 1) != (cut >> e.other & 1) ? e.cost : 0;
            for (size_t n = 0; n < count; ++n) sum += cut >> n & 1 ? band.to_rest[n] : band.to_part[n];
            return sum;
        };
        int64_t least = std::numeric_limits<int64_t>::max();
        uint32_t smallest = 0;  // the intersection of all minimal ones
        for (uint32_t cut = 0; cut < 1U << count; ++cut) {
            if (cost(cut) < least) least = cost(cut), smallest = cut;
            if (cost(cut) == least) smallest &= cut;
        }
        uint32_t found = 0;
        const std::vector<uint8_t> cut = minimum_cut(band);
        ASSERT_EQ(cut.size(), count);
        for (size_t n = 0; n < count; ++n) found |= uint32_t{cut[n]} << n;
        ASSERT_EQ(cost(found), least);
        ASSERT_EQ(found, smallest);
    }
}

TEST(Border, MeshCostsAreTheDocumentedOnesAndTheirCutIsMinimal) {
    std::mt19937 random(2);
    const TriMesh mesh = perturbed(snowman(6, 8), 0.05, 3);
    const auto plain = plain_costs(mesh);
    const double area = surface_area(mesh);
    int enumerated = 0;
    for (int round = 0; round < 200; ++round) {
        const Part part = random_part(mesh, random, 1, 0.4 + 0.007 * round);
        if (!both_sides(part)) continue;
        const BorderBand band = build_border_band(Creases(mesh.view()), part);
        double inside = 0;
        for (size_t t = 0; t < mesh.triangles.size(); ++t)
            if (const auto [i, j, k] = mesh.triangles[t]; part[idx(mesh.face_of(t))])
                inside += partwheel::area(mesh.vertices[idx(i)], mesh.vertices[idx(j)], mesh.vertices[idx(k)]);
        const double unit = (1 << 24) / (0.2 * std::sqrt(std::min(inside, area - inside)));
        for (const CutEdge& edge : band.edges) {
            const auto [one, other] = std::minmax(band.faces[idx(edge.one)], band.faces[idx(edge.other)]);
            const double ratio = static_cast<double>(edge.cost) / unit / plain.at({one, other});
            if (part[idx(one)] != part[idx(other)])
                EXPECT_NEAR(ratio, 1, 1e-4);
            else
                EXPECT_TRUE(ratio > 1 && ratio < 1.5001) << ratio;
        }
        // All divisions of the band: this one is minimal.
        if (band.faces.size() > 16 || band.faces.size() < 4) continue;
        ++enumerated;
        const auto cost = [&](const std::function<bool(size_t)>& in_part) {
            int64_t sum = 0;
            for (const CutEdge& e : band.edges) sum += in_part(idx(e.one)) != in_part(idx(e.other)) ? e.cost : 0;
            for (size_t n = 0; n < band.faces.size(); ++n) sum += in_part(n) ? band.to_rest[n] : band.to_part[n];
            return sum;
        };
        const Part result = snap(mesh, part);
        const int64_t found = cost([&](size_t n) { return result[idx(band.faces[n])] != 0; });
        for (uint32_t cut = 0; cut < 1U << band.faces.size(); ++cut)
            ASSERT_LE(found, cost([&](size_t n) { return (cut >> n & 1) != 0; }));
    }
    EXPECT_GE(enumerated, 5);
}

TEST(Border, BordersMoveIntoTheGroove) {
    const TriMesh rod = grooved_rod();
    const Part below = where(rod, [](const Point& p) { return p[2] < 0; });
    for (const double z : {-0.75, -0.25, 0.0, 0.5, 0.75}) {
        EXPECT_EQ(snap(rod, where(rod, [&](const Point& p) { return p[2] < z; })), below) << z;
        const auto under_wave = [&](const Point& p) { return p[2] < z + 0.2 * std::sin(7 * std::atan2(p[1], p[0])); };
        const Part ragged = where(rod, under_wave);
        EXPECT_EQ(snap(rod, ragged), below) << z;
    }
    // Beyond the band it has no effect.
    const Part far = where(rod, [](const Point& p) { return p[2] < -2.5; });
    EXPECT_EQ(snap(rod, far), far);
    // A ridge does not attract the border from three edges away.
    const TriMesh ridged = grooved_rod(1.1);
    const Part beside = where(ridged, [](const Point& p) { return p[2] < -0.75; });
    EXPECT_NE(snap(ridged, beside), where(ridged, [](const Point& p) { return p[2] < 0; }));
}

TEST(Border, OrderUnitAndWindingDoNotMatter) {
    std::mt19937 random(5);
    int changed = 0;
    for (const TriMesh& mesh : {perturbed(grooved_rod(), 0.02, 4), perturbed(snowman(30, 40), 0.01, 5),
                                without_faces(perturbed(snowman(20, 30), 0.01, 6))})
        for (int round = 0; round < 4; ++round) {
            const Part part = random_part(mesh, random, 1, 0.7 + 0.3 * round);
            if (!both_sides(part)) continue;
            const Part result = snap(mesh, part);
            changed += result != part;
            for (const double scale : {1e-4, 1e4, 1e-70, 1e80})
                EXPECT_EQ(snap(stretched(mesh, {scale, scale, scale}), part), result);
            EXPECT_EQ(snap(inside_out(mesh), part), result);
            EXPECT_EQ(snap(moved(mesh, {3, -5, 7}), part), result);
            const Shuffled other = shuffled(mesh, 9);
            Part given, wanted;
            for (const int32_t f : other.face) given.push_back(part[idx(f)]), wanted.push_back(result[idx(f)]);
            EXPECT_EQ(snap(other.mesh, given), wanted);
        }
    EXPECT_GE(changed, 6);
}

TEST(Border, ComponentsSurviveAndCostsDoNotRise) {
    std::mt19937 random(8);
    int changed = 0;
    for (const TriMesh& mesh : {perturbed(snowman(14, 18), 0.03, 1), perturbed(torus(30, 12, 2, 0.6), 0.05, 2),
                                without_faces(perturbed(hedgehog(6), 0.01, 3)),
                                surface_of("U", block({0, 0, 0}, {9, 3, 3}) + block({0, 3, 0}, {3, 9, 3}) +
                                                    block({6, 3, 0}, {9, 9, 3}))}) {
        const auto costs = plain_costs(mesh);
        for (int round = 0; round < 60; ++round) {
            const Part part = random_part(mesh, random, 1 + random() % 4, 0.2 + 0.03 * round);
            if (!both_sides(part)) continue;
            const Part result = snap(mesh, part);
            changed += result != part;
            ASSERT_TRUE(both_sides(result));
            ASSERT_LE(cost_of(costs, result), cost_of(costs, part) * (1 + 1e-5));
            for (const uint8_t side : {uint8_t{0}, uint8_t{1}})
                ASSERT_LE(pieces(costs, result, side), pieces(costs, part, side)) << mesh.name << round;
        }
    }
    EXPECT_GE(changed, 50);
}

}  // namespace
}  // namespace partwheel::test
