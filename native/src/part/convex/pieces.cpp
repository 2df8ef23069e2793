// Pieces of the solid and the planes that divide them best.
//
// A hull needs points alone: what a plane leaves of a piece has the hull of the vertices on that side and of the points
// where edges cross. The hulls below planes that go up in one direction grow, so a sweep adds to one hull; another one
// comes down. That costs about as much as two hulls of the piece, for all places of the plane.
#include "part/convex/pieces.h"

#include <algorithm>
#include <cmath>

namespace partwheel::convex {

namespace {

constexpr size_t places = 16;        // of the plane, in a sweep
constexpr double flat = 1e-9;        // of a piece's extent: nearer to the plane is in it

std::vector<int32_t> vertices_of(std::span<const Tetrahedron> tetrahedra) {
    std::vector<int32_t> used;
    used.reserve(4 * tetrahedra.size());
    for (const Tetrahedron& t : tetrahedra) used.insert(used.end(), t.begin(), t.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    return used;
}

std::vector<std::array<int32_t, 2>> edges_of(std::span<const Tetrahedron> tetrahedra) {
    std::vector<std::array<int32_t, 2>> edges;
    edges.reserve(6 * tetrahedra.size());
    for (const Tetrahedron& t : tetrahedra)
        for (size_t i = 0; i < 4; ++i)
            for (size_t j = i + 1; j < 4; ++j) edges.push_back({std::min(t[i], t[j]), std::max(t[i], t[j])});
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

// The principal directions of some points: eigenvectors of their covariance, by Jacobi's rotations.
std::array<Point, 3> principal_directions(const HullKernel& kernel, std::span<const int32_t> vertices) {
    Point mean{};
    for (const int32_t v : vertices) mean = mean + kernel.point(v);
    mean = 1 / static_cast<double>(vertices.size()) * mean;
    double a[3][3] = {};
    for (const int32_t v : vertices) {
        const Point d = kernel.point(v) - mean;
        for (size_t i = 0; i < 3; ++i)
            for (size_t j = 0; j < 3; ++j) a[i][j] += d[i] * d[j];
    }
    std::array<Point, 3> q = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // rows
    constexpr size_t rounds = 12;
    for (size_t round = 0; round < rounds; ++round)
        for (size_t i = 0; i < 2; ++i)
            for (size_t j = i + 1; j < 3; ++j) {
                if (a[i][j] == 0) continue;
                const double theta = (a[j][j] - a[i][i]) / (2 * a[i][j]);
                const double t = std::copysign(1 / (std::fabs(theta) + std::sqrt(theta * theta + 1)), theta);
                const double c = 1 / std::sqrt(t * t + 1), s = t * c;
                for (size_t k = 0; k < 3; ++k) {
                    const double x = a[k][i], y = a[k][j];
                    a[k][i] = c * x - s * y;
                    a[k][j] = s * x + c * y;
                }
                for (size_t k = 0; k < 3; ++k) {
                    const double x = a[i][k], y = a[j][k];
                    a[i][k] = c * x - s * y;
                    a[j][k] = s * x + c * y;
                    const double u = q[i][k], v = q[j][k];
                    q[i][k] = c * u - s * v;
                    q[j][k] = s * u + c * v;
                }
            }
    return q;
}

// The extreme ones of points in a plane across this direction: a few of them decide, and most are dropped.
void keep_extreme(std::vector<Point>& points, const Point& direction) {
    // Seen along the axis that the plane is most across.
    size_t axis = 0;
    for (size_t k = 1; k < 3; ++k)
        if (std::fabs(direction[k]) > std::fabs(direction[axis])) axis = k;
    const size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
    if (points.size() < 4) return;
    std::sort(points.begin(), points.end(), [&](const Point& a, const Point& b) {
        return a[x] != b[x] ? a[x] < b[x] : (a[y] != b[y] ? a[y] < b[y] : a[axis] < b[axis]);
    });
    std::vector<Point> kept;
    const auto left = [&](const Point& a, const Point& b, const Point& c) {
        return (b[x] - a[x]) * (c[y] - a[y]) - (b[y] - a[y]) * (c[x] - a[x]) > 0;
    };
    for (int side = 0; side < 2; ++side) {
        const size_t begin = kept.size();
        for (const Point& p : points) {
            while (kept.size() >= begin + 2 && !left(kept[kept.size() - 2], kept.back(), p)) kept.pop_back();
            kept.push_back(p);
        }
        kept.pop_back();
        std::reverse(points.begin(), points.end());
    }
    points = std::move(kept);
}

}  // namespace

Piece Pieces::piece(std::vector<Tetrahedron> tetrahedra) {
    Hull hull = kernel_.build(vertices_of(tetrahedra));
    return {std::move(tetrahedra), std::move(hull)};
}

Piece Pieces::joined(const Piece& a, const Piece& b) {
    Piece both;
    both.tetrahedra = a.tetrahedra;
    both.tetrahedra.insert(both.tetrahedra.end(), b.tetrahedra.begin(), b.tetrahedra.end());
    both.hull = kernel_.unite(a.hull, b.hull.vertices());
    return both;
}

double Pieces::joined_cost(const Piece& a, const Piece& b) {
    return kernel_.united_volume(a.hull, b.hull.vertices()).volume;
}

bool Pieces::touch(const Piece& a, const Piece& b, double gap) const {
    const Box x = kernel_.bounds(a.hull), y = kernel_.bounds(b.hull);
    for (size_t k = 0; k < 3; ++k)
        if (x.low[k] > y.high[k] + gap || y.low[k] > x.high[k] + gap) return false;
    return true;
}

Division Pieces::best_division(std::span<const Tetrahedron> tetrahedra, std::span<const Point> more) {
    const auto vertices = vertices_of(tetrahedra);
    const auto edges = edges_of(tetrahedra);
    Division best;
    for (const Point& d : principal_directions(kernel_, vertices)) sweep(vertices, edges, d, best);
    for (const Point& d : more) sweep(vertices, edges, d, best);
    if (more.empty())
        for (size_t i = 0; i < lattice_directions; ++i) sweep(vertices, edges, lattice_direction(i), best);
    return best;
}

void Pieces::sweep(std::span<const int32_t> vertices, std::span<const std::array<int32_t, 2>> edges,
                   const Point& direction, Division& best) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const int32_t v : vertices) {
        const double h = dot(direction, kernel_.point(v));
        low = std::min(low, h);
        high = std::max(high, h);
    }
    if (!(low < high)) return;
    const double step = (high - low) / (places + 1);
    std::vector<double> offsets;
    for (size_t i = 1; i <= places; ++i) offsets.push_back(low + static_cast<double>(i) * step);
    Division here;
    try_planes(vertices, edges, direction, offsets, here);
    // Finer, where it may become the best.
    if (here.cost < best.cost + 0.02 * std::fabs(best.cost) || best.cost == HUGE_VAL) {
        const double middle = here.plane.offset;
        offsets.clear();
        for (int i = -3; i <= 3; ++i)
            if (i != 0) offsets.push_back(middle + i * step / 4);
        try_planes(vertices, edges, direction, offsets, here);
    }
    if (here.cost < best.cost) best = here;
}

void Pieces::try_planes(std::span<const int32_t> vertices, std::span<const std::array<int32_t, 2>> edges,
                        const Point& direction, std::span<const double> offsets, Division& best) {
    const size_t n = offsets.size(), kept = kernel_.point_count();
    // Between which planes each vertex is; and where edges cross each plane.
    std::vector<std::vector<int32_t>> between(n + 1);
    std::vector<std::vector<Point>> crossings(n);
    const auto band = [&](double h) {
        return static_cast<size_t>(std::lower_bound(offsets.begin(), offsets.end(), h) - offsets.begin());
    };
    for (const int32_t v : vertices) between[band(dot(direction, kernel_.point(v)))].push_back(v);
    for (const auto& [a, b] : edges) {
        const Point &p = kernel_.point(a), &q = kernel_.point(b);
        const double hp = dot(direction, p), hq = dot(direction, q);
        const size_t first = band(std::min(hp, hq)), last = band(std::max(hp, hq));
        for (size_t i = first; i < last; ++i) crossings[i].push_back(p + (offsets[i] - hp) / (hq - hp) * (q - p));
    }
    std::vector<std::vector<int32_t>> at_plane(n);
    for (size_t i = 0; i < n; ++i) {
        keep_extreme(crossings[i], direction);
        for (const Point& p : crossings[i]) at_plane[i].push_back(kernel_.add(p));
    }
    std::vector<double> costs(n, 0);
    for (const bool up : {true, false}) {
        Hull hull;
        for (size_t j = 0; j < n; ++j) {
            const size_t i = up ? j : n - 1 - j;
            std::vector<int32_t> added = between[up ? i : i + 1];
            added.insert(added.end(), at_plane[i].begin(), at_plane[i].end());
            hull = hull ? kernel_.unite(hull, added) : kernel_.build(added);
            costs[i] += hull.facet_count() ? hull.volume() : HUGE_VAL;
        }
    }
    for (size_t i = 0; i < n; ++i)
        if (costs[i] < best.cost) best = {{direction, offsets[i]}, costs[i]};
    kernel_.forget(kept);
}

std::array<Piece, 2> Pieces::divided(std::span<const Tetrahedron> tetrahedra, const CutPlane& plane) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Tetrahedron& t : tetrahedra)
        for (const int32_t v : t) {
            const double h = plane.height(kernel_.point(v));
            low = std::min(low, h);
            high = std::max(high, h);
        }
    Sliced sides = slice(tetrahedra, plane, flat * (high - low), kernel_);
    return {piece(std::move(sides.below)), piece(std::move(sides.above))};
}

}  // namespace partwheel::convex
