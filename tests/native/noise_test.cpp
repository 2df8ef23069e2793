// The noise estimate against known noise; smoothing against a direct implementation.
#include "support/shapes.h"
#include "prepare/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace partwheel::test {
namespace {

using partwheel::operator+, partwheel::operator-;

double mean_edge(const TriMesh& mesh) {
    double sum = 0;
    for (const Triangle& t : mesh.triangles)
        for (size_t k = 0; k < 3; ++k)
            sum += length(mesh.vertices[static_cast<size_t>(t[k])] - mesh.vertices[static_cast<size_t>(t[(k + 1) % 3])]);
    return sum / (3 * static_cast<double>(mesh.triangles.size()));
}

// Moves each vertex halfway to the mean of its neighbors, `times` times.
std::vector<Point> smooth_naively(std::vector<Point> vertices, const std::vector<std::set<size_t>>& neighbors, int times) {
    while (times-- > 0) {
        const std::vector<Point> before = vertices;
        for (size_t v = 0; v < vertices.size(); ++v) {
            Point sum{};
            for (const size_t n : neighbors[v]) sum = sum + before[n];
            for (size_t i = 0; i < 3; ++i)
                vertices[v][i] = (before[v][i] + sum[i] / static_cast<double>(neighbors[v].size())) / 2;
        }
    }
    return vertices;
}

TEST(Noise, SmoothingAddsBackTheSmoothedResidual) {
    const TriMesh mesh = perturbed(torus(16, 8, 2, 0.6), 0.1, 1);
    std::vector<std::set<size_t>> neighbors(mesh.vertices.size());
    for (const Triangle& t : mesh.triangles)
        for (size_t k = 0; k < 3; ++k)
            for (size_t other : {(k + 1) % 3, (k + 2) % 3})
                neighbors[static_cast<size_t>(t[k])].insert(static_cast<size_t>(t[other]));
    for (const int times : {1, 3}) {
        std::vector<Point> expected = smooth_naively(mesh.vertices, neighbors, times), residual = expected;
        for (size_t v = 0; v < residual.size(); ++v) residual[v] = mesh.vertices[v] - expected[v];
        residual = smooth_naively(residual, neighbors, times);
        const std::vector<Point> result = remove_noise(mesh.vertices, mesh.triangles, times - 0.5);
        for (size_t v = 0; v < residual.size(); ++v)
            EXPECT_LT(length(result[v] - (expected[v] + residual[v])), 1e-12) << times << ", vertex " << v;
    }
}

// The deviate along the normal is that of each coordinate, which is even between -sqrt(3) and sqrt(3) deviates.
TEST(Noise, EstimateIsTheNoiseInEdgeLengths) {
    const TriMesh smooth = torus(96, 36, 2, 0.7);
    EXPECT_EQ(estimate_noise(smooth.vertices, smooth.triangles), 0);
    for (const double noise : {0.12, 0.2, 0.3}) {
        const TriMesh mesh = perturbed(smooth, std::sqrt(3) * noise * mean_edge(smooth), 5);
        EXPECT_NEAR(estimate_noise(mesh.vertices, mesh.triangles) / noise, 1, 0.2) << noise;
    }
}

}  // namespace
}  // namespace partwheel::test
