// The index is made: bodies, surface, trees, hulls of the top; and asked about points and rays.
#include "query/part_index.h"

#include "base/error.h"
#include "base/adjacency.h"
#include "hull/hull.h"
#include "convex/distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace partwheel {

using index::Node;
using index::Top;
using index::Tree;

namespace {

// The hierarchy's last merges are undone until there are so many groups; below them the tree is one of boxes alone.
constexpr size_t most_groups = 8;

// By how much rounding may put a box's near side behind its far one.
constexpr double rounding = 1e-12;

// The clusters, which must be a cut of the binary tree, and the merges that join them.
Top top_of(std::span<const Merge> merges, std::span<const int32_t> clusters, std::span<const int32_t> bounds) {
    const size_t leaves = merges.size() + 1;
    Top top{{bounds.begin(), bounds.end()}, {}};
    std::vector<int32_t> number(leaves + merges.size(), -1);
    for (size_t i = 0; i < clusters.size(); ++i) number[idx(clusters[i])] = static_cast<int32_t>(i);
    for (size_t m = 0; m < merges.size(); ++m) {
        const int32_t left = number[idx(merges[m].left)], right = number[idx(merges[m].right)];
        if (left < 0 || right < 0) continue;
        number[leaves + m] = static_cast<int32_t>(clusters.size() + top.joins.size());
        top.joins.push_back({left, right});
    }
    return top;
}

// How many leaves each cluster has.
std::vector<int32_t> sizes(std::span<const Merge> merges) {
    const size_t leaves = merges.size() + 1;
    std::vector<int32_t> size(leaves, 1);
    for (const Merge& m : merges) size.push_back(size[idx(m.left)] + size[idx(m.right)]);
    return size;
}

std::vector<int32_t> bounds_of(std::span<const int32_t> clusters, std::span<const int32_t> size) {
    std::vector<int32_t> bounds = {0};
    for (const int32_t c : clusters) bounds.push_back(bounds.back() + size[idx(c)]);
    return bounds;
}

}  // namespace

PartIndex::PartIndex(const Hierarchy& hierarchy, std::span<const int32_t> bounds, Progress& progress) {
    const std::span<const Merge> merges = hierarchy.merges();
    const std::vector<int32_t> size = sizes(merges);
    if (bounds.empty()) {
        take_tetrahedra(hierarchy);
        progress.reach(0.3);
        const auto groups = cut_undoing_last(merges, std::min(most_groups, hierarchy.tetrahedron_count()));
        plant(top_of(merges, groups, bounds_of(groups, size)), progress);
        return;
    }
    // A cluster is divided if it is more than a part: what is left are the parts, if those are clusters.
    std::vector<int32_t> first(size.size());
    std::iota(first.begin(), first.end(), 0);
    for (size_t m = 0; m < merges.size(); ++m) first[merges.size() + 1 + m] = first[idx(merges[m].left)];
    const auto divided = [&](size_t m) {
        const size_t c = merges.size() + 1 + m;
        const auto part = std::upper_bound(bounds.begin(), bounds.end(), first[c]);
        return part == bounds.end() || first[c] + size[c] > *part;
    };
    const std::vector<int32_t> clusters = cut_tree(merges, divided);
    if (!std::ranges::equal(bounds_of(clusters, size), bounds))
        throw Error(PW_ERROR_ARGUMENT, "The bounds are none of a cut of this hierarchy. Take those of pw_hierarchy_cut_*.");
    take_hulls(hierarchy, bounds, progress);
    std::vector<int32_t> each(clusters.size() + 1);
    std::iota(each.begin(), each.end(), 0);
    plant(top_of(merges, clusters, each), progress);
}

