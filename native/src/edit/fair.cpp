// Least squares of the umbrella vectors (discrete Laplacians) of the free vertices and their neighbors.
#include "edit/fair.h"

#include "base/error.h"
#include "base/adjacency.h"
#include "edit/sparse_factor.h"

#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>

namespace partwheel {

namespace {

// Relative to the mean: shorter edges, as Boolean operations leave them, count as this long.
constexpr double min_relative_length = 1e-3;

// Fixes each connected component of free vertices that has no fixed neighbor.
void fix_isolated_components(std::span<const std::array<int32_t, 2>> edges, std::vector<bool>& free) {
    UnionFind components(free.size());
    for (const auto& [a, b] : edges)
        if (free[idx(a)] && free[idx(b)]) components.unite(idx(a), idx(b));
    std::vector<bool> has_fixed_neighbor(free.size(), false);
    for (const auto& [a, b] : edges) {
        if (free[idx(a)] && !free[idx(b)]) has_fixed_neighbor[components.find(idx(a))] = true;
        if (free[idx(b)] && !free[idx(a)]) has_fixed_neighbor[components.find(idx(b))] = true;
    }
    for (size_t i = 0; i < free.size(); ++i)
        if (free[i] && !has_fixed_neighbor[components.find(i)]) free[i] = false;
}

}  // namespace

std::vector<Point> fair_vertices(std::span<const Point> vertices, std::span<const std::array<int32_t, 2>> edges,
                                 std::span<const uint8_t> may_move, Progress& progress) {
    for (size_t v = 0; v < vertices.size(); ++v)
        if (!std::ranges::all_of(vertices[v], [](double x) { return std::isfinite(x); }))
            throw Error(PW_ERROR_NOT_FINITE, "A coordinate is not a finite number.",
                        {.vertices = {static_cast<int64_t>(v), -1}});
    for (const auto& edge : edges)
        for (int32_t v : edge)
            if (v < 0 || idx(v) >= vertices.size())
                throw Error(PW_ERROR_INDEX, "An edge has a vertex that is not there.");
    std::vector<bool> free(vertices.size());
    for (size_t i = 0; i < vertices.size(); ++i) free[i] = may_move[i] != 0;
    fix_isolated_components(edges, free);
    progress.reach(0.1);

    // One row per free vertex and per neighbor of one: its umbrella should vanish. The umbrella of a fixed vertex
    // also has a constant part, from its fixed neighbors: how the surface arrives there.
    std::vector<Eigen::Index> column(vertices.size(), -1), row(vertices.size(), -1);
    Eigen::Index columns = 0, rows = 0;
    std::vector<size_t> row_vertex;
    const auto add_row = [&](size_t v) {
        if (row[v] >= 0) return;
        row[v] = rows++;
        row_vertex.push_back(v);
    };
    for (size_t v = 0; v < vertices.size(); ++v)
        if (free[v]) column[v] = columns++, add_row(v);
    std::vector<Point> result(vertices.begin(), vertices.end());
    if (columns == 0) return result;
    for (const auto& [a, b] : edges) {
        if (free[idx(a)]) add_row(idx(b));
        if (free[idx(b)]) add_row(idx(a));
    }

    double sum = 0;
    size_t count = 0;
    const auto touches = [&](const std::array<int32_t, 2>& e) { return row[idx(e[0])] >= 0 || row[idx(e[1])] >= 0; };
    for (const auto& e : edges)
        if (e[0] != e[1] && touches(e)) sum += length(vertices[idx(e[0])] - vertices[idx(e[1])]), ++count;
    const double mean = sum / static_cast<double>(std::max<size_t>(count, 1));
    if (!(mean > 0)) return result;
    const auto relative_length = [&](const std::array<int32_t, 2>& e) {
        return std::max(length(vertices[idx(e[0])] - vertices[idx(e[1])]) / mean, min_relative_length);
    };
    std::vector<int> degree(static_cast<size_t>(rows), 0);
    for (const auto& e : edges)
        for (int32_t v : e)
            if (e[0] != e[1] && row[idx(v)] >= 0) ++degree[static_cast<size_t>(row[idx(v)])];

    // Scale-dependent umbrella: 2 / degree * sum over neighbors of (neighbor - vertex) / length, in units of the mean
    // length.
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(rows, 3);
    const Point origin = vertices[row_vertex.front()];
    const auto add = [&](Eigen::Index r, size_t v, double weight) {
        if (column[v] >= 0) {
            entries.emplace_back(r, column[v], weight);
            return;
        }
        const Point p = vertices[v] - origin;
        for (size_t k = 0; k < 3; ++k) right(r, static_cast<Eigen::Index>(k)) -= weight * p[k] / mean;
    };
    for (const auto& e : edges)
        for (size_t k = 0; k < 2; ++k) {
            const size_t v = idx(e[k]), neighbor = idx(e[1 - k]);
            const Eigen::Index r = row[v];
            if (e[0] == e[1] || r < 0) continue;
            const double weight = 2.0 / degree[static_cast<size_t>(r)] / relative_length(e);
            add(r, neighbor, weight);
            add(r, v, -weight);
        }
    progress.reach(0.2);
    Eigen::SparseMatrix<double> umbrellas(rows, columns);
    umbrellas.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SparseMatrix<double> transposed = umbrellas.transpose();
    progress.reach(0.25);
    const Eigen::SparseMatrix<double> system = transposed * umbrellas;
    progress.reach(0.3);
    const SparseFactor factor(system, progress, 0.3, 0.9);
    const Eigen::MatrixXd projected = transposed * right;
    std::vector<Point> positions(static_cast<size_t>(columns));
    for (Eigen::Index c = 0; c < columns; ++c)
        positions[idx(factor.row_of(static_cast<size_t>(c)))] = {projected(c, 0), projected(c, 1), projected(c, 2)};
    progress.reach(0.9);
    factor.solve(positions);
    for (size_t v = 0; v < vertices.size(); ++v) {
        if (column[v] < 0) continue;
        const Point& p = positions[idx(factor.row_of(static_cast<size_t>(column[v])))];
        if (!std::ranges::all_of(p, [](double x) { return std::isfinite(x); }))
            throw Error(PW_ERROR_INTERNAL, "The surface could not be smoothed: its edges are too unequal.");
        result[v] = origin + mean * p;
    }
    return result;
}

}  // namespace partwheel
