// Construction of the index; point location, ray casting and nearest points.
#include "query/part_index.h"

#include "base/corners.h"
#include "base/error.h"
#include "base/adjacency.h"
#include "base/sorted.h"
#include "hull/hull.h"
#include "convex/distance.h"

namespace partwheel {

using index::Node;
using index::TopLevels;
using index::PartBvh;

namespace {

// Support maps exist for this many groups, the parts of the last merges, and for all merges above.
constexpr size_t max_groups = 8;

// Relative error by which rounding may put a box's entry behind its exit.
constexpr double rounding = 1e-12;

// clusters: a cut of the binary tree.
TopLevels make_top(std::span<const Merge> merges, std::span<const int32_t> clusters, std::span<const int32_t> bounds) {
    const size_t leaves = merges.size() + 1;
    TopLevels top{{bounds.begin(), bounds.end()}, {}};
    std::vector<int32_t> number(leaves + merges.size(), -1);
    for (size_t i = 0; i < clusters.size(); ++i) number[idx(clusters[i])] = static_cast<int32_t>(i);
    for (size_t m = 0; m < merges.size(); ++m) {
        const int32_t left = number[idx(merges[m].left)], right = number[idx(merges[m].right)];
        if (left < 0 || right < 0) continue;
        number[leaves + m] = static_cast<int32_t>(clusters.size() + top.merges.size());
        top.merges.push_back({left, right});
    }
    return top;
}

}  // namespace

PartIndex::PartIndex(const Hierarchy& hierarchy, std::span<const int32_t> bounds, Progress& progress) {
    const std::span<const Merge> merges = hierarchy.merges();
    if (bounds.empty()) {
        set_tetrahedra(hierarchy);
        progress.reach(0.3);
        const auto groups = cut_undoing_last(merges, std::min(max_groups, hierarchy.tetrahedron_count()));
        build_trees(make_top(merges, groups, hierarchy.bounds_of(groups)), progress);
        return;
    }
    // Divides each cluster whose children are on both sides of a bound. If the parts are clusters, they remain.
    const auto is_divided = [&](size_t m) { return std::ranges::binary_search(bounds, hierarchy.end_of(merges[m].left)); };
    const std::vector<int32_t> clusters = cut_tree(merges, is_divided);
    if (!std::ranges::equal(hierarchy.bounds_of(clusters), bounds))
        throw Error(PW_ERROR_ARGUMENT,
                    "The bounds are not those of a cut of this hierarchy. Get them from pw_hierarchy_cut_*.");
    set_hulls(hierarchy, bounds, progress);
    build_trees(make_top(merges, clusters, iota(clusters.size() + 1)), progress);  // each is a group of its own
}

void PartIndex::set_tetrahedra(const Hierarchy& hierarchy) {
    vertices_.assign(hierarchy.vertices().begin(), hierarchy.vertices().end());
    tetrahedra_.assign(hierarchy.tetrahedra().begin(), hierarchy.tetrahedra().end());
    std::vector<convex::BoundaryFacet> boundary = convex::boundary_facets(tetrahedra_);
    std::ranges::stable_sort(boundary, {}, &convex::BoundaryFacet::tetrahedron);
    for (const auto& [corners, tetrahedron] : boundary) {
        facets_.push_back(corners);
        body_.push_back(tetrahedron);
    }
    UnionFind sets(vertices_.size());
    for (const Tetrahedron& t : tetrahedra_)
        for (const int32_t v : t) sets.unite(idx(t[0]), idx(v));
    std::vector<bool> is_recorded(vertices_.size(), false);
    for (size_t t = 0; t < tetrahedra_.size(); ++t) {
        const size_t component = sets.find(idx(tetrahedra_[t][0]));
        if (!is_recorded[component]) components_.push_back({tetrahedra_[t][0], static_cast<int32_t>(t)});
        is_recorded[component] = true;
    }
}

void PartIndex::set_hulls(const Hierarchy& hierarchy, std::span<const int32_t> bounds, Progress& progress) {
    side_begin_.push_back(0);
    for (size_t part = 0; part + 1 < bounds.size(); ++part) {
        const TriangleMesh hull = hierarchy.hull(idx(bounds[part]), idx(bounds[part + 1]), progress);
        progress.reach(0.4 * static_cast<double>(part) / static_cast<double>(bounds.size()));
        const auto before = static_cast<int32_t>(vertices_.size());
        if (!hull.vertices.empty()) components_.push_back({before, static_cast<int32_t>(part)});
        vertices_.insert(vertices_.end(), hull.vertices.begin(), hull.vertices.end());
        for (const auto& [a, b, c] : hull.triangles) {
            sides_.push_back({a + before, b + before, c + before});
            body_.push_back(static_cast<int32_t>(part));
        }
        side_begin_.push_back(static_cast<int32_t>(sides_.size()));
    }
    facets_ = sides_;
}

// top: groups of bodies. Facets must be sorted by body.
void PartIndex::build_trees(const TopLevels& top, Progress& progress) {
    frame_ = Frame::around(vertices_);
    working_ = frame_.to_working(vertices_);

    std::vector<Box> boxes;
    for (int32_t body = 0; body < top.bounds.back(); ++body) {
        boxes.emplace_back();
        all_sides(body, [&](const Triangle& t) {
            for (const int32_t v : t) boxes.back().add(working_[idx(v)]);
            return true;
        });
    }
    progress.reach(0.45);
    bodies_ = PartBvh(boxes, top);
    progress.reach(0.6);

    TopLevels facet_top = top;
    for (int32_t& bound : facet_top.bounds)
        bound = static_cast<int32_t>(std::ranges::lower_bound(body_, bound) - body_.begin());
    for (const Triangle& f : facets_) corners_.push_back(corner_points(working_, f));
    std::vector<std::vector<Point>> extreme(top.groups() + top.merges.size());
    for (size_t i = 0; i < extreme.size(); ++i) {
        progress.reach(0.6 + 0.3 * static_cast<double>(i) / static_cast<double>(extreme.size()));
        std::vector<Point> points;
        if (i < top.groups()) {
            for (auto f = idx(facet_top.bounds[i]); f < idx(facet_top.bounds[i + 1]); ++f)
                points.insert(points.end(), corners_[f].begin(), corners_[f].end());
            sort_unique(points);
        } else {
            for (const int32_t side : top.merges[i - top.groups()])
                points.insert(points.end(), extreme[idx(side)].begin(), extreme[idx(side)].end());
        }
        if (points.size() > 3) points = convex_hull(points, progress).vertices;
        extreme[i] = points;
        support_maps_.emplace_back(points);
    }

    boxes.clear();
    for (const std::array<Point, 3>& corners : corners_) boxes.push_back(Box::around(corners));
    if (boxes.empty())
        throw Error(PW_ERROR_NO_VOLUME, "The hulls of these parts have no volume. Use fewer parts, or the tetrahedra.");
    surface_ = PartBvh(boxes, facet_top);
    const auto sort_by = [&](auto& values) {
        auto sorted = values;
        for (size_t i = 0; i < sorted.size(); ++i) sorted[i] = values[idx(surface_.order[i])];
        values = std::move(sorted);
    };
    sort_by(facets_);
    sort_by(corners_);
    sort_by(body_);
}

int32_t PartIndex::locate(const Point& p) const {
    const Point q = frame_.to_working(p);
    return locate(p, {q, q}, false, [this](int32_t v) { return vertices_[idx(v)]; });
}

RayHit PartIndex::first_hit(const Point& origin, const Point& direction) const {
    const Ray ray(frame_.to_working(origin), 1 / frame_.scale * direction);
    const Point inverse{1 / ray.direction[0], 1 / ray.direction[1], 1 / ray.direction[2]};
    const std::array<bool, 3> backwards{std::signbit(ray.direction[0]), std::signbit(ray.direction[1]),
                                        std::signbit(ray.direction[2])};
    RayHit best{-1, std::numeric_limits<double>::max()};
    // The distance at which the ray enters a box; infinity if it misses.
    const auto entry_distance = [&](const Node& node, size_t side) {
        double near = 0, far = best.distance;
        for (size_t k = 0; k < 3; ++k) {
            const double low = node.low[k][side], high = node.high[k][side];
            const double enter = ((backwards[k] ? high : low) - ray.origin[k]) * inverse[k];
            const double leave = ((backwards[k] ? low : high) - ray.origin[k]) * inverse[k];
            near = enter > near ? enter : near;  // false for NaN, of a ray along a side of the box
            far = leave < far ? leave : far;
        }
        return near <= far + rounding * far ? std::min(near, far) : std::numeric_limits<double>::infinity();
    };
    surface_.nearest_first(entry_distance, best.distance, [&](size_t i) {
        const auto& [a, b, c] = corners_[i];
        const double distance = ray.intersect(a, b, c);
        if (distance >= 0 && std::pair(distance, body_[i]) < std::pair(best.distance, best.triangle))
            best = {body_[i], distance};
    });
    return best.triangle < 0 ? RayHit{} : best;
}

NearestPart PartIndex::nearest(const Point& p) const {
    NearestPart best{locate(p), 0, p};
    if (best.part >= 0) return best;
    const Point q = frame_.to_working(p);
    double least = std::numeric_limits<double>::infinity();  // squared, in working coordinates, as what follows
    const auto squared_distance = [&](const Node& node, size_t side) {
        double sum = 0;
        for (size_t k = 0; k < 3; ++k) {
            const double d = std::max({node.low[k][side] - q[k], 0.0, q[k] - node.high[k][side]});
            sum += d * d;
        }
        return sum;
    };
    surface_.nearest_first(squared_distance, least, [&](size_t i) {
        const auto& [a, b, c] = corners_[i];
        const Point near = nearest_on_triangle(q, a, b, c);
        const double distance = squared(q - near);
        if (best.part < 0 || std::pair(distance, body_[i]) < std::pair(least, best.part))
            least = distance, best = {body_[i], 0, near};
    });
    return {best.part, std::sqrt(least) * frame_.scale, frame_.to_caller(best.point)};
}

}  // namespace partwheel
