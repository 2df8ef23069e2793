// The number of tree nodes that a winding number visits: sublinear for a surface, linear for intersecting triangles;
// meshes with many of those are refused.
#include "fill/winding.h"

#include "support/built.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

using namespace partwheel::test;
using partwheel::WindingNumber;
using Corner = partwheel::Point;
using partwheel::operator*;

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

TEST(WindingCost, CrossingTrianglesNeedAllNodes) {
    EXPECT_GT(mean_visits(crossing_triangles(2000)), 2000);
    EXPECT_GT(mean_visits(crossing_triangles(8000)), 8000);
}

TEST(WindingCost, ManyCrossingTrianglesAreAsManySheets) {
    const TriMesh mesh = crossing_triangles(5000);
    const Built built = try_build(mesh, 0, nullptr, 0);
    ASSERT_EQ(built.status, PW_OK) << built.message;
    EXPECT_EQ(summary(built.handle).sheets, 5000U);
}
