// As-rigid-as-possible deformation of a triangle surface by handles.
#include "edit/deform.h"

#include "base/morton.h"
#include "base/error.h"
#include "edit/surface_measures.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <Eigen/SparseCore>

namespace partwheel {

namespace {

// Degenerate triangles: the doubled area is at least this share of the longest side squared, and the weights at least
// min_weight. So cotangents stay finite and all corners connected.
constexpr double min_relative_height = 1e-5;
constexpr double min_weight = 0.1;

// Newton's method for rotations ends when a step turns by less than this (radians; its error is then about the
// square), or after max_newton_steps.
constexpr double newton_tolerance = 1e-3;
constexpr int max_newton_steps = 12;

// Vertices per task; fewer than min_parallel_vertices are processed by one thread.
constexpr size_t vertices_per_task = 512, min_parallel_vertices = 4000;

Point rotated(const Matrix& m, const Point& p) { return p[0] * m[0] + p[1] * m[1] + p[2] * m[2]; }

inline Matrix to_matrix(const Quaternion& q) {
    const auto [w, x, y, z] = q;
    return {{{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
             {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
             {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}}};
}

// Solves h x = g for symmetric h (xx, yy, zz, xy, xz, yz). Returns false if h is not safely positive definite.
bool solve_positive(const std::array<double, 6>& h, const Point& g, Point& x) {
    const auto [xx, yy, zz, xy, xz, yz] = h;
    const double scale = xx + yy + zz;
    const double c00 = yy * zz - yz * yz, c01 = xz * yz - xy * zz, c02 = xy * yz - xz * yy;
    const double c11 = xx * zz - xz * xz, c12 = xy * xz - xx * yz, c22 = xx * yy - xy * xy;
    const double det = xx * c00 + xy * c01 + xz * c02;
    constexpr double margin = 1e-10;
    if (!(xx > 0 && c22 > margin * scale * scale && det > margin * scale * scale * scale)) return false;
    const double inverse_det = 1 / det;
    x = {inverse_det * (c00 * g[0] + c01 * g[1] + c02 * g[2]), inverse_det * (c01 * g[0] + c11 * g[1] + c12 * g[2]),
         inverse_det * (c02 * g[0] + c12 * g[1] + c22 * g[2])};
    return true;
}

// The rotation R that maximizes trace(R^T s), by SVD.
Quaternion rotation_by_svd(const Matrix& s) {
    Eigen::Matrix3d m;
    for (Eigen::Index j = 0; j < 3; ++j) m.col(j) << s[j][0], s[j][1], s[j][2];
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d u = svd.matrixU();
    if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) *= -1;
    const Eigen::Quaterniond q(Eigen::Matrix3d(u * svd.matrixV().transpose()));
    return {q.w(), q.x(), q.y(), q.z()};
}

// The same by Newton's method from q. trace(R^T s) has one maximum; its other critical points are saddles and the
// minimum. So as long as the Hessian is negative definite, the iteration ends at the maximum.
Quaternion best_rotation(const Matrix& s, Quaternion q) {
    for (int step_count = 0; step_count < max_newton_steps; ++step_count) {
        const Matrix r = to_matrix(q);
        // m = r^T s
        const double m00 = dot(r[0], s[0]), m01 = dot(r[0], s[1]), m02 = dot(r[0], s[2]);
        const double m10 = dot(r[1], s[0]), m11 = dot(r[1], s[1]), m12 = dot(r[1], s[2]);
        const double m20 = dot(r[2], s[0]), m21 = dot(r[2], s[1]), m22 = dot(r[2], s[2]);
        const Point gradient{m21 - m12, m02 - m20, m10 - m01};
        const std::array<double, 6> hessian{m11 + m22,          m00 + m22,          m00 + m11,
                                            -(m01 + m10) * 0.5, -(m02 + m20) * 0.5, -(m12 + m21) * 0.5};
        Point step;
        if (!solve_positive(hessian, gradient, step)) break;
        const Point half = 0.5 * step;
        const double size = 1 / std::sqrt(1 + dot(half, half));
        const double w = size, x = size * half[0], y = size * half[1], z = size * half[2];
        q = {q[0] * w - q[1] * x - q[2] * y - q[3] * z, q[0] * x + q[1] * w + q[2] * z - q[3] * y,
             q[0] * y - q[1] * z + q[2] * w + q[3] * x, q[0] * z + q[1] * y - q[2] * x + q[3] * w};
        if (dot(step, step) < newton_tolerance * newton_tolerance) {
            const double length = 1 / std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
            return {q[0] * length, q[1] * length, q[2] * length, q[3] * length};
        }
    }
    return rotation_by_svd(s);
}

// The cotangents of the angles at corners 0, 1, 2; for degenerate triangles see min_relative_height.
std::array<double, 3> cotangents(const Point& a, const Point& b, const Point& c) {
    const Point ab = b - a, bc = c - b, ca = a - c, normal = cross(ab, ca);
    const double doubled_area = length(normal);
    const double min_area2 = min_relative_height * std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)});
    if (!(min_area2 > 0)) return {1, 1, 1};  // a point
    const double offset = doubled_area < min_area2 ? min_weight : 0, divisor = std::max(doubled_area, min_area2);
    return {offset - dot(ab, ca) / divisor, offset - dot(bc, ab) / divisor, offset - dot(ca, bc) / divisor};
}

}  // namespace

