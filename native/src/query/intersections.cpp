// Where two indexes touch: pairs of nodes, by their boxes and, at the top, by their hulls; then facets; then whether a
// piece of one is all inside the other.
#include "hull/vectors.h"
#include "query/part_index.h"
#include "query/triangles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <initializer_list>

namespace partwheel {

using index::Corners;
using index::Tree;

namespace {

// What is this far apart, relative to the sizes at hand, is surely apart.
constexpr double rounding = 1e-12;

// A plane between two hulls is sought in so many steps at most, and no longer where they reach into each other by more
// than this, of the smaller one's size. What this does not separate, boxes and facets decide.
constexpr int most_steps = 6;
constexpr double deep = 0.1;

Point turned_by(const Affine& m, const Point& p) {
    return {m[0] * p[0] + m[1] * p[1] + m[2] * p[2], m[4] * p[0] + m[5] * p[1] + m[6] * p[2],
            m[8] * p[0] + m[9] * p[1] + m[10] * p[2]};
}

Point turned_back_by(const Affine& m, const Point& p) {
    return {m[0] * p[0] + m[4] * p[1] + m[8] * p[2], m[1] * p[0] + m[5] * p[1] + m[9] * p[2],
            m[2] * p[0] + m[6] * p[1] + m[10] * p[2]};
}

double largest(std::initializer_list<double> numbers) {
    double most = 0;
    for (const double x : numbers) most = std::max(most, std::fabs(x));
    return most;
}
double largest(const Point& p) { return largest({p[0], p[1], p[2]}); }

// A box, to be moved: its middle, and half its sides.
struct Block {
    Point middle, half;
    explicit Block(const Box& box) : middle(0.5 * (box.low + box.high)), half(0.5 * (box.high - box.low)) {}
};

// Where the second is moved to, in coordinates in which the first lies along the axes.
class Move {
public:
    explicit Move(const Affine& m, double slack) : m_(m), slack_(slack) {
        std::ranges::transform(m, reach_.begin(), [](double x) { return std::fabs(x); });
    }

    const Affine& matrix() const { return m_; }
    double slack() const { return slack_; }

    // An axis is enough to tell them apart.
    bool apart(const Block& first, const Block& second) const {
        const Point way = transform_point(m_, second.middle) - first.middle, reach = turned_by(reach_, second.half);
        for (size_t k = 0; k < 3; ++k)
            if (std::fabs(way[k]) > first.half[k] + reach[k] + slack_) return true;
        return false;
    }

private:
    Affine m_, reach_{};
    double slack_;
};

bool separate(const Corners& a, const Corners& b) {
    for (size_t k = 0; k < 3; ++k) {
        const auto [least_a, most_a] = std::minmax({a[0][k], a[1][k], a[2][k]});
        const auto [least_b, most_b] = std::minmax({b[0][k], b[1][k], b[2][k]});
        if (least_a > most_b || least_b > most_a) return true;
    }
    return false;
}

}  // namespace

PartIndex::SupportMap::SupportMap(std::span<const Point> points) {
    if (points.empty()) return;
    const size_t stride = (points.size() + few - 1) / few;
    for (size_t from = 0; from < stride; ++from)
        for (size_t i = from; i < points.size(); i += stride)
            for (size_t k = 0; k < 3; ++k) along[k].push_back(points[i][k]);
    if (points.size() % 2 == 1)
        for (std::vector<double>& numbers : along) numbers.push_back(numbers.back());
    const Box box = Box::around(points);
    middle = 0.5 * (box.low + box.high);
    size = box.diagonal();
}

Point PartIndex::SupportMap::farthest(const Point& axis, bool all) const {
    Double2 most = {-HUGE_VAL, -HUGE_VAL};
    Int64x2 best = {0, 0}, here = {0, 1};
    const size_t count = all ? along[0].size() : std::min(along[0].size(), few);
    for (size_t i = 0; i < count; i += 2, here += 2) {
        const Double2 far = axis[0] * vector_at<Double2>(&along[0][i]) + axis[1] * vector_at<Double2>(&along[1][i]) +
                        axis[2] * vector_at<Double2>(&along[2][i]);
        const Int64x2 more = far > most;
        best = (here & more) | (best & ~more);
        most = std::bit_cast<Double2>((std::bit_cast<Int64x2>(far) & more) | (std::bit_cast<Int64x2>(most) & ~more));
    }
    const auto i = static_cast<size_t>(most[1] > most[0] ? best[1] : best[0]);
    return {along[0][i], along[1][i], along[2][i]};
}

class PartIndex::Pair {
public:
    Pair(const PartIndex& a, const PartIndex& b, const Affine& matrix)
        : a_(a), b_(b), matrix_(matrix), onto_a_(onto_a()), onto_b_(onto_b()) {
        const Affine& m = onto_a_.matrix();
        double sum = 0;
        for (size_t row = 0; row < 12; row += 4)
            for (size_t k = 0; k < 3; ++k) sum += m[row + k] * m[row + k];
        growth_ = std::sqrt(sum / 3);
    }

