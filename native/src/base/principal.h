// Principal directions, with the same bits on every machine.
#pragma once

#include "base/geometry.h"

namespace partwheel {

inline void add_outer_product(std::array<Point, 3>& sum, const Point& p, double weight = 1) {
    for (size_t k = 0; k < 3; ++k) sum[k] = sum[k] + weight * p[k] * p;
}

// Diagonalizes a symmetric matrix, and returns its orthonormal eigenvectors. Jacobi's method needs no function but
// square roots.
inline std::array<Point, 3> diagonalize(std::array<Point, 3>& m) {
    std::array<Point, 3> axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int sweep = 0; sweep < 12; ++sweep)  // a few are enough
        for (const auto& [p, q] : {std::array<size_t, 2>{0, 1}, {0, 2}, {1, 2}}) {
            if (m[p][q] == 0) continue;
            const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
            const double t = (theta < 0 ? -1 : 1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
            const double c = 1 / std::sqrt(t * t + 1), s = t * c;
            const auto rotate = [&](auto& x, auto& y) {
                const auto before = x;
                x = c * before - s * y;
                y = s * before + c * y;
            };
            for (Point& row : m) rotate(row[p], row[q]);
            rotate(m[p], m[q]);
            rotate(axes[p], axes[q]);
        }
    return axes;
}

// The eigenvectors of the points' covariance matrix.
inline std::array<Point, 3> principal_directions(std::span<const Point> points) {
    Point mean{};
    for (const Point& p : points) mean = mean + p;
    mean = 1 / static_cast<double>(points.size()) * mean;
    std::array<Point, 3> covariance{};
    for (const Point& p : points) add_outer_product(covariance, p - mean);
    return diagonalize(covariance);
}

}  // namespace partwheel
