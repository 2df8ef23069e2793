// The multilayer perceptron. Several hidden units are computed side by side, of which the compiler makes vector
// instructions. Each one's sum has the same order as alone, so the bits don't depend on it.
#include "parts/merge/merge_policy.h"

namespace partwheel {

namespace {

template <size_t units>
double sum_of_units(const double* weights, std::span<const double> features, double sum) {
    const size_t stride = features.size() + 2;
    std::array<double, units> z;
    for (size_t k = 0; k < units; ++k) z[k] = weights[k * stride];
    for (size_t i = 0; i < features.size(); ++i)
        for (size_t k = 0; k < units; ++k) z[k] += weights[k * stride + 1 + i] * features[i];
    for (double& value : z) value /= 1 + std::abs(value);
    for (size_t k = 0; k < units; ++k) sum += weights[k * stride + 1 + features.size()] * z[k];
    return sum;
}

}  // namespace

double mlp_forward(std::span<const double> weights, std::span<const double> features) {
    constexpr size_t side_by_side = 8;
    const size_t stride = features.size() + 2, units = weights.size() / stride;
    double sum = weights.back();
    size_t h = 0;
    for (; h + side_by_side <= units; h += side_by_side) sum = sum_of_units<side_by_side>(&weights[h * stride], features, sum);
    for (; h < units; ++h) sum = sum_of_units<1>(&weights[h * stride], features, sum);
    return sum;
}

}  // namespace partwheel