    IntersectingParts touching() {
        const bool has_surfaces = !a_.surface_.root.empty() && !b_.surface_.root.empty();
        if (has_surfaces && !look(a_.surface_.root, b_.surface_.root)) look_inside();
        return found_;
    }

private:
    // Of b's frame to a's. The slack is for all that is rounded on the way, in the caller's coordinates as well.
    Move onto_a() const {
        const double scale = b_.frame_.scale / a_.frame_.scale;
        Affine m = matrix_;
        for (size_t row = 0; row < 12; row += 4)
            for (size_t k = 0; k < 3; ++k) m[row + k] *= scale;
        const Point corner = transform_point(matrix_, b_.frame_.origin), shift = 1 / a_.frame_.scale * (corner - a_.frame_.origin);
        for (size_t k = 0; k < 3; ++k) m[4 * k + 3] = shift[k];
        const double turn = largest({m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]});
        const double far = largest({matrix_[3], matrix_[7], matrix_[11], largest(a_.frame_.origin), largest(corner)}) /
                           a_.frame_.scale;
        return Move(m, rounding * (1 + turn + far + turn * largest(b_.frame_.origin) / b_.frame_.scale));
    }
    Move onto_b() const {
        const Affine m = compose_with_inverse(identity, onto_a_.matrix());
        const double turn = largest({m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]});
        return Move(m, 3 * turn * onto_a_.slack() + rounding * (1 + turn + largest({m[3], m[7], m[11]})));
    }

    Point moved(int32_t vertex) const { return transform_point(matrix_, b_.vertices_[idx(vertex)]); }

    // Chung, Wang, "Quick Collision Detection of Polytopes in Virtual Environments" (1996): where the corners farthest along
    // an axis are past each other, it is turned away from the way between them.
    bool apart(const SupportMap& a, const SupportMap& b) const {
        Point axis = transform_point(onto_a_.matrix(), b.middle) - a.middle;
        for (int step = 0; step < most_steps; ++step) {
            const double size = length(axis);
            if (!(size > 0)) return false;
            axis = 1 / size * axis;
            const Point back = turned_back_by(onto_a_.matrix(), -1 * axis);
            const auto between = [&](bool all) { return transform_point(onto_a_.matrix(), b.farthest(back, all)) - a.farthest(axis, all); };
            Point way = between(false);
            if (dot(axis, way) > 4 * onto_a_.slack()) {
                way = between(true);
                if (dot(axis, way) > 4 * onto_a_.slack()) return true;
            }
            const double gap = dot(axis, way);
            if (step > 0 && gap < -deep * std::min(a.size, growth_ * b.size)) return false;
            axis = axis - 2 * gap / dot(way, way) * way;
        }
        return false;
    }

    bool apart(const Tree::Subtree& s, const Tree::Subtree& t) const {
        const Block a(s.box), b(t.box);
        if (onto_a_.apart(a, b) || onto_b_.apart(b, a)) return true;
        return s.number >= 0 && t.number >= 0 && apart(a_.clouds_[idx(s.number)], b_.clouds_[idx(t.number)]);
    }

    bool look(const Tree::Subtree& s, const Tree::Subtree& t) {
        if (apart(s, t)) return false;
        if (s.count > 0 && t.count > 0) return look_at_facets(s, t);
        const bool divide_t = s.count > 0 || (t.count == 0 && growth_ * t.box.diagonal() > s.box.diagonal());
        const std::array<Tree::Subtree, 2> halves = {(divide_t ? b_ : a_).surface_.child(divide_t ? t.child : s.child, 0),
                                                     (divide_t ? b_ : a_).surface_.child(divide_t ? t.child : s.child, 1)};
        // First those that are nearer to each other, where they may meet sooner.
        std::array<double, 2> away{};
        for (size_t i = 0; i < 2; ++i) {
            const Point way = transform_point(onto_a_.matrix(), Block((divide_t ? halves[i] : t).box).middle) -
                              Block((divide_t ? s : halves[i]).box).middle;
            away[i] = dot(way, way);
        }
        const size_t first = away[1] < away[0];
        for (const size_t i : {first, 1 - first})
            if (divide_t ? look(s, halves[i]) : look(halves[i], t)) return true;
        return false;
    }

    bool look_at_facets(const Tree::Subtree& s, const Tree::Subtree& t) {
        for (auto j = idx(t.child); j < idx(t.child + t.count); ++j) {
            const Triangle& of_b = b_.facets_[j];
            const Corners second = {moved(of_b[0]), moved(of_b[1]), moved(of_b[2])};
            for (auto i = idx(s.child); i < idx(s.child + s.count); ++i) {
                const Triangle& of_a = a_.facets_[i];
                const Corners first = {a_.vertices_[idx(of_a[0])], a_.vertices_[idx(of_a[1])], a_.vertices_[idx(of_a[2])]};
                if (separate(first, second)) continue;
                if (const auto point = index::common_point(first, second)) {
                    found_ = {{a_.body_[i], b_.body_[j]}, *point};
                    return true;
                }
            }
        }
        return false;
    }

    // Where no facets meet, a piece is all inside the other or all outside.
    void look_inside() {
        for (const Piece& piece : b_.pieces_) {
            const Point p = moved(piece.vertex);
            const int32_t body = a_.locate(p);
            if (body < 0) continue;
            found_ = {{body, piece.body}, p};
            return;
        }
        const auto& m = matrix_;
        const bool mirrored = dot(cross({m[0], m[1], m[2]}, {m[4], m[5], m[6]}), {m[8], m[9], m[10]}) < 0;
        const Point slack{onto_b_.slack(), onto_b_.slack(), onto_b_.slack()};
        for (const Piece& piece : a_.pieces_) {
            const Point& p = a_.vertices_[idx(piece.vertex)];
            const Point q = transform_point(onto_b_.matrix(), a_.working_[idx(piece.vertex)]);
            const int32_t body = b_.locate(p, {q - slack, q + slack}, mirrored, [&](int32_t v) { return moved(v); });
            if (body < 0) continue;
            found_ = {{piece.body, body}, p};
            return;
        }
    }

    const PartIndex &a_, &b_;
    const Affine matrix_;
    const Move onto_a_, onto_b_;
    double growth_ = 0;  // of lengths in b's frame when they come to a's
    IntersectingParts found_;
};

IntersectingParts PartIndex::touching(const PartIndex& other, const Affine& matrix) const {
    return Pair(*this, other, matrix).touching();
}

}  // namespace partwheel
