// The top of the tree built anew: choose parts, measure them and what lies between, join them, score the result.
#include "tree/regroup/regroup.h"

#include "cluster/hull/hull.h"
#include "tree/regroup/regroup_fitted.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

namespace partwheel {

namespace {

// Logarithm to the base 2 by arithmetic alone, so that it is the same on every machine; clamped.
double log2_of(double x) {
    constexpr double limit = 20;
    if (!(x > 0)) return -limit;
    int exponent = 0;
    const double m = std::frexp(x, &exponent), root_half = 0.70710678118654752440;
    const double z = (m - root_half) / (m + root_half), q = z * z;
    const double series =
        z * (1 + q * (1.0 / 3 + q * (1.0 / 5 + q * (1.0 / 7 + q * (1.0 / 9 + q * (1.0 / 11 + q * (1.0 / 13)))))));
    return std::clamp(static_cast<double>(exponent) - 0.5 + 2 * 1.44269504088896340736 * series, -limit, limit);
}

// Costs are the logits of a likelihood; more than this tells no more.
constexpr double largest_cost = 8;

// What lies between two parts, or around one: all of it is added up when parts are joined.
struct Border {
    double interface = 0;  // area of the facets between the tetrahedra
    double length = 0;     // of the border on the surface
    double crease = 0;     // its length times the sine of half the angle it bends by, below 0 where concave
    double concave = 0;    // the length that is concave by more than concave_bend
    double curvature = 0;  // its length times the smoothed mean curvature, squashed to -1..1

    Border& operator+=(const Border& other) {
        interface += other.interface;
        length += other.length;
        crease += other.crease;
        concave += other.concave;
        curvature += other.curvature;
        return *this;
    }
};

constexpr double concave_bend = 0.02;
constexpr double middling_curvature = 4;  // of a model of unit area: squashed to a half
constexpr int smoothing_passes = 4;

struct Link {
    int32_t a = 0, b = 0;  // parts
    Border border;
    double hull = 0;  // volume of the hull of both, or of less than both have become
    double cost = -std::numeric_limits<double>::infinity();
    bool alive = true;
    bool guessed = true;  // the cost; else it was worked out with the hull
};

struct Part {
    double volume = 0, area = 0;
    double log_volume = 0, log_area = 0;  // log2_of() them: each is in many measures
    Border rim;
    Hull hull;
    double hull_volume = 0;
    int32_t number = 0;          // its cluster's, see Merge
    int32_t low = 0;             // its lowest tetrahedron
    std::vector<int32_t> links;
    double own_cost = -largest_cost, worst_cost = -largest_cost;  // of the merge that made it; of any below
    bool alive = true;
};

// A side of an outer triangle.
struct Side {
    int32_t low, high;  // its vertices
    int32_t triangle;
    bool forward;  // from low to high
    auto operator<=>(const Side&) const = default;
};

// Sorts: by the lower vertex first, which takes no comparisons.
void sort_by_edge(std::vector<Side>& sides, size_t vertices) {
    std::vector<size_t> end(vertices + 1, 0);
    for (const Side& s : sides) ++end[static_cast<size_t>(s.low) + 1];
    std::partial_sum(end.begin(), end.end(), end.begin());
    std::vector<Side> sorted(sides.size());
    for (const Side& s : sides) sorted[end[static_cast<size_t>(s.low)]++] = s;
    sides.swap(sorted);
    auto begin = sides.begin();
    for (size_t v = 0; v < vertices; ++v) {
        const auto after = sides.begin() + static_cast<std::ptrdiff_t>(end[v]);
        std::sort(begin, after);
        begin = after;
    }
}

class Regrouping {
public:
    Regrouping(const TetMesh& mesh, const BinaryTree& tree, Progress& progress, std::span<const double> pair_numbers,
               RegroupTrace* trace)
        : mesh_(mesh), tree_(tree), progress_(progress), pair_numbers_(pair_numbers), trace_(trace),
          kernel_(mesh.vertices) {}
    Regrouped run();

private:
    const Point& point(int32_t v) const { return mesh_.vertices[static_cast<size_t>(v)]; }
    Part& at(int32_t p) { return parts_[static_cast<size_t>(p)]; }
    void choose_parts();
    void measure();
    double hull_volume(const Link& link);
    double cost(const Link& link, double hull, bool exact);
    void enter(Link& link);
    void price(Link& link);
    PairMeasures measures(const Part& a, const Part& b, const Border& border, double hull) const;
    void join(int32_t a, int32_t b, double cost);
    void join_neighbours();
    void join_components();
    OwnMeasures measures(const Part& part) const;
    NodeMeasures measures(size_t node) const;
    std::vector<double> scores() const;