Deformation::Deformation(std::span<const Point> vertices, std::span<const Triangle> source_triangles,
                         std::span<const int32_t> roles, size_t threads, Progress& progress)
    : threads_(threads, vertices.size() < min_parallel_vertices ? 1 : vertices.size() / vertices_per_task) {
    require_triangles(vertices, source_triangles);
    progress.reach(0.05);
    const Box box = Box::around(vertices);
    origin_ = 0.5 * (box.low + box.high);
    source_vertex_ = order_on_curve(vertices);
    std::vector<int32_t> sorted_id(vertices.size());
    for (size_t v = 0; v < vertices.size(); ++v) {
        const int32_t source = source_vertex_[v];
        sorted_id[source] = static_cast<int32_t>(v);
        source_positions_.push_back(vertices[source]);
        rest_.push_back(vertices[source] - origin_);
        role_.push_back(roles[source]);
    }
    positions_ = rest_;
    std::vector<Triangle> triangles;
    triangles.reserve(source_triangles.size());
    for (const auto& [a, b, c] : source_triangles) triangles.push_back({sorted_id[a], sorted_id[b], sorted_id[c]});
    std::ranges::stable_sort(triangles, {}, [](const Triangle& t) { return std::ranges::min(t); });

    progress.reach(0.1);
    fix_unconnected_vertices(triangles);
    set_handles();
    progress.reach(0.2);
    build_elements(triangles);
    progress.reach(0.25);
    factorize(triangles, progress);
    compute_weights(progress);
    quaternion_.assign(vertices.size(), {1, 0, 0, 0});
    rotation_.resize(vertices.size());
}

// Fixes vertices that are not connected to a fixed vertex or a handle.
void Deformation::fix_unconnected_vertices(std::span<const Triangle> triangles) {
    UnionFind components(role_.size());
    for (const auto& [a, b, c] : triangles) {
        components.unite(idx(a), idx(b));
        components.unite(idx(b), idx(c));
    }
    std::vector<uint8_t> is_constrained(role_.size(), 0);
    for (size_t v = 0; v < role_.size(); ++v) {
        if (role_[v] < PW_VERTEX_FIXED || role_[v] >= PW_MAX_COUNT)
            throw Error(PW_ERROR_ARGUMENT, "Each vertex's role must be free, fixed or a handle's number.",
                        {.vertices = {source_vertex_[v], -1}});
        if (role_[v] != PW_VERTEX_FREE) is_constrained[components.find(v)] = 1;
    }
    for (size_t v = 0; v < role_.size(); ++v)
        if (role_[v] == PW_VERTEX_FREE && !is_constrained[components.find(v)]) role_[v] = PW_VERTEX_FIXED;
}

void Deformation::set_handles() {
    const int32_t last_handle = std::max(-1, std::ranges::max(role_));
    if (last_handle >= 0 && idx(last_handle) >= role_.size())
        throw Error(PW_ERROR_ARGUMENT, "Handles must be numbered 0, 1, 2 without a gap.");
    handles_.resize(static_cast<size_t>(last_handle + 1));
    for (size_t v = 0; v < role_.size(); ++v)
        if (role_[v] >= 0) handles_[role_[v]].vertices.push_back(static_cast<int32_t>(v));
    for (Handle& handle : handles_) {
        if (handle.vertices.empty()) throw Error(PW_ERROR_ARGUMENT, "Handles must be numbered 0, 1, 2 without a gap.");
        handle.matrix = identity;
    }
}

