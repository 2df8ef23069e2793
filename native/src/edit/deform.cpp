// As-rigid-as-possible deformation of a triangle surface by handles, and distances along a surface.
#include "edit/deform.h"

#include "base/morton.h"
#include "base/error.h"
#include "mesh/surface.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace partwheel {

namespace {

// A triangle whose doubled area is less than this part of its longest side squared counts as that much thicker, and its
// edges are held by weights of at least least_weight: cotangents stay finite and every corner connected.
constexpr double thin = 1e-5;
constexpr double least_weight = 0.1;

// Rotations: Newton's method ends when a step turns by less than this (its error is then about the square), or after so
// many steps.
constexpr double small_turn = 1e-3;
constexpr int most_turns = 12;

// Threads take so many vertices at a time, if there are at least so many.
constexpr size_t vertices_a_piece = 512, worth_sharing = 4000;

using partwheel::operator+, partwheel::operator*;  // else the next ones would hide them
Wide wide(double x, double y, double z) { return {Wide::Pair{x, y}, z}; }
Wide wide(const Point& p) { return wide(p[0], p[1], p[2]); }
Point narrow(const Wide& p) { return {p.xy[0], p.xy[1], p.z}; }
Wide operator+(const Wide& a, const Wide& b) { return {a.xy + b.xy, a.z + b.z}; }
Wide operator*(double s, const Wide& a) { return {s * a.xy, s * a.z}; }
Wide operator*(const Matrix& m, const Point& p) { return p[0] * m[0] + p[1] * m[1] + p[2] * m[2]; }

double product(const Wide& a, const Wide& b) {
    const Wide::Pair xy = a.xy * b.xy;
    return xy[0] + xy[1] + a.z * b.z;
}

inline Matrix to_matrix(const Quaternion& q) {
    const auto [w, x, y, z] = q;
    return {wide(1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
            wide(2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
            wide(2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))};
}

// Solves h x = g for a symmetric h (xx, yy, zz, xy, xz, yz). False if h is not safely positive definite.
bool solve_positive(const std::array<double, 6>& h, const Point& g, Point& x) {
    const auto [xx, yy, zz, xy, xz, yz] = h;
    const double scale = xx + yy + zz;
    const double c00 = yy * zz - yz * yz, c01 = xz * yz - xy * zz, c02 = xy * yz - xz * yy;
    const double c11 = xx * zz - xz * xz, c12 = xy * xz - xx * yz, c22 = xx * yy - xy * xy;
    const double det = xx * c00 + xy * c01 + xz * c02;
    constexpr double margin = 1e-10;
    if (!(xx > 0 && c22 > margin * scale * scale && det > margin * scale * scale * scale)) return false;
    const double one_by_det = 1 / det;
    x = {one_by_det * (c00 * g[0] + c01 * g[1] + c02 * g[2]), one_by_det * (c01 * g[0] + c11 * g[1] + c12 * g[2]),
         one_by_det * (c02 * g[0] + c12 * g[1] + c22 * g[2])};
    return true;
}

// The rotation R with the largest trace(R^T s), by singular values.
Quaternion rotation_by_svd(const Matrix& s) {
    Eigen::Matrix3d m;
    for (Eigen::Index j = 0; j < 3; ++j) m.col(j) << s[j].xy[0], s[j].xy[1], s[j].z;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d u = svd.matrixU();
    if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) *= -1;
    const Eigen::Quaterniond q(Eigen::Matrix3d(u * svd.matrixV().transpose()));
    return {q.w(), q.x(), q.y(), q.z()};
}

// The same by Newton's method, from the rotation q. trace(R^T s) has one maximum, all else where its gradient vanishes
// are saddles and the minimum; so where the Hessian stays negative definite this ends at the maximum.
Quaternion best_rotation(const Matrix& s, Quaternion q) {
    for (int turn = 0; turn < most_turns; ++turn) {
        const Matrix r = to_matrix(q);
        // m = r^T s
        const double m00 = product(r[0], s[0]), m01 = product(r[0], s[1]), m02 = product(r[0], s[2]);
        const double m10 = product(r[1], s[0]), m11 = product(r[1], s[1]), m12 = product(r[1], s[2]);
        const double m20 = product(r[2], s[0]), m21 = product(r[2], s[1]), m22 = product(r[2], s[2]);
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
        if (dot(step, step) < small_turn * small_turn) {
            const double length = 1 / std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
            return {q[0] * length, q[1] * length, q[2] * length, q[3] * length};
        }
    }
    return rotation_by_svd(s);
}

// Cotangents of a triangle's angles, opposite corner 0, 1, 2; of a thin triangle: see above.
std::array<double, 3> cotangents(const Point& a, const Point& b, const Point& c) {
    const Point ab = b - a, bc = c - b, ca = a - c, normal = cross(ab, ca);
    const double doubled_area = length(normal);
    const double least = thin * std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)});
    if (!(least > 0)) return {1, 1, 1};  // a point
    const double more = doubled_area < least ? least_weight : 0, divisor = std::max(doubled_area, least);
    return {more - dot(ab, ca) / divisor, more - dot(bc, ab) / divisor, more - dot(ca, bc) / divisor};
}

