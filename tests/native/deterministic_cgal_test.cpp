// What stands in for the standard library's in CGAL's headers: the same answers.
#include <gtest/gtest.h>

#include <partwheel/deterministic.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace {

using partwheel::deterministic::acos;
using partwheel::deterministic::atan2;

TEST(DeterministicCgal, NthElementIsThatOfTheSortedRange) {
    std::mt19937 random(1);
    for (const unsigned distinct : {1u, 2u, 7u, 1000000u})
        for (size_t size = 1; size < 300; size += 7) {
            std::vector<unsigned> given(size);
            for (unsigned& value : given) value = static_cast<unsigned>(random() % distinct);
            std::vector<unsigned> sorted = given;
            std::sort(sorted.begin(), sorted.end());
            const size_t n = random() % size;
            partwheel::deterministic::nth_element(given.begin(), given.begin() + static_cast<std::ptrdiff_t>(n), given.end(),
                                           std::less<>());
            EXPECT_EQ(given[n], sorted[n]);
            for (size_t i = 0; i < size; ++i) EXPECT_TRUE(i < n ? given[i] <= given[n] : given[i] >= given[n]);
            std::sort(given.begin(), given.end());
            EXPECT_EQ(given, sorted);
        }
}

TEST(DeterministicCgal, AnglesAreThoseOfTheSystem) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int i = 0; i < 10000; ++i) {
        const double y = any(random), x = any(random);
        EXPECT_NEAR(atan2(y, x), std::atan2(y, x), 2e-15);
        EXPECT_NEAR(acos(x), std::acos(x), 2e-15 / std::sqrt(1 - x * x));
    }
    for (const double y : {-1.0, 0.0, 1.0})
        for (const double x : {-1.0, 0.0, 1.0}) EXPECT_NEAR(atan2(y, x), std::atan2(y, x), 1e-15);
    EXPECT_EQ(acos(1), 0);
    EXPECT_NEAR(acos(-1), std::acos(-1.0), 1e-15);
}

}  // namespace
