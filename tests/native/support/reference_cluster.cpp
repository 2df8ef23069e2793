// Listing 1 of the paper by brute force.
#include "support/reference_cluster.h"

#include "support/reference_hull.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <tuple>

namespace partwheel::test {

namespace {

double rank(long double concavity, long double hull_volume) {
    if (concavity <= convex_tolerance * hull_volume) return 0;
    int exponent = 0;
    const long double mantissa = std::frexp(concavity, &exponent);
    return static_cast<double>(std::ldexp(std::round(std::ldexp(mantissa, concavity_bits)), exponent - concavity_bits));
}

long double tet_volume(const Point& a, const Point& b, const Point& c, const Point& d) {
    std::array<std::array<long double, 3>, 3> e;
    for (size_t k = 0; k < 3; ++k) {
        const long double o = a[k];
        e[0][k] = b[k] - o;
        e[1][k] = c[k] - o;
        e[2][k] = d[k] - o;
    }
    return (e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
            e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) / 6;
}

double box_volume(const std::vector<Point>& points) {
    Point low = points[0], high = points[0];
    for (const Point& p : points)
        for (size_t d = 0; d < 3; ++d) {
            low[d] = std::min(low[d], p[d]);
            high[d] = std::max(high[d], p[d]);
        }
    return (high[0] - low[0]) * (high[1] - low[1]) * (high[2] - low[2]);
}

}  // namespace

bool ReferenceCost::operator<(const ReferenceCost& other) const {
    return std::tie(rank, balance, low, high) < std::tie(other.rank, other.balance, other.low, other.high);
}

bool surely_before(const ReferenceCost& a, const ReferenceCost& b) {
    if (a.rank_high < b.rank_low) return true;
    const bool tied = a.rank_low == a.rank_high && b.rank_low == b.rank_high && a.rank_low == b.rank_low;
    return tied && std::tie(a.balance, a.low, a.high) < std::tie(b.balance, b.low, b.high);
}

ReferenceClustering::ReferenceClustering(const TetMesh& mesh) : points_(mesh.vertices) {
    for (; static_cast<size_t>(next_) < mesh.tetrahedra.size(); ++next_) {
        const Tetrahedron& t = mesh.tetrahedra[static_cast<size_t>(next_)];
        Cluster cluster;
        cluster.vertices.assign(t.begin(), t.end());
        std::sort(cluster.vertices.begin(), cluster.vertices.end());
        cluster.lowest = next_;
        const auto point = [&](size_t k) -> const Point& { return points_[static_cast<size_t>(t[k])]; };
        cluster.volume = tet_volume(point(0), point(1), point(2), point(3));
        clusters_.emplace(next_, std::move(cluster));
    }
    for (int32_t t = 0; t < next_; ++t)
        for (const int32_t n : mesh.neighbors[static_cast<size_t>(t)])
            if (n > t) add_edge(t, n);
}

ReferenceClustering::Edge ReferenceClustering::edge(int32_t a, int32_t b) const {
    return clusters_.at(a).lowest < clusters_.at(b).lowest ? Edge{a, b} : Edge{b, a};
}

ReferenceCost ReferenceClustering::measure(const Cluster& a, const Cluster& b) {
    std::vector<int32_t> vertices;
    std::set_union(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                   std::back_inserter(vertices));
    std::vector<Point> points;
    for (const int32_t v : vertices) points.push_back(points_[static_cast<size_t>(v)]);
    ReferenceCost cost;
    ++hulls_built_;
    cost.hull_volume = reference_hull_volume(points);
    cost.volume = a.volume + b.volume;
    cost.balance = a.tetrahedra * a.tetrahedra + b.tetrahedra * b.tetrahedra;
    cost.low = std::min(a.lowest, b.lowest);
    cost.high = std::max(a.lowest, b.lowest);
    const long double concavity = cost.hull_volume - cost.volume;
    cost.tolerance = static_cast<double>(1e-12L * cost.hull_volume) + 1e-14 * box_volume(points);
    cost.rank = rank(concavity, cost.hull_volume);
    cost.rank_low = rank(concavity - cost.tolerance, cost.hull_volume);
    cost.rank_high = rank(concavity + cost.tolerance, cost.hull_volume);
    return cost;
}

void ReferenceClustering::connect_components() {
    std::map<int32_t, int32_t> by_lowest;  // lowest tetrahedron -> cluster
    for (const auto& [id, cluster] : clusters_) by_lowest.emplace(cluster.lowest, id);
    std::set<Edge> edges;
    for (const auto& [lowest, id] : by_lowest) {
        std::vector<std::pair<double, int32_t>> others;  // at the same distance, the lowest tetrahedron comes first
        for (const auto& [other_lowest, other] : by_lowest)
            if (other != id) others.emplace_back(squared_box_distance(clusters_.at(id).vertices, clusters_.at(other).vertices), other_lowest);
        std::sort(others.begin(), others.end());
        if (clusters_.size() > 64) others.resize(16);
        for (const auto& [distance, other_lowest] : others) edges.insert(edge(id, by_lowest.at(other_lowest)));
    }
    for (const auto& [a, b] : edges) add_edge(a, b);
}

double ReferenceClustering::squared_box_distance(const std::vector<int32_t>& a, const std::vector<int32_t>& b) const {
    double sum = 0;
    for (size_t d = 0; d < 3; ++d) {
        const auto by_coordinate = [&](int32_t v, int32_t w) { return points_[static_cast<size_t>(v)][d] < points_[static_cast<size_t>(w)][d]; };
        const auto range = [&](const std::vector<int32_t>& vertices) {
            const auto [low, high] = std::minmax_element(vertices.begin(), vertices.end(), by_coordinate);
            return std::pair(points_[static_cast<size_t>(*low)][d], points_[static_cast<size_t>(*high)][d]);
        };
        const auto [low_a, high_a] = range(a);
        const auto [low_b, high_b] = range(b);
        const double gap = std::max({0.0, low_b - high_a, low_a - high_b});
        sum += gap * gap;
    }
    return sum;
}

void ReferenceClustering::add_edge(int32_t a, int32_t b) {
    const Edge e = edge(a, b);
    const ReferenceCost cost = measure(clusters_.at(e.first), clusters_.at(e.second));
    costs_.emplace(e, cost);
    queue_.emplace(cost, e);
    clusters_.at(a).neighbors.insert(b);
    clusters_.at(b).neighbors.insert(a);
}

void ReferenceClustering::remove_edge(int32_t a, int32_t b) {
    const Edge e = edge(a, b);
    queue_.erase({costs_.at(e), e});
    costs_.erase(e);
    clusters_.at(a).neighbors.erase(b);
    clusters_.at(b).neighbors.erase(a);
}

std::optional<ReferenceClustering::Candidate> ReferenceClustering::cheapest() {
    if (queue_.empty()) {
        if (components_ == 0) components_ = clusters_.size();
        connect_components();
    }
    if (queue_.empty()) return std::nullopt;
    const auto& [cost, e] = *queue_.begin();
    return Candidate{e.first, e.second, cost};
}

const ReferenceCost* ReferenceClustering::cost(int32_t left, int32_t right) const {
    const auto it = costs_.find({left, right});
    return it == costs_.end() ? nullptr : &it->second;
}

bool ReferenceClustering::is_a_cheapest(const ReferenceCost& cost) const {
    return std::none_of(costs_.begin(), costs_.end(),
                        [&](const auto& other) { return surely_before(other.second, cost); });
}

void ReferenceClustering::merge(int32_t left, int32_t right) {
    Cluster merged;
    const Cluster &a = clusters_.at(left), &b = clusters_.at(right);
    std::set_union(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                   std::back_inserter(merged.vertices));
    merged.tetrahedra = a.tetrahedra + b.tetrahedra;
    merged.lowest = std::min(a.lowest, b.lowest);
    merged.volume = a.volume + b.volume;
    std::set<int32_t> neighbors = a.neighbors;
    neighbors.insert(b.neighbors.begin(), b.neighbors.end());
    neighbors.erase(left);
    neighbors.erase(right);
    for (const int32_t old : {left, right})
        for (const int32_t n : std::set<int32_t>(clusters_.at(old).neighbors)) remove_edge(old, n);
    clusters_.erase(left);
    clusters_.erase(right);
    const int32_t made = next_++;
    clusters_.emplace(made, std::move(merged));
    for (const int32_t n : neighbors) add_edge(made, n);
}

Comparison compare_with_reference(const TetMesh& mesh, const BinaryTree& tree) {
    Comparison result;
    std::ostringstream failure;
    failure.precision(17);
    ReferenceClustering reference(mesh);
    for (const Merge& m : tree.merges) {
        const auto best = reference.cheapest();
        if (!best) {
            failure << "merge " << result.merges << ": the reference has nothing left to merge";
            break;
        }
        const auto describe = [](const ReferenceClustering::Candidate& c) {
            std::ostringstream text;
            text.precision(17);
            text << "clusters " << c.left << " and " << c.right << " (concavity " << c.cost.rank << " in ["
                 << c.cost.rank_low << ", " << c.cost.rank_high << "], balance " << c.cost.balance << ", lowest "
                 << c.cost.low << " and " << c.cost.high << ")";
            return text.str();
        };
        const ReferenceCost* cost = reference.cost(m.left, m.right);
        if (cost == nullptr) {
            failure << "merge " << result.merges << ": clusters " << m.left << " and " << m.right
                    << " are no candidates; the reference takes " << describe(*best);
            break;
        }
        if (m.left != best->left || m.right != best->right) {
            if (!reference.is_a_cheapest(*cost)) {
                failure << "merge " << result.merges << ": took " << describe({m.left, m.right, *cost}) << ", but "
                        << describe(*best) << " comes first";
                break;
            }
            ++result.parted;
        }
        if (m.concavity < cost->rank_low || m.concavity > cost->rank_high ||
            std::fabs(m.hull_volume - static_cast<double>(cost->hull_volume)) > cost->tolerance) {
            failure << "merge " << result.merges << ": concavity " << m.concavity << ", hull volume " << m.hull_volume
                    << "; the reference: " << cost->rank << ", " << static_cast<double>(cost->hull_volume);
            break;
        }
        reference.merge(m.left, m.right);
        ++result.merges;
    }
    if (failure.str().empty() && reference.cheapest()) failure << "merges are missing at the end";
    if (failure.str().empty() && tree.components != std::max<size_t>(reference.components(), 1))
        failure << tree.components << " components, the reference has " << reference.components();
    result.failure = failure.str();
    return result;
}

}  // namespace partwheel::test