void PartIndex::take_tetrahedra(const Hierarchy& hierarchy) {
    vertices_.assign(hierarchy.vertices().begin(), hierarchy.vertices().end());
    tetrahedra_.assign(hierarchy.tetrahedra().begin(), hierarchy.tetrahedra().end());
    std::vector<convex::OuterFacet> outer = convex::boundary_facets(tetrahedra_);
    std::ranges::stable_sort(outer, {}, &convex::OuterFacet::tetrahedron);
    for (const auto& [corners, tetrahedron] : outer) {
        facets_.push_back(corners);
        body_.push_back(tetrahedron);
    }
    UnionFind joined(vertices_.size());
    for (const Tetrahedron& t : tetrahedra_)
        for (const int32_t v : t) joined.join(idx(t[0]), idx(v));
    std::vector<bool> is_recorded(vertices_.size(), false);
    for (size_t t = 0; t < tetrahedra_.size(); ++t) {
        const size_t piece = joined.find(idx(tetrahedra_[t][0]));
        if (!is_recorded[piece]) pieces_.push_back({tetrahedra_[t][0], static_cast<int32_t>(t)});
        is_recorded[piece] = true;
    }
}

void PartIndex::take_hulls(const Hierarchy& hierarchy, std::span<const int32_t> bounds, Progress& progress) {
    side_begin_.push_back(0);
    for (size_t part = 0; part + 1 < bounds.size(); ++part) {
        const TriangleMesh hull = hierarchy.hull(idx(bounds[part]), idx(bounds[part + 1]));
        progress.reach(0.4 * static_cast<double>(part) / static_cast<double>(bounds.size()));
        const auto before = static_cast<int32_t>(vertices_.size());
        if (!hull.vertices.empty()) pieces_.push_back({before, static_cast<int32_t>(part)});
        vertices_.insert(vertices_.end(), hull.vertices.begin(), hull.vertices.end());
        for (const auto& [a, b, c] : hull.triangles) {
            sides_.push_back({a + before, b + before, c + before});
            body_.push_back(static_cast<int32_t>(part));
        }
        side_begin_.push_back(static_cast<int32_t>(sides_.size()));
    }
    facets_ = sides_;
}