void check(std::span<const Point> vertices, std::span<const Triangle> triangles) {
    if (vertices.empty() || triangles.empty())
        throw Error(PW_ERROR_EMPTY, "There are no triangles: select a part with faces.");
    check_arrays({vertices, triangles, {}, triangles.size()});
}

// Vertices along a space-filling curve (Morton's) through the box of a grid of 2^21 cells a side.
std::vector<int32_t> along_curve(std::span<const Point> points, const Box& box) {
    const auto [x, y, z] = box.high - box.low;
    const double longest = std::max({x, y, z});
    const double cells = longest > 0 ? 2097151 / longest : 0;
    std::vector<std::pair<uint64_t, int32_t>> keys;
    keys.reserve(points.size());
    for (size_t v = 0; v < points.size(); ++v) {
        const auto cell = [&](size_t k) { return static_cast<uint64_t>((points[v][k] - box.low[k]) * cells); };
        keys.push_back({morton_code({cell(2), cell(1), cell(0)}), static_cast<int32_t>(v)});
    }
    std::sort(keys.begin(), keys.end());
    std::vector<int32_t> order;
    order.reserve(keys.size());
    for (const auto& [key, v] : keys) order.push_back(v);
    return order;
}

}  // namespace

Deformation::Deformation(std::span<const Point> vertices, std::span<const Triangle> given_triangles,
                         std::span<const int32_t> roles, size_t threads, Progress& progress)
    : threads_(threads, vertices.size() < worth_sharing ? 1 : vertices.size() / vertices_a_piece) {
    check(vertices, given_triangles);
    progress.reach(0.05);
    const Box box = Box::around(vertices);
    origin_ = 0.5 * (box.low + box.high);
    place_in_given_ = along_curve(vertices, box);
    std::vector<int32_t> ours(vertices.size());
    for (size_t v = 0; v < vertices.size(); ++v) {
        const int32_t given = place_in_given_[v];
        ours[given] = static_cast<int32_t>(v);
        given_.push_back(vertices[given]);
        rest_.push_back(vertices[given] - origin_);
        role_.push_back(roles[given]);
    }
    now_ = rest_;
    std::vector<Triangle> triangles;
    triangles.reserve(given_triangles.size());
    for (const auto& [a, b, c] : given_triangles) triangles.push_back({ours[a], ours[b], ours[c]});
    std::stable_sort(triangles.begin(), triangles.end(), [](const Triangle& a, const Triangle& b) {
        return std::min({a[0], a[1], a[2]}) < std::min({b[0], b[1], b[2]});
    });

    progress.reach(0.1);

    // What nothing holds or moves stays.
    UnionFind components(vertices.size());
    for (const auto& [a, b, c] : triangles) {
        components.join(idx(a), idx(b));
        components.join(idx(b), idx(c));
    }
    std::vector<uint8_t> held(vertices.size(), 0), used(vertices.size(), 0);
    for (const Triangle& triangle : triangles)
        for (const int32_t v : triangle) used[v] = 1;
    int32_t last_handle = -1;
    for (size_t v = 0; v < vertices.size(); ++v) {
        if (role_[v] < PW_VERTEX_FIXED || role_[v] >= PW_MAX_COUNT)
            throw Error(PW_ERROR_ARGUMENT, "A vertex's role is neither free, nor fixed, nor a handle's number.",
                        {.vertices = {place_in_given_[v], -1}});
        if (role_[v] != PW_VERTEX_FREE) held[components.find(v)] = 1;
        last_handle = std::max(last_handle, role_[v]);
    }
    for (size_t v = 0; v < vertices.size(); ++v)
        if (role_[v] == PW_VERTEX_FREE && !(held[components.find(v)] && used[v])) role_[v] = PW_VERTEX_FIXED;

    if (last_handle >= 0 && static_cast<size_t>(last_handle) >= vertices.size())
        throw Error(PW_ERROR_ARGUMENT, "Handles must be numbered 0, 1, 2 without a gap.");
    handles_.resize(static_cast<size_t>(last_handle + 1));
    for (size_t v = 0; v < vertices.size(); ++v)
        if (role_[v] >= 0) handles_[role_[v]].vertices.push_back(static_cast<int32_t>(v));
    for (Handle& handle : handles_) {
        if (handle.vertices.empty()) throw Error(PW_ERROR_ARGUMENT, "Handles must be numbered 0, 1, 2 without a gap.");
        handle.matrix = identity;
    }

    progress.reach(0.2);
    build_elements(triangles);
    factorize(triangles, progress);
    progress.reach(0.9);
    find_weights();
    quaternion_.assign(vertices.size(), {1, 0, 0, 0});
    rotation_.resize(vertices.size());
}

