// orientation() and collinear() against exact rational arithmetic.
#include "base/predicates.h"

#include "support/reference_hull.h"
#include "support/sizes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace partwheel::test {
namespace {

using Int4 = std::array<Point, 4>;

int of(const Int4& p) { return orientation(p[0], p[1], p[2], p[3]); }
int reference(const Int4& p) { return reference_orientation(p[0], p[1], p[2], p[3]); }

// A coordinate a few units in the last place away; 0 stays, as next to it products underflow.
double nudged(double x, int ulps) {
    if (x == 0) return x;
    for (; ulps > 0; --ulps) x = std::nextafter(x, HUGE_VAL);
    for (; ulps < 0; ++ulps) x = std::nextafter(x, -HUGE_VAL);
    return x;
}

class Predicates : public testing::Test {
protected:
    double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); }
    Point point(double size) { return {real(-size, size), real(-size, size), real(-size, size)}; }

    void expect_exact(const Int4& p) {
        const int sign = reference(p);
        ASSERT_EQ(of(p), sign);
        ASSERT_EQ(of({p[1], p[0], p[2], p[3]}), -sign);
        ASSERT_EQ(of({p[1], p[2], p[0], p[3]}), sign);
        ASSERT_EQ(of({p[3], p[2], p[1], p[0]}), sign);
        ++seen[static_cast<size_t>(sign + 1)];
    }

    std::mt19937 random{1};
    std::array<int, 3> seen{};  // how often the sign was -1, 0, 1
    const int rounds = sized(20000, 1000);
};

TEST_F(Predicates, NearlyCoplanarByUlps) {
    for (int i = 0; i < rounds; ++i) {
        const Point a = point(1), b = point(1), c = point(1);
        const double s = real(-2, 2), t = real(-2, 2);
        Point d;
        for (size_t k = 0; k < 3; ++k) d[k] = nudged(a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k]), whole(-2, 2));
        expect_exact({a, b, c, d});
    }
    EXPECT_GT(seen[0], rounds / 10);
    EXPECT_GT(seen[2], rounds / 10);
}

TEST_F(Predicates, AllScales) {
    for (int exponent = -30; exponent <= 30; ++exponent) {
        const double scale = std::pow(10.0, exponent);
        for (int i = 0; i < rounds / 60; ++i) {
            Int4 p{point(scale), point(scale), point(scale), point(scale)};
            expect_exact(p);
            const double t = real(0, 1);
            for (size_t k = 0; k < 3; ++k) p[3][k] = nudged(p[0][k] + t * (p[1][k] - p[2][k]), whole(-1, 1));
            expect_exact(p);
        }
    }
}

TEST_F(Predicates, Collinear) {
    EXPECT_TRUE(collinear({0, 0, 0}, {1, 2, 3}, {2, 4, 6}));
    EXPECT_TRUE(collinear({1, 1, 1}, {1, 1, 1}, {5, 2, 9}));
    EXPECT_FALSE(collinear({0, 0, 0}, {1, 2, 3}, {2, 4, nudged(6, 1)}));
    // Three points are on one line exactly if every fourth is in one plane with them; three directions suffice.
    for (int i = 0; i < rounds; ++i) {
        const int size = whole(2, 4);
        std::array<Point, 3> p;
        for (Point& q : p)
            q = {0.1 * whole(0, size), 0.1 * whole(0, size), 0.1 * whole(0, size)};
        if (i % 2 == 0)
            for (size_t k = 0; k < 3; ++k) p[2][k] = nudged(p[0][k] + 3 * (p[1][k] - p[0][k]), whole(-1, 1));
        bool line = true;
        for (size_t k = 0; k < 3; ++k) {
            Point fourth = p[0];
            fourth[k] += 7;
            line = line && reference_orientation(p[0], p[1], p[2], fourth) == 0;
        }
        ASSERT_EQ(collinear(p[0], p[1], p[2]), line);
    }
}

}  // namespace
}  // namespace partwheel::test
