// The surface's folds; and the parts measured: volumes, areas, hulls, and what lies between them, inside and on the surface.
#include "parts/merge/parts.h"

#include "base/adjacency.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace partwheel {

namespace {

constexpr double concave_bend = 0.02;
constexpr double sharp_bend = 0.2;
constexpr double middling_curvature = 4;  // of a model of unit area: squashed to a half
constexpr int smoothing_passes = 4, wide_passes = 24;

}  // namespace

std::vector<SurfaceEdge> surface_edges(const TetMesh& mesh) {
    const double length_unit = Frame::around(mesh.vertices).longest, area_unit = length_unit * length_unit;
    const auto point = [&](int32_t v) -> const Point& { return mesh.vertices[idx(v)]; };
    std::vector<Triangle> outer;
    std::vector<int32_t> behind;
    std::vector<Point> normals;
    std::vector<double> curvature(mesh.vertices.size(), 0), around(mesh.vertices.size(), 0);
    double whole = 0;
    for (size_t t = 0; t < mesh.tetrahedra.size(); ++t)
        for (size_t k = 0; k < 4; ++k) {
            if (mesh.neighbors[t][k] >= 0) continue;
            const Triangle f = facet(mesh.tetrahedra[t], k);
            Point n = cross(point(f[1]) - point(f[0]), point(f[2]) - point(f[0]));
            const double twice = length(n), size = twice / 2 / area_unit;
            if (twice > 0)
                for (double& x : n) x /= twice;
            outer.push_back(f);
            behind.push_back(static_cast<int32_t>(t));
            normals.push_back(n);
            whole += size;
            for (const int32_t v : f) around[idx(v)] += size / 3;
        }
    struct Edge {
        int32_t low, high;
        double length, bend;  // bend: the sine of half the angle, below 0 where concave
    };
    std::vector<Edge> edges;
    std::vector<SurfaceEdge> folds;  // of the same edges
    for_each_edge(mesh.vertices.size(), outer, [&](int32_t low, std::span<const Side> sides) {
        for (size_t i = 0; i + 1 < sides.size(); i += 2) {
            const int32_t high = sides[i].high, s = sides[i].number / 3, t = sides[i + 1].number / 3;
            const Point &m = normals[idx(s)], &n = normals[idx(t)];
            const Point along = point(high) - point(low);
            const double turn = dot(cross(m, n), along) * (sides[i].upwards ? 1 : -1);
            const double bend = partwheel::length(n - m) / 2 * (turn < 0 ? -1 : 1);
            edges.push_back({low, high, partwheel::length(along) / length_unit, bend});
            folds.push_back({behind[idx(s)], behind[idx(t)], {}});
        }
    });
    // Mean curvature, smoothed over the surface: it finds creases that many small edges share. Only the quotient
    // matters, so both sums may grow with each pass.
    for (const Edge& e : edges)
        for (const int32_t v : {e.low, e.high}) curvature[idx(v)] += e.length * e.bend / 2;
    const double unit = std::sqrt(whole);
    const auto smoothed = [&](int more_passes) {
        for (int pass = 0; pass < more_passes; ++pass) {
            std::vector<double> c = curvature, r = around;
            for (const Edge& e : edges) {
                const auto i = idx(e.low), j = idx(e.high);
                c[i] += curvature[j];
                c[j] += curvature[i];
                r[i] += around[j];
                r[j] += around[i];
            }
            curvature.swap(c);
            around.swap(r);
        }
        std::vector<double> h(curvature.size(), 0);
        for (size_t i = 0; i < h.size(); ++i)
            if (around[i] > 0) h[i] = curvature[i] / around[i] * unit;
        return h;
    };
    const std::vector<double> curved = smoothed(smoothing_passes), widely = smoothed(wide_passes - smoothing_passes);
    for (size_t i = 0; i < edges.size(); ++i) {
        const Edge& e = edges[i];
        const auto squashed = [&](const std::vector<double>& of) {
            const double h = (of[idx(e.low)] + of[idx(e.high)]) / 2;
            return h / (middling_curvature + std::abs(h));
        };
        const auto length_if = [&](bool it_is) { return it_is ? e.length : 0; };
        folds[i].border = {.length = e.length,
                           .crease = e.length * e.bend,
                           .sharpness = e.length * std::abs(e.bend),
                           .concave = length_if(e.bend < -concave_bend),
                           .ridge = length_if(e.bend > sharp_bend),
                           .valley = length_if(e.bend < -sharp_bend),
                           .curvature = e.length * squashed(curved),
                           .wide = e.length * squashed(widely)};
    }
    return folds;
}

