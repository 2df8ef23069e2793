// Nearest-triangle queries by a tree of boxes.
#include "mesh/nearest.h"

#include "mesh/rays.h"

namespace partwheel {

namespace {

Point nearest_on_segment(const Point& p, const Point& a, const Point& b) {
    const Point along = b - a;
    const double size = squared(along), t = size > 0 ? std::clamp(dot(p - a, along) / size, 0.0, 1.0) : 0;
    return t < 1 ? a + t * along : b;
}

// Sorts items so that the first half lies below the second one, along the longest side of the box around all; then each
// half likewise.
void sort_by_halves(std::span<int32_t> items, std::span<const Point> centers) {
    if (items.size() < 2) return;
    const Box box = Box::around(points_at(centers, items));
    const Point extent = box.high - box.low;
    const auto axis = static_cast<size_t>(std::ranges::max_element(extent) - extent.begin());
    const auto key = [&](int32_t i) { return std::tuple(centers[idx(i)][axis], centers[idx(i)], i); };
    const size_t middle = items.size() / 2;
    std::ranges::nth_element(items, items.begin() + static_cast<std::ptrdiff_t>(middle), {}, key);
    sort_by_halves(items.first(middle), centers);
    sort_by_halves(items.subspan(middle), centers);
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

NearestTriangle::NearestTriangle(std::span<const Point> vertices, std::span<const Triangle> triangles)
    : order_(iota(triangles.size())) {
    std::vector<Corners> corners;
    std::vector<Point> centers;
    for (const Triangle& t : triangles) {
        Corners& points = corners.emplace_back(corner_points(vertices, t));
        // The numbering of corners may not change rounding.
        std::rotate(points.begin(), std::ranges::min_element(points), points.end());
        centers.push_back(1.0 / 3 * (points[0] + points[1] + points[2]));
    }
    sort_by_halves(order_, centers);
    std::vector<Box> boxes;
    for (const int32_t t : order_) {
        corners_.push_back(corners[idx(t)]);
        boxes.push_back(Box::around(corners_.back()));
    }
    tree_ = Bvh(boxes);
}

NearestTriangle::Found NearestTriangle::search(const Point& p, Found best) const {
    const auto is_wanted = [&](double squared, size_t place) {
        return squared < best.squared || (squared == best.squared && place < best.place);
    };
    tree_.nearest_first([&](const Box& box) { return squared_distance(box, p); }, is_wanted, [&](size_t place, double) {
        const Point point = nearest_on(place, p);
        if (is_wanted(squared(p - point), place)) best = {place, point, squared(p - point)};
    });
    return best;
}

Near NearestTriangle::operator()(const Point& p) {
    if (last_.place != none) last_.point = nearest_on(last_.place, p), last_.squared = squared(p - last_.point);
    last_ = search(p, last_);
    return near(last_);
}

Near NearestTriangle::operator()(const Point& p, double distance) const {
    const Found found = search(p, {none, {}, distance * distance});
    return found.place == none ? Near{} : near(found);
}

bool NearestTriangle::within(const Point& p, double distance) const {
    const double limit = distance * distance;
    return tree_.any_of([&](const Box& box) { return squared_distance(box, p) <= limit; },
                        [&](size_t place) { return squared(p - nearest_on(place, p)) <= limit; });
}

bool NearestTriangle::is_outside(const Point& p) const {
    const Ray ray(p, {0.5377, 0.3141, 0.7823});
    size_t crossings = 0;
    tree_.any_of([&](const Box& box) { return ray.may_hit(box, 0, HUGE_VAL); }, [&](size_t place) {
        const auto& [a, b, c] = corners_[place];
        crossings += ray.intersect(a, b, c) > 0;
        return false;
    });
    return crossings % 2 == 0;
}

}  // namespace partwheel