void Deformation::build_elements(std::span<const Triangle> triangles) {
    cot_.reserve(triangles.size());
    elements_.reserve(triangles.size());
    for (const Triangle& t : triangles) {
        const Point &a = rest_[t[0]], &b = rest_[t[1]], &c = rest_[t[2]];
        const std::array<double, 3> cot = cotangents(a, b, c);
        cot_.push_back(cot);
        elements_.push_back(
            {wide(cot[2] * (a - b) + cot[1] * (a - c)), wide(cot[2] * (b - a) + cot[0] * (b - c)), t});
    }
    around_ = CsrArray<Corner>(rest_.size(), [&](const auto& put) {
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
                                       "connected with it.");
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
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
    progress.reach(0.3);
    factor.analyzePattern(laplacian);  // neither this nor the next can be interrupted
    progress.reach(0.5);
    factor.factorize(laplacian);
    progress.reach(0.8);
    const Eigen::VectorXd d = factor.vectorD();
    const bool sound = factor.info() == Eigen::Success && d.allFinite() && d.minCoeff() > 0;
    if (!sound)
        throw Error(PW_ERROR_DEGENERATE, "The part's faces are too thin to be deformed. Dissolve degenerate faces or "
                                         "merge vertices by distance first.");
    const auto& lower = factor.matrixL().nestedExpression();
    column_.assign(lower.outerIndexPtr(), lower.outerIndexPtr() + count + 1);
    row_.assign(lower.innerIndexPtr(), lower.innerIndexPtr() + lower.nonZeros());
    value_.assign(lower.valuePtr(), lower.valuePtr() + lower.nonZeros());
    for (const double each : d) one_by_d_.push_back(1 / each);
    const auto& place_of = factor.permutationP().indices();
    vertex_of_.resize(count);
    for (size_t v = 0; v < rest_.size(); ++v)
        if (unknown_[v] >= 0) vertex_of_[unknown_[v] = place_of[unknown_[v]]] = static_cast<int32_t>(v);
    for (Coupling& coupling : couplings_) coupling.unknown = place_of[coupling.unknown];
    right_.resize(count);
}

void Deformation::solve(std::vector<Point>& x) const {
    const size_t count = one_by_d_.size();
    for (size_t j = 0; j < count; ++j) {
        const Point xj = x[j];
        for (int32_t p = column_[j]; p < column_[j + 1]; ++p) {
            Point& to = x[row_[p]];
            const double value = value_[p];
            to[0] -= value * xj[0], to[1] -= value * xj[1], to[2] -= value * xj[2];
        }
    }
    for (size_t j = count; j-- > 0;) {
        Point sum = one_by_d_[j] * x[j];
        for (int32_t p = column_[j]; p < column_[j + 1]; ++p) {
            const Point& from = x[row_[p]];
            const double value = value_[p];
            sum[0] -= value * from[0], sum[1] -= value * from[1], sum[2] -= value * from[2];
        }
        x[j] = sum;
    }
}

// A harmonic function for each handle: 1 at its vertices, 0 at all others that are not free. Three at a time.
void Deformation::find_weights() {
    for (size_t first = 0; first < handles_.size(); first += 3) {
        std::fill(right_.begin(), right_.end(), Point{});
        for (const Coupling& coupling : couplings_) {
            const int32_t handle = role_[coupling.vertex] - static_cast<int32_t>(first);
            if (handle >= 0 && handle < 3) right_[coupling.unknown][handle] += coupling.weight;
        }
        solve(right_);
        for (size_t k = 0; k < 3 && first + k < handles_.size(); ++k)
            for (const Point& weights : right_) handles_[first + k].weight.push_back(std::clamp(weights[k], 0.0, 1.0));
    }
}

void Deformation::move(size_t handle, const Affine& matrix) {
    Handle& moved = handles_[handle];
    Affine about = matrix;  // the origin
    for (size_t row = 0; row < 3; ++row)
        about[4 * row + 3] += dot({matrix[4 * row], matrix[4 * row + 1], matrix[4 * row + 2]}, origin_) - origin_[row];
    for (const double x : about)
        if (!(std::abs(x) <= 1e100))
            throw Error(PW_ERROR_NOT_FINITE, "An entry of a handle's matrix is infinite, too large, or not a number.");
    const Affine step = compose_with_inverse(about, moved.matrix);
    if (finite(step)) {
        for (size_t u = 0; u < vertex_of_.size(); ++u) {
            Point& p = now_[vertex_of_[u]];
            p = p + moved.weight[u] * (transform_point(step, p) - p);
        }
    }
    for (const int32_t v : moved.vertices) now_[v] = transform_point(about, rest_[v]);
    moved.matrix = about;
}

void Deformation::fit_rotations() {
    threads_.parallel_for(now_.size(), vertices_a_piece, [this](size_t first, size_t last) {
        for (size_t vertex = first; vertex < last; ++vertex) {
            Matrix s{};
            for (const Corner& corner : around_.with(vertex)) {
                const Element& e = elements_[corner.element];
                const Point& c = now_[e.corners[2]];
                const Wide u = wide(now_[e.corners[0]] - c), v = wide(now_[e.corners[1]] - c);
                const Point d0 = narrow(e.d0), d1 = narrow(e.d1);
                s[0] = s[0] + (d0[0] * u + d1[0] * v);
                s[1] = s[1] + (d0[1] * u + d1[1] * v);
                s[2] = s[2] + (d0[2] * u + d1[2] * v);
            }
            quaternion_[vertex] = best_rotation(s, quaternion_[vertex]);
            rotation_[vertex] = to_matrix(quaternion_[vertex]);
        }
    });
}

void Deformation::place() {
    std::fill(right_.begin(), right_.end(), Point{});
    for (const Coupling& coupling : couplings_)
        right_[coupling.unknown] = right_[coupling.unknown] + coupling.weight * now_[coupling.vertex];
    threads_.parallel_for(now_.size(), vertices_a_piece, [this](size_t first, size_t last) {
        for (size_t vertex = first; vertex < last; ++vertex) {
            if (unknown_[vertex] < 0) continue;
            Wide sum{};
            for (const Corner& corner : around_.with(vertex)) {
                const Element& e = elements_[corner.element];
                const Point d = narrow(corner.corner == 0   ? e.d0
                                       : corner.corner == 1 ? e.d1
                                                                : -1.0 * (e.d0 + e.d1));
                const Matrix &a = rotation_[e.corners[0]], &b = rotation_[e.corners[1]], &c = rotation_[e.corners[2]];
                for (size_t j = 0; j < 3; ++j) sum = sum + d[j] * (a[j] + b[j] + c[j]);
            }
            Point& right = right_[unknown_[vertex]];
            right = right + narrow((1.0 / 3) * sum);
        }
    });
    solve(right_);
    for (size_t u = 0; u < right_.size(); ++u) now_[vertex_of_[u]] = right_[u];
}

void Deformation::iterate(size_t iterations) {
    for (size_t i = 0; i < iterations; ++i) {
        fit_rotations();
        place();
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
                const Point off = (now_[a] - now_[b]) - narrow(rotation_[i] * (rest_[a] - rest_[b]));
                sum += cot_[t][k] * dot(off, off);
            }
        }
    }
    return sum;
}

