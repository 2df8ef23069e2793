// Distances from tetrahedra, and the largest of a surface's by branch and bound.
#include "part/convex/apart.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace partwheel::convex {

namespace {

constexpr size_t leaf = 4;  // tetrahedra

double squared(const Point& p) { return dot(p, p); }

double squared_to_box(const Point& p, const Box& box) {
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) {
        const double d = std::max({box.low[k] - p[k], 0.0, p[k] - box.high[k]});
        sum += d * d;
    }
    return sum;
}

Point nearest_on_segment(const Point& p, const Point& a, const Point& b) {
    const Point along = b - a;
    const double size = squared(along), t = size > 0 ? std::clamp(dot(p - a, along) / size, 0.0, 1.0) : 0;
    return a + t * along;
}

double squared_to_tetrahedron(const Point& p, const std::array<Point, 4>& t) {
    double best = HUGE_VAL;
    for (const auto& [i, j, k] : facet_corners) {
        const Point n = cross(t[j] - t[i], t[k] - t[i]);
        if (dot(p - t[i], n) > 0) best = std::min(best, squared(p - nearest_on_triangle(p, t[i], t[j], t[k])));
    }
    return best == HUGE_VAL ? 0 : best;
}

}  // namespace

Point nearest_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
    const Point n = cross(b - a, c - a);
    const double size = squared(n);
    if (size > 0 && dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
        dot(cross(a - c, p - c), n) >= 0)
        return p - dot(p - a, n) / size * n;
    Point best = nearest_on_segment(p, a, b);
    for (const Point& q : {nearest_on_segment(p, b, c), nearest_on_segment(p, c, a)})
        if (squared(p - q) < squared(p - best)) best = q;
    return best;
}

Distances::Distances(std::span<const Point> points, std::span<const Tetrahedron> tetrahedra)
    : points_(points), tetrahedra_(tetrahedra) {
    bound(0, 0, tetrahedra.size());
}

void Distances::bound(size_t node, size_t first, size_t last) {
    if (boxes_.size() <= node) boxes_.resize(node + 1);
    Box box;
    if (last - first <= leaf) {
        for (const Tetrahedron& t : tetrahedra_.subspan(first, last - first))
            for (const int32_t v : t) box.add(points_[at(v)]);
    } else {
        const size_t middle = first + (last - first) / 2;
        bound(2 * node + 1, first, middle);
        bound(2 * node + 2, middle, last);
        for (const size_t half : {2 * node + 1, 2 * node + 2}) {
            box.add(boxes_[half].low);
            box.add(boxes_[half].high);
        }
    }
    boxes_[node] = box;
}

// best and enough are squares.
void Distances::nearest(size_t node, size_t first, size_t last, const Point& p, double enough, double& best) const {
    if (last - first <= leaf) {
        for (const auto& [a, b, c, d] : tetrahedra_.subspan(first, last - first))
            best = std::min(best, squared_to_tetrahedron(p, {points_[at(a)], points_[at(b)], points_[at(c)],
                                                             points_[at(d)]}));
        return;
    }
    const size_t middle = first + (last - first) / 2;
    const double below = squared_to_box(p, boxes_[2 * node + 1]), above = squared_to_box(p, boxes_[2 * node + 2]);
    for (const bool second : {below > above, below <= above})
        if (best > enough && (second ? above : below) < best) {
            if (second)
                nearest(2 * node + 2, middle, last, p, enough, best);
            else
                nearest(2 * node + 1, first, middle, p, enough, best);
        }
}

double Distances::distance(const Point& p, double enough) const {
    double best = HUGE_VAL;
    nearest(0, 0, tetrahedra_.size(), p, std::max(enough, 0.0) * std::max(enough, 0.0), best);
    return std::sqrt(best);
}

double Distances::farthest(const TriangleMesh& surface, double slack, double enough) const {
    struct Area {
        double most;  // no point of it is farther away
        std::array<Point, 3> corners;
        bool operator<(const Area& other) const { return most < other.most; }
    };
    std::priority_queue<Area> areas;
    double least = 0, settled = 0;  // some point is as far away as the one; those not among the areas no more than the other
    const auto in_doubt = [&] { return std::max(least + slack, enough); };
    const auto add = [&](const std::array<Point, 3>& corners) {
        const auto& [a, b, c] = corners;
        const Point middle = 1.0 / 3 * (a + b + c);
        const double reach = std::sqrt(std::max({squared(a - middle), squared(b - middle), squared(c - middle)}));
        const double limit = in_doubt(), away = distance(middle, limit - reach);
        if (away + reach <= limit) {
            settled = std::max(settled, away + reach);
        } else {
            least = std::max(least, away);
            areas.push({away + reach, corners});
        }
    };
    // The large ones first, so that small ones matter less. No point of a triangle is farther from a corner than the
    // longest side by the root of three.
    std::vector<std::pair<double, Triangle>> by_size;
    for (const Triangle& t : surface.triangles) {
        double longest = 0;
        for (size_t k = 0; k < 3; ++k)
            longest = std::max(longest, squared(surface.vertices[at(t[k])] - surface.vertices[at(t[(k + 1) % 3])]));
        by_size.push_back({std::sqrt(longest / 3), t});
    }
    std::ranges::sort(by_size, std::greater{});
    std::vector<double> of_vertex(surface.vertices.size(), -1);
    for (const auto& [reach, t] : by_size) {
        if (least > enough && std::isfinite(enough)) return least;
        double farthest_corner = 0;
        for (const int32_t v : t) {
            if (of_vertex[at(v)] < 0) of_vertex[at(v)] = distance(surface.vertices[at(v)], in_doubt() / 2);
            farthest_corner = std::max(farthest_corner, of_vertex[at(v)]);
        }
        if (farthest_corner + reach <= in_doubt())
            settled = std::max(settled, farthest_corner + reach);
        else
            add({surface.vertices[at(t[0])], surface.vertices[at(t[1])], surface.vertices[at(t[2])]});
    }
    while (!areas.empty()) {
        const auto [most, corners] = areas.top();
        if (most <= in_doubt()) return std::max(most, settled);
        if (least > enough && std::isfinite(enough)) return least;
        areas.pop();
        // Halved across the longest side.
        size_t k = 0;
        const auto side = [&](size_t i) { return squared(corners[(i + 1) % 3] - corners[i]); };
        for (size_t i = 1; i < 3; ++i)
            if (side(i) > side(k)) k = i;
        const Point &a = corners[k], &b = corners[(k + 1) % 3], &c = corners[(k + 2) % 3];
        const Point middle = 0.5 * (a + b);
        add({a, middle, c});
        add({middle, b, c});
    }
    return settled;
}

}  // namespace partwheel::convex
