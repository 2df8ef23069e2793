// Pieces of the solid and their best cut planes.
//
// One side of a plane has the hull of the vertices on that side and of the points where edges cross the plane. As the
// plane sweeps in one direction, the hull below it grows by adding points; a second sweep back gives the hulls above.
// All offsets together cost about two hulls of the piece.
#include "convex/pieces.h"

#include "base/adjacency.h"
#include "base/principal.h"
#include "base/sorted.h"

namespace partwheel::convex {

namespace {

// An even number: a cut through the center, which symmetry favors, is rarely good in the long run.
constexpr int n_offsets = 4;
constexpr size_t n_refined_directions = 2;
constexpr int n_finer_offsets = 2;  // on either side of the best, a third of a step apart
constexpr int n_refinements = 3;
constexpr double first_tilt = 0.1;  // radians; halves with each refinement, as does the shift
constexpr double touch_tolerance = 1e-6;     // of the model's size
constexpr double parallel = 1e-9;
constexpr size_t max_wall_directions = 16;  // per piece, as many as the other directions
constexpr double min_side = 1e-6;         // of a piece's extent, that a wall leaves on either side
constexpr double wall_preference = 1e-6;  // of a piece's cost: a wall that is worse by less is taken
constexpr double min_pair_gain = 1e-5;    // of a piece's cost, for two planes together
// Perturbs the points in a cut plane, relative to the model's size: coplanar points would need exact arithmetic.
// These hulls are only used for their volumes.
constexpr double bulge = 1e-6;
constexpr double jitter = 1e-7;

// Keeps the corners of the 2D convex hull of points in a plane perpendicular to this direction (monotone chain).
void keep_convex_hull(std::vector<Point>& points, const Point& direction) {
    // Projected along the axis closest to the normal.
    size_t axis = 0;
    for (size_t k = 1; k < 3; ++k)
        if (std::fabs(direction[k]) > std::fabs(direction[axis])) axis = k;
    const size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
    if (points.size() < 4) return;
    std::sort(points.begin(), points.end(), [&](const Point& a, const Point& b) {
        return a[x] != b[x] ? a[x] < b[x] : (a[y] != b[y] ? a[y] < b[y] : a[axis] < b[axis]);
    });
    std::vector<Point> hull_corners;
    const auto left = [&](const Point& a, const Point& b, const Point& c) {
        return (b[x] - a[x]) * (c[y] - a[y]) - (b[y] - a[y]) * (c[x] - a[x]) > 0;
    };
    for (int side = 0; side < 2; ++side) {
        const size_t begin = hull_corners.size();
        for (const Point& p : points) {
            while (hull_corners.size() >= begin + 2 &&
                   !left(hull_corners[hull_corners.size() - 2], hull_corners.back(), p))
                hull_corners.pop_back();
            hull_corners.push_back(p);
        }
        hull_corners.pop_back();
        std::reverse(points.begin(), points.end());
    }
    points = std::move(hull_corners);
}

}  // namespace

// Sorts by counting, because most vertices and edges occur several times.
VertexEdgeSet::VertexEdgeSet(std::span<const Tetrahedron> tetrahedra, std::vector<int32_t>& rank) {
    for (const Tetrahedron& t : tetrahedra)
        for (const int32_t v : t) {
            if (idx(v) >= rank.size()) rank.resize(idx(v) + 1, -1);
            if (std::exchange(rank[idx(v)], 0) < 0) vertices.push_back(v);
        }
    std::ranges::sort(vertices);
    for (size_t i = 0; i < vertices.size(); ++i) rank[idx(vertices[i])] = static_cast<int32_t>(i);
    CsrArray<int32_t> ends(vertices.size(), [&](const auto& put) {  // of the edges from each vertex, by rank
        for (const Tetrahedron& t : tetrahedra)
            for (size_t i = 0; i < 4; ++i)
                for (size_t j = i + 1; j < 4; ++j)
                    if (t[i] != t[j]) put(idx(rank[idx(std::min(t[i], t[j]))]), std::max(t[i], t[j]));
    });
    for (size_t i = 0; i < vertices.size(); ++i) {
        const std::span<int32_t> row = ends.row(i);
        std::ranges::sort(row);
        for (auto to = row.begin(), last = std::unique(row.begin(), row.end()); to != last; ++to)
            edges.push_back({vertices[i], *to});
    }
    for (const int32_t v : vertices) rank[idx(v)] = -1;
}

VertexEdgeSet::VertexEdgeSet(const VertexEdgeSet& a, const VertexEdgeSet& b) {
    std::ranges::set_union(a.vertices, b.vertices, std::back_inserter(vertices));
    std::ranges::set_union(a.edges, b.edges, std::back_inserter(edges));
}

ConvexPiece PieceFactory::build_piece(std::vector<Tetrahedron> tetrahedra) {
    VertexEdgeSet mesh(tetrahedra, rank_);
    Hull hull = kernel_.build(mesh.vertices);
    double volume = 0;
    for (const auto& [a, b, c, d] : tetrahedra)
        volume += std::fabs(signed_volume6(kernel_.point(a), kernel_.point(b), kernel_.point(c), kernel_.point(d))) / 6;
    const Box bounds = kernel_.bounds(hull);
    return {std::move(tetrahedra), std::move(mesh), std::move(hull), bounds, volume};
}

ConvexPiece PieceFactory::unite(const ConvexPiece& a, const ConvexPiece& b) {
    std::vector<Tetrahedron> both = a.tetrahedra;
    both.insert(both.end(), b.tetrahedra.begin(), b.tetrahedra.end());
    Hull hull = kernel_.unite(a.hull, b.hull.vertices());
    const Box bounds = kernel_.bounds(hull);
    return {std::move(both), {a.mesh, b.mesh}, std::move(hull), bounds, a.volume + b.volume};
}

double PieceFactory::union_cost(const ConvexPiece& a, const ConvexPiece& b) {
    return kernel_.union_volume(a.hull, b.hull.vertices()).volume;
}

bool PieceFactory::may_touch(const ConvexPiece& a, const ConvexPiece& b) const {
    const auto grown = [](const Box& box) { return Box{box.low, box.high + filled<3>(touch_tolerance)}; };
    return grown(a.bounds).overlaps(grown(b.bounds));
}

std::vector<Point> PieceFactory::find_principal_directions(const VertexEdgeSet& mesh) const {
    std::vector<Point> points;
    for (const int32_t v : mesh.vertices) points.push_back(kernel_.point(v));
    const auto directions = principal_directions(points);
    return {directions.begin(), directions.end()};
}

Division PieceFactory::find_best_division(const ConvexPiece& piece) {
    Division best = find_best_across(piece.mesh, find_directions(piece.mesh));
    for (const Division& wall : evaluate_walls(piece.mesh, walls_))
        if (wall.cost < best.cost + wall_preference * piece.cost()) best = wall;
    return best;
}

std::vector<Point> PieceFactory::find_directions(const VertexEdgeSet& mesh) const {
    std::vector<Point> directions = find_principal_directions(mesh);
    for (size_t i = 0; i < lattice_directions; ++i) directions.push_back(lattice_direction(i));
    return directions;
}

std::vector<Division> PieceFactory::evaluate_walls(const VertexEdgeSet& mesh, std::span<const Plane> walls) {
    std::vector<PlaneStack> stacks;
    for (size_t begin = 0, end = 0; begin < walls.size() && stacks.size() < max_wall_directions; begin = end) {
        PlaneStack stack{walls[begin].normal, {}};
        const auto [low, high] = extent(mesh, stack.normal);
        const double margin = touch_tolerance + min_side * (high - low);
        for (; end < walls.size() && length(walls[end].normal - stack.normal) < parallel; ++end)
            if (walls[end].offset > low + margin && walls[end].offset < high - margin)
                stack.offsets.push_back(walls[end].offset);
        if (!stack.offsets.empty()) stacks.push_back(std::move(stack));
    }
    const auto costs = costs_of_planes(mesh, stacks);
    std::vector<Division> divisions;
    for (size_t i = 0; i < stacks.size(); ++i)
        for (size_t j = 0; j < stacks[i].offsets.size(); ++j)
            divisions.push_back({{stacks[i].normal, stacks[i].offsets[j]}, costs[i][j]});
    return divisions;
}

Division PieceFactory::find_best_pair(const ConvexPiece& piece, const Point& p, const std::function<void()>& tick) {
    const std::vector<Point> directions = find_directions(piece.mesh);
    const size_t point_count = kernel_.point_count();
    Division best, halves;
    double longest = 0;
    for (const Point& d : directions) {
        tick();
        const Point normal = 1 / length(d) * d;
        const auto [low, high] = extent(piece.mesh, normal);
        if (high - low > longest) {
            longest = high - low;
            halves = {{normal, (low + high) / 2}, piece.cost()};
        }
        const Plane plane{normal, dot(normal, p)};
        if (!(low + touch_tolerance < plane.offset && plane.offset < high - touch_tolerance)) continue;
        double sum = 0;
        for (const ConvexPiece& side : divide(piece.tetrahedra, plane)) {
            std::vector<PlaneStack> stacks;
            for (const Point& e : directions) {
                const Point across = 1 / length(e) * e;
                const auto [side_low, side_high] = extent(side.mesh, across);
                const double offset = dot(across, p);
                if (side_low + touch_tolerance < offset && offset < side_high - touch_tolerance)
                    stacks.push_back({across, {offset}});
            }
            double cost = side.cost();
            for (const auto& costs : costs_of_planes(side.mesh, stacks)) cost = std::min(cost, costs[0]);
            sum += cost;
        }
        forget_points(point_count);
        if (sum < best.cost) best = {plane, sum};
    }
    return best.cost < (1 - min_pair_gain) * piece.cost() ? best : halves;
}

Division PieceFactory::find_best_division(const ConvexPiece& a, const ConvexPiece& b) {
    const VertexEdgeSet both(a.mesh, b.mesh);
    std::vector<Point> directions = find_principal_directions(both);
    const Box &x = a.bounds, &y = b.bounds;
    directions.push_back(y.low + y.high - x.low - x.high);
    return find_best_across(both, directions);
}

Division PieceFactory::find_best_across(const VertexEdgeSet& mesh, const std::vector<Point>& directions) {
    struct Direction {
        Division best;
        double step = 0;  // from plane to plane
    };
    std::vector<PlaneStack> stacks;
    std::vector<Direction> evaluated;
    for (const Point& d : directions) {
        const double size = length(d);
        if (!(size > 0)) continue;
        PlaneStack stack{1 / size * d, {}};
        const auto [low, high] = extent(mesh, stack.normal);
        if (!(low < high)) continue;
        const double step = (high - low) / (n_offsets + 1);
        for (int i = 1; i <= n_offsets; ++i) stack.offsets.push_back(low + i * step);
        stacks.push_back(std::move(stack));
        evaluated.push_back({{}, step});
    }
    const std::vector<Division> coarse = evaluate_planes(mesh, stacks);
    for (size_t i = 0; i < evaluated.size(); ++i) evaluated[i].best = coarse[i];
    std::ranges::stable_sort(evaluated, {}, [](const Direction& d) { return d.best.cost; });
    evaluated.resize(std::min(evaluated.size(), n_refined_directions));
    stacks.clear();
    for (const auto& [middle, step] : evaluated) {
        PlaneStack stack{middle.plane.normal, {}};
        for (int i = -n_finer_offsets; i <= n_finer_offsets; ++i)
            if (i != 0) stack.offsets.push_back(middle.plane.offset + i * step / (n_finer_offsets + 1));
        stacks.push_back(std::move(stack));
    }
    const std::vector<Division> fine = evaluate_planes(mesh, stacks);
    Division best;
    for (size_t i = 0; i < fine.size(); ++i)
        for (const Division& division : {evaluated[i].best, fine[i]})
            if (division.cost < best.cost) best = division;
    return best;
}

Division PieceFactory::refine_division(const ConvexPiece& a, const ConvexPiece& b, Division best) {
    const VertexEdgeSet both(a.mesh, b.mesh);
    const auto [low, high] = extent(both, best.plane.normal);
    double shift = (high - low) / (n_offsets + 1) / (n_finer_offsets + 1) / 2, tilt = first_tilt;
    for (int i = 0; i < n_refinements; ++i, shift /= 2, tilt /= 2) {
        const std::optional<Point> middle = cut_center(both, best.plane);
        if (!middle) break;
        const Point n = best.plane.normal;
        const Point across = std::fabs(n[0]) < 0.5 ? cross(n, {1, 0, 0}) : cross(n, {0, 1, 0});
        const Point x = tilt / length(across) * across, y = cross(n, x);
        std::vector<PlaneStack> stacks;
        for (const Point& tilted : {n, n + x, n - x, n + y, n - y}) {
            const Point normal = 1 / length(tilted) * tilted;
            const double offset = dot(normal, *middle);
            stacks.push_back({normal, {offset - shift, offset, offset + shift}});
        }
        for (const Division& division : evaluate_planes(both, stacks))
            if (division.cost < best.cost) best = division;
    }
    return best;
}

// The smallest and largest height along a direction.
std::array<double, 2> PieceFactory::extent(const VertexEdgeSet& mesh, const Point& direction) const {
    std::array<double, 2> range{HUGE_VAL, -HUGE_VAL};
    for (const int32_t v : mesh.vertices) {
        const double h = dot(direction, kernel_.point(v));
        range = {std::min(range[0], h), std::max(range[1], h)};
    }
    return range;
}

// The mean of the points where edges cross the plane.
std::optional<Point> PieceFactory::cut_center(const VertexEdgeSet& mesh, const Plane& plane) const {
    Point sum{};
    size_t count = 0;
    for (const auto& [v, w] : mesh.edges) {
        const Point &p = kernel_.point(v), &q = kernel_.point(w);
        const double h = plane.height(p), k = plane.height(q);
        if ((h < 0) == (k < 0)) continue;
        sum = sum + p + h / (h - k) * (q - p);
        ++count;
    }
    if (count == 0) return std::nullopt;
    return 1 / static_cast<double>(count) * sum;
}

// The best plane of each stack, the first one in a tie.
std::vector<Division> PieceFactory::evaluate_planes(const VertexEdgeSet& mesh, std::span<const PlaneStack> stacks) {
    const auto costs = costs_of_planes(mesh, stacks);
    std::vector<Division> best(stacks.size());
    for (size_t i = 0; i < stacks.size(); ++i)
        for (size_t j = 0; j < costs[i].size(); ++j)
            if (costs[i][j] < best[i].cost) best[i] = {{stacks[i].normal, stacks[i].offsets[j]}, costs[i][j]};
    return best;
}

std::vector<std::vector<double>> PieceFactory::costs_of_planes(const VertexEdgeSet& mesh, std::span<const PlaneStack> stacks) {
    n_sweeps_ += stacks.size();
    std::vector<std::vector<double>> costs(stacks.size());
    threads_.parallel_for_each(stacks.size(), [&](size_t thread, size_t i) {
        sweeps_[thread].copy_points(kernel_);
        costs[i] = sweeps_[thread].costs(mesh, stacks[i]);
    });
    return costs;
}

void PieceFactory::forget_points(size_t count) {
    kernel_.forget(count);
    for (PlaneSweep& sweep : sweeps_) sweep.forget_points(count);
}

std::vector<double> PlaneSweep::costs(const VertexEdgeSet& mesh, const PlaneStack& planes) {
    const auto& [normal, offsets] = planes;
    const size_t n = offsets.size(), point_count = kernel_.point_count();
    heights_.resize(std::max(heights_.size(), point_count));
    bands_.resize(std::max(bands_.size(), n + 1));
    crossings_.resize(std::max(crossings_.size(), n));
    for (std::vector<int32_t>& band : bands_) band.clear();
    for (std::vector<Point>& points : crossings_) points.clear();
    for (const int32_t v : mesh.vertices) {
        Height& height = heights_[idx(v)];
        height = {dot(normal, kernel_.point(v)), 0};
        while (height.band < n && offsets[height.band] < height.value) ++height.band;
        bands_[height.band].push_back(v);
    }
    for (const auto& [a, b] : mesh.edges) {
        const auto [ha, band_a] = heights_[idx(a)];
        const auto [hb, band_b] = heights_[idx(b)];
        for (size_t i = std::min(band_a, band_b), last = std::max(band_a, band_b); i < last; ++i)
            crossings_[i].push_back(kernel_.point(a) +
                                    (offsets[i] - ha) / (hb - ha) * (kernel_.point(b) - kernel_.point(a)));
    }
    std::vector<std::vector<int32_t>> at_plane(n);
    for (size_t i = 0; i < n; ++i) {
        keep_convex_hull(crossings_[i], normal);
        const Box box = Box::around(crossings_[i]);
        const Point middle = 0.5 * (box.low + box.high);
        const double share = bulge / std::max(box.diagonal(), bulge);
        for (const Point& p : crossings_[i])
            at_plane[i].push_back(kernel_.add(p - share * dot(p - middle, p - middle) * normal));
    }
    std::vector<double> costs(n, 0);
    std::vector<int32_t> added;
    for (const bool up : {true, false}) {
        Hull hull;
        for (size_t j = 0; j < n; ++j) {
            const size_t i = up ? j : n - 1 - j;
            added = bands_[up ? i : i + 1];
            added.insert(added.end(), at_plane[i].begin(), at_plane[i].end());
            hull = hull ? kernel_.unite(hull, added) : kernel_.build(added);
            costs[i] += hull.volume();
        }
    }
    kernel_.forget(point_count);
    return costs;
}

std::array<ConvexPiece, 2> PieceFactory::divide(std::vector<Tetrahedron> tetrahedra, const Plane& plane) {
    SliceResult sides = slice(tetrahedra, plane, kernel_, jitter);
    return {build_piece(std::move(sides.below)), build_piece(std::move(sides.above))};
}

}  // namespace partwheel::convex