// The trees, from groups of bodies; facets are sorted by their body.
void PartIndex::plant(const Top& top, Progress& progress) {
    frame_ = Frame::around(vertices_);
    working_.reserve(vertices_.size());
    for (const Point& p : vertices_) working_.push_back(frame_.to_working(p));

    std::vector<Box> boxes;
    for (int32_t body = 0; body < top.bounds.back(); ++body) {
        boxes.emplace_back();
        sides_of(body, [&](const Triangle& t) {
            for (const int32_t v : t) boxes.back().add(working_[idx(v)]);
            return true;
        });
    }
    progress.reach(0.45);
    bodies_ = Tree(boxes, top);
    progress.reach(0.6);

    Top of_facets = top;
    for (int32_t& bound : of_facets.bounds)
        bound = static_cast<int32_t>(std::ranges::lower_bound(body_, bound) - body_.begin());
    for (const auto& [a, b, c] : facets_) corners_.push_back({working_[idx(a)], working_[idx(b)], working_[idx(c)]});
    std::vector<std::vector<Point>> extreme(top.groups() + top.joins.size());
    for (size_t i = 0; i < extreme.size(); ++i) {
        progress.reach(0.6 + 0.3 * static_cast<double>(i) / static_cast<double>(extreme.size()));
        std::vector<Point> points;
        if (i < top.groups()) {
            for (auto f = idx(of_facets.bounds[i]); f < idx(of_facets.bounds[i + 1]); ++f)
                points.insert(points.end(), corners_[f].begin(), corners_[f].end());
            std::ranges::sort(points);
            points.erase(std::unique(points.begin(), points.end()), points.end());
        } else {
            for (const int32_t side : top.joins[i - top.groups()])
                points.insert(points.end(), extreme[idx(side)].begin(), extreme[idx(side)].end());
        }
        if (points.size() > 3) points = convex_hull(points).vertices;
        extreme[i] = points;
        clouds_.emplace_back(points);
    }

    boxes.clear();
    for (const std::array<Point, 3>& corners : corners_) boxes.push_back(Box::around(corners));
    if (boxes.empty())
        throw Error(PW_ERROR_NO_VOLUME, "The hulls of these parts have no volume. Take fewer parts, or the tetrahedra.");
    surface_ = Tree(boxes, of_facets);
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

// A ray on its way through the tree.
struct PartIndex::Sent {
    const PartIndex& index;
    Ray ray;
    Point inverse{1 / ray.direction[0], 1 / ray.direction[1], 1 / ray.direction[2]};
    std::array<bool, 3> backwards{std::signbit(ray.direction[0]), std::signbit(ray.direction[1]),
                                  std::signbit(ray.direction[2])};
    RayHit best{-1, std::numeric_limits<double>::infinity()};

    // Infinity if it passes the box.
    double enters(const Node& node, size_t side) const {
        double near = 0, far = best.distance;
        for (size_t k = 0; k < 3; ++k) {
            const double low = node.low[k][side], high = node.high[k][side];
            const double enter = ((backwards[k] ? high : low) - ray.origin[k]) * inverse[k];
            const double leave = ((backwards[k] ? low : high) - ray.origin[k]) * inverse[k];
            near = enter > near ? enter : near;  // 0 x infinity, along a side of the box, is no bound
            far = leave < far ? leave : far;
        }
        return near <= far + rounding * far ? near : std::numeric_limits<double>::infinity();
    }

    void look(int32_t child, int32_t count) {
        if (count > 0) {
            for (auto i = idx(child); i < idx(child + count); ++i) {
                const auto& [a, b, c] = index.corners_[i];
                const double distance = ray.to(a, b, c);
                if (distance >= 0 && std::pair(distance, index.body_[i]) < std::pair(best.distance, best.triangle))
                    best = {index.body_[i], distance};
            }
            return;
        }
        const Node& node = index.surface_.nodes[idx(child)];
        const std::array<double, 2> near = {enters(node, 0), enters(node, 1)};
        const size_t first = near[1] < near[0];
        if (near[first] < std::numeric_limits<double>::infinity()) look(node.child[first], node.count[first]);
        if (near[1 - first] <= best.distance && near[1 - first] < std::numeric_limits<double>::infinity())
            look(node.child[1 - first], node.count[1 - first]);
    }
};

RayHit PartIndex::first(const Point& origin, const Point& direction) const {
    Sent sent{*this, Ray(frame_.to_working(origin), 1 / frame_.scale * direction)};
    if (!surface_.root.empty()) sent.look(surface_.root.child, surface_.root.count);
    return sent.best.triangle < 0 ? RayHit{} : sent.best;
}

// The surface's point that is nearest, in the frame.
struct PartIndex::Sought {
    const PartIndex& index;
    Point p;
    double best = std::numeric_limits<double>::infinity();  // squared
    int32_t body = -1;
    Point point{};

    double squared_to(const Node& node, size_t side) const {
        double sum = 0;
        for (size_t k = 0; k < 3; ++k) {
            const double d = std::max({node.low[k][side] - p[k], 0.0, p[k] - node.high[k][side]});
            sum += d * d;
        }
        return sum;
    }

    void look(int32_t child, int32_t count) {
        if (count > 0) {
            for (auto i = idx(child); i < idx(child + count); ++i) {
                const auto& [a, b, c] = index.corners_[i];
                const Point q = convex::nearest_on_triangle(p, a, b, c);
                const double away = convex::squared(p - q);
                if (body < 0 || std::pair(away, index.body_[i]) < std::pair(best, body))
                    best = away, body = index.body_[i], point = q;
            }
            return;
        }
        const Node& node = index.surface_.nodes[idx(child)];
        const std::array<double, 2> away = {squared_to(node, 0), squared_to(node, 1)};
        const size_t first = away[1] < away[0];
        for (const size_t side : {first, 1 - first})
            if (away[side] <= best) look(node.child[side], node.count[side]);
    }
};

NearestPart PartIndex::nearest(const Point& p) const {
    const int32_t body = locate(p);
    if (body >= 0) return {body, 0, p};
    Sought sought{*this, frame_.to_working(p)};
    if (!surface_.root.empty()) sought.look(surface_.root.child, surface_.root.count);
    return {sought.body, std::sqrt(sought.best) * frame_.scale, frame_.to_caller(sought.point)};
}

}  // namespace partwheel
