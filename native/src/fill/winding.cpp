// The winding number: solid angles of near triangles, dipoles of far nodes.
//
// A run of a fan's triangles is replaced by one triangle, from the apex to the two ends of the run's rim, and a dipole
// for the strip between the rim and that triangle's outer edge. Only points in between would see the difference.
#include "fill/winding.h"

#include "base/morton.h"
#include "mesh/surface.h"

#include <numbers>

namespace partwheel {

namespace {

constexpr size_t run_bits = 2, run = 1 << run_bits;  // children of a node

// A node farther away than this many radii is far: the error of its dipole is a few thousandths of its share.
constexpr double far = 2;

// A fan is a row of at least min_row triangles around a vertex with more than min_degree triangles.
constexpr size_t min_degree = 256, min_row = 16;

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

WindingNumber::WindingNumber(std::span<const Point> vertices, std::span<const Triangle> triangles) : vertices_(vertices) {
    if (triangles.empty()) return;
    const Frame frame = Frame::around(vertices);
    std::vector<std::pair<uint64_t, Triangle>> order;
    for (const Triangle& item : find_fans(triangles)) {
        Point middle;
        if (item[0] < 0) {
            double area = 0;
            middle = leaf(item, area).center;
        } else {
            const auto [x, y, z] = vertices_[idx(item[0])] + vertices_[idx(item[1])] + vertices_[idx(item[2])];
            middle = {x / 3, y / 3, z / 3};
        }
        order.push_back({morton_code_in_unit_cube(frame.in_cube(middle), morton_bits - 1), item});
    }
    std::sort(order.begin(), order.end());
    std::vector<double> areas(order.size());
    std::vector<Node>& leaves = levels_.emplace_back();
    for (size_t i = 0; i < order.size(); ++i) {
        items_.push_back(order[i].second);
        leaves.push_back(leaf(items_[i], areas[i]));
    }
    complete(levels_, std::move(areas));
}

// Adds the upper levels. A node sums up the centers and dipoles of its children; its ball contains theirs.
void WindingNumber::complete(Levels& levels, std::vector<double> areas) {
    while (levels.back().size() > 1) {
        const std::vector<Node>& below = levels.back();
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
        levels.push_back(std::move(level));
    }
}

// Moves fans to fans_. Returns the items: the other triangles as they are, and the fans.
std::vector<Triangle> WindingNumber::find_fans(std::span<const Triangle> triangles) {
    std::vector<size_t> degree(vertices_.size(), 0);
    for (const Triangle& t : triangles)
        for (const int32_t v : t) ++degree[idx(v)];
    std::vector<Triangle> items, around;  // around: {apex, from, to}
    for (Triangle t : triangles) {
        const auto apex = std::ranges::max_element(t, {}, [&](int32_t v) { return degree[idx(v)]; });
        const bool is_in_fan = degree[idx(*apex)] > min_degree;
        if (is_in_fan) std::rotate(t.begin(), apex, t.end());
        (is_in_fan ? around : items).push_back(t);
    }
    std::ranges::sort(around);
    std::vector<std::pair<int32_t, int32_t>> ends;  // apex, to
    for (const auto& [apex, from, to] : around) ends.emplace_back(apex, to);
    std::ranges::sort(ends);
    std::vector<bool> is_used(around.size(), false);
    const auto follow = [&](size_t t) {  // from triangle t on
        std::vector<size_t> row;
        while (t < around.size() && !is_used[t]) {
            is_used[t] = true;
            row.push_back(t);
            const auto [apex, from, to] = around[t];
            t = static_cast<size_t>(std::ranges::lower_bound(around, Triangle{apex, to, 0}) - around.begin());
            if (t < around.size() && (around[t][0] != apex || around[t][1] != to)) return row;
        }
        return row;
    };
    for (const bool is_in_circle : {false, true})  // rows that have a first triangle, then the others
        for (size_t t = 0; t < around.size(); ++t) {
            const auto& [apex, from, to] = around[t];
            if (is_used[t] || (!is_in_circle && std::ranges::binary_search(ends, std::pair(apex, from)))) continue;
            const std::vector<size_t> row = follow(t);
            if (row.size() < min_row) {
                for (const size_t i : row) items.push_back(around[i]);
                continue;
            }
            std::vector<int32_t> rim{from};
            for (const size_t i : row) rim.push_back(around[i][2]);
            items.push_back({-1 - static_cast<int32_t>(fans_.size()), 0, 0});
            add_fan(apex, rim);
        }
    return items;
}

void WindingNumber::add_fan(int32_t apex, std::span<const int32_t> rim) {
    Fan& fan = fans_.emplace_back();
    fan.apex = vertices_[idx(apex)];
    for (const int32_t v : rim) fan.rim.push_back(vertices_[idx(v)]);
    const auto dipole = [&](size_t from, size_t to) { return 0.5 * cross(fan.rim[from] - fan.apex, fan.rim[to] - fan.apex); };
    std::vector<Node>& leaves = fan.levels.emplace_back();
    for (size_t t = 0; t + 1 < fan.rim.size(); ++t) {
        const Point side = fan.rim[t + 1] - fan.rim[t];
        leaves.push_back({fan.rim[t] + 0.5 * side, dipole(t, t + 1), length(side) / 2});
    }
    complete(fan.levels, std::vector<double>(leaves.size(), 1));
    for (size_t level = 0, count = 1; level < fan.levels.size(); ++level, count *= run)
        for (size_t n = 0; n < fan.levels[level].size(); ++n) {
            Point& sum = fan.levels[level][n].dipole;
            sum = sum - dipole(n * count, std::min((n + 1) * count, fan.rim.size() - 1));
        }
}

// area: of the item.
WindingNumber::Node WindingNumber::leaf(const Triangle& item, double& area) const {
    Node node;
    area = 0;
    if (item[0] >= 0) {
        const Point &a = vertices_[idx(item[0])], &b = vertices_[idx(item[1])], &c = vertices_[idx(item[2])];
        area = partwheel::area(a, b, c);
        node.center = (1.0 / 3) * (a + b + c);
        node.dipole = 0.5 * cross(b - a, c - a);
        for (const Point* p : {&a, &b, &c}) node.radius = std::max(node.radius, length(*p - node.center));
        return node;
    }
    const Fan& fan = fans_[idx(-1 - item[0])];
    for (size_t t = 0; t + 1 < fan.rim.size(); ++t) {
        const Point &b = fan.rim[t], &c = fan.rim[t + 1];
        const double size = partwheel::area(fan.apex, b, c);
        area += size;
        node.center = node.center + size / 3 * (fan.apex + b + c);
        node.dipole = node.dipole + 0.5 * cross(b - fan.apex, c - fan.apex);
    }
    node.center = area > 0 ? 1 / area * node.center : fan.apex;
    node.radius = length(fan.apex - node.center);
    for (const Point& p : fan.rim) node.radius = std::max(node.radius, length(p - node.center));
    return node;
}

double WindingNumber::at(const Point& p) const {
    size_t visits = 0;
    return levels_.empty() ? 0 : at(p, levels_.size() - 1, 0, 1, visits) / (4 * std::numbers::pi);
}

size_t WindingNumber::visits(const Point& p) const {
    size_t visits = 0;
    if (!levels_.empty()) at(p, levels_.size() - 1, 0, 1, visits);
    return visits;
}

double WindingNumber::at(const Point& p, size_t level, size_t begin, size_t end, size_t& visits) const {
    visits += end - begin;
    double sum = 0;
    for (size_t i = begin; i < end; ++i) {
        const Node& node = levels_[level][i];
        const Point way = node.center - p;
        const double squared = dot(way, way), reach = far * node.radius;
        if (squared > reach * reach) {
            sum += dot(way, node.dipole) / (squared * std::sqrt(squared));
        } else if (level == 0) {
            sum += at(items_[i], p, visits);
        } else {
            const size_t first = i * run, last = std::min(first + run, levels_[level - 1].size());
            sum += at(p, level - 1, first, last, visits);
        }
    }
    return sum;
}

double WindingNumber::at(const Triangle& item, const Point& p, size_t& visits) const {
    if (item[0] < 0) {
        const Fan& fan = fans_[idx(-1 - item[0])];
        return at(fan, p, fan.levels.size() - 1, 0, visits);
    }
    const auto corner = [&](size_t k) { return vertices_[idx(item[k])] - p; };
    return solid_angle(corner(0), corner(1), corner(2));
}

// A run of triangles counts as one triangle and a dipole if p is far from its rim and not between both surfaces, which
// lie in the cone from the apex around the ball of the rim.
double WindingNumber::at(const Fan& fan, const Point& p, size_t level, size_t index, size_t& visits) const {
    ++visits;
    const Node& node = fan.levels[level][index];
    const Point way = node.center - p, axis = node.center - fan.apex, from_apex = p - fan.apex;
    const double squared = dot(way, way), reach = far * node.radius, ball = node.radius * node.radius;
    const double along = dot(axis, from_apex);
    const bool is_in_cone = dot(axis, axis) <= ball ||
                            (along >= 0 && (dot(axis, axis) - ball) * dot(from_apex, from_apex) <= along * along);
    if (level == 0 || (squared > reach * reach && !is_in_cone)) {
        const size_t count = size_t{1} << (run_bits * level), last = std::min((index + 1) * count, fan.rim.size() - 1);
        const double whole = solid_angle(fan.apex - p, fan.rim[index * count] - p, fan.rim[last] - p);
        return level == 0 ? whole : whole + dot(way, node.dipole) / (squared * std::sqrt(squared));
    }
    double sum = 0;
    const size_t begin = index * run, end = std::min(begin + run, fan.levels[level - 1].size());
    for (size_t i = begin; i < end; ++i) sum += at(fan, p, level - 1, i, visits);
    return sum;
}

}  // namespace partwheel
