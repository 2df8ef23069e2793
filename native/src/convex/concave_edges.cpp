// Concave edges by the dihedral angles of boundary facets; walls by counting edges per plane.
#include "convex/concave_edges.h"

#include "base/adjacency.h"
#include "base/corners.h"
#include "base/elementary.h"
#include "convex/distance.h"

namespace partwheel::convex {

namespace {

constexpr double min_angle = 0.02;         // radians: flatter edges come from rounding
constexpr double min_wall_share = 0.001;   // of one plane, in the weight of all concave edges
constexpr double min_share = 0.5;          // of at most max_walls planes together; less: the surface is curved
constexpr size_t max_walls = 128;
constexpr size_t max_paired_edges = 256;   // with more edges, planes through two of them are not tried
constexpr double flat = 1e-7;              // distance from a plane, in working coordinates
constexpr double cell = 1e-5;              // planes in one cell are the same
constexpr double cell_offset = 0.5772156;  // of a cell: keeps round numbers away from borders of cells

// The plane of this direction through a point; its first nonzero component is positive.
Plane plane_through(Point normal, const Point& p) {
    normal = 1 / length(normal) * normal;
    for (const double component : normal) {
        if (std::fabs(component) < flat) continue;
        if (component < 0) normal = -1 * normal;
        break;
    }
    return {normal, dot(normal, p)};
}

std::array<int64_t, 4> cell_of(const Plane& plane) {
    const auto round = [](double x) { return static_cast<int64_t>(std::floor(x / cell + cell_offset)); };
    return {round(plane.normal[0]), round(plane.normal[1]), round(plane.normal[2]), round(plane.offset)};
}

bool is_in_plane(const ConcaveEdge& edge, const Plane& plane) {
    return std::fabs(plane.height(edge.from)) < flat && std::fabs(plane.height(edge.to)) < flat;
}

using WeightedPlanes = std::map<std::array<int64_t, 4>, std::pair<Plane, double>>;  // by cells

// At most max_walls planes above a weight, by direction, the heaviest direction first.
std::vector<Plane> heaviest_planes(const WeightedPlanes& weight_of_plane, double limit) {
    std::vector<double> weights;
    for (const auto& [key, counted] : weight_of_plane) weights.push_back(counted.second);
    std::ranges::sort(weights, std::greater{});
    if (weights.size() > max_walls) limit = std::max(limit, weights[max_walls]);
    std::vector<std::pair<double, std::vector<Plane>>> directions;
    for (const auto& [key, counted] : weight_of_plane) {  // parallel planes are adjacent cells
        const auto& [plane, weight] = counted;
        if (!(weight > limit)) continue;
        if (directions.empty() || length(directions.back().second.back().normal - plane.normal) > flat)
            directions.emplace_back();
        directions.back().first += weight;
        directions.back().second.push_back(plane);
    }
    std::ranges::stable_sort(directions, std::greater{}, [](const auto& d) { return d.first; });
    std::vector<Plane> heaviest;
    for (const auto& [weight, planes] : directions) heaviest.insert(heaviest.end(), planes.begin(), planes.end());
    return heaviest;
}

// Planes that resolve two edges at once.
std::vector<Plane> planes_of_pairs(std::span<const ConcaveEdge> edges) {
    std::vector<Plane> planes;
    for (size_t i = 0; i < edges.size(); ++i)
        for (size_t j = i + 1; j < edges.size(); ++j) {
            const Point along = edges[i].to - edges[i].from;
            const Point to_from = cross(along, edges[j].from - edges[i].from);
            const Point to_to = cross(along, edges[j].to - edges[i].from);
            const Point normal = length(to_from) > length(to_to) ? to_from : to_to;
            if (!(length(normal) > flat * length(along))) continue;  // on one line
            const Plane plane = plane_through(normal, edges[i].from);
            if (edges[i].is_resolved_by(plane) && edges[j].is_resolved_by(plane)) planes.push_back(plane);
        }
    return planes;
}

std::vector<ConcaveEdge> find_concave_edges(std::span<const Point> points, std::span<const Tetrahedron> solid,
                                            Progress& progress) {
    std::vector<Triangle> triangles;
    std::vector<Point> normals;
    progress.reach(0);
    for (const BoundaryFacet& f : boundary_facets(solid)) {
        const auto [a, b, c] = corner_points(points, f.corners);
        const Point n = cross(b - a, c - a);
        if (!(length(n) > 0)) continue;
        triangles.push_back(f.corners);
        normals.push_back(1 / length(n) * n);
    }
    progress.reach(0);
    std::vector<ConcaveEdge> edges;
    for_each_edge(points.size(), triangles, [&](int32_t low, std::span<const Side> sides) {
        if (sides.size() != 2) return;  // edges of other than two facets are not concave
        const auto apex = [&](const Side& side) { return triangles[idx(side.number / 3)][idx((side.number + 2) % 3)]; };
        const auto [s, t] = std::minmax(sides[0], sides[1], [&](const Side& x, const Side& y) { return apex(x) < apex(y); });
        const Point &from = points[idx(low)], &n = normals[idx(s.number / 3)], &m = normals[idx(t.number / 3)];
        if (!(dot(n, points[idx(apex(t))] - from) > 0)) return;
        const double cosine = std::clamp(dot(n, m), -1.0, 1.0);
        const double angle = angle_of(std::sqrt(1 - cosine * cosine), cosine);
        if (angle >= min_angle) edges.push_back({from, points[idx(sides[0].high)], angle, {n, m}});
    });
    return edges;
}

}  // namespace

ConcaveEdges::ConcaveEdges(std::span<const Point> points, std::span<const Tetrahedron> solid, Progress& progress)
    : edges(find_concave_edges(points, solid, progress)) {
    progress.reach(0);
    WeightedPlanes weight_of_plane;
    double total = 0;
    for (const ConcaveEdge& edge : edges) {
        const auto& [n, m] = edge.normals;
        total += edge.weight();
        for (const Point& normal : {n, m, n - m}) {
            const Plane plane = plane_through(normal, edge.from);
            weight_of_plane.try_emplace(cell_of(plane), plane, 0).first->second.second += edge.weight();
        }
    }
    progress.reach(0);
    if (edges.size() <= max_paired_edges)
        for (const Plane& plane : planes_of_pairs(edges)) {
            double& counted = weight_of_plane.try_emplace(cell_of(plane), plane, 0).first->second.second;
            counted = std::max(counted, resolved_weight(edges, plane));
        }
    walls = heaviest_planes(weight_of_plane, min_wall_share * total);
    double in_walls = 0;
    for (const ConcaveEdge& edge : edges)
        if (std::ranges::any_of(walls, [&](const Plane& wall) { return edge.is_resolved_by(wall); }))
            in_walls += edge.weight();
    if (in_walls < min_share * total) walls.clear();
}

double resolved_weight(std::span<const ConcaveEdge> edges, const Plane& plane) {
    double weight = 0;
    for (const ConcaveEdge& edge : edges)
        if (edge.is_resolved_by(plane)) weight += edge.weight();
    return weight;
}

bool ConcaveEdge::is_resolved_by(const Plane& plane) const {
    if (!is_in_plane(*this, plane)) return false;
    // normal = a * normals[0] - b * normals[1]: a and b, times a common factor, must have the same sign.
    const Point along = to - from;
    const double a = dot(cross(plane.normal, normals[1]), along), b = dot(cross(plane.normal, normals[0]), along);
    const double rounding = flat * length(along);
    return (a > -rounding && b > -rounding) || (a < rounding && b < rounding);
}

void divide_edges(std::span<const ConcaveEdge> edges, const Plane& plane, std::vector<ConcaveEdge>& below,
                  std::vector<ConcaveEdge>& above) {
    for (const ConcaveEdge& edge : edges) {
        if (edge.is_resolved_by(plane)) continue;
        if (is_in_plane(edge, plane)) {  // the solid at the edge is on one side
            (dot(edge.normals[0] + edge.normals[1], plane.normal) > 0 ? below : above).push_back(edge);
            continue;
        }
        const double h = plane.height(edge.from), k = plane.height(edge.to);
        if (std::min(h, k) > -flat) {
            above.push_back(edge);
        } else if (std::max(h, k) < flat) {
            below.push_back(edge);
        } else {
            const Point middle = edge.from + h / (h - k) * (edge.to - edge.from);
            (h < 0 ? below : above).push_back({edge.from, middle, edge.angle, edge.normals});
            (h < 0 ? above : below).push_back({middle, edge.to, edge.angle, edge.normals});
        }
    }
}

}  // namespace partwheel::convex
