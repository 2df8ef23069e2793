// The number of tree nodes that a winding number visits: sublinear for a surface, linear for intersecting triangles;
// meshes with many of those are refused.
#include "fill/winding.h"

#include "support/built.h"
#include "support/sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

using namespace partwheel::test;
using partwheel::WindingNumber;
using Corner = partwheel::Point;
using partwheel::operator*;
using partwheel::operator+;

namespace {

// Triangles with corners on a sphere: nearly every pair intersects.
TriMesh crossing_triangles(size_t count) {
    TriMesh mesh;
    mesh.name = "crossing triangles";
    std::mt19937 random(1);
    std::normal_distribution<double> any;
    while (mesh.triangles.size() < count) {
        const auto n = static_cast<int32_t>(mesh.vertices.size());
        for (int k = 0; k < 3; ++k) {
            const Corner p = {any(random), any(random), any(random)};
            mesh.vertices.push_back(1 / partwheel::length(p) * p);
        }
        mesh.triangles.push_back({n, n + 1, n + 2});
    }
    mesh.face_count = mesh.triangles.size();
    return mesh;
}

double mean_visits(const TriMesh& mesh) {
    const WindingNumber winding(mesh.vertices, mesh.triangles);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> any(-0.6, 0.6);
    double sum = 0;
    constexpr int points = 50;
    for (int i = 0; i < points; ++i) sum += static_cast<double>(winding.visits({any(random), any(random), any(random)}));
    return sum / points;
}

}  // namespace

TEST(WindingCost, ASurfaceNeedsFewNodes) {
    const TriMesh small = sphere(32, 32), large = sphere(128, 128);
    EXPECT_LT(mean_visits(large), 4 * mean_visits(small));  // of 16 times as many triangles
    EXPECT_LT(mean_visits(large), 0.2 * static_cast<double>(large.triangles.size()));
}

TEST(WindingCost, FansNeedFewNodes) {
    const auto cone = [](int count) { return lathe("cone", {{1, 0}}, count); };
    const auto coin = [](int count) { return lathe("coin", {{1, 0}, {1, 0.1}}, count); };
    for (const std::function<TriMesh(int)>& shape : std::vector<std::function<TriMesh(int)>>{cone, coin}) {
        const double one = mean_visits(shape(4000)), four = mean_visits(shape(16000));
        EXPECT_LT(four, 1.5 * one) << shape(3).name;
        EXPECT_LT(four, 1000) << shape(3).name;
    }
}

// Also next to the surface, with an apex off the middle, with holes, and with triangles turned around.
TEST(WindingCost, FansWindAsTheirTriangles) {
    TriMesh cone = lathe("cone", {{1, 0}}, 700);
    cone.vertices.back() = {0.3, 0.2, 1.2};
    const TriMesh rough = perturbed(lathe("rough coin", {{1, 0}, {1, 0.1}}, 700), 0.02, 1);
    TriMesh broken = named(rough, "broken coin");
    for (size_t t = 0; t < broken.triangles.size(); t += 97) std::swap(broken.triangles[t][0], broken.triangles[t][1]);
    for (size_t t = 0; t + 50 < broken.triangles.size(); t += 301) broken.triangles.erase(broken.triangles.begin() + static_cast<std::ptrdiff_t>(t));
    for (const TriMesh& mesh : {cone, rough, broken}) {
        const WindingNumber winding(mesh.vertices, mesh.triangles);
        std::mt19937 random(3);
        std::uniform_real_distribution<double> any(-1.1, 1.1), near(-0.05, 0.05);
        double farthest = 0;
        for (int i = 0; i < 1000; ++i) {
            Corner p{any(random), any(random), any(random)};
            if (i % 2 == 0) {
                const auto& [a, b, c] = mesh.triangles[random() % mesh.triangles.size()];
                const auto at = [&](int32_t v) { return mesh.vertices[static_cast<size_t>(v)]; };
                p = 0.3 * at(a) + 0.3 * at(b) + 0.4 * at(c) + Corner{near(random), near(random), near(random)};
            }
            farthest = std::max(farthest, std::fabs(winding.at(p) - partwheel::winding_number(mesh.vertices, mesh.triangles, p)));
        }
        EXPECT_LT(farthest, 0.02) << mesh.name;
    }
}

TEST(WindingCost, CrossingTrianglesNeedAllNodes) {
    EXPECT_GT(mean_visits(crossing_triangles(2000)), 2000);
    EXPECT_GT(mean_visits(crossing_triangles(8000)), 8000);
}

TEST(WindingCost, ManyCrossingTrianglesAreAsManySheets) {
    const TriMesh mesh = crossing_triangles(sized(5000, 1000));
    const Built built = try_build(mesh, 0, nullptr, 0);
    ASSERT_EQ(built.status, PW_OK) << built.message;
    EXPECT_EQ(summary(built.handle).sheets, mesh.triangles.size());
}
