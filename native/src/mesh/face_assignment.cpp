// Assigns each source face to the nearest triangles of another surface.
#include "mesh/face_assignment.h"

#include "base/corners.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <charconv>

namespace partwheel {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;  // inexact, which is enough to measure distances
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::iterator>>>;

// Samples between two checks for cancellation.
constexpr size_t samples_between_polls = 256;

// A smaller distance, relative to the diagonal, counts as 0.
constexpr double rounding = 1e-12;

Kernel::Point_3 to_cgal(const Point& p) { return {p[0], p[1], p[2]}; }

Triangles to_cgal(std::span<const Point> vertices, std::span<const Triangle> triangles) {
    Triangles result;
    for (const Triangle& t : triangles) {
        const auto corner = [&](size_t k) { return to_cgal(vertices[idx(t[k])]); };
        result.emplace_back(corner(0), corner(1), corner(2));
    }
    return result;
}

// A triangle of the source: its longest side goes from `corner` along `u`; `v` goes from `corner` to the opposite
// corner.
struct SampledTriangle {
    Point corner, u, v;
    double length = 0, area;  // length: of u

    SampledTriangle(const Surface& source, size_t triangle) : area(source.samples[triangle].area) {
        for (size_t k = 0; k < 3; ++k) {
            const auto at = [&](size_t i) { return source.vertices[idx(source.triangles[triangle][i % 3])]; };
            const Point side = at(k + 1) - at(k);
            if (k > 0 && partwheel::length(side) <= length) continue;
            corner = at(k);
            u = side;
            v = at(k + 2) - corner;
            length = partwheel::length(side);
        }
    }

    // Calls visit(middle, area) for each piece. No piece is longer or wider than the spacing: the triangle is divided
    // into strips along its longest side, and each strip across.
    template <class Function>
    void for_each_piece(double spacing, const Function& visit) const {
        const auto parts = [&](double extent) { return std::max(1.0, std::ceil(extent / spacing)); };
        const double strips = length > 0 ? parts(2 * area / length) : 1;
        for (double strip = 0; strip < strips; ++strip) {
            const double below = 1 - strip / strips, above = 1 - (strip + 1) / strips;  // lengths, relative to u's
            const double middle = 1 - below + (below + 2 * above) / (below + above) / (3 * strips);
            const double count = parts(below * length);
            for (double i = 0; i < count; ++i)
                visit(corner + ((i + 0.5) / count * (1 - middle)) * u + middle * v,
                      area * (below + above) / strips / count);
        }
    }
};

// With this spacing there are at most `max_samples` more pieces than triangles: a triangle of length l and height h <=
// l has at most (l / s) (h / s / 2 + 1) + h / s + 1 <= area / s^2 + 2 l / s + 1 pieces with spacing s.
double least_spacing(double area, double lengths) {
    return (lengths + std::sqrt(lengths * lengths + area * max_samples)) / max_samples;
}

// For each source triangle the one of the surface with the same corners, or -1.
std::vector<int32_t> find_unchanged(const Surface& source, const Surface& surface) {
    using Corners = std::array<Point, 3>;
    const auto corners = [](const Surface& s, size_t t) {
        Corners sorted = corner_points(s.vertices, s.triangles[t]);
        std::ranges::sort(sorted);
        return sorted;
    };
    std::vector<std::pair<Corners, int32_t>> order;
    for (size_t t = 0; t < surface.triangles.size(); ++t) order.push_back({corners(surface, t), static_cast<int32_t>(t)});
    std::ranges::sort(order);
    std::vector<int32_t> unchanged;
    for (size_t t = 0; t < source.triangles.size(); ++t) {
        const std::pair<Corners, int32_t> lowest{corners(source, t), -1};
        const auto found = std::ranges::lower_bound(order, lowest);
        unchanged.push_back(found != order.end() && found->first == lowest.first ? found->second : -1);
    }
    return unchanged;
}

}  // namespace

Assignment assign_source_faces_by_distance(const Surface& source, Surface& surface, Progress& progress) {
    NearestTriangle nearest(surface.vertices, surface.triangles);
    double area = 0, lengths = 0;
    for (size_t t = 0; t < source.triangles.size(); ++t) {
        const SampledTriangle sampled(source, t);
        area += sampled.area;
        lengths += sampled.length;
    }
    const double size = diagonal(source);
    const double spacing = std::max(size * sample_spacing, least_spacing(area, lengths));
    double farthest = 0, outside = near_enough * size, distance = 0, hidden = 0;
    size_t samples = 0, t = 0;
    // Triangles that are still there are not searched for: each of their points might be in the boxes of many.
    const std::vector<int32_t> unchanged = find_unchanged(source, surface);
    const auto find = [&](const Point& p, int32_t triangle) {
        if (samples++ % samples_between_polls == 0)
            progress.advance(0.9 + 0.1 * static_cast<double>(t) / static_cast<double>(source.triangles.size()));
        const Near near = triangle >= 0 ? Near{triangle, 0, p} : nearest(p);
        distance = std::sqrt(near.squared);
        farthest = std::max(farthest, distance);
        if (distance > outside && nearest.is_outside(p)) outside = distance;
        return near.triangle;
    };

    std::vector<int32_t> triangle_at(source.vertices.size(), -1);
    for (size_t i = 0; i < unchanged.size(); ++i)
        for (const int32_t v : source.triangles[i]) triangle_at[idx(v)] = std::max(triangle_at[idx(v)], unchanged[i]);
    for (size_t v = 0; v < source.vertices.size(); ++v) find(source.vertices[v], triangle_at[v]);
    surface.samples.clear();
    for (; t < source.triangles.size(); ++t)
        SampledTriangle(source, t).for_each_piece(spacing, [&](const Point& p, double piece_area) {
            surface.samples.push_back({source.samples[t].face, find(p, unchanged[t]), piece_area, unchanged[t] >= 0});
            if (distance > hidden_beyond * size) hidden += piece_area;
        });
    surface.face_count = source.face_count;
    surface.deviation = farthest < rounding * size ? 0 : farthest / size;
    return {outside > near_enough * size ? outside / size : 0, area > 0 ? hidden / area : 0};
}

