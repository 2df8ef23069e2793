// Noisy surfaces: the estimate of the noise, and smoothing that hardly shrinks the shape.
#include "prepare/noise.h"

namespace partwheel {

namespace {

// Quantiles of fewer vertices mean little.
constexpr size_t min_vertex_count = 500;

// A surface is noisy from this noise on, relative to the edges around a vertex: nearly positions models without noise,
// even finely detailed ones, have less. The estimates by several quantiles may differ by max_quantile_ratio.
constexpr double min_noise = 0.08;
constexpr double max_quantile_ratio = 1.6;

// The umbrella operator, applied twice, multiplies the deviation of independent noise by this where six edges meet.
constexpr double umbrella_gain = 1.36;

// The mean of the neighbors of each vertex. On a closed surface every neighbor counts twice. A vertex without neighbors
// stays.
std::vector<Point> neighbor_means(std::span<const Point> vertices, std::span<const Triangle> triangles) {
    std::vector<Point> sum(vertices.size(), Point{});
    std::vector<int32_t> count(vertices.size(), 0);
    for (const Triangle& t : triangles)
        for (size_t k = 0; k < 3; ++k) {
            const size_t v = idx(t[k]);
            sum[v] = sum[v] + (vertices[idx(t[(k + 1) % 3])] + vertices[idx(t[(k + 2) % 3])]);
            count[v] += 2;
        }
    for (size_t v = 0; v < vertices.size(); ++v)
        for (size_t i = 0; i < 3; ++i) sum[v][i] = count[v] ? sum[v][i] / count[v] : vertices[v][i];
    return sum;
}

std::vector<Point> difference(const std::vector<Point>& a, const std::vector<Point>& b) {
    std::vector<Point> d(a.size());
    for (size_t v = 0; v < a.size(); ++v) d[v] = a[v] - b[v];
    return d;
}

std::vector<Point> blur(std::vector<Point> vertices, std::span<const Triangle> triangles, int times) {
    for (int pass = 0; pass < times; ++pass) {
        const std::vector<Point> means = neighbor_means(vertices, triangles);
        for (size_t v = 0; v < vertices.size(); ++v) vertices[v] = 0.5 * (vertices[v] + means[v]);
    }
    return vertices;
}

}  // namespace

double estimate_noise(std::span<const Point> vertices, std::span<const Triangle> triangles) {
    if (vertices.size() < min_vertex_count) return 0;
    std::vector<Point> normal(vertices.size(), Point{});
    std::vector<double> edges(vertices.size(), 0);
    std::vector<int32_t> count(vertices.size(), 0);
    for (const Triangle& t : triangles) {
        const auto at = [&](size_t k) -> const Point& { return vertices[static_cast<size_t>(t[k % 3])]; };
        const Point n = cross(at(1) - at(0), at(2) - at(0));
        for (size_t k = 0; k < 3; ++k) {
            const auto v = static_cast<size_t>(t[k]);
            normal[v] = normal[v] + n;
            edges[v] += length(at(k + 1) - at(k)) + length(at(k + 2) - at(k));
            count[v] += 2;
        }
    }
    const std::vector<Point> positions(vertices.begin(), vertices.end());
    const std::vector<Point> first_difference = difference(positions, neighbor_means(positions, triangles));
    const std::vector<Point> second_difference = difference(first_difference, neighbor_means(first_difference, triangles));
    std::vector<double> noise;
    for (size_t v = 0; v < positions.size(); ++v) {
        const double size = length(normal[v]) * edges[v];
        if (size > 0) noise.push_back(std::abs(dot(second_difference[v], normal[v])) * count[v] / (umbrella_gain * size));
    }
    if (noise.size() < min_vertex_count) return 0;
    // Quantiles of the absolute value of a normal deviate.
    struct Quantile {
        double probability, deviations;
    };
    double least = HUGE_VAL, most = 0;
    for (const Quantile q : {Quantile{0.1, 0.12566}, {0.25, 0.31864}, {0.5, 0.67449}, {0.75, 1.15035}}) {
        const auto at = noise.begin() + static_cast<std::ptrdiff_t>(q.probability * static_cast<double>(noise.size()));
        std::nth_element(noise.begin(), at, noise.end());
        least = std::min(least, *at / q.deviations);
        most = std::max(most, *at / q.deviations);
    }
    return least >= min_noise && most <= max_quantile_ratio * least ? least : 0;
}

// blur(), then the blurred difference added back ("twicing", Tukey 1977): each frequency loses the square of its share
// only.
std::vector<Point> remove_noise(const std::vector<Point>& vertices, std::span<const Triangle> triangles, double passes) {
    const int times = static_cast<int>(std::ceil(passes));
    std::vector<Point> result = blur(vertices, triangles, times);
    const std::vector<Point> lost = blur(difference(vertices, result), triangles, times);
    for (size_t v = 0; v < result.size(); ++v) result[v] = result[v] + lost[v];
    return result;
}

}  // namespace partwheel