    const TetMesh& mesh_;
    const BinaryTree& tree_;
    Progress& progress_;
    std::span<const double> pair_numbers_;
    RegroupTrace* trace_;
    HullKernel kernel_;
    std::vector<Part> parts_;
    std::vector<Link> links_;
    // By cost, then number; those whose cost is not the link's any more count no longer.
    std::priority_queue<std::pair<double, int32_t>, std::vector<std::pair<double, int32_t>>, std::greater<>> queue_;
    std::vector<int32_t> part_of_;       // of each tetrahedron
    std::vector<uint8_t> goes_;          // merges of the paper's tree that are undone
    std::vector<std::array<int32_t, 2>> joined_;
    std::vector<int32_t> above_, beside_;  // of each part: what it became a part of, and with which other; -1
    std::vector<int32_t> link_to_;       // scratch of join()
    size_t fine_ = 0;                    // parts before any was joined
    double length_unit_ = 1, area_unit_ = 1, volume_unit_ = 1;  // of the longest side of the bounding box
    double volume_ = 0, area_ = 0, log_volume_ = 0, log_area_ = 0, hull_volume_ = 0;  // of all
    Regrouped result_;
};

// Cuts the paper's tree where most surface lies in what is least convex, components first.
void Regrouping::choose_parts() {
    const size_t leaves = mesh_.tetrahedra.size(), merges = tree_.merges.size(), joins = tree_.components - 1;
    goes_.assign(merges, 0);
    std::vector<uint8_t> root(leaves + merges, 1);
    for (size_t m = 0; m + joins < merges; ++m)
        root[static_cast<size_t>(tree_.merges[m].left)] = root[static_cast<size_t>(tree_.merges[m].right)] = 0;
    std::vector<double> area(leaves + merges, 0);
    for (size_t t = 0; t < leaves; ++t)
        for (size_t k = 0; k < 4; ++k) {
            if (mesh_.neighbours[t][k] >= 0) continue;
            const Triangle f = facet(mesh_.tetrahedra[t], k);
            area[t] += partwheel::area(point(f[0]), point(f[1]), point(f[2]));
        }
    for (size_t m = 0; m < merges; ++m) {
        const Merge& merge = tree_.merges[m];
        area[leaves + m] = area[static_cast<size_t>(merge.left)] + area[static_cast<size_t>(merge.right)];
    }
    std::priority_queue<std::pair<float, int32_t>> queue;   // the lower number first where they tie
    std::vector<int32_t> chosen;
    const auto offer = [&](int32_t c) {
        const auto i = static_cast<size_t>(c);
        float concavity = 0;  // rounded as costs are, see price()
        if (i >= leaves && tree_.merges[i - leaves].concavity > 0)
            concavity = static_cast<float>(tree_.merges[i - leaves].concavity /
                                           tree_.merges[i - leaves].hull_volume * area[i]);
        if (concavity > 0)
            queue.push({concavity, -c});
        else
            chosen.push_back(c);
    };
    for (size_t c = 0; c + joins < leaves + merges; ++c)
        if (root[c]) offer(static_cast<int32_t>(c));
    while (!queue.empty() && queue.size() + chosen.size() < most_regrouped_parts) {
        const auto m = static_cast<size_t>(-queue.top().second) - leaves;
        queue.pop();
        goes_[m] = 1;
        offer(tree_.merges[m].left);
        offer(tree_.merges[m].right);
    }
    for (; !queue.empty(); queue.pop()) chosen.push_back(-queue.top().second);
    std::sort(chosen.begin(), chosen.end());

    fine_ = chosen.size();
    part_of_.assign(leaves, -1);
    parts_.resize(fine_);
    for (size_t p = 0; p < chosen.size(); ++p) {
        parts_[p].number = chosen[p];
        std::vector<int32_t> todo = {chosen[p]};
        while (!todo.empty()) {
            const auto c = static_cast<size_t>(todo.back());
            todo.pop_back();
            if (c < leaves) {
                part_of_[c] = static_cast<int32_t>(p);
            } else {
                todo.push_back(tree_.merges[c - leaves].left);
                todo.push_back(tree_.merges[c - leaves].right);
            }
        }
    }
}

// Volumes, areas, hulls, and what lies between the parts.
void Regrouping::measure() {
    std::array<double, 3> low = mesh_.vertices.front(), high = low;
    for (const Point& p : mesh_.vertices)
        for (size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    length_unit_ = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    area_unit_ = length_unit_ * length_unit_;
    volume_unit_ = area_unit_ * length_unit_;

    struct Between {
        int32_t a, b;
        bool facet;
        Border border;
    };
    std::vector<Side> sides;
    std::vector<Between> between;
    std::vector<Point> normals;
    std::vector<int32_t> part;  // of each outer triangle
    std::vector<double> curvature(mesh_.vertices.size(), 0), around(mesh_.vertices.size(), 0);
    std::vector<std::vector<int32_t>> corners(fine_);
    std::vector<int32_t> taken_by(mesh_.vertices.size(), -1);  // of each vertex, the part seen last
    for (size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
        const Tetrahedron& tet = mesh_.tetrahedra[t];
        const int32_t p = part_of_[t];
        std::vector<int32_t>& mine = corners[static_cast<size_t>(p)];
        if (mine.empty()) at(p).low = static_cast<int32_t>(t);
        for (const int32_t v : tet)
            if (std::exchange(taken_by[static_cast<size_t>(v)], p) != p) mine.push_back(v);
        const double six = six_volumes(point(tet[0]), point(tet[1]), point(tet[2]), point(tet[3]));
        at(p).volume += six / 6 / volume_unit_;
        for (size_t k = 0; k < 4; ++k) {
            const int32_t other = mesh_.neighbours[t][k];
            const int32_t q = other < 0 ? -1 : part_of_[static_cast<size_t>(other)];
            if (other >= 0 && q <= p) continue;
            const Triangle f = facet(tet, k);
            Point n = cross(point(f[1]) - point(f[0]), point(f[2]) - point(f[0]));
            const double twice = length(n);
            const double size = twice / 2 / area_unit_;
            if (other >= 0) {
                between.push_back({p, q, true, {size, 0, 0, 0, 0}});
                continue;
            }
            if (twice > 0)
                for (double& x : n) x /= twice;
            at(p).area += size;
            const auto number = static_cast<int32_t>(normals.size());
            normals.push_back(n);
            part.push_back(p);
            for (size_t i = 0; i < 3; ++i) {
                const int32_t v = f[i], w = f[(i + 1) % 3];
                sides.push_back({std::min(v, w), std::max(v, w), number, v < w});
                around[static_cast<size_t>(v)] += size / 3;
            }
        }
    }
    progress_.advance(0.1);
    for (size_t p = 0; p < fine_; ++p) {
        parts_[p].volume = std::max(0.0, parts_[p].volume);
        parts_[p].hull = kernel_.build(corners[p]);
        parts_[p].hull_volume = parts_[p].hull.volume() / volume_unit_;
        parts_[p].log_volume = log2_of(parts_[p].volume);
        parts_[p].log_area = log2_of(parts_[p].area);
        volume_ += parts_[p].volume;
        area_ += parts_[p].area;
        if (p % 16 == 0) progress_.advance(0.1);
    }
    log_volume_ = log2_of(volume_);
    log_area_ = log2_of(area_);
    hull_volume_ = tree_.merges.back().hull_volume / volume_unit_;

    struct Fold {
        int32_t low, high, s, t;
        double length, bend;  // bend: the sine of half the angle, below 0 where concave
    };
    std::vector<Fold> folds;
    sort_by_edge(sides, mesh_.vertices.size());
    for (size_t i = 0; i + 1 < sides.size(); ++i) {
        const Side &x = sides[i], &y = sides[i + 1];
        if (x.low != y.low || x.high != y.high) continue;
        const Point &m = normals[static_cast<size_t>(x.triangle)], &n = normals[static_cast<size_t>(y.triangle)];
        const Point along = point(x.high) - point(x.low);
        const double turn = dot(cross(m, n), along) * (x.forward ? 1 : -1);
        const double bend = std::sqrt(std::max(0.0, (1 - dot(m, n)) / 2)) * (turn < 0 ? -1 : 1);
        const double length = partwheel::length(along) / length_unit_;
        folds.push_back({x.low, x.high, x.triangle, y.triangle, length, bend});
        ++i;
    }
    // Mean curvature, smoothed over the surface: it finds creases that many small edges share. Only the quotient
    // matters, so both sums may grow with each pass.
    for (const Fold& f : folds)
        for (const int32_t v : {f.low, f.high}) curvature[static_cast<size_t>(v)] += f.length * f.bend / 2;
    for (int pass = 0; pass < smoothing_passes; ++pass) {
        std::vector<double> c = curvature, r = around;
        for (const Fold& f : folds) {
            const auto i = static_cast<size_t>(f.low), j = static_cast<size_t>(f.high);
            c[i] += curvature[j];
            c[j] += curvature[i];
            r[i] += around[j];
            r[j] += around[i];
        }
        curvature.swap(c);
        around.swap(r);
    }
    progress_.advance(0.2);
    const double unit = std::sqrt(area_);
    const auto curved = [&](int32_t v) {
        const auto i = static_cast<size_t>(v);
        return around[i] > 0 ? curvature[i] / around[i] * unit : 0;
    };
    for (const Fold& f : folds) {
        const auto [p, q] = std::minmax(part[static_cast<size_t>(f.s)], part[static_cast<size_t>(f.t)]);
        if (p == q) continue;
        const double h = (curved(f.low) + curved(f.high)) / 2;
        between.push_back({p, q, false,
                           {0, f.length, f.length * f.bend, f.bend < -concave_bend ? f.length : 0,
                            f.length * h / (middling_curvature + std::abs(h))}});
    }
    std::stable_sort(between.begin(), between.end(), [](const Between& x, const Between& y) {
        return std::pair(x.a, x.b) < std::pair(y.a, y.b);
    });
    for (size_t i = 0; i < between.size();) {
        Link link{between[i].a, between[i].b, {}};
        bool facet_shared = false;
        for (; i < between.size() && between[i].a == link.a && between[i].b == link.b; ++i) {
            link.border += between[i].border;
            facet_shared |= between[i].facet;
        }
        if (!facet_shared) continue;  // they only touch along an edge
        for (const int32_t p : {link.a, link.b}) {
            at(p).rim += link.border;
            at(p).links.push_back(static_cast<int32_t>(links_.size()));
        }
        links_.push_back(link);
    }
}

double convexity_gap(double volume, double hull) { return hull > 0 ? std::clamp(1 - volume / hull, 0.0, 1.0) : 0; }

double share(double part, double whole) { return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0; }

double mean(double sum, double length) { return length > 0 ? sum / length : 0; }

// hull: the volume of the hull of both.
PairMeasures Regrouping::measures(const Part& a, const Part& b, const Border& border, double hull) const {
    const auto rough_a = static_cast<float>(a.area), rough_b = static_cast<float>(b.area);
    const bool ordered = rough_a < rough_b || (rough_a == rough_b && a.low < b.low);
    const Part &s = ordered ? a : b, &l = ordered ? b : a;
    const double volume = s.volume + l.volume, area = s.area + l.area;
    const double gaps = std::max(0.0, s.hull_volume - s.volume) + std::max(0.0, l.hull_volume - l.volume);
    const double excess = std::max(0.0, hull - volume - gaps);  // the concavity that joining adds
    const double gap = convexity_gap(volume, hull), gap_s = convexity_gap(s.volume, s.hull_volume),
                 gap_l = convexity_gap(l.volume, l.hull_volume);
    const double length = log2_of(border.length), face = log2_of(border.interface);
    const double thick_s = s.log_volume - s.log_area, thick_l = l.log_volume - l.log_area;
    const double size = log_volume_ / 3;
    return {
        .area_s = s.log_area - log_area_,
        .area_both = log2_of(area) - log_area_,
        .volume_s = s.log_volume - log_volume_,
        .volume_both = log2_of(volume) - log_volume_,
        .gap_both = gap,
        .gap_s = gap_s,
        .gap_l = gap_l,
        .excess_to_s = log2_of(1e-4 + (s.hull_volume > 0 ? excess / s.hull_volume : 0)),
        .excess_to_all = log2_of(1e-8 + excess / hull_volume_),
        .face_to_volume_s = std::clamp(face - 2 * s.log_volume / 3, -8.0, 4.0),
        .face_to_area_s = std::clamp(face - s.log_area, -8.0, 4.0),
        .length_to_area_s = std::clamp(length - s.log_area / 2, -8.0, 4.0),
        .length_share_s = share(border.length, s.rim.length),
        .length_share_l = share(border.length, l.rim.length),
        .face_share_s = share(border.interface, s.rim.interface),
        .face_share_l = share(border.interface, l.rim.interface),
        .thickness_step = std::clamp(thick_s - thick_l, -6.0, 6.0),
        .face_to_thick_s = std::clamp(face - length - thick_s, -8.0, 4.0),
        .face_to_thick_l = std::clamp(face - length - thick_l, -8.0, 4.0),
        .crease = mean(border.crease, border.length),
        .concave = share(border.concave, border.length),
        .curvature = mean(border.curvature, border.length),
        .outline = std::clamp(2 * length - face, -4.0, 8.0),
        .face_to_volume_l = std::clamp(face - 2 * l.log_volume / 3, -10.0, 4.0),
        .gap_added = gap - std::max(gap_s, gap_l),
        .area_step = l.log_area - s.log_area,
        .thickness_s = std::clamp(thick_s - size, -8.0, 2.0),
        .thickness_l = std::clamp(thick_l - size, -8.0, 2.0),
    };
}

// Of the hull of both parts.
double Regrouping::hull_volume(const Link& link) {
    const Part &a = at(link.a), &b = at(link.b);
    const bool by_facets = a.hull.facet_count() > b.hull.facet_count();
    const Part &large = by_facets ? a : b, &small = by_facets ? b : a;
    return kernel_.united_volume(large.hull, small.hull.vertices()).volume / volume_unit_;
}

// hull: the volume of the hull of both parts, exact or a guess.
double Regrouping::cost(const Link& link, double hull, bool exact) {
    const auto inputs = in_order(measures(at(link.a), at(link.b), link.border, hull));
    if (trace_ && exact) trace_->pairs.push_back({link.a, link.b, inputs});
    // Rounded, so that pairs that cost the same by symmetry tie, whatever rounding errors their measures carry.
    return static_cast<double>(static_cast<float>(fitted(pair_numbers_, inputs)));
}

// Enters a pair, new or grown, by what it would cost if its hull were as small as it can be. Pairs seldom get cheaper
// by growing, or by a larger hull: so the dear ones, which are most, never need their hull.
void Regrouping::enter(Link& link) {
    const Part &a = at(link.a), &b = at(link.b);
    if (a.area == 0 || b.area == 0) {
        // Without any surface it is no part: it goes first, with the neighbour that it shares most with.
        link.cost = -1e6 - link.border.interface / area_;
        link.guessed = false;
    } else {
        const double least = std::max(link.hull, a.hull_volume + b.hull_volume);
        link.cost = std::max(link.cost, cost(link, least, false));
        link.guessed = true;
    }
    queue_.push({link.cost, static_cast<int32_t>(&link - links_.data())});
}

// What it does cost.
void Regrouping::price(Link& link) {
    link.hull = hull_volume(link);
    link.cost = cost(link, link.hull, true);
    link.guessed = false;
    queue_.push({link.cost, static_cast<int32_t>(&link - links_.data())});
}

void Regrouping::join(int32_t ia, int32_t ib, double cost) {
    const auto number = static_cast<int32_t>(parts_.size());
    parts_.emplace_back();
    Part &a = at(ia), &b = at(ib), &u = parts_.back();
    u.volume = a.volume + b.volume;
    u.area = a.area + b.area;
    u.log_volume = log2_of(u.volume);
    u.log_area = log2_of(u.area);
    u.low = std::min(a.low, b.low);
    u.own_cost = std::clamp(cost, -largest_cost, largest_cost);
    u.worst_cost = std::max({u.own_cost, a.worst_cost, b.worst_cost});
    const bool by_facets = a.hull.facet_count() > b.hull.facet_count();
    const Part &large = by_facets ? a : b, &small = by_facets ? b : a;
    u.hull = kernel_.unite(large.hull, small.hull.vertices());
    u.hull_volume = u.hull.volume() / volume_unit_;
    u.number = static_cast<int32_t>(part_of_.size() + result_.tree.merges.size());
    const Part &first = a.low < b.low ? a : b, &second = a.low < b.low ? b : a;
    result_.tree.merges.push_back(
        {first.number, second.number, ranked_concavity(u.hull.volume(), u.volume * volume_unit_), u.hull.volume()});
    joined_.push_back({ia, ib});

    for (const int32_t old : {ia, ib})
        for (const int32_t l : at(old).links) {
            Link& link = links_[static_cast<size_t>(l)];
            if (!link.alive) continue;
            const int32_t other = link.a == old ? link.b : link.a;
            int32_t& twin = link_to_[static_cast<size_t>(other)];
            if (other == ia || other == ib) {
                link.alive = false;
            } else if (twin < 0) {
                twin = l;
                link.a = other;
                link.b = number;
                u.links.push_back(l);
            } else {
                Link& kept = links_[static_cast<size_t>(twin)];
                kept.border += link.border;
                kept.hull = std::max(kept.hull, link.hull);
                kept.cost = std::min(kept.cost, link.cost);
                link.alive = false;
            }
        }
    for (const int32_t l : u.links) {
        Link& link = links_[static_cast<size_t>(l)];
        link_to_[static_cast<size_t>(link.a)] = -1;
        u.rim += link.border;
    }
    for (const int32_t l : u.links) enter(links_[static_cast<size_t>(l)]);
    a.alive = b.alive = false;
    a.hull = Hull();
    b.hull = Hull();
}

void Regrouping::join_neighbours() {
    for (Link& link : links_) enter(link);
    if (trace_)  // fitting needs to see the dear ones too
        for (const Link& link : links_)
            if (link.guessed) cost(link, hull_volume(link), true);
    while (!queue_.empty()) {
        const auto [cost, number] = queue_.top();
        queue_.pop();
        Link& link = links_[static_cast<size_t>(number)];
        if (!link.alive || link.cost != cost) continue;
        if (link.guessed) {
            price(link);
            continue;
        }
        join(link.a, link.b, link.cost);
        progress_.advance(0.2 + 0.8 * static_cast<double>(joined_.size()) / static_cast<double>(fine_));
    }
}

// As in the paper's tree.
void Regrouping::join_components() {
    const size_t leaves = part_of_.size(), joins = tree_.components - 1, merges = tree_.merges.size();
    std::vector<int32_t> component(leaves, -1);  // at its lowest tetrahedron
    for (size_t p = 0; p < parts_.size(); ++p)
        if (parts_[p].alive) component[static_cast<size_t>(parts_[p].low)] = static_cast<int32_t>(p);
    std::vector<int32_t> low(leaves + merges);
    std::iota(low.begin(), low.begin() + static_cast<std::ptrdiff_t>(leaves), 0);
    for (size_t m = 0; m < merges; ++m) {
        const auto a = static_cast<size_t>(low[static_cast<size_t>(tree_.merges[m].left)]);
        const auto b = static_cast<size_t>(low[static_cast<size_t>(tree_.merges[m].right)]);
        low[leaves + m] = static_cast<int32_t>(std::min(a, b));
        if (m + joins < merges) continue;
        join(component[a], component[b], largest_cost);
        component[std::min(a, b)] = static_cast<int32_t>(parts_.size()) - 1;
    }
}

OwnMeasures Regrouping::measures(const Part& p) const {
    const double length = log2_of(p.rim.length), face = log2_of(p.rim.interface);
    const double thick = p.log_volume - p.log_area;
    return {
        .area = p.log_area - log_area_,
        .volume = p.log_volume - log_volume_,
        .gap = convexity_gap(p.volume, p.hull_volume),
        .length_to_area = std::clamp(length - p.log_area / 2, -8.0, 4.0),
        .face_to_volume = std::clamp(face - 2 * p.log_volume / 3, -8.0, 4.0),
        .crease = mean(p.rim.crease, p.rim.length),
        .concave = mean(p.rim.concave, p.rim.length),
        .curvature = mean(p.rim.curvature, p.rim.length),
        .face_to_area = std::clamp(face - p.log_area, -8.0, 4.0),
        .own_cost = p.own_cost,
        .worst_cost = p.worst_cost,
        .thickness = std::clamp(thick - log_volume_ / 3, -8.0, 2.0),
        .outline = std::clamp(2 * length - face, -4.0, 8.0),
        .face_to_thick = std::clamp(face - length - thick, -8.0, 4.0),
        .dents = log2_of(1e-6 + std::max(0.0, p.hull_volume - p.volume) / hull_volume_),
    };
}

NodeMeasures Regrouping::measures(size_t node) const {
    const bool root = above_[node] < 0;
    const size_t up = root ? node : static_cast<size_t>(above_[node]);
    const size_t side = root ? node : static_cast<size_t>(beside_[node]);
    const OwnMeasures own = measures(parts_[node]), parent = measures(parts_[up]), sibling = measures(parts_[side]);
    const double out = root ? largest_cost : parent.own_cost;
    double cheapest_above = largest_cost, dearest_above = root ? largest_cost : -largest_cost;
    for (int32_t p = above_[node]; p >= 0; p = above_[static_cast<size_t>(p)]) {
        cheapest_above = std::min(cheapest_above, parts_[static_cast<size_t>(p)].own_cost);
        dearest_above = std::max(dearest_above, parts_[static_cast<size_t>(p)].own_cost);
    }
    // How many parts there are when it comes, and when it goes.
    const auto parts_at = [&](size_t n) { return static_cast<double>(n < fine_ ? fine_ : 2 * fine_ - 1 - n); };
    return {
        .own = own,
        .parent_cost = out,
        .cost_step = out - own.own_cost,
        .sibling_area = sibling.area - own.area,
        .parent_area = parent.area - own.area,
        .sibling_gap = sibling.gap,
        .sibling_thickness = sibling.thickness,
        .parent_gap = parent.gap,
        .parent_crease = parent.crease,
        .parent_concave = parent.concave,
        .parent_curvature = parent.curvature,
        .root = root ? 1.0 : 0.0,
        .gap_step = parent.gap - own.gap,
        .parts_when_made = log2_of(parts_at(node)),
        .parts_when_joined = log2_of(root ? 1 : parts_at(up) + 1),
        .cheapest_above = cheapest_above,
        .dearest_above = dearest_above,
        .sibling_volume = std::abs(sibling.volume - own.volume),
    };
}

std::vector<double> Regrouping::scores() const {
    const size_t leaves = part_of_.size();
    std::vector<double> of_part;
    for (size_t n = 0; n < parts_.size(); ++n) {
        const auto inputs = in_order(measures(n));
        if (trace_) trace_->nodes.push_back(inputs);
        const double logit = fitted(fitted_node_numbers, inputs);
        of_part.push_back((1 + logit / (1 + std::abs(logit))) / 2);
    }
    // Parts in depth-first order of the new tree.
    std::vector<int32_t> part_of_cluster(leaves + result_.tree.merges.size(), -1);
    for (size_t p = 0; p < fine_; ++p)
        part_of_cluster[static_cast<size_t>(parts_[p].number)] = static_cast<int32_t>(p);
    std::vector<double> ordered;
    std::vector<int32_t> todo = {static_cast<int32_t>(part_of_cluster.size()) - 1};
    while (!todo.empty()) {
        const auto c = static_cast<size_t>(todo.back());
        todo.pop_back();
        if (part_of_cluster[c] >= 0) {
            ordered.push_back(of_part[static_cast<size_t>(part_of_cluster[c])]);
            continue;
        }
        todo.push_back(result_.tree.merges[c - leaves].right);
        todo.push_back(result_.tree.merges[c - leaves].left);
    }
    ordered.insert(ordered.end(), of_part.begin() + static_cast<std::ptrdiff_t>(fine_), of_part.end());
    return ordered;
}

Regrouped Regrouping::run() {
    choose_parts();
    measure();
    // What stays of the paper's tree, with new numbers.
    const size_t leaves = part_of_.size(), joins = tree_.components - 1;
    std::vector<int32_t> number(leaves + tree_.merges.size(), -1);
    std::iota(number.begin(), number.begin() + static_cast<std::ptrdiff_t>(leaves), 0);
    result_.tree.components = tree_.components;
    for (size_t m = 0; m + joins < tree_.merges.size(); ++m) {
        if (goes_[m]) continue;
        Merge merge = tree_.merges[m];
        merge.left = number[static_cast<size_t>(merge.left)];
        merge.right = number[static_cast<size_t>(merge.right)];
        number[leaves + m] = static_cast<int32_t>(leaves + result_.tree.merges.size());
        result_.tree.merges.push_back(merge);
    }
    for (Part& p : parts_) p.number = number[static_cast<size_t>(p.number)];

    parts_.reserve(2 * fine_ - 1);  // join() holds references
    link_to_.assign(2 * fine_ - 1, -1);
    join_neighbours();
    join_components();
    above_.assign(parts_.size(), -1);
    beside_.assign(parts_.size(), -1);
    for (size_t j = 0; j < joined_.size(); ++j)
        for (size_t k = 0; k < 2; ++k) {
            above_[static_cast<size_t>(joined_[j][k])] = static_cast<int32_t>(fine_ + j);
            beside_[static_cast<size_t>(joined_[j][k])] = joined_[j][1 - k];
        }
    result_.scores = scores();
    if (trace_) {
        trace_->part_of_tetrahedron = part_of_;
        trace_->merges = joined_;
    }
    return std::move(result_);
}

}  // namespace

double fitted(std::span<const double> numbers, std::span<const double> inputs) {
    double sum = numbers.back();
    const size_t row = inputs.size() + 2;
    for (size_t h = 0; h + row < numbers.size(); h += row) {
        double z = numbers[h];
        for (size_t i = 0; i < inputs.size(); ++i) z += numbers[h + 1 + i] * inputs[i];
        sum += numbers[h + 1 + inputs.size()] * (z / (1 + std::abs(z)));
    }
    return sum;
}

Regrouped regroup(const TetMesh& mesh, const BinaryTree& tree, Progress& progress,
                  std::span<const double> pair_numbers, RegroupTrace* trace) {
    if (tree.merges.empty()) return {tree, {1.0}};
    const std::span<const double> numbers = pair_numbers.empty() ? fitted_pair_numbers : pair_numbers;
    return Regrouping(mesh, tree, progress, numbers, trace).run();
}

}  // namespace partwheel
