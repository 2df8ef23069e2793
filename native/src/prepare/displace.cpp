// The gentlest repair: some vertices set apart, or all smoothed.
#include "prepare/displace.h"

#include "mesh/face_assignment.h"
#include "prepare/noise.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace partwheel {

namespace {

// Passes of smoothing until a surface doesn't cross itself, one after the other, as multiples of the noise.
constexpr double uncrossing_passes[] = {45, 70, 110};

// No vertex is moved further than this, relative to the diagonal: enough for noise of a deviate of 1 %, and what would
// need more is better filled from points.
constexpr double farthest_moved = 1.0 / 20;

// The vertices that are at the place of another.
std::vector<size_t> at_one_place(const std::vector<Point>& vertices) {
    std::vector<size_t> order(vertices.size()), found;
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return vertices[a] < vertices[b]; });
    for (size_t k = 0; k < order.size(); ++k) {
        const auto same = [&](size_t other) { return vertices[order[k]] == vertices[order[other]]; };
        if ((k > 0 && same(k - 1)) || (k + 1 < order.size() && same(k + 1))) found.push_back(order[k]);
    }
    return found;
}

// Those vertices moved against their normals.
std::vector<Point> set_apart(const Surface& source, const std::vector<size_t>& touching) {
    std::vector<Point> normal(source.vertices.size(), Point{}), result = source.vertices;
    std::vector<double> shortest(source.vertices.size(), HUGE_VAL);
    for (const Triangle& t : source.triangles) {
        const auto at = [&](size_t k) -> const Point& { return source.vertices[static_cast<size_t>(t[k % 3])]; };
        const Point n = cross(at(1) - at(0), at(2) - at(0));
        for (size_t k = 0; k < 3; ++k) {
            const auto v = static_cast<size_t>(t[k]);
            normal[v] = normal[v] + n;
            shortest[v] = std::min({shortest[v], length(at(k + 1) - at(k)), length(at(k + 2) - at(k))});
        }
    }
    for (const size_t v : touching) {
        const double size = length(normal[v]);
        for (size_t i = 0; i < 3 && size > 0; ++i) result[v][i] -= nudge * shortest[v] * normal[v][i] / size;
    }
    return result;
}

}  // namespace

std::optional<Surface> displace_vertices(const Surface& source, Progress& progress) {
    Surface surface = source;
    pw_status status = PW_ERROR_SELF_INTERSECTION;
    const auto attempt = [&](std::vector<Point> vertices) {
        surface.vertices = std::move(vertices);
        return status = surface_status(surface, progress);
    };
    std::string account;
    const std::vector<size_t> touching = at_one_place(source.vertices);
    if (!touching.empty() && attempt(set_apart(source, touching)) == PW_OK)
        account = "Repaired: " + std::to_string(touching.size()) + " touching vertices set apart.";
    const bool crosses = status == PW_ERROR_SELF_INTERSECTION;
    const double noise = crosses ? estimate_noise(source.vertices, source.triangles) : 0;
    for (const double passes : uncrossing_passes)
        if (noise > 0 && status == PW_ERROR_SELF_INTERSECTION &&
            attempt(smoothed(source.vertices, source.triangles, passes * noise)) == PW_OK)
            account = "Repaired: the surface is so rough that it passes through itself, and was smoothed.";
    if (status != PW_OK) return {};

    double farthest = 0;
    for (size_t v = 0; v < source.vertices.size(); ++v) {
        const double way = length(surface.vertices[v] - source.vertices[v]);
        if (way > 0) surface.source_vertex[v] = -1;
        farthest = std::max(farthest, way);
    }
    surface.deviation = farthest / diagonal(source);
    if (surface.deviation > farthest_moved) return {};
    surface.account = account + " " + at_most_away(surface.deviation) + ".";
    return surface;
}

}  // namespace partwheel