struct NearestTriangle::Boxes {
    using Found = Tree::Point_and_primitive_id;

    Triangles triangles;
    Tree tree;
    Found last;

    Near near(const Point& p, const Found& found) const {
        const auto& [point, triangle] = found;
        return {static_cast<int32_t>(triangle - triangles.begin()), CGAL::squared_distance(point, to_cgal(p)),
                {point.x(), point.y(), point.z()}};
    }

    explicit Boxes(Triangles given)
        : triangles(std::move(given)), tree(triangles.begin(), triangles.end()),
          last(triangles[0].vertex(0), triangles.begin()) {
        tree.build();
    }

    Found closest(const Point& p, const Found& hint) const;
};

namespace {

using Node = CGAL::AABB_node<Tree::AABB_traits>;

double squared_distance(const CGAL::Bbox_3& box, const Kernel::Point_3& p) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
        const double gap = std::max(box.min(k), std::min(p[k], box.max(k))) - p[k];  // no branches
        sum += gap * gap;
    }
    return sum;
}

// CGAL's search for the closest point, in CGAL's order, so that it finds the same one of several. But it starts with
// the distance of a triangle in a box that is near, and leaves out triangles whose box is farther away than the closest
// point.
class ClosestPoint {
public:
    using Found = Tree::Point_and_primitive_id;

    ClosestPoint(const Kernel::Point_3& p, const Found& hint)
        : p_(p), closest_(hint), squared_(CGAL::squared_distance(p, hint.first)) {}

    Found search(const Tree& tree) {
        const Found hint = closest_;
        if (tree.size() > 1) descend(*tree.root_node(), tree.size());
        const Found nearby = std::exchange(closest_, hint);
        tree.traversal(p_, *this);
        return closest_ == hint ? nearby : closest_;  // rounding may put its boxes too far away
    }

    static constexpr bool go_further() { return true; }
    bool do_intersect(const Kernel::Point_3&, const Node& node) const { return squared_distance(node.bbox(), p_) <= squared_; }

    void intersection(const Kernel::Point_3&, const Tree::Primitive& primitive) {
        const Kernel::Triangle_3& triangle = primitive.datum();
        if (squared_distance(triangle.bbox(), p_) > squared_) return;
        const Kernel::Point_3 point = Kernel().construct_projected_point_3_object()(triangle, p_);
        const double squared = CGAL::squared_distance(p_, point);
        if (squared > squared_ || point == closest_.first) return;
        squared_ = squared;
        closest_ = {point, primitive.id()};
    }

private:
    // Goes down into the nearer box each time, and looks at the triangles of the last one.
    void descend(const Node& root, size_t count) {
        const Node* node = &root;
        while (count > 3) {
            const Node &left = node->left_child(), &right = node->right_child();
            const bool is_left = squared_distance(left.bbox(), p_) <= squared_distance(right.bbox(), p_);
            node = is_left ? &left : &right;
            count = is_left ? count / 2 : count - count / 2;
        }
        node->traversal(p_, *this, count);
    }

    const Kernel::Point_3 p_;
    Found closest_;
    double squared_;
};

}  // namespace

NearestTriangle::Boxes::Found NearestTriangle::Boxes::closest(const Point& p, const Found& hint) const {
    return ClosestPoint(to_cgal(p), hint).search(tree);
}

NearestTriangle::NearestTriangle(std::span<const Point> vertices, std::span<const Triangle> triangles)
    : boxes_(std::make_unique<Boxes>(to_cgal(vertices, triangles))) {}

NearestTriangle::~NearestTriangle() = default;

Near NearestTriangle::operator()(const Point& p) {
    boxes_->last = boxes_->closest(p, boxes_->last);
    return boxes_->near(p, boxes_->last);
}

Near NearestTriangle::operator()(const Point& p, double distance) const {
    const Kernel::Point_3 limit(p[0] + distance, p[1], p[2]);  // the search goes no farther than it
    const Boxes::Found found = boxes_->closest(p, {limit, boxes_->triangles.end()});
    return found.second == boxes_->triangles.end() ? Near{} : boxes_->near(p, found);
}

bool NearestTriangle::within(const Point& p, double distance) const {
    return boxes_->tree.do_intersect(Kernel::Sphere_3(to_cgal(p), distance * distance));
}

bool NearestTriangle::is_outside(const Point& p) const {
    const Kernel::Ray_3 ray(to_cgal(p), Kernel::Vector_3(0.5377, 0.3141, 0.7823));
    return boxes_->tree.number_of_intersected_primitives(ray) % 2 == 0;
}

double diagonal(const Surface& source) { return length(Box::around(source.vertices).high); }

std::string with_commas(size_t n) {
    std::string text = std::to_string(n);
    for (size_t end = text.size(); end > 3; end -= 3) text.insert(end - 3, ",");
    return text;
}

std::string counted_faces(size_t n, const char* one, const char* many) {
    return with_commas(n) + (n == 1 ? " face " : " faces ") + (n == 1 ? one : many);
}

std::string percent(double share) {
    char text[32];  // printf would write a comma where the host's locale has one
    char* const end = std::to_chars(text, std::end(text), 100 * share, std::chars_format::general, 2).ptr;
    return std::string(text, end) + " %";
}

std::string at_most_away(double distance) {
    return "The surface used is at most " + percent(distance) + " of the model's size away";
}

}  // namespace partwheel
