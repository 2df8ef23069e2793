// The multilayer perceptron. Several hidden units are computed side by side. Each one's sum has the same order as alone,
// so the bits don't depend on it.
#include "hull/vectors.h"
#include "parts/merge/merge_policy.h"

namespace partwheel {

namespace {

constexpr size_t side_by_side = 16;

}  // namespace

Mlp::Mlp(std::span<const double> weights, size_t feature_count)
    : units_((weights.size() / (feature_count + 2) + side_by_side - 1) / side_by_side * side_by_side),
      bias_(weights.back()), weights_((feature_count + 2) * units_, 0) {
    for (size_t i = 0; i + 1 < weights.size(); ++i)
        weights_[i % (feature_count + 2) * units_ + i / (feature_count + 2)] = weights[i];
}

double Mlp::operator()(std::span<const double> features) const {
    double sum = bias_;
    for (size_t first = 0; first < units_; first += side_by_side) {
        std::array<Double2, side_by_side / 2> z;
        const double* weights = &weights_[first];
        for (size_t k = 0; k < z.size(); ++k) z[k] = vector_at<Double2>(weights + 2 * k);
        for (const double feature : features) {
            weights += units_;
            for (size_t k = 0; k < z.size(); ++k) z[k] += vector_at<Double2>(weights + 2 * k) * feature;
        }
        weights += units_;
        for (size_t k = 0; k < z.size(); ++k) {
            const Double2 share = vector_at<Double2>(weights + 2 * k) * (z[k] / (1 + magnitude(z[k])));
            sum = sum + share[0] + share[1];
        }
    }
    return sum;
}

}  // namespace partwheel
