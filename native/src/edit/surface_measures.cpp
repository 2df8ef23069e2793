// Normals by Max's weights; distances by shortest paths.
#include "edit/surface_measures.h"

#include "base/adjacency.h"
#include "base/error.h"
#include "mesh/surface.h"

namespace partwheel {

namespace {

struct WeightedEdge {
    int32_t to;
    double length;
};

// Edges, and lines straight across an edge between its two opposite corners, from each vertex.
CsrArray<WeightedEdge> build_distance_graph(std::span<const Point> vertices, std::span<const Triangle> triangles,
                                            Progress& progress) {
    std::vector<std::pair<int32_t, WeightedEdge>> directed;  // (from, edge)
    const auto add = [&](int32_t a, int32_t b, double length) {
        directed.push_back({a, {b, length}});
        directed.push_back({b, {a, length}});
    };
    for_each_edge(vertices.size(), triangles, [&](int32_t low, std::span<const Side> sides) {
        if (low % 4096 == 0) progress.reach(0.05 + 0.45 * low / static_cast<double>(vertices.size()));
        const int32_t high = sides[0].high;
        const Point along = vertices[high] - vertices[low];
        const double length = partwheel::length(along);
        add(low, high, length);
        if (sides.size() != 2 || !(length > 0)) return;
        // Unfolds both opposite corners into the plane: (x, y) and (u, -v), with the edge on the x axis.
        const auto opposite = [&](size_t i) { return triangles[sides[i].number / 3][(sides[i].number + 2) % 3]; };
        const Point first = vertices[opposite(0)] - vertices[low], second = vertices[opposite(1)] - vertices[low];
        const double x = dot(first, along) / length, u = dot(second, along) / length;
        const double y = std::sqrt(std::max(dot(first, first) - x * x, 0.0));
        const double v = std::sqrt(std::max(dot(second, second) - u * u, 0.0));
        const double crossing = y + v > 0 ? (x * v + u * y) / (y + v) : -1;
        if (crossing >= 0 && crossing <= length)
            add(opposite(0), opposite(1), std::sqrt((x - u) * (x - u) + (y + v) * (y + v)));
    });
    return CsrArray<WeightedEdge>(vertices.size(), [&](const auto& put) {
        for (const auto& [from, edge] : directed) put(idx(from), edge);
    });
}

}  // namespace

void require_triangles(std::span<const Point> vertices, std::span<const Triangle> triangles) {
    if (vertices.empty() || triangles.empty())
        throw Error(PW_ERROR_EMPTY, "There are no triangles: select a part with faces.");
    check_arrays({vertices, triangles, {}, triangles.size()});
}

void vertex_normals(std::span<const Point> vertices, std::span<const Triangle> triangles, std::span<Point> normals) {
    require_triangles(vertices, triangles);
    // Scales by a power of two, which is exact, to about unit size: fourth powers of lengths must not over- or
    // underflow.
    double longest = 0;
    for (const auto& [i, j, k] : triangles)
        for (const Point& side : {vertices[j] - vertices[i], vertices[k] - vertices[j], vertices[i] - vertices[k]})
            for (const double component : side) longest = std::max(longest, std::abs(component));
    const double scale = longest > 0 ? std::ldexp(1.0, -std::max(std::ilogb(longest), -1022)) : 1;

    std::fill(normals.begin(), normals.end(), Point{});
    for (const auto& [i, j, k] : triangles) {
        const Point &a = vertices[i], &b = vertices[j], &c = vertices[k];
        const Point ab = scale * (b - a), bc = scale * (c - b), ca = scale * (a - c), normal = cross(ab, bc);
        const double ab2 = dot(ab, ab), bc2 = dot(bc, bc), ca2 = dot(ca, ca);
        if (!(ab2 > 0 && bc2 > 0 && ca2 > 0)) continue;
        normals[i] = normals[i] + (1 / (ab2 * ca2)) * normal;
        normals[j] = normals[j] + (1 / (ab2 * bc2)) * normal;
        normals[k] = normals[k] + (1 / (bc2 * ca2)) * normal;
    }
    for (Point& normal : normals) {
        const double size = length(normal);
        normal = size > 0 && std::isfinite(size) ? (1 / size) * normal : Point{};
    }
}

std::vector<double> surface_distances(std::span<const Point> vertices, std::span<const Triangle> triangles,
                                      std::span<const uint8_t> start, Progress& progress) {
    require_triangles(vertices, triangles);
    progress.reach(0.05);
    const CsrArray<WeightedEdge> graph = build_distance_graph(vertices, triangles, progress);
    progress.reach(0.6);
    std::vector<double> distances(vertices.size(), HUGE_VAL);
    std::vector<int32_t> sources;
    for (size_t v = 0; v < vertices.size(); ++v)
        if (start[v]) distances[v] = 0, sources.push_back(static_cast<int32_t>(v));
    size_t n_visited = 0;
    find_shortest_paths(distances, sources, [&](int32_t v, double distance, const auto& relax) {
        if (++n_visited % 4096 == 0)
            progress.reach(0.6 + 0.4 * static_cast<double>(n_visited) / static_cast<double>(vertices.size()));
        for (const auto& [to, length] : graph.row(idx(v))) relax(to, distance + length);
        return true;
    });
    return distances;
}

}  // namespace partwheel
