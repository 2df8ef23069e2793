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

using Edge = std::array<int32_t, 2>;

// may_move, except in connected components without a fixed vertex.
std::vector<bool> free_vertices(std::span<const Edge> edges, std::span<const uint8_t> may_move) {
    UnionFind components(may_move.size());
    for (const auto& [a, b] : edges) components.unite(idx(a), idx(b));
    std::vector<bool> has_fixed(may_move.size(), false), free(may_move.size());
    for (size_t i = 0; i < free.size(); ++i)
        if (!may_move[i]) has_fixed[components.find(i)] = true;
    for (size_t i = 0; i < free.size(); ++i) free[i] = may_move[i] && has_fixed[components.find(i)];
    return free;
}

void check(std::span<const Point> vertices, std::span<const Edge> edges) {
    for (size_t v = 0; v < vertices.size(); ++v)
        if (!is_finite(vertices[v]))
            throw Error(PW_ERROR_NOT_FINITE, "A coordinate is not a finite number.",
                        {.vertices = {static_cast<int64_t>(v), -1}});
    for (const Edge& edge : edges)
        for (int32_t v : edge)
            if (v < 0 || idx(v) >= vertices.size())
                throw Error(PW_ERROR_INDEX, "An edge refers to a vertex that does not exist.");
}

// The umbrellas of free vertices and of their neighbors are left * x - right, with the positions x of the free vertices
// relative to an origin, in units of the mean edge length. The umbrella of a fixed vertex has a constant part from its
// fixed neighbors, so that the surface continues smoothly there.
struct Umbrellas {
    std::vector<Eigen::Index> column;  // of each free vertex, else -1
    Point origin{};
    double unit = 0;
    Eigen::SparseMatrix<double> left;  // without rows if nothing can move
    Eigen::MatrixXd right;
};

// Scale-dependent umbrella: 2 / degree * sum over neighbors of (neighbor - vertex) / length.
Umbrellas make_umbrellas(std::span<const Point> vertices, std::span<const Edge> edges, const std::vector<bool>& free) {
    Umbrellas system{std::vector<Eigen::Index>(vertices.size(), -1), {}, 0, {}, {}};
    Eigen::Index columns = 0, rows = 0;
    std::vector<Eigen::Index> row(vertices.size(), -1);
    for (size_t v = 0; v < vertices.size(); ++v) {
        if (!free[v]) continue;
        if (columns == 0) system.origin = vertices[v];
        system.column[v] = columns++;
        row[v] = 0;
    }
    for (const auto& [a, b] : edges)
        if (free[idx(a)] || free[idx(b)]) row[idx(a)] = row[idx(b)] = 0;
    for (Eigen::Index& r : row)
        if (r == 0) r = rows++;
    const auto is_used = [&](const Edge& e) { return e[0] != e[1] && (row[idx(e[0])] >= 0 || row[idx(e[1])] >= 0); };
    const auto edge_length = [&](const Edge& e) { return length(vertices[idx(e[0])] - vertices[idx(e[1])]); };
    std::vector<int> degree(vertices.size(), 0);
    size_t count = 0;
    for (const Edge& e : edges) {
        if (!is_used(e)) continue;
        system.unit += edge_length(e), ++count;
        for (const int32_t v : e) ++degree[idx(v)];
    }
    system.unit /= static_cast<double>(std::max<size_t>(count, 1));
    if (columns == 0 || !(system.unit > 0)) return system;

    std::vector<Eigen::Triplet<double>> entries;
    system.right = Eigen::MatrixXd::Zero(rows, 3);
    const auto add = [&](Eigen::Index r, size_t v, double weight) {
        if (system.column[v] >= 0) {
            entries.emplace_back(r, system.column[v], weight);
            return;
        }
        const Point p = vertices[v] - system.origin;
        for (size_t k = 0; k < 3; ++k) system.right(r, static_cast<Eigen::Index>(k)) -= weight * p[k] / system.unit;
    };
    for (const Edge& e : edges)
        for (size_t k = 0; k < 2; ++k) {
            const size_t v = idx(e[k]);
            if (e[0] == e[1] || row[v] < 0) continue;
            const double weight = 2.0 / degree[v] / std::max(edge_length(e) / system.unit, min_relative_length);
            add(row[v], idx(e[1 - k]), weight);
            add(row[v], v, -weight);
        }
    system.left.resize(rows, columns);
    system.left.setFromTriplets(entries.begin(), entries.end());
    return system;
}

}  // namespace

std::vector<Point> fair_vertices(std::span<const Point> vertices, std::span<const Edge> edges, std::span<const uint8_t> may_move,
                                 Progress& progress) {
    check(vertices, edges);
    const std::vector<bool> free = free_vertices(edges, may_move);
    progress.reach(0.1);
    const Umbrellas umbrellas = make_umbrellas(vertices, edges, free);
    progress.reach(0.2);
    std::vector<Point> result(vertices.begin(), vertices.end());
    if (umbrellas.left.rows() == 0) return result;
    const Eigen::SparseMatrix<double> transposed = umbrellas.left.transpose();
    progress.reach(0.25);
    const Eigen::SparseMatrix<double> squared = transposed * umbrellas.left;
    progress.reach(0.3);
    const SparseFactor factor(squared, progress, 0.3, 0.9);
    const Eigen::MatrixXd projected = transposed * umbrellas.right;
    std::vector<Point> positions(static_cast<size_t>(squared.rows()));
    for (Eigen::Index c = 0; c < squared.rows(); ++c)
        positions[idx(factor.row_of(static_cast<size_t>(c)))] = {projected(c, 0), projected(c, 1), projected(c, 2)};
    progress.reach(0.9);
    factor.solve(positions);
    for (size_t v = 0; v < vertices.size(); ++v) {
        if (!free[v]) continue;
        const Point& p = positions[idx(factor.row_of(static_cast<size_t>(umbrellas.column[v])))];
        if (!is_finite(p))
            throw Error(PW_ERROR_INTERNAL, "The surface can't be smoothed: its edges differ too much in length. Dissolve degenerate "
                                           "faces first.");
        result[v] = umbrellas.origin + umbrellas.unit * p;
    }
    return result;
}

}  // namespace partwheel