void Deformation::build_elements(std::span<const Triangle> triangles) {
    cot_.reserve(triangles.size());
    elements_.reserve(triangles.size());
    for (const Triangle& t : triangles) {
        const Point &a = rest_[t[0]], &b = rest_[t[1]], &c = rest_[t[2]];
        const std::array<double, 3> cot = cotangents(a, b, c);
        cot_.push_back(cot);
        elements_.push_back(
            {cot[2] * (a - b) + cot[1] * (a - c), cot[2] * (b - a) + cot[0] * (b - c), t});
    }
    corners_at_ = CsrArray<Corner>(rest_.size(), [&](const auto& put) {
        for (size_t t = 0; t < triangles.size(); ++t)
            for (int32_t k = 0; k < 3; ++k) put(idx(triangles[t][k]), Corner{static_cast<int32_t>(t), k});
    });
}

void Deformation::factorize(std::span<const Triangle> triangles, Progress& progress) {
    unknown_.assign(rest_.size(), -1);
    int32_t count = 0;
    for (size_t v = 0; v < rest_.size(); ++v)
        if (role_[v] == PW_VERTEX_FREE) unknown_[v] = count++;
    if (count == 0)
        throw Error(PW_ERROR_ARGUMENT, "No vertex is free to deform: the handle must be smaller than the part, and "
                                       "connected to it.");
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(triangles.size() * 6);
    for (size_t t = 0; t < triangles.size(); ++t)
        for (size_t k = 0; k < 3; ++k) {
            const int32_t i = triangles[t][(k + 1) % 3], j = triangles[t][(k + 2) % 3];
            if (i == j) continue;  // no edge
            const double weight = cot_[t][k];
            const int32_t a = unknown_[i], b = unknown_[j];
            if (a >= 0) entries.emplace_back(a, a, weight);
            if (b >= 0) entries.emplace_back(b, b, weight);
            if (a >= 0 && b >= 0) entries.emplace_back(std::max(a, b), std::min(a, b), -weight);
            if (a >= 0 && b < 0) couplings_.push_back({a, j, weight});
            if (b >= 0 && a < 0) couplings_.push_back({b, i, weight});
        }
    Eigen::SparseMatrix<double> laplacian(count, count);
    laplacian.setFromTriplets(entries.begin(), entries.end());
    factor_ = SparseFactor(laplacian, progress, 0.3, 0.8);
    if (!factor_.is_positive_definite())
        throw Error(PW_ERROR_DEGENERATE, "The part's faces are too thin to be deformed. Dissolve degenerate faces or "
                                         "merge vertices by distance first.");
    free_vertex_.resize(count);
    for (size_t v = 0; v < rest_.size(); ++v)
        if (unknown_[v] >= 0) free_vertex_[unknown_[v] = factor_.row_of(idx(unknown_[v]))] = static_cast<int32_t>(v);
    for (Coupling& coupling : couplings_) coupling.unknown = factor_.row_of(idx(coupling.unknown));
    right_hand_side_.resize(count);
}

// A harmonic function for each handle: 1 at its vertices, 0 at all other constrained ones. Solves for three at a time.
void Deformation::compute_weights(Progress& progress) {
    for (size_t first = 0; first < handles_.size(); first += 3) {
        progress.reach(0.8 + 0.2 * static_cast<double>(first) / static_cast<double>(handles_.size()));
        std::fill(right_hand_side_.begin(), right_hand_side_.end(), Point{});
        for (const Coupling& coupling : couplings_) {
            const int32_t handle = role_[coupling.vertex] - static_cast<int32_t>(first);
            if (handle >= 0 && handle < 3) right_hand_side_[coupling.unknown][handle] += coupling.weight;
        }
        factor_.solve(right_hand_side_);
        for (size_t k = 0; k < 3 && first + k < handles_.size(); ++k)
            for (const Point& weights : right_hand_side_)
                handles_[first + k].weight.push_back(std::clamp(weights[k], 0.0, 1.0));
    }
}

