// The winding number: solid angles of near triangles, dipoles of far nodes.
#include "fill/winding.h"

#include "base/morton.h"
#include "mesh/surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace partwheel {

namespace {

constexpr size_t run = 4;  // children of a node

// A node farther away than this many radii is far: the error of its dipole is a few thousandths of its share.
constexpr double far = 2;

// The angle of the point (x, y), y >= 0, from the x axis, to 2e-8: Abramowitz, Stegun 4.4.49. The standard library's is
// not the same everywhere.
double angle(double x, double y) {
    const double wide = std::fabs(x), least = std::min(wide, y), most = std::max(wide, y);
    if (most == 0) return 0;
    const double r = least / most, s = r * r;
    double a = 0.0028662257;
    for (const double c : {-0.0161657367, 0.0429096138, -0.0752896400, 0.1065626393, -0.1420889944, 0.1999355085,
                           -0.3333314528, 1.0})
        a = a * s + c;
    a *= r;
    if (y > wide) a = std::numbers::pi / 2 - a;
    return x < 0 ? std::numbers::pi - a : a;
}

// The solid angle of a triangle, seen from the origin, below 0 from outside: van Oosterom, Strackee (1983).
double solid_angle(const Point& a, const Point& b, const Point& c) {
    const double x = length(a), y = length(b), z = length(c);
    const double six = dot(a, cross(b, c));
    const double part = x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y;
    const double half = angle(part, std::fabs(six));
    return six < 0 ? -2 * half : 2 * half;
}

}  // namespace

double winding_number(std::span<const Point> vertices, std::span<const Triangle> triangles, const Point& p) {
    double sum = 0;
    for (const Triangle& t : triangles) {
        const auto corner = [&](size_t k) { return vertices[idx(t[k])] - p; };
        sum += solid_angle(corner(0), corner(1), corner(2));
    }
    return sum / (4 * std::numbers::pi);
}

WindingNumber::WindingNumber(std::span<const Point> vertices, std::span<const Triangle> triangles)
    : vertices_(vertices), triangles_(triangles.begin(), triangles.end()) {
    if (triangles.empty()) return;
    const auto point = [&](int32_t v) -> const Point& { return vertices_[idx(v)]; };
    const Frame frame = Frame::around(vertices);
    std::vector<std::pair<uint64_t, Triangle>> order;
    for (const Triangle& t : triangles) {
        const auto [x, y, z] = point(t[0]) + point(t[1]) + point(t[2]);
        order.push_back({morton_code_in_unit_cube(frame.in_cube({x / 3, y / 3, z / 3}), morton_bits - 1), t});
    }
    std::sort(order.begin(), order.end());
    for (size_t t = 0; t < order.size(); ++t) triangles_[t] = order[t].second;

    // A node of a level sums up the centers and dipoles of its children; its ball contains theirs.
    std::vector<double> areas(triangles_.size());
    std::vector<Node> below(triangles_.size());
    for (size_t t = 0; t < below.size(); ++t) {
        const Point &a = point(triangles_[t][0]), &b = point(triangles_[t][1]), &c = point(triangles_[t][2]);
        areas[t] = area(a, b, c);
        below[t].center = (1.0 / 3) * (a + b + c);
        below[t].dipole = 0.5 * cross(b - a, c - a);
        for (const Point* p : {&a, &b, &c}) below[t].radius = std::max(below[t].radius, length(*p - below[t].center));
    }
    levels_.push_back(below);
    while (below.size() > 1) {
        std::vector<Node> level((below.size() + run - 1) / run);
        std::vector<double> whole(level.size(), 0);
        for (size_t i = 0; i < below.size(); ++i) {
            Node& node = level[i / run];
            node.dipole = node.dipole + below[i].dipole;
            node.center = node.center + areas[i] * below[i].center;
            whole[i / run] += areas[i];
        }
        for (size_t n = 0; n < level.size(); ++n)
            level[n].center = whole[n] > 0 ? 1 / whole[n] * level[n].center : below[n * run].center;
        for (size_t i = 0; i < below.size(); ++i) {
            Node& node = level[i / run];
            node.radius = std::max(node.radius, length(below[i].center - node.center) + below[i].radius);
        }
        areas = std::move(whole);
        levels_.push_back(level);
        below = std::move(level);
    }
}

double WindingNumber::at(const Point& p) const {
    return levels_.empty() ? 0 : at(p, levels_.size() - 1, 0) / (4 * std::numbers::pi);
}

size_t WindingNumber::visits(const Point& p) const { return levels_.empty() ? 0 : visits(p, levels_.size() - 1, 0); }

size_t WindingNumber::visits(const Point& p, size_t level, size_t index) const {
    const Node& node = levels_[level][index];
    const Point way = node.center - p;
    const double reach = far * node.radius;
    if (level == 0 || dot(way, way) > reach * reach) return 1;
    size_t count = 1;
    const size_t begin = index * run, end = std::min(begin + run, levels_[level - 1].size());
    for (size_t i = begin; i < end; ++i) count += visits(p, level - 1, i);
    return count;
}

double WindingNumber::at(const Point& p, size_t level, size_t index) const {
    const Node& node = levels_[level][index];
    const Point way = node.center - p;
    const double squared = dot(way, way), reach = far * node.radius;
    if (squared > reach * reach) return dot(way, node.dipole) / (squared * std::sqrt(squared));
    if (level == 0) {
        const auto corner = [&](size_t k) { return vertices_[idx(triangles_[index][k])] - p; };
        return solid_angle(corner(0), corner(1), corner(2));
    }
    double sum = 0;
    const size_t begin = index * run, end = std::min(begin + run, levels_[level - 1].size());
    for (size_t i = begin; i < end; ++i) sum += at(p, level - 1, i);
    return sum;
}

}  // namespace partwheel
