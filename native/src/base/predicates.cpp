// Exact orientation: a floating-point filter, then expansions of the rounded differences, then of the exact ones.
//
// An expansion is a sum of doubles that don't overlap, smallest first; sums and products of expansions are exact.
// The build must not fuse multiplications and additions (-ffp-contract=off).
#include "base/predicates.h"

namespace partwheel {

namespace {

template <int N>
struct Expansion {
    double part[N];
    int size = 0;
    void push(double x) {
        if (x != 0) part[size++] = x;
    }
};

// a + b = sum + error, exactly.
inline void two_sum(double a, double b, double& sum, double& error) {
    sum = a + b;
    const double b_virtual = sum - a;
    error = (a - (sum - b_virtual)) + (b - b_virtual);
}

// a * b = product + error, exactly (Dekker's product with Veltkamp's split, so that no fused instruction is needed).
inline void split(double a, double& high, double& low) {
    constexpr double splitter = 134217729.0;  // 2^27 + 1
    const double c = splitter * a;
    high = c - (c - a);
    low = a - high;
}

inline void two_product(double a, double b, double& product, double& error) {
    product = a * b;
    double ah, al, bh, bl;
    split(a, ah, al);
    split(b, bh, bl);
    error = al * bl - (((product - ah * bh) - al * bh) - ah * bl);
}

// Shewchuk's linear-time merge, dropping zeros.
template <int N, int M>
Expansion<N + M> sum(const Expansion<N>& e, const Expansion<M>& f) {
    Expansion<N + M> h;
    int i = 0, j = 0;
    double q = 0;
    while (i < e.size || j < f.size) {
        const bool take_e = j >= f.size || (i < e.size && std::fabs(e.part[i]) < std::fabs(f.part[j]));
        const double next = take_e ? e.part[i++] : f.part[j++];
        double error;
        two_sum(q, next, q, error);
        h.push(error);
    }
    h.push(q);
    return h;
}

template <int N>
Expansion<2 * N> scaled(const Expansion<N>& e, double b) {
    Expansion<2 * N> h;
    double q = 0;
    for (int i = 0; i < e.size; ++i) {
        double product, product_error, error;
        two_product(e.part[i], b, product, product_error);
        two_sum(q, product_error, q, error);
        h.push(error);
        two_sum(product, q, q, error);
        h.push(error);
    }
    h.push(q);
    return h;
}

inline Expansion<2> expansion(double high, double low) {
    Expansion<2> e;
    e.push(low);
    e.push(high);
    return e;
}

inline Expansion<2> product(double a, double b) {
    double high, low;
    two_product(a, b, high, low);
    return expansion(high, low);
}

template <int N>
Expansion<4 * N> product(const Expansion<N>& e, const Expansion<2>& f) {
    return sum(scaled(e, f.size > 0 ? f.part[0] : 0), scaled(e, f.size > 1 ? f.part[1] : 0));
}

inline Expansion<2> difference(double a, double b) {
    double high, low;
    two_sum(a, -b, high, low);
    return expansion(high, low);
}

template <int N>
int sign_of(const Expansion<N>& e) {
    const double largest = e.size == 0 ? 0 : e.part[e.size - 1];
    return largest > 0 ? 1 : largest < 0 ? -1 : 0;
}

// The sign of the exact determinant of three rounded differences: decides most close cases, and all if the
// differences are exact. 2 if undecided (Shewchuk 1997, the second stage of his adaptive predicate).
int rounded_orientation(const Point& u, const Point& v, const Point& w, double permanent, bool exact) {
    const auto term = [](double p, double q, double r, double s, double t) {
        return scaled(sum(product(p, q), product(-r, s)), t);
    };
    const auto det = sum(sum(term(u[1], v[2], u[2], v[1], w[0]), term(u[2], v[0], u[0], v[2], w[1])),
                         term(u[0], v[1], u[1], v[0], w[2]));
    if (exact) return sign_of(det);
    double estimate = 0;
    for (int i = 0; i < det.size; ++i) estimate += det.part[i];
    constexpr double bound = (3 + 28 * 0x1p-53) * 0x1p-53;
    if (std::fabs(estimate) < bound * permanent) return 2;
    return estimate > 0 ? 1 : estimate < 0 ? -1 : 2;
}

// Whether p - a is exact.
bool is_exact_difference(const Point& p, const Point& a) {
    double lost = 0;
    for (size_t k = 0; k < 3; ++k) {
        double difference, error;
        two_sum(p[k], -a[k], difference, error);
        lost += std::fabs(error);
    }
    return lost == 0;
}

// The sign of the determinant of the exact differences.
int exact_orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
    const auto term = [&](size_t i, size_t j, size_t k) {  // w[i] (u[j] v[k] - u[k] v[j])
        const auto minor = sum(product(difference(b[j], a[j]), difference(c[k], a[k])),
                               product(difference(a[k], b[k]), difference(c[j], a[j])));
        return product(minor, difference(d[i], a[i]));
    };
    return sign_of(sum(sum(term(0, 1, 2), term(1, 2, 0)), term(2, 0, 1)));
}

}  // namespace

int orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
    const Point u = b - a, v = c - a, w = d - a;
    const double yz = u[1] * v[2], zy = u[2] * v[1];
    const double zx = u[2] * v[0], xz = u[0] * v[2];
    const double xy = u[0] * v[1], yx = u[1] * v[0];
    const double det = (yz - zy) * w[0] + (zx - xz) * w[1] + (xy - yx) * w[2];
    const double permanent = (std::fabs(yz) + std::fabs(zy)) * std::fabs(w[0]) +
                             (std::fabs(zx) + std::fabs(xz)) * std::fabs(w[1]) +
                             (std::fabs(xy) + std::fabs(yx)) * std::fabs(w[2]);
    constexpr double bound = 8.0 * 0x1p-53;  // (7 + 56 eps) eps in Shewchuk's analysis, rounded up
    if (det > bound * permanent) return 1;
    if (det < -bound * permanent) return -1;
    if (permanent == 0) return 0;  // e.g. in an axis-aligned plane
    const bool exact = is_exact_difference(b, a) && is_exact_difference(c, a) && is_exact_difference(d, a);
    const int sign = rounded_orientation(u, v, w, permanent, exact);
    return sign < 2 ? sign : exact_orientation(a, b, c, d);
}

int orientation_along(size_t axis, const Point& a, const Point& b, const Point& c) {
    const auto project = [axis](const Point& p) { return Point{p[(axis + 1) % 3], p[(axis + 2) % 3], 0}; };
    const Point from = project(a);
    return orientation(from, project(b), project(c), {from[0], from[1], 1});
}

bool collinear(const Point& a, const Point& b, const Point& c) {
    return orientation_along(0, a, b, c) == 0 && orientation_along(1, a, b, c) == 0 && orientation_along(2, a, b, c) == 0;
}

}  // namespace partwheel
