// Rough surfaces: the estimate of the noise, and smoothing that hardly shrinks.
#include "prepare/noise.h"

#include <algorithm>
#include <cmath>

namespace partwheel {

namespace {

// Of fewer vertices the quantiles say little.
constexpr size_t fewest_vertices = 500;

// The noise, relative to the edges around a vertex, from which a surface is rough: nearly all models without noise, finely
// detailed ones included, stay below. And how far the estimates of it by several quantiles may be apart.
constexpr double least_noise = 0.08;
constexpr double most_unlike = 1.6;

// How much the umbrella operator, applied twice, enlarges the deviation of independent noise where six edges meet.
constexpr double umbrella_gain = 1.36;

// The middle of the neighbours of each vertex; those of a closed surface count twice each, so all alike. A vertex
// without neighbours stays.
std::vector<Point> middles(std::span<const Point> vertices, std::span<const Triangle> triangles) {
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

std::vector<Point> blurred(std::vector<Point> vertices, std::span<const Triangle> triangles, int times) {
    for (int pass = 0; pass < times; ++pass) {
        const std::vector<Point> middle = middles(vertices, triangles);
        for (size_t v = 0; v < vertices.size(); ++v) vertices[v] = 0.5 * (vertices[v] + middle[v]);
    }
    return vertices;
}

}  // namespace

double estimate_noise(std::span<const Point> vertices, std::span<const Triangle> triangles) {
    if (vertices.size() < fewest_vertices) return 0;
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
    const std::vector<Point> all(vertices.begin(), vertices.end());
    const std::vector<Point> once = difference(all, middles(all, triangles));
    const std::vector<Point> twice = difference(once, middles(once, triangles));
    std::vector<double> noise;
    for (size_t v = 0; v < all.size(); ++v) {
        const double size = length(normal[v]) * edges[v];
        if (size > 0) noise.push_back(std::abs(dot(twice[v], normal[v])) * count[v] / (umbrella_gain * size));
    }
    if (noise.size() < fewest_vertices) return 0;
    // Of the absolute value of a normal deviate.
    struct Quantile {
        double share, deviations;
    };
    double least = HUGE_VAL, most = 0;
    for (const Quantile q : {Quantile{0.1, 0.12566}, {0.25, 0.31864}, {0.5, 0.67449}, {0.75, 1.15035}}) {
        const auto at = noise.begin() + static_cast<std::ptrdiff_t>(q.share * static_cast<double>(noise.size()));
        std::nth_element(noise.begin(), at, noise.end());
        least = std::min(least, *at / q.deviations);
        most = std::max(most, *at / q.deviations);
    }
    return least >= least_noise && most <= most_unlike * least ? least : 0;
}

// Blurred, and what was lost blurred and given back ("twicing", Tukey 1977): it shrinks by the square only.
std::vector<Point> smoothed(const std::vector<Point>& vertices, std::span<const Triangle> triangles, double passes) {
    const int times = static_cast<int>(std::ceil(passes));
    std::vector<Point> result = blurred(vertices, triangles, times);
    const std::vector<Point> lost = blurred(difference(vertices, result), triangles, times);
    for (size_t v = 0; v < result.size(); ++v) result[v] = result[v] + lost[v];
    return result;
}

}  // namespace partwheel