void Deformation::reset() {
    now_ = rest_;
    quaternion_.assign(rest_.size(), {1, 0, 0, 0});
    for (Handle& handle : handles_) handle.matrix = identity;
}

void Deformation::positions(std::span<Point> out) const {
    for (size_t v = 0; v < now_.size(); ++v) out[place_in_given_[v]] = given_[v] + (now_[v] - rest_[v]);
}

void vertex_normals(std::span<const Point> vertices, std::span<const Triangle> triangles, std::span<Point> normals) {
    check(vertices, triangles);
    // In a unit of about the longest side, fourth powers of lengths stay numbers: a power of two, so nothing is rounded.
    double longest = 0;
    for (const auto& [i, j, k] : triangles)
        for (const Point& side : {vertices[j] - vertices[i], vertices[k] - vertices[j], vertices[i] - vertices[k]})
            for (const double component : side) longest = std::max(longest, std::abs(component));
    const double by = longest > 0 ? std::ldexp(1.0, -std::max(std::ilogb(longest), -1022)) : 1;

    std::fill(normals.begin(), normals.end(), Point{});
    for (const auto& [i, j, k] : triangles) {
        const Point &a = vertices[i], &b = vertices[j], &c = vertices[k];
        const Point ab = by * (b - a), bc = by * (c - b), ca = by * (a - c), normal = cross(ab, bc);
        const double one = dot(ab, ab), two = dot(bc, bc), three = dot(ca, ca);
        if (!(one > 0 && two > 0 && three > 0)) continue;
        normals[i] = normals[i] + (1 / (one * three)) * normal;
        normals[j] = normals[j] + (1 / (one * two)) * normal;
        normals[k] = normals[k] + (1 / (two * three)) * normal;
    }
    for (Point& normal : normals) {
        const double size = length(normal);
        normal = size > 0 && std::isfinite(size) ? (1 / size) * normal : Point{};
    }
}

