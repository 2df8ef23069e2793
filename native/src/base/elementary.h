// Elementary functions with the same bits on every system, unlike those of the C library: sums and square roots only.
// Their relative error is about 1e-15.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

namespace partwheel {

// e^x; |x| <= 700.
inline double exp_of(double x) {
    const double k = std::nearbyint(x / std::numbers::ln2), r = x - k * 0x1.62e42feep-1 - k * 0x1.a39ef35793c76p-33;
    double power = 1, sum = 1;
    for (int n = 1; n <= 13; ++n) sum += power *= r / n;
    return std::ldexp(sum, static_cast<int>(k));
}

// The natural logarithm.
inline double log_of(double x) {
    if (!(x > 0) || !std::isfinite(x)) return x == 0 ? -HUGE_VAL : x > 0 ? x : std::numeric_limits<double>::quiet_NaN();
    int exponent = 0;
    double mantissa = std::frexp(x, &exponent);
    if (mantissa < std::numbers::sqrt2 / 2) mantissa *= 2, --exponent;
    const double t = (mantissa - 1) / (mantissa + 1);  // the logarithm of the mantissa is 2 artanh(t)
    double series = 0;
    for (int n = 23; n > 0; n -= 2) series = 1.0 / n + t * t * series;
    return exponent * std::numbers::ln2 + 2 * t * series;
}

// The angle of the vector (x, y), 0 to pi; y >= 0. Of the null vector: 0.
inline double angle_of(double y, double x) {
    const bool is_steep = y > std::fabs(x);
    double t = is_steep ? x / y : x != 0 ? y / x : 0;  // tangent of an angle of at most pi / 4, which is halved twice
    for (int halving = 0; halving < 2; ++halving) t /= 1 + std::sqrt(1 + t * t);
    double series = 0;
    for (int n = 21; n > 0; n -= 2) series = 1.0 / n - t * t * series;
    const double angle = 4 * t * series;
    return is_steep ? std::numbers::pi / 2 - angle : x < 0 ? std::numbers::pi + angle : angle;
}

struct UnitVector {
    double cosine, sine;
};

// |angle| <= 1e9.
inline UnitVector unit_vector(double angle) {
    const double k = std::nearbyint(angle / (std::numbers::pi / 2));
    const double r = angle - k * 0x1.921fb544p+0 - k * 0x1.0b4611a626331p-34;
    double sine = 1, cosine = 1;
    for (int n = 17; n > 1; n -= 2) {
        cosine = 1 - cosine * r * r / ((n - 1) * (n - 2));
        sine = 1 - sine * r * r / (n * (n - 1));
    }
    sine *= r;
    const auto quarter = static_cast<long long>(k) & 3;
    const UnitVector turned = quarter % 2 ? UnitVector{-sine, cosine} : UnitVector{cosine, sine};
    return quarter < 2 ? turned : UnitVector{-turned.cosine, -turned.sine};
}

}  // namespace partwheel
