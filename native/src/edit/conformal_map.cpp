// The scale of a conformal map by conjugate gradients, its peaks, and its outline on a grid.
#include "edit/conformal_map.h"

#include "base/elementary.h"

#include <numbers>

namespace partwheel {

namespace {

constexpr double solver_tolerance = 1e-4;  // of conjugate gradients: relative residual
constexpr int max_solver_iterations = 3000, iterations_per_poll = 16;
constexpr int smoothing_rounds = 3;  // of |u|, so that a peak is more than a single sharp vertex
constexpr double saddle_weight = 0.5;  // of u > 0 relative to u < 0: cuts to saddles make the outline overlap itself
constexpr double min_peak_fraction = 0.5;  // of the highest peak
constexpr double min_peak_spacing = 2;     // between peaks, in distances from the boundary
// Relative heights are rounded, so that mirror images have equal ones. Of these, the lower vertex comes first.
constexpr double height_digits = 1e6;
constexpr double max_heading = 1e9;    // more is a failed solver
constexpr double max_exponent = 17;    // so that factors stay finite
constexpr int grid_size = 192;         // pixels along the longer side of an outline's bounding box
constexpr double tiny = 1e-300;

// A symmetric matrix: its diagonal, and -weight elsewhere.
struct SparseMatrix {
    struct Entry {
        int32_t column;
        double weight;
    };
    std::vector<double> diagonal;
    CsrArray<Entry> entries;

