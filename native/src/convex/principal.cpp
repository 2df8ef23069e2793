// Eigenvectors by the cyclic Jacobi method.
#include "convex/principal.h"

#include <cmath>

namespace partwheel::convex {

namespace {

constexpr size_t max_sweeps = 12;  // a few are enough

}  // namespace

std::array<Point, 3> principal_directions(std::span<const Point> points) {
    Point mean{};
    for (const Point& p : points) mean = mean + p;
    mean = 1 / static_cast<double>(points.size()) * mean;
    double a[3][3] = {};
    for (const Point& p : points) {
        const Point d = p - mean;
        for (size_t i = 0; i < 3; ++i)
            for (size_t j = 0; j < 3; ++j) a[i][j] += d[i] * d[j];
    }
    std::array<Point, 3> q = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // rows
    for (size_t sweep = 0; sweep < max_sweeps; ++sweep)
        for (size_t i = 0; i < 2; ++i)
            for (size_t j = i + 1; j < 3; ++j) {
                if (a[i][j] == 0) continue;
                const double theta = (a[j][j] - a[i][i]) / (2 * a[i][j]);
                const double t = std::copysign(1 / (std::fabs(theta) + std::sqrt(theta * theta + 1)), theta);
                const double c = 1 / std::sqrt(t * t + 1), s = t * c;
                for (size_t k = 0; k < 3; ++k) {
                    const double x = a[k][i], y = a[k][j];
                    a[k][i] = c * x - s * y;
                    a[k][j] = s * x + c * y;
                }
                for (size_t k = 0; k < 3; ++k) {
                    const double x = a[i][k], y = a[j][k];
                    a[i][k] = c * x - s * y;
                    a[j][k] = s * x + c * y;
                    const double u = q[i][k], v = q[j][k];
                    q[i][k] = c * u - s * v;
                    q[j][k] = s * u + c * v;
                }
            }
    return q;
}

}  // namespace partwheel::convex