Parts compute_part_features(const TetMesh& mesh, std::span<const SurfaceEdge> folds, std::span<const int32_t> part_of, size_t count,
                    double hull_volume, std::vector<Hull> hulls, HullKernel& kernel, Progress& progress) {
    const double length_unit = Frame::around(mesh.vertices).longest, area_unit = length_unit * length_unit;
    Parts parts;
    parts.all.resize(count);
    parts.fine = count;
    parts.volume_unit = area_unit * length_unit;
    const auto point = [&](int32_t v) -> const Point& { return mesh.vertices[idx(v)]; };

    struct Between {
        int32_t a, b;
        bool facet;
        Border border;
    };
    std::vector<Between> between;
    std::vector<std::vector<int32_t>> corners(count);
    std::vector<int32_t> taken_by(mesh.vertices.size(), -1);  // of each vertex, the part seen last
    for (size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        const Tetrahedron& tet = mesh.tetrahedra[t];
        const int32_t p = part_of[t];
        std::vector<int32_t>& mine = corners[idx(p)];
        if (mine.empty()) parts[p].low = static_cast<int32_t>(t);
        for (const int32_t v : tet)
            if (std::exchange(taken_by[idx(v)], p) != p) mine.push_back(v);
        const double six = signed_volume6(point(tet[0]), point(tet[1]), point(tet[2]), point(tet[3]));
        parts[p].volume += six / 6 / parts.volume_unit;
        for (size_t k = 0; k < 4; ++k) {
            const int32_t other = mesh.neighbors[t][k];
            const int32_t q = other < 0 ? -1 : part_of[idx(other)];
            if (other >= 0 && q <= p) continue;
            const auto [a, b, c] = facet(tet, k);
            const double size = area(point(a), point(b), point(c)) / area_unit;
            if (other >= 0)
                between.push_back({p, q, true, {.interface = size}});
            else
                parts[p].area += size;
        }
    }
    progress.advance(0.1);
    for (size_t p = 0; p < count; ++p) {
        Part& part = parts.all[p];
        part.volume = std::max(0.0, part.volume);
        part.hull = hulls.empty() ? kernel.build(corners[p]) : std::move(hulls[p]);
        part.hull_volume = part.hull.volume() / parts.volume_unit;
        part.take_logs();
        parts.whole.volume += part.volume;
        parts.whole.area += part.area;
        if (p % 16 == 0) progress.advance(0.1);
    }
    parts.whole.take_logs();
    parts.whole.hull_volume = hull_volume / parts.volume_unit;

    for (const auto& [one, other, border] : folds) {
        const auto [p, q] = std::minmax(part_of[idx(one)], part_of[idx(other)]);
        if (p != q) between.push_back({p, q, false, border});
    }
    std::stable_sort(between.begin(), between.end(), [](const Between& x, const Between& y) {
        return std::pair(x.a, x.b) < std::pair(y.a, y.b);
    });
    for (size_t i = 0; i < between.size();) {
        Pair pair{between[i].a, between[i].b, {}};
        bool facet_shared = false;
        for (; i < between.size() && between[i].a == pair.a && between[i].b == pair.b; ++i) {
            pair.border += between[i].border;
            facet_shared |= between[i].facet;
        }
        if (!facet_shared) continue;  // they only touch along an edge
        for (const int32_t p : {pair.a, pair.b}) {
            parts[p].rim += pair.border;
            parts[p].pairs.push_back(static_cast<int32_t>(parts.pairs.size()));
        }
        parts.pairs.push_back(pair);
    }
    return parts;
}

}  // namespace partwheel