    // Returns the dot product of x and the result.
    double multiply(std::span<const double> x, std::span<double> result) const {
        double product = 0;
        for (size_t i = 0; i < x.size(); ++i) {
            double sum = diagonal[i] * x[i];
            for (const auto& [column, weight] : entries.row(i)) sum -= weight * x[idx(column)];
            result[i] = sum;
            product += x[i] * sum;
        }
        return product;
    }
};

double squared_length(std::span<const double> a) { return std::inner_product(a.begin(), a.end(), a.begin(), 0.0); }

// Solves matrix x = right_side by conjugate gradients; stops where the matrix is not positive definite. x: the initial
// guess.
void solve(const SparseMatrix& matrix, std::span<const double> right_side, std::vector<double>& x, Progress& progress) {
    const size_t n = x.size();
    std::vector<double> residual(n), direction(n, 0), image(n);
    const double goal = solver_tolerance * solver_tolerance * squared_length(right_side);
    matrix.multiply(x, image);
    for (size_t i = 0; i < n; ++i) residual[i] = right_side[i] - image[i];
    double squared_norm = squared_length(residual), ratio = 0;
    for (int iteration = 0; iteration < max_solver_iterations && squared_norm > goal; ++iteration) {
        if (iteration % iterations_per_poll == 0) progress.reach(0);
        for (size_t i = 0; i < n; ++i) direction[i] = residual[i] + ratio * direction[i];
        const double curvature = matrix.multiply(direction, image);
        if (!(curvature > 0)) break;
        const double step = squared_norm / curvature, before = squared_norm;
        squared_norm = 0;
        for (size_t i = 0; i < n; ++i) {
            x[i] += step * direction[i], residual[i] -= step * image[i];
            squared_norm += residual[i] * residual[i];
        }
        ratio = squared_norm / before;
    }
}

}  // namespace

ConformalMap::ConformalMap(const Patch& patch, std::span<const double> guess, Progress& progress)
    : patch_(patch), log_scale_(patch.vertex_count, 0), turning_angle_(patch.vertex_count, 2 * std::numbers::pi) {
    const SeamMesh& mesh = patch.mesh;
    std::vector<int32_t> unknown(patch.vertex_count, -1), inner;
    for (size_t v = 0; v < patch.vertex_count; ++v)
        if (!patch.is_boundary[v]) unknown[v] = static_cast<int32_t>(inner.size()), inner.push_back(static_cast<int32_t>(v));
    for (size_t c = 0; c < patch.vertex.size(); ++c) {
        turning_angle_[idx(patch.vertex[c])] -= mesh.faces[c / 3].angle[c % 3];  // in the end the angle defect
        if (!patch.is_boundary[idx(patch.vertex[c])]) log_scale_[idx(patch.vertex[c])] = guess[c];
    }
    std::vector<double> weight;  // of each uncut edge
    for (const int32_t e : patch.uncut) weight.push_back(mesh.edges[idx(e)].weight);
    // Scaled from both sides so that the diagonal is 1. Sides at the boundary lie between vertices where u is known.
    std::vector<double> diagonal(patch.vertex_count, 0);
    for (size_t k = 0; k < weight.size(); ++k)
        for (const int32_t v : patch.uncut_ends[k]) diagonal[idx(v)] += weight[k];
    std::vector<double> scale, right_side, x;
    SparseMatrix matrix;
    for (const int32_t v : inner) {
        scale.push_back(1 / std::sqrt(diagonal[idx(v)] > 0 ? diagonal[idx(v)] : 1));
        matrix.diagonal.push_back(diagonal[idx(v)] > 0 ? 1 : diagonal[idx(v)]);
        right_side.push_back(-turning_angle_[idx(v)] * scale.back());
        x.push_back(log_scale_[idx(v)] / scale.back());
    }
    matrix.entries = CsrArray<SparseMatrix::Entry>(inner.size(), [&](const auto& put) {
        for (size_t k = 0; k < weight.size(); ++k) {
            const int32_t a = unknown[idx(patch.uncut_ends[k][0])], b = unknown[idx(patch.uncut_ends[k][1])];
            if (a < 0 || b < 0) continue;
            const double entry = weight[k] * scale[idx(a)] * scale[idx(b)];
            put(idx(a), SparseMatrix::Entry{b, entry}), put(idx(b), SparseMatrix::Entry{a, entry});
        }
    });
    solve(matrix, right_side, x, progress);
    for (size_t i = 0; i < inner.size(); ++i) log_scale_[idx(inner[i])] = x[i] * scale[i];
    for (double& angle : turning_angle_) angle -= std::numbers::pi;
    for (size_t k = 0; k < weight.size(); ++k) {
        const size_t a = idx(patch.uncut_ends[k][0]), b = idx(patch.uncut_ends[k][1]);
        const double flow = weight[k] * (log_scale_[a] - log_scale_[b]);
        turning_angle_[a] += flow, turning_angle_[b] -= flow;
    }
}

std::vector<double> ConformalMap::corner_log_scale() const {
    std::vector<double> result;
    for (const int32_t v : patch_.vertex) result.push_back(log_scale_[idx(v)]);
    return result;
}

double ConformalMap::area_distortion() const {
    std::vector<double> factors, third;  // of each triangle; the share of each vertex in them
    for (const double u : log_scale_) third.push_back(u == 0 ? 1 : exp_of(std::clamp(2.0 / 3 * u, -max_exponent, max_exponent)));
    for (size_t c = 0; c < patch_.vertex.size(); c += 3)
        factors.push_back(third[idx(patch_.vertex[c])] * third[idx(patch_.vertex[c + 1])] * third[idx(patch_.vertex[c + 2])]);
    return partwheel::area_distortion(patch_.mesh, factors);
}

std::vector<int32_t> ConformalMap::peaks(std::span<const double> boundary_distance, size_t max_count) const {
    const size_t count = patch_.vertex_count;
    std::vector<double> height = log_scale_, degree(count, 1);
    for (const auto& [a, b] : patch_.uncut_ends) ++degree[idx(a)], ++degree[idx(b)];
    for (int round = 0; round < smoothing_rounds; ++round) {
        std::vector<double> sum = height;
        for (const auto& [a, b] : patch_.uncut_ends) sum[idx(a)] += height[idx(b)], sum[idx(b)] += height[idx(a)];
        for (size_t v = 0; v < count; ++v) height[v] = patch_.is_boundary[v] ? 0 : sum[v] / degree[v];
    }
    for (double& h : height) h = h < 0 ? -h : saddle_weight * h;
    const double highest = std::max(*std::ranges::max_element(height), tiny);
    std::vector<Point> position(count);
    for (size_t c = 0; c < patch_.vertex.size(); ++c) position[idx(patch_.vertex[c])] = patch_.mesh.faces[c / 3].corners[c % 3];
    std::vector<std::pair<double, int32_t>> candidates;  // (-height, vertex)
    for (size_t v = 0; v < count; ++v) {
        const double relative = std::nearbyint(height[v] / highest * height_digits) / height_digits;
        if (relative > min_peak_fraction && std::isfinite(boundary_distance[v]))
            candidates.emplace_back(-relative, static_cast<int32_t>(v));
    }
    std::ranges::sort(candidates);
    std::vector<int32_t> peaks;
    while (!candidates.empty() && peaks.size() < max_count) {
        const size_t peak = idx(candidates.front().second);
        peaks.push_back(candidates.front().second);
        std::erase_if(candidates, [&](const auto& candidate) {
            const size_t v = idx(candidate.second);
            const double distance = std::max(boundary_distance[v], boundary_distance[peak]);
            return length(position[v] - position[peak]) <= min_peak_spacing * distance;
        });
    }
    return peaks;
}

double ConformalMap::overlap_fraction() const {
    const std::vector<Patch::BoundaryStep> loop = patch_.boundary_loop();
    std::vector<std::array<double, 2>> outline;
    double heading = 0, total = 0, x = 0, y = 0;
    for (const auto& [vertex, length] : loop) {
        heading += turning_angle_[idx(vertex)];
        if (!(std::fabs(heading) < max_heading)) return 0;
        const auto [cosine, sine] = unit_vector(heading);
        total += length;
        outline.push_back({x += length * cosine, y += length * sine});
    }
    double passed = 0;  // closes the outline: the gap is spread over its length
    for (size_t i = 0; i < loop.size(); ++i) {
        passed += loop[i].length / std::max(total, tiny);
        outline[i] = {outline[i][0] - passed * x, outline[i][1] - passed * y};
    }
    return partwheel::overlap_fraction(outline);
}

double area_distortion(const SeamMesh& mesh, std::span<const double> factors, double max_factor) {
    const double total = std::max(mesh.area(), tiny);
    double mean = 0, sum = 0;
    for (size_t t = 0; t < factors.size(); ++t) mean += factors[t] * (mesh.faces[t].area / total);
    for (size_t t = 0; t < factors.size(); ++t) {
        const double factor = factors[t] / std::max(mean, tiny);
        sum += std::min(std::max(factor, 1 / std::max(factor, 1e-9)), max_factor) * (mesh.faces[t].area / total);
    }
    return sum;
}

double overlap_fraction(std::span<const std::array<double, 2>> outline) {
    Box box;
    for (const auto& [x, y] : outline) box.add(Point{x, y, 0});
    const double size = std::max(box.high[0] - box.low[0], box.high[1] - box.low[1]);
    if (!(size > 0 && std::isfinite(size))) return 0;
    const auto pixel = [&](size_t i, size_t k) { return (outline[i][k] - box.low[k]) * (grid_size / size); };
    const auto first_center = [](double at) { return std::clamp(static_cast<int>(std::ceil(at - 0.5)), 0, grid_size); };
    std::vector<std::array<int, grid_size + 1>> turns(grid_size + 1);  // where the outline crosses the centers of each row
    for (size_t i = 0; i < outline.size(); ++i) {
        const size_t next = (i + 1) % outline.size();
        const double x = pixel(i, 0), y = pixel(i, 1), next_x = pixel(next, 0), next_y = pixel(next, 1);
        for (int row = first_center(std::min(y, next_y)); row < first_center(std::max(y, next_y)); ++row) {
            const double crossing = x + (row + 0.5 - y) / (next_y - y) * (next_x - x);
            turns[idx(row)][idx(first_center(crossing))] += next_y < y ? 1 : -1;
        }
    }
    size_t inside = 0, overlap = 0;
    for (const auto& row : turns) {
        int winding_number = 0;
        for (const int turn : row) {
            winding_number += turn;
            inside += winding_number != 0 ? 1 : 0;
            overlap += std::abs(winding_number) > 1 ? 1 : 0;
        }
    }
    return static_cast<double>(overlap) / static_cast<double>(std::max<size_t>(inside, 1));
}

}  // namespace partwheel
