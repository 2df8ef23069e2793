// Intersection of two indexes: simultaneous traversal of both trees, with tests of boxes and, in the top levels, of
// hulls; then exact tests of facets; then containment of whole components.
#include "base/corners.h"
#include "hull/vectors.h"
#include "mesh/triangles.h"
#include "query/part_index.h"

#include <initializer_list>

namespace partwheel {

using index::PartBvh;

namespace {

// Relative error bound: boxes and hulls farther apart than this are disjoint.
constexpr double rounding = 1e-12;

// The search for a separating plane of two hulls ends after this many steps, or if they overlap by more than this share
// of the smaller one's size. Pairs that it does not separate are left to boxes and facets.
constexpr int max_axis_steps = 6;
constexpr double max_penetration = 0.1;

Point rotate(const Affine& m, const Point& p) {
    return {m[0] * p[0] + m[1] * p[1] + m[2] * p[2], m[4] * p[0] + m[5] * p[1] + m[6] * p[2],
            m[8] * p[0] + m[9] * p[1] + m[10] * p[2]};
}

Point rotate_back(const Affine& m, const Point& p) {
    return {m[0] * p[0] + m[4] * p[1] + m[8] * p[2], m[1] * p[0] + m[5] * p[1] + m[9] * p[2],
            m[2] * p[0] + m[6] * p[1] + m[10] * p[2]};
}

double largest(std::initializer_list<double> numbers) {
    double most = 0;
    for (const double x : numbers) most = std::max(most, std::fabs(x));
    return most;
}
double largest(const Point& p) { return largest({p[0], p[1], p[2]}); }

// A box by its center and half its sides.
struct CenteredBox {
    Point center, half_size;
    explicit CenteredBox(const Box& box) : center(0.5 * (box.low + box.high)), half_size(0.5 * (box.high - box.low)) {}
};

// From the second index's working coordinates to the first's. slack: bound of the rounding errors.
class Transform {
public:
    explicit Transform(const Affine& m, double slack) : m_(m), slack_(slack) {
        std::ranges::transform(m, reach_.begin(), [](double x) { return std::fabs(x); });
    }

    const Affine& matrix() const { return m_; }
    double slack() const { return slack_; }

    // Separating axis test along the axes of the first box.
    bool is_separated(const CenteredBox& first, const CenteredBox& second) const {
        const Point offset = transform_point(m_, second.center) - first.center, reach = rotate(reach_, second.half_size);
        for (size_t k = 0; k < 3; ++k)
            if (std::fabs(offset[k]) > first.half_size[k] + reach[k] + slack_) return true;
        return false;
    }

private:
    Affine m_, reach_{};
    double slack_;
};

}  // namespace

PartIndex::SupportMap::SupportMap(std::span<const Point> points) {
    if (points.empty()) return;
    const size_t stride = (points.size() + coarse_count - 1) / coarse_count;
    for (size_t from = 0; from < stride; ++from)
        for (size_t i = from; i < points.size(); i += stride)
            for (size_t k = 0; k < 3; ++k) coordinates[k].push_back(points[i][k]);
    if (points.size() % 2 == 1)
        for (std::vector<double>& numbers : coordinates) numbers.push_back(numbers.back());
    const Box box = Box::around(points);
    center = 0.5 * (box.low + box.high);
    size = box.diagonal();
}

Point PartIndex::SupportMap::support_point(const Point& axis, bool use_all) const {
    Double2 max_height = {-HUGE_VAL, -HUGE_VAL};
    Int64x2 best = {0, 0}, indices = {0, 1};
    const size_t count = use_all ? coordinates[0].size() : std::min(coordinates[0].size(), coarse_count);
    for (size_t i = 0; i < count; i += 2, indices += 2) {
        const Double2 far = axis[0] * vector_at<Double2>(&coordinates[0][i]) +
                            axis[1] * vector_at<Double2>(&coordinates[1][i]) +
                            axis[2] * vector_at<Double2>(&coordinates[2][i]);
        const Int64x2 is_higher = far > max_height;
        best = (indices & is_higher) | (best & ~is_higher);
        max_height = std::bit_cast<Double2>((std::bit_cast<Int64x2>(far) & is_higher) |
                                            (std::bit_cast<Int64x2>(max_height) & ~is_higher));
    }
    const auto i = static_cast<size_t>(max_height[1] > max_height[0] ? best[1] : best[0]);
    return {coordinates[0][i], coordinates[1][i], coordinates[2][i]};
}

class PartIndex::IntersectionTest {
public:
    IntersectionTest(const PartIndex& a, const PartIndex& b, const Affine& matrix)
        : a_(a), b_(b), matrix_(matrix), onto_a_(onto_a()), onto_b_(onto_b()) {
        const Affine& m = onto_a_.matrix();
        double sum = 0;
        for (size_t row = 0; row < 12; row += 4)
            for (size_t k = 0; k < 3; ++k) sum += m[row + k] * m[row + k];
        scale_ = std::sqrt(sum / 3);
    }

