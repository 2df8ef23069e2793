// Least squares of the umbrella vectors (discrete Laplacians) of the free vertices and their neighbors.
#include "edit/fair.h"

#include "base/error.h"
#include "base/adjacency.h"
#include "edit/sparse_factor.h"

#include <Eigen/SparseCore>

namespace partwheel {

namespace {

// Relative to the mean: shorter edges, as Boolean operations leave them, count as this long.
constexpr double min_relative_length = 1e-3;

// Fixes each connected component without a fixed vertex.
void fix_isolated_components(std::span<const std::array<int32_t, 2>> edges, std::vector<bool>& free) {
    UnionFind components(free.size());
    for (const auto& [a, b] : edges) components.unite(idx(a), idx(b));
    std::vector<bool> has_fixed(free.size(), false);
    for (size_t i = 0; i < free.size(); ++i)
        if (!free[i]) has_fixed[components.find(i)] = true;
    for (size_t i = 0; i < free.size(); ++i) free[i] = free[i] && has_fixed[components.find(i)];
}

void check(std::span<const Point> vertices, std::span<const std::array<int32_t, 2>> edges) {
    for (size_t v = 0; v < vertices.size(); ++v)
        if (!std::ranges::all_of(vertices[v], [](double x) { return std::isfinite(x); }))
            throw Error(PW_ERROR_NOT_FINITE, "A coordinate is not a finite number.",
                        {.vertices = {static_cast<int64_t>(v), -1}});
    for (const auto& edge : edges)
        for (int32_t v : edge)
            if (v < 0 || idx(v) >= vertices.size())
                throw Error(PW_ERROR_INDEX, "An edge has a vertex that is not there.");
}

// One row per free vertex and per neighbor of one: its umbrella should vanish. The umbrella of a fixed vertex also has
// a constant part, from its fixed neighbors: how the surface arrives there. One column per free vertex.
class UmbrellaSystem {
public:
    UmbrellaSystem(std::span<const Point> vertices, std::span<const std::array<int32_t, 2>> edges, const std::vector<bool>& free)
        : vertices_(vertices), edges_(edges), column_(vertices.size(), -1), row_(vertices.size(), -1) {
        number_rows(free);
        measure_edges();
    }

    // Nothing can move.
    bool is_empty() const { return columns_ == 0 || !(mean_length_ > 0); }
    // Moves the free vertices.
    void solve(std::span<Point> result, Progress& progress) const {
        const auto rows = static_cast<Eigen::Index>(row_vertex_.size());
        std::vector<Eigen::Triplet<double>> entries;
        Eigen::MatrixXd right = Eigen::MatrixXd::Zero(rows, 3);
        fill(entries, right);
        progress.reach(0.2);
        Eigen::SparseMatrix<double> umbrellas(rows, columns_);
        umbrellas.setFromTriplets(entries.begin(), entries.end());
        const Eigen::SparseMatrix<double> transposed = umbrellas.transpose();
        progress.reach(0.25);
        const Eigen::SparseMatrix<double> system = transposed * umbrellas;
        progress.reach(0.3);
        const SparseFactor factor(system, progress, 0.3, 0.9);
        const Eigen::MatrixXd projected = transposed * right;
        std::vector<Point> positions(static_cast<size_t>(columns_));
        for (Eigen::Index c = 0; c < columns_; ++c)
            positions[idx(factor.row_of(static_cast<size_t>(c)))] = {projected(c, 0), projected(c, 1), projected(c, 2)};
        progress.reach(0.9);
        factor.solve(positions);
        for (size_t v = 0; v < vertices_.size(); ++v) {
            if (column_[v] < 0) continue;
            const Point& p = positions[idx(factor.row_of(static_cast<size_t>(column_[v])))];
            if (!std::ranges::all_of(p, [](double x) { return std::isfinite(x); }))
                throw Error(PW_ERROR_INTERNAL, "The surface could not be smoothed: its edges are too unequal.");
            result[v] = origin_ + mean_length_ * p;
        }
    }

private:
    using Edge = std::array<int32_t, 2>;

    void number_rows(const std::vector<bool>& free) {
        const auto add_row = [&](size_t v) {
            if (row_[v] >= 0) return;
            row_[v] = static_cast<Eigen::Index>(row_vertex_.size());
            row_vertex_.push_back(v);
        };
        for (size_t v = 0; v < vertices_.size(); ++v)
            if (free[v]) column_[v] = columns_++, add_row(v);
        for (const auto& [a, b] : edges_) {
            if (free[idx(a)]) add_row(idx(b));
            if (free[idx(b)]) add_row(idx(a));
        }
        if (columns_ > 0) origin_ = vertices_[row_vertex_.front()];
    }

    void measure_edges() {
        degree_.resize(row_vertex_.size(), 0);
        double sum = 0;
        size_t count = 0;
        for (const Edge& e : edges_) {
            if (e[0] == e[1] || (row_[idx(e[0])] < 0 && row_[idx(e[1])] < 0)) continue;
            sum += edge_length(e), ++count;
            for (const int32_t v : e)
                if (row_[idx(v)] >= 0) ++degree_[static_cast<size_t>(row_[idx(v)])];
        }
        mean_length_ = sum / static_cast<double>(std::max<size_t>(count, 1));
    }

    // Scale-dependent umbrella: 2 / degree * sum over neighbors of (neighbor - vertex) / length, in units of the mean
    // length.
    void fill(std::vector<Eigen::Triplet<double>>& entries, Eigen::MatrixXd& right) const {
        const auto add = [&](Eigen::Index r, size_t v, double weight) {
            if (column_[v] >= 0) {
                entries.emplace_back(r, column_[v], weight);
                return;
            }
            const Point p = vertices_[v] - origin_;
            for (size_t k = 0; k < 3; ++k) right(r, static_cast<Eigen::Index>(k)) -= weight * p[k] / mean_length_;
        };
        for (const Edge& e : edges_)
            for (size_t k = 0; k < 2; ++k) {
                const size_t v = idx(e[k]), neighbor = idx(e[1 - k]);
                const Eigen::Index r = row_[v];
                if (e[0] == e[1] || r < 0) continue;
                const double relative_length = std::max(edge_length(e) / mean_length_, min_relative_length);
                const double weight = 2.0 / degree_[static_cast<size_t>(r)] / relative_length;
                add(r, neighbor, weight);
                add(r, v, -weight);
            }
    }

    double edge_length(const Edge& e) const { return length(vertices_[idx(e[0])] - vertices_[idx(e[1])]); }

    std::span<const Point> vertices_;
    std::span<const Edge> edges_;
    std::vector<Eigen::Index> column_, row_;  // of each vertex, or -1
    Eigen::Index columns_ = 0;
    std::vector<size_t> row_vertex_;
    std::vector<int> degree_;  // of each row
    double mean_length_ = 0;   // of the edges at vertices with a row
    Point origin_{};
};

}  // namespace

std::vector<Point> fair_vertices(std::span<const Point> vertices, std::span<const std::array<int32_t, 2>> edges,
                                 std::span<const uint8_t> may_move, Progress& progress) {
    check(vertices, edges);
    std::vector<bool> free(vertices.size());
    for (size_t i = 0; i < vertices.size(); ++i) free[i] = may_move[i] != 0;
    fix_isolated_components(edges, free);
    progress.reach(0.1);
    std::vector<Point> result(vertices.begin(), vertices.end());
    if (const UmbrellaSystem system(vertices, edges, free); !system.is_empty()) system.solve(result, progress);
    return result;
}

}  // namespace partwheel
