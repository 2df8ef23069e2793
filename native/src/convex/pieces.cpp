// Pieces of the solid and the planes that divide them best.
//
// A hull needs points alone: what a plane leaves of a piece has the hull of the vertices on that side and of the points
// where edges cross. The hulls below planes that go up in one direction grow, so a sweep adds to one hull; another one
// comes down. That costs about as much as two hulls of the piece, for all places of the plane.
#include "convex/pieces.h"

#include "convex/principal.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace partwheel::convex {

namespace {

// An even number: what is best in the middle, by symmetry, is seldom good for long.
constexpr int places = 4;
constexpr size_t finer_directions = 2;
constexpr int finer_places = 2;  // on either side, each a third of the way to the next
constexpr int refinements = 3;
constexpr double first_tilt = 0.1;  // in radians; half as much in each refinement, as the way that the plane is shifted by
constexpr double gap = 1e-6;     // boxes that are nearer may touch
// Points of a plane are moved off it by so much, relative to the model, lest it takes exact arithmetic to see that they
// are in one plane. These hulls are only measured.
constexpr double bulge = 1e-6;
constexpr double jitter = 1e-7;

std::array<Edge, 6> edges_of(const Tetrahedron& t) {
    std::array<Edge, 6> edges;
    size_t n = 0;
    for (size_t i = 0; i < 4; ++i)
        for (size_t j = i + 1; j < 4; ++j) edges[n++] = {std::min(t[i], t[j]), std::max(t[i], t[j])};
    return edges;
}

template <class T>
void each_once(std::vector<T>& items) {
    std::sort(items.begin(), items.end());
    items.erase(std::unique(items.begin(), items.end()), items.end());
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

Outline::Outline(std::span<const Tetrahedron> tetrahedra) {
    vertices.reserve(4 * tetrahedra.size());
    edges.reserve(6 * tetrahedra.size());
    for (const Tetrahedron& t : tetrahedra) {
        vertices.insert(vertices.end(), t.begin(), t.end());
        for (const Edge& e : edges_of(t))
            if (e[0] != e[1]) edges.push_back(e);
    }
    each_once(vertices);
    each_once(edges);
}

Outline::Outline(const Outline& a, const Outline& b) {
    std::ranges::set_union(a.vertices, b.vertices, std::back_inserter(vertices));
    std::ranges::set_union(a.edges, b.edges, std::back_inserter(edges));
}

Piece Pieces::piece(std::vector<Tetrahedron> tetrahedra) {
    Outline outline(tetrahedra);
    Hull hull = kernel_.build(outline.vertices);
    double solid = 0;
    for (const auto& [a, b, c, d] : tetrahedra)
        solid += std::fabs(signed_volume6(kernel_.point(a), kernel_.point(b), kernel_.point(c), kernel_.point(d))) / 6;
    return {std::move(tetrahedra), std::move(outline), std::move(hull), solid};
}

Piece Pieces::joined(const Piece& a, const Piece& b) {
    std::vector<Tetrahedron> both = a.tetrahedra;
    both.insert(both.end(), b.tetrahedra.begin(), b.tetrahedra.end());
    return {std::move(both), {a.outline, b.outline}, kernel_.unite(a.hull, b.hull.vertices()), a.solid + b.solid};
}

double Pieces::joined_cost(const Piece& a, const Piece& b) {
    return kernel_.union_volume(a.hull, b.hull.vertices()).volume;
}

bool Pieces::touch(const Piece& a, const Piece& b) const {
    const Box x = kernel_.bounds(a.hull), y = kernel_.bounds(b.hull);
    for (size_t k = 0; k < 3; ++k)
        if (x.low[k] > y.high[k] + gap || y.low[k] > x.high[k] + gap) return false;
    return true;
}

std::vector<Point> Pieces::principal(const Outline& outline) const {
    std::vector<Point> points;
    for (const int32_t v : outline.vertices) points.push_back(kernel_.point(v));
    const auto found = principal_directions(points);
    return {found.begin(), found.end()};
}

Division Pieces::best_division(const Piece& piece) {
    std::vector<Point> directions = principal(piece.outline);
    for (size_t i = 0; i < lattice_directions; ++i) directions.push_back(lattice_direction(i));
    return best_across(piece.outline, std::move(directions));
}

Division Pieces::best_division(const Piece& a, const Piece& b) {
    const Outline both(a.outline, b.outline);
    std::vector<Point> directions = principal(both);
    const Box x = kernel_.bounds(a.hull), y = kernel_.bounds(b.hull);
    directions.push_back(y.low + y.high - x.low - x.high);
    return best_across(both, std::move(directions));
}

Division Pieces::best_across(const Outline& outline, std::vector<Point> directions) {
    struct Sweep {
        Division best;
        double step = 0;
    };
    std::vector<Sweep> sweeps;
    std::vector<double> offsets;
    for (const Point& d : directions) {
        const double size = length(d);
        if (!(size > 0)) continue;
        const Point along = 1 / size * d;
        const auto [low, high] = span(outline, along);
        if (!(low < high)) continue;
        Sweep sweep;
        sweep.step = (high - low) / (places + 1);
        offsets.clear();
        for (int i = 1; i <= places; ++i) offsets.push_back(low + i * sweep.step);
        try_planes(outline, along, offsets, sweep.best);
        sweeps.push_back(sweep);
    }
    std::ranges::stable_sort(sweeps, {}, [](const Sweep& s) { return s.best.cost; });
    sweeps.resize(std::min(sweeps.size(), finer_directions));
    Division best;
    for (Sweep& sweep : sweeps) {
        const auto [normal, middle] = sweep.best.plane;
        offsets.clear();
        for (int i = -finer_places; i <= finer_places; ++i)
            if (i != 0) offsets.push_back(middle + i * sweep.step / (finer_places + 1));
        try_planes(outline, normal, offsets, sweep.best);
        if (sweep.best.cost < best.cost) best = sweep.best;
    }
    return best;
}

Division Pieces::refined(const Piece& a, const Piece& b, Division best) {
    const Outline both(a.outline, b.outline);
    const auto [low, high] = span(both, best.plane.normal);
    double shift = (high - low) / (places + 1) / (finer_places + 1) / 2, tilt = first_tilt;
    for (int i = 0; i < refinements; ++i, shift /= 2, tilt /= 2) {
        const std::optional<Point> middle = middle_of_cut(both, best.plane);
        if (!middle) break;
        const Point n = best.plane.normal;
        const Point across = std::fabs(n[0]) < 0.5 ? cross(n, {1, 0, 0}) : cross(n, {0, 1, 0});
        const Point x = tilt / length(across) * across, y = cross(n, x);
        for (const Point& tilted : {n, n + x, n - x, n + y, n - y}) {
            const Point normal = 1 / length(tilted) * tilted;
            const double offset = dot(normal, *middle);
            try_planes(both, normal, std::array{offset - shift, offset, offset + shift}, best);
        }
    }
    return best;
}

// From where to where the vertices are, along a direction.
std::array<double, 2> Pieces::span(const Outline& outline, const Point& direction) const {
    std::array<double, 2> found{HUGE_VAL, -HUGE_VAL};
    for (const int32_t v : outline.vertices) {
        const double h = dot(direction, kernel_.point(v));
        found = {std::min(found[0], h), std::max(found[1], h)};
    }
    return found;
}

// The mean of where edges cross a plane.
std::optional<Point> Pieces::middle_of_cut(const Outline& outline, const CutPlane& plane) const {
    Point sum{};
    size_t count = 0;
    for (const auto& [v, w] : outline.edges) {
        const Point &p = kernel_.point(v), &q = kernel_.point(w);
        const double h = plane.height(p), k = plane.height(q);
        if ((h < 0) == (k < 0)) continue;
        sum = sum + p + h / (h - k) * (q - p);
        ++count;
    }
    if (count == 0) return std::nullopt;
    return 1 / static_cast<double>(count) * sum;
}

// offsets: rising. direction: of length 1.
void Pieces::try_planes(const Outline& outline, const Point& direction, std::span<const double> offsets, Division& best) {
    const size_t n = offsets.size(), kept = kernel_.point_count();
    heights_.resize(std::max(heights_.size(), kept));
    // Between which planes each vertex is; and where edges cross each plane.
    std::vector<std::vector<int32_t>> between(n + 1);
    std::vector<std::vector<Point>> crossings(n);
    const auto band = [&](double h) {
        size_t i = 0;
        while (i < n && offsets[i] < h) ++i;
        return i;
    };
    for (const int32_t v : outline.vertices) {
        heights_[idx(v)] = dot(direction, kernel_.point(v));
        between[band(heights_[idx(v)])].push_back(v);
    }
    for (const auto& [a, b] : outline.edges) {
        const double ha = heights_[idx(a)], hb = heights_[idx(b)];
        const size_t last = band(std::max(ha, hb));
        for (size_t i = band(std::min(ha, hb)); i < last; ++i)
            crossings[i].push_back(kernel_.point(a) +
                                   (offsets[i] - ha) / (hb - ha) * (kernel_.point(b) - kernel_.point(a)));
    }
    std::vector<std::vector<int32_t>> at_plane(n);
    for (size_t i = 0; i < n; ++i) {
        keep_extreme(crossings[i], direction);
        const Box box = Box::around(crossings[i]);
        const Point middle = 0.5 * (box.low + box.high);
        const double share = bulge / std::max(box.diagonal(), bulge);
        for (const Point& p : crossings[i])
            at_plane[i].push_back(kernel_.add(p - share * dot(p - middle, p - middle) * direction));
    }
    std::vector<double> costs(n, 0);
    for (const bool up : {true, false}) {
        Hull hull;
        for (size_t j = 0; j < n; ++j) {
            const size_t i = up ? j : n - 1 - j;
            std::vector<int32_t> added = between[up ? i : i + 1];
            added.insert(added.end(), at_plane[i].begin(), at_plane[i].end());
            hull = hull ? kernel_.unite(hull, added) : kernel_.build(added);
            costs[i] += hull.volume();
        }
    }
    for (size_t i = 0; i < n; ++i)
        if (costs[i] < best.cost) best = {{direction, offsets[i]}, costs[i]};
    kernel_.forget(kept);
}

std::array<Piece, 2> Pieces::divided(std::vector<Tetrahedron> tetrahedra, const CutPlane& plane) {
    Sliced sides = slice(tetrahedra, plane, kernel_, jitter);
    return {piece(std::move(sides.below)), piece(std::move(sides.above))};
}

}  // namespace partwheel::convex
