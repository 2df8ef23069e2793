// The gentlest repair: coincident vertices moved apart, or all vertices smoothed.
#include "prepare/displace.h"

#include "mesh/face_assignment.h"
#include "prepare/noise.h"

namespace partwheel {

namespace {

// Numbers of smoothing passes to try, as multiples of the noise, until the surface doesn't cross itself.
constexpr double smoothing_passes[] = {45, 70, 110};

// No vertex moves farther than this, relative to the diagonal. That is enough for noise with a standard deviation of 1
// %; filling from points is better for anything noisier.
constexpr double max_displacement = 1.0 / 20;

// The vertices at the position of another vertex. In a surface, these follow each other.
std::vector<size_t> find_coincident_vertices(const std::vector<Point>& vertices) {
    std::vector<size_t> found;
    for (size_t v = 0; v < vertices.size(); ++v)
        if ((v > 0 && vertices[v] == vertices[v - 1]) || (v + 1 < vertices.size() && vertices[v] == vertices[v + 1]))
            found.push_back(v);
    return found;
}

// The source's vertices, the coincident ones moved against their normals.
std::vector<Point> move_inward(const Surface& source, const std::vector<size_t>& coincident) {
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
    for (const size_t v : coincident) {
        const double size = length(normal[v]);
        for (size_t i = 0; i < 3 && size > 0; ++i) result[v][i] -= inward_shift * shortest[v] * normal[v][i] / size;
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
    std::string notes;
    const std::vector<size_t> coincident = find_coincident_vertices(source.vertices);
    if (!coincident.empty() && attempt(move_inward(source, coincident)) == PW_OK)
        notes = "Repaired: " + std::to_string(coincident.size()) + " touching vertices set apart.";
    const bool crosses = status == PW_ERROR_SELF_INTERSECTION;
    const double noise = crosses ? estimate_noise(source.vertices, source.triangles) : 0;
    for (const double passes : smoothing_passes)
        if (noise > 0 && status == PW_ERROR_SELF_INTERSECTION &&
            attempt(remove_noise(source.vertices, source.triangles, passes * noise)) == PW_OK)
            notes = "Repaired: the surface is so rough that it passes through itself, and was smoothed.";
    if (status != PW_OK) return {};

    double farthest = 0;
    for (size_t v = 0; v < source.vertices.size(); ++v) {
        const double distance = length(surface.vertices[v] - source.vertices[v]);
        if (distance > 0) surface.source_vertex[v] = -1;
        farthest = std::max(farthest, distance);
    }
    surface.deviation = farthest / diagonal(source);
    if (surface.deviation > max_displacement) return {};
    surface.notes = notes + " " + at_most_away(surface.deviation) + ".";
    return surface;
}

}  // namespace partwheel