void Deformation::move(size_t handle, const Affine& matrix) {
    Handle& target = handles_[handle];
    Affine centered = matrix;  // relative to origin_
    for (size_t row = 0; row < 3; ++row)
        centered[4 * row + 3] += dot({matrix[4 * row], matrix[4 * row + 1], matrix[4 * row + 2]}, origin_) - origin_[row];
    for (const double x : centered)
        if (!(std::abs(x) <= 1e100))
            throw Error(PW_ERROR_NOT_FINITE, "An entry of a handle's matrix is infinite, too large, or not a number.");
    const Affine step = compose_with_inverse(centered, target.matrix);
    if (is_finite(step)) {
        for (size_t u = 0; u < free_vertex_.size(); ++u) {
            Point& p = positions_[free_vertex_[u]];
            p = p + target.weight[u] * (transform_point(step, p) - p);
        }
    }
    for (const int32_t v : target.vertices) positions_[v] = transform_point(centered, rest_[v]);
    target.matrix = centered;
}

void Deformation::fit_rotations() {
    threads_.parallel_for(positions_.size(), vertices_per_task, [this](size_t first, size_t last) {
        for (size_t vertex = first; vertex < last; ++vertex) {
            Matrix s{};
            for (const Corner& corner : corners_at_.row(vertex)) {
                const Element& e = elements_[corner.element];
                const Point& c = positions_[e.corners[2]];
                const Point u = positions_[e.corners[0]] - c, v = positions_[e.corners[1]] - c;
                for (size_t j = 0; j < 3; ++j) s[j] = s[j] + (e.d0[j] * u + e.d1[j] * v);
            }
            quaternion_[vertex] = best_rotation(s, quaternion_[vertex]);
            rotation_[vertex] = to_matrix(quaternion_[vertex]);
        }
    });
}

void Deformation::solve_positions() {
    std::fill(right_hand_side_.begin(), right_hand_side_.end(), Point{});
    for (const auto& [unknown, vertex, weight] : couplings_)
        right_hand_side_[unknown] = right_hand_side_[unknown] + weight * positions_[vertex];
    threads_.parallel_for(positions_.size(), vertices_per_task, [this](size_t first, size_t last) {
        for (size_t vertex = first; vertex < last; ++vertex) {
            if (unknown_[vertex] < 0) continue;
            Point sum{};
            for (const Corner& corner : corners_at_.row(vertex)) {
                const Element& e = elements_[corner.element];
                const Point d = corner.corner == 0 ? e.d0 : corner.corner == 1 ? e.d1 : -1.0 * (e.d0 + e.d1);
                const Matrix &a = rotation_[e.corners[0]], &b = rotation_[e.corners[1]], &c = rotation_[e.corners[2]];
                for (size_t j = 0; j < 3; ++j) sum = sum + d[j] * (a[j] + b[j] + c[j]);
            }
            Point& right = right_hand_side_[unknown_[vertex]];
            right = right + (1.0 / 3) * sum;
        }
    });
    factor_.solve(right_hand_side_);
    for (size_t u = 0; u < right_hand_side_.size(); ++u) positions_[free_vertex_[u]] = right_hand_side_[u];
}

void Deformation::iterate(size_t iterations) {
    for (size_t i = 0; i < iterations; ++i) {
        fit_rotations();
        solve_positions();
    }
}

double Deformation::energy() {
    fit_rotations();
    double sum = 0;
    for (size_t t = 0; t < elements_.size(); ++t) {
        const Triangle& corners = elements_[t].corners;
        for (size_t k = 0; k < 3; ++k) {
            const int32_t a = corners[(k + 1) % 3], b = corners[(k + 2) % 3];
            for (const int32_t i : corners) {
                const Point residual = (positions_[a] - positions_[b]) - rotated(rotation_[i], rest_[a] - rest_[b]);
                sum += cot_[t][k] * dot(residual, residual);
            }
        }
    }
    return sum;
}

void Deformation::reset() {
    positions_ = rest_;
    quaternion_.assign(rest_.size(), {1, 0, 0, 0});
    for (Handle& handle : handles_) handle.matrix = identity;
}

void Deformation::positions(std::span<Point> out) const {
    for (size_t v = 0; v < positions_.size(); ++v)
        out[source_vertex_[v]] = source_positions_[v] + (positions_[v] - rest_[v]);
}

}  // namespace partwheel