std::vector<double> surface_distances(std::span<const Point> vertices, std::span<const Triangle> triangles,
                                      std::span<const uint8_t> start, Progress& progress) {
    check(vertices, triangles);
    progress.reach(0.05);
    struct Way {
        int32_t to;
        double length;
    };
    std::vector<std::pair<int32_t, Way>> directed;  // from, and where to
    const auto add = [&](int32_t a, int32_t b, double length) {
        directed.push_back({a, {b, length}});
        directed.push_back({b, {a, length}});
    };
    for_each_edge(vertices.size(), triangles, [&](int32_t low, std::span<const Side> sides) {
        if (low % 4096 == 0) progress.reach(0.05 + 0.45 * low / static_cast<double>(vertices.size()));
        const int32_t high = sides[0].high;
        const Point along = vertices[high] - vertices[low];
        const double length = partwheel::length(along);
        add(low, high, length);
        if (sides.size() != 2 || !(length > 0)) return;
        // Both opposite corners laid flat: along the edge from its low end, and away from it on either side.
        const auto opposite = [&](size_t i) { return triangles[sides[i].number / 3][(sides[i].number + 2) % 3]; };
        const Point one = vertices[opposite(0)] - vertices[low], other = vertices[opposite(1)] - vertices[low];
        const double x = dot(one, along) / length, u = dot(other, along) / length;
        const double y = std::sqrt(std::max(dot(one, one) - x * x, 0.0));
        const double v = std::sqrt(std::max(dot(other, other) - u * u, 0.0));
        const double crossing = y + v > 0 ? (x * v + u * y) / (y + v) : -1;
        if (crossing >= 0 && crossing <= length) add(opposite(0), opposite(1), std::sqrt((x - u) * (x - u) + (y + v) * (y + v)));
    });
    const CsrArray<Way> ways(vertices.size(), [&](const auto& put) {
        for (const auto& [from, way] : directed) put(idx(from), way);
    });

    progress.reach(0.6);
    std::vector<double> distance(vertices.size());
    size_t settled = 0;
    using Reached = std::pair<double, int32_t>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
    for (size_t v = 0; v < vertices.size(); ++v) {
        distance[v] = start[v] ? 0 : std::numeric_limits<double>::infinity();
        if (start[v]) front.push({0, static_cast<int32_t>(v)});
    }
    while (!front.empty()) {
        const auto [length, v] = front.top();
        front.pop();
        if (length > distance[v]) continue;
        if (++settled % 4096 == 0)
            progress.reach(0.6 + 0.4 * static_cast<double>(settled) / static_cast<double>(vertices.size()));
        for (const Way& way : ways.with(idx(v))) {
            const double through = length + way.length;
            if (through < distance[way.to]) {
                distance[way.to] = through;
                front.push({through, way.to});
            }
        }
    }
    return distance;
}

}  // namespace partwheel
