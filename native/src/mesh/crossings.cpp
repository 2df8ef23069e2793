// Pairs of triangles that intersect: a tree of bounds against itself, then exact tests.
#include "mesh/crossings.h"

#include "base/adjacency.h"
#include "base/corners.h"
#include "base/error.h"
#include "base/morton.h"
#include "mesh/triangles.h"

namespace partwheel {

namespace {

// The number of steps is quadratic in the worst cases: long triangles side by side, and polygons around one edge most
// of whose triangles share no side with a triangle at that edge.
constexpr size_t max_steps_of_any_mesh = 20000000, max_steps_per_triangle_and_level = 20;

constexpr double usual_steps_per_triangle = 40;  // real surfaces take 20 to 60; only progress bars depend on it
constexpr size_t steps_between_polls = 4096;

// Only fans of more triangles are compared by directions.
constexpr size_t small_fan = 16;

// More than the rounding error of a direction.
constexpr double direction_rounding = 1e-12;

const Box all_directions{{-1, -1, -1}, {1, 1, 1}};

void add_with_margin(Box& box, const Point& p, double margin) {
    const Point reach = filled<3>(margin);
    box.add({p - reach, p + reach});
}

// The directions from a vertex to all points between a and b: an arc on the unit sphere. Its points are within a
// quarter of the square of its chord from the chord.
Box directions_from_vertex(const Point& center, const Point& a, const Point& b) {
    const Point first = 1 / length(a - center) * (a - center), last = 1 / length(b - center) * (b - center);
    const double margin = dot(last - first, last - first) / 4 + direction_rounding;
    if (!std::isfinite(margin)) return all_directions;  // a corner coincides with the center
    Box box;
    add_with_margin(box, first, margin);
    add_with_margin(box, last, margin);
    return box;
}

// The directions from an edge, at right angles to it, to all points between a and b: an arc on a circle.
Box directions_from_edge(const Point& from, const Point& to, const Point& a, const Point& b) {
    const Point edge = to - from;
    std::array<Point, 2> ends;
    double rounding = 0;
    for (size_t k = 0; k < 2; ++k) {
        const Point diagonal = (k == 0 ? a : b) - from, height = diagonal - dot(diagonal, edge) / dot(edge, edge) * edge;
        rounding += direction_rounding * length(diagonal) / length(height);
        ends[k] = 1 / length(height) * height;
    }
    if (!(rounding < 1)) return all_directions;
    const double margin = dot(ends[1] - ends[0], ends[1] - ends[0]) / 4 + 4 * rounding;
    Box box;
    for (const Point& end : ends) add_with_margin(box, end, margin);
    return box;
}

// Whether two triangles intersect anywhere but in shared corners and edges.
bool cross_each_other(std::span<const Point> vertices, Triangle t, Triangle u) {
    size_t shared = 0;  // corners, which go first
    for (size_t i = 0; i < 3; ++i) {
        const auto same = std::find(u.begin() + static_cast<std::ptrdiff_t>(shared), u.end(), t[i]);
        if (same == u.end()) continue;
        std::iter_swap(u.begin() + static_cast<std::ptrdiff_t>(shared), same);
        std::swap(t[i], t[shared++]);
    }
    return shared == 3 || common_point(corner_points(vertices, t), corner_points(vertices, u), shared);
}

}  // namespace

CrossingSearch::CrossingSearch(std::span<const Point> vertices, std::span<const Triangle> triangles)
    : vertices_(vertices), triangles_(triangles), order_(triangles.size()) {
    // A fan's triangles follow each other, by direction; other triangles are sorted by their centroids.
    const std::vector<Center> centers = find_centers();
    std::vector<Node> leaves;
    std::vector<Point> positions, directions;
    for (size_t t = 0; t < triangles.size(); ++t) {
        const auto& [a, b, c] = triangles[t];
        const auto& [v, w] = centers[t];
        const Node& node = leaves.emplace_back(leaf(triangles[t], centers[t]));
        const Point centroid = 1.0 / 3 * (vertices[idx(a)] + vertices[idx(b)] + vertices[idx(c)]);
        positions.push_back(v < 0 ? centroid : vertices[idx(v)]);
        directions.push_back(v < 0 ? Point{} : 0.5 * (node.directions.low + node.directions.high));
    }
    const std::vector<uint64_t> place = morton_codes(positions), direction = morton_codes(directions);
    std::iota(order_.begin(), order_.end(), size_t{0});
    std::ranges::sort(order_, {}, [&](size_t t) { return std::tuple(place[t], centers[t], direction[t], t); });

    std::vector<Node>& lowest = levels_.emplace_back();
    for (const size_t t : order_) lowest.push_back(leaves[t]);
    while (levels_.back().size() > 1) {
        const std::vector<Node>& children = levels_.back();
        std::vector<Node> level;
        for (size_t i = 0; i < children.size(); i += 2) {
            Node& node = level.emplace_back(children[i]);
            if (i + 1 == children.size()) break;
            const Node& other = children[i + 1];
            node.bounds.add(other.bounds);
            node.directions.add(other.directions);
            if (node.center != other.center) node.center = no_center;
        }
        levels_.push_back(std::move(level));
    }
}

// For each triangle, the first that exists: the edge that more than small_fan triangles share; such an edge of an
// adjacent triangle, if one of this triangle's corners lies on it; a vertex that more than small_fan triangles share.
std::vector<CrossingSearch::Center> CrossingSearch::find_centers() const {
    std::vector<size_t> degree(vertices_.size(), 0), largest(triangles_.size(), small_fan);
    std::vector<Center> centers(triangles_.size(), no_center);
    for (const Triangle& t : triangles_)
        for (const int32_t v : t) ++degree[idx(v)];
    for_each_edge(vertices_.size(), triangles_, [&](int32_t, std::span<const Side> sides) {
        for (const Side& side : sides) {
            const size_t t = idx(side.number) / 3, k = idx(side.number) % 3;
            if (sides.size() <= largest[t]) continue;
            const auto [low, high] = std::minmax(triangles_[t][k], triangles_[t][(k + 1) % 3]);
            centers[t] = {low, high};
            largest[t] = sides.size();
        }
    });
    const std::vector<Center> edges = centers;
    for_each_edge(vertices_.size(), triangles_, [&](int32_t, std::span<const Side> sides) {
        if (sides.size() != 2) return;
        const size_t t = idx(sides[0].number) / 3, u = idx(sides[1].number) / 3;
        for (const auto& [from, to] : {std::pair(t, u), std::pair(u, t)})
            if (edges[to] == no_center && std::ranges::find_first_of(triangles_[to], edges[from]) != triangles_[to].end())
                centers[to] = edges[from];
    });
    for (size_t t = 0; t < triangles_.size(); ++t) {
        if (centers[t] != no_center) continue;
        const int32_t v = *std::ranges::max_element(triangles_[t], {}, [&](int32_t corner) { return degree[idx(corner)]; });
        if (degree[idx(v)] > small_fan) centers[t] = {v, -1};
    }
    return centers;
}

CrossingSearch::Node CrossingSearch::leaf(const Triangle& triangle, const Center& center) const {
    Node node;
    node.center = center;
    std::vector<Point> others;
    for (const int32_t v : triangle) {
        const auto& [x, y, z] = vertices_[idx(v)];
        // Rounding is monotone: where triangles intersect, so do their bounds.
        node.bounds.add(std::array{x, y, z, x + y, x - y, x + z, x - z, y + z, y - z});
        if (v != center[0] && v != center[1]) others.push_back(vertices_[idx(v)]);
    }
    if (center == no_center) return node;
    const bool is_edge = center[1] >= 0;
    const Point& origin = vertices_[idx(center[0])];
    if (others.size() != 2 && !(is_edge && others.size() == 1))  // a corner is repeated
        node.directions = all_directions;
    else if (is_edge)
        node.directions = directions_from_edge(origin, vertices_[idx(center[1])], others.front(), others.back());
    else
        node.directions = directions_from_vertex(origin, others[0], others[1]);
    return node;
}

size_t CrossingSearch::max_steps() const {
    return max_steps_of_any_mesh + max_steps_per_triangle_and_level * triangles_.size() * levels_.size();
}

bool CrossingSearch::compare(Place a, Place b, Progress& progress, const Visit& visit) {
    if (++steps_ % steps_between_polls == 0) {
        const double usual_steps = usual_steps_per_triangle * static_cast<double>(triangles_.size());
        progress.advance_by(steps_between_polls / (steps_between_polls + usual_steps));
    }
    if (steps_ > max_steps())
        throw Error(PW_ERROR_SELF_INTERSECTION,
                    "So many triangles are so close to each other that the mesh can't be checked for triangles that pass "
                    "through each other. Decimate or remesh the model, or delete copies of its parts.");
    const Node &one = levels_[a.level][a.index], &other = levels_[b.level][b.index];
    if (!one.bounds.overlaps(other.bounds)) return true;
    if (one.center != no_center && one.center == other.center && !one.directions.overlaps(other.directions)) return true;
    if (a.level == 0 && b.level == 0) return visit(order_[a.index], order_[b.index]);
    if (a.level < b.level) std::swap(a, b);
    for (size_t child = 2 * a.index; child < std::min(levels_[a.level - 1].size(), 2 * a.index + 2); ++child)
        if (!compare({a.level - 1, child}, b, progress, visit)) return false;
    return true;
}

bool CrossingSearch::compare_within(Place place, Progress& progress, const Visit& visit) {
    if (place.level == 0) return true;
    const Place one{place.level - 1, 2 * place.index}, other{place.level - 1, 2 * place.index + 1};
    if (!compare_within(one, progress, visit)) return false;
    if (other.index >= levels_[other.level].size()) return true;
    return compare_within(other, progress, visit) && compare(one, other, progress, visit);
}

void CrossingSearch::for_each_crossing(Progress& progress, const Visit& visit) {
    steps_ = 0;
    if (triangles_.empty()) return;
    compare_within({levels_.size() - 1, 0}, progress, [&](size_t t, size_t u) {
        return !cross_each_other(vertices_, triangles_[t], triangles_[u]) || visit(t, u);
    });
}

}  // namespace partwheel