    IntersectingParts intersect() {
        const bool has_surfaces = !a_.surface_.root.empty() && !b_.surface_.root.empty();
        if (has_surfaces && !search(a_.surface_.root, b_.surface_.root)) test_containment();
        return result_;
    }

private:
    // From b's frame to a's. The slack bounds all rounding errors, also in the caller's coordinates.
    Transform onto_a() const {
        const double scale = b_.frame_.scale / a_.frame_.scale;
        Affine m = matrix_;
        for (size_t row = 0; row < 12; row += 4)
            for (size_t k = 0; k < 3; ++k) m[row + k] *= scale;
        const Point corner = transform_point(matrix_, b_.frame_.origin),
                    shift = 1 / a_.frame_.scale * (corner - a_.frame_.origin);
        for (size_t k = 0; k < 3; ++k) m[4 * k + 3] = shift[k];
        const double turn = largest({m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]});
        const double far = largest({matrix_[3], matrix_[7], matrix_[11], largest(a_.frame_.origin), largest(corner)}) /
                           a_.frame_.scale;
        return Transform(m, rounding * (1 + turn + far + turn * largest(b_.frame_.origin) / b_.frame_.scale));
    }
    Transform onto_b() const {
        const Affine m = compose_with_inverse(identity, onto_a_.matrix());
        const double turn = largest({m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]});
        return Transform(m, 3 * turn * onto_a_.slack() + rounding * (1 + turn + largest({m[3], m[7], m[11]})));
    }

    Point transformed(int32_t vertex) const { return transform_point(matrix_, b_.vertices_[idx(vertex)]); }

    // Chung, Wang, "Quick Collision Detection of Polytopes in Virtual Environments" (1996): reflects the axis by the
    // vector between the two support points until they are separated along it.
    bool is_separated(const SupportMap& a, const SupportMap& b) const {
        Point axis = transform_point(onto_a_.matrix(), b.center) - a.center;
        for (int step = 0; step < max_axis_steps; ++step) {
            const double size = length(axis);
            if (!(size > 0)) return false;
            axis = 1 / size * axis;
            const Point back = rotate_back(onto_a_.matrix(), -1 * axis);
            const auto gap_vector = [&](bool use_all) {
                return transform_point(onto_a_.matrix(), b.support_point(back, use_all)) -
                       a.support_point(axis, use_all);
            };
            Point offset = gap_vector(false);
            if (dot(axis, offset) > 4 * onto_a_.slack()) {
                offset = gap_vector(true);
                if (dot(axis, offset) > 4 * onto_a_.slack()) return true;
            }
            const double gap = dot(axis, offset);
            if (step > 0 && gap < -max_penetration * std::min(a.size, scale_ * b.size)) return false;
            axis = axis - 2 * gap / dot(offset, offset) * offset;
        }
        return false;
    }

    bool is_separated(const PartBvh::Subtree& s, const PartBvh::Subtree& t) const {
        const CenteredBox a(s.box), b(t.box);
        if (onto_a_.is_separated(a, b) || onto_b_.is_separated(b, a)) return true;
        return s.id >= 0 && t.id >= 0 && is_separated(a_.support_maps_[idx(s.id)], b_.support_maps_[idx(t.id)]);
    }

    bool search(const PartBvh::Subtree& s, const PartBvh::Subtree& t) {
        if (is_separated(s, t)) return false;
        if (s.count > 0 && t.count > 0) return intersect_facets(s, t);
        const bool divide_t = s.count > 0 || (t.count == 0 && scale_ * t.box.diagonal() > s.box.diagonal());
        const std::array<PartBvh::Subtree, 2> children = {
            (divide_t ? b_ : a_).surface_.child(divide_t ? t.child : s.child, 0),
            (divide_t ? b_ : a_).surface_.child(divide_t ? t.child : s.child, 1)};
        // Nearer pair first.
        std::array<double, 2> distance{};
        for (size_t i = 0; i < 2; ++i) {
            const Point offset = transform_point(onto_a_.matrix(), CenteredBox((divide_t ? children[i] : t).box).center) -
                              CenteredBox((divide_t ? s : children[i]).box).center;
            distance[i] = dot(offset, offset);
        }
        const size_t first = distance[1] < distance[0];
        for (const size_t i : {first, 1 - first})
            if (divide_t ? search(s, children[i]) : search(children[i], t)) return true;
        return false;
    }

    bool intersect_facets(const PartBvh::Subtree& s, const PartBvh::Subtree& t) {
        for (auto j = idx(t.child); j < idx(t.child + t.count); ++j) {
            const Triangle& of_b = b_.facets_[j];
            const Corners second = {transformed(of_b[0]), transformed(of_b[1]), transformed(of_b[2])};
            const Box box = Box::around(second);
            for (auto i = idx(s.child); i < idx(s.child + s.count); ++i) {
                const Corners first = corner_points(a_.vertices_, a_.facets_[i]);
                if (!box.overlaps(Box::around(first))) continue;
                if (const auto point = common_point(first, second)) {
                    result_ = {{a_.body_[i], b_.body_[j]}, *point};
                    return true;
                }
            }
        }
        return false;
    }

    // If no facets intersect, each component is entirely inside or outside the other index.
    void test_containment() {
        for (const Component& component : b_.components_) {
            const Point p = transformed(component.vertex);
            const int32_t body = a_.locate(p);
            if (body < 0) continue;
            result_ = {{body, component.body}, p};
            return;
        }
        const auto& m = matrix_;
        const bool is_mirrored = dot(cross({m[0], m[1], m[2]}, {m[4], m[5], m[6]}), {m[8], m[9], m[10]}) < 0;
        const Point slack{onto_b_.slack(), onto_b_.slack(), onto_b_.slack()};
        for (const Component& component : a_.components_) {
            const Point& p = a_.vertices_[idx(component.vertex)];
            const Point q = transform_point(onto_b_.matrix(), a_.working_[idx(component.vertex)]);
            const int32_t body =
                b_.locate(p, {q - slack, q + slack}, is_mirrored, [&](int32_t v) { return transformed(v); });
            if (body < 0) continue;
            result_ = {{component.body, body}, p};
            return;
        }
    }

    const PartIndex &a_, &b_;
    const Affine matrix_;
    const Transform onto_a_, onto_b_;
    double scale_ = 0;  // of lengths, from b's frame to a's
    IntersectingParts result_;
};

IntersectingParts PartIndex::intersect(const PartIndex& other, const Affine& matrix) const {
    return IntersectionTest(*this, other, matrix).intersect();
}

}  // namespace partwheel
