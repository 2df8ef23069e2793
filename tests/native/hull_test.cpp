// HullKernel against CGAL's convex_hull_3: extreme points exactly, volumes to rounding, boundaries closed and convex.
#include "hull/hull.h"

#include "base/predicates.h"
#include "support/reference_hull.h"
#include "support/sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

namespace partwheel::test {
namespace {

using partwheel::operator+, partwheel::operator*;
using Points = std::vector<Point>;

std::vector<int32_t> numbers(size_t from, size_t to) {
    std::vector<int32_t> n(to - from);
    std::iota(n.begin(), n.end(), static_cast<int32_t>(from));
    return n;
}

std::vector<int32_t> list(std::span<const int32_t> numbers) { return {numbers.begin(), numbers.end()}; }

Hull unite(HullKernel& kernel, const Hull& a, const Hull& b) { return kernel.unite(a, b.vertices()); }

double union_volume(HullKernel& kernel, const Hull& a, const Hull& b) {
    const HullKernel::VolumeBound bound = kernel.union_volume(a, b.vertices());
    EXPECT_TRUE(bound.exact);
    return bound.volume;
}

// The error bound of a volume: the cubed extent of the points times a few roundings. The extent, not the magnitude:
// signed_volume6() works on differences.
double rounding(const Points& points) {
    Point low = points[0], high = points[0];
    for (const Point& p : points)
        for (size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    return 1e-13 * (high[0] - low[0]) * (high[1] - low[1]) * (high[2] - low[2]);
}

// Closed, a sphere by Euler's formula, outward, and no given point outside any facet, all by exact predicates.
void expect_convex_boundary(const Hull& hull, const Points& points, const std::vector<int32_t>& members) {
    std::set<std::pair<int32_t, int32_t>> edges;
    std::set<int32_t> used;
    const auto at = [&](int32_t v) -> const Point& { return points[static_cast<size_t>(v)]; };
    for (const HullFacet& facet : hull.facets()) {
        const Triangle& f = facet.corners;
        for (size_t k = 0; k < 3; ++k) {
            ASSERT_TRUE(edges.emplace(f[k], f[(k + 1) % 3]).second) << "an edge twice in the same direction";
            used.insert(f[k]);
        }
        ASSERT_FALSE(collinear(at(f[0]), at(f[1]), at(f[2])));
        for (const int32_t v : members) ASSERT_LE(orientation(at(f[0]), at(f[1]), at(f[2]), at(v)), 0);
    }
    for (const auto& [a, b] : edges) ASSERT_TRUE(edges.contains({b, a})) << "an open edge";
    for (const HullFacet& f : hull.facets())
        for (size_t k = 0; k < 3; ++k) {  // the facet across an edge traverses it in reverse
            ASSERT_LT(static_cast<size_t>(f.neighbors[k]), hull.facets().size());
            const Triangle& across = hull.facets()[static_cast<size_t>(f.neighbors[k])].corners;
            const int32_t from = f.corners[k], to = f.corners[(k + 1) % 3];
            size_t at_to = 0;
            while (at_to < 2 && across[at_to] != to) ++at_to;
            ASSERT_EQ(across[at_to], to);
            ASSERT_EQ(across[(at_to + 1) % 3], from);
        }
    ASSERT_EQ(used.size() + hull.facets().size(), edges.size() / 2 + 2) << "not a sphere";
    ASSERT_EQ(list(hull.vertices()), std::vector<int32_t>(used.begin(), used.end()));
}

// Members are indices of points.
void expect_hull(const Hull& hull, const Points& points, const std::vector<int32_t>& members) {
    Points chosen;
    for (const int32_t v : members) chosen.push_back(points[static_cast<size_t>(v)]);
    const ReferenceHull reference = reference_hull(chosen);
    if (reference.flat) {
        EXPECT_TRUE(hull.facets().empty());
        EXPECT_EQ(hull.volume(), 0);
        std::set<int32_t> all(members.begin(), members.end());
        EXPECT_EQ(list(hull.vertices()), std::vector<int32_t>(all.begin(), all.end()));
        return;
    }
    ASSERT_NO_FATAL_FAILURE(expect_convex_boundary(hull, points, members));
    std::vector<Point> extreme, expected;
    for (const int32_t v : hull.vertices()) extreme.push_back(points[static_cast<size_t>(v)]);
    for (const int32_t i : reference.extreme) expected.push_back(chosen[static_cast<size_t>(i)]);
    std::sort(extreme.begin(), extreme.end());
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(extreme, expected);
    const auto volume = static_cast<double>(reference.volume);
    ASSERT_NEAR(hull.volume(), volume, 1e-12 * volume + rounding(chosen));
}

// Splits the points in two, at random or one from the rest; builds both, unites them, and compares all with CGAL.
void expect_all(const Points& points, size_t split) {
    HullKernel kernel(points);
    const auto left = numbers(0, split), right = numbers(split, points.size()), all = numbers(0, points.size());
    const Hull a = kernel.build(left), b = kernel.build(right);
    ASSERT_NO_FATAL_FAILURE(expect_hull(a, points, left)) << "left";
    ASSERT_NO_FATAL_FAILURE(expect_hull(b, points, right)) << "right";
    const double volume = union_volume(kernel, a, b);
    const double turned_volume = union_volume(kernel, b, a);
    const Hull united = unite(kernel, a, b), turned = unite(kernel, b, a);
    ASSERT_NO_FATAL_FAILURE(expect_hull(united, points, all)) << "united";
    ASSERT_NO_FATAL_FAILURE(expect_hull(turned, points, all)) << "united the other way round";
    ASSERT_NEAR(volume, united.volume(), 1e-12 * united.volume() + rounding(points));
    ASSERT_NEAR(turned_volume, united.volume(), 1e-12 * united.volume() + rounding(points));
    const Hull direct = kernel.build(all);
    ASSERT_NO_FATAL_FAILURE(expect_hull(direct, points, all)) << "built";
    const auto [low, high] = kernel.bounds(direct);
    for (size_t k = 0; k < 3; ++k) {
        ASSERT_EQ(low[k],
                  (*std::min_element(points.begin(), points.end(), [&](auto& p, auto& q) { return p[k] < q[k]; }))[k]);
        ASSERT_EQ(high[k],
                  (*std::max_element(points.begin(), points.end(), [&](auto& p, auto& q) { return p[k] < q[k]; }))[k]);
    }
}

class HullTest : public testing::Test {
protected:
    double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); }

    // Many sets from one generator, of all sizes up to `most`; all kinds of splits, often a single point.
    void expect_many(int rounds, int most, const std::function<Point()>& make) {
        rounds = sized(rounds, std::max(rounds / 10, 20));
        for (int i = 0; i < rounds; ++i) {
            Points points(static_cast<size_t>(whole(2, i % 5 == 0 ? most : std::min(most, 12))));
            for (Point& p : points) p = make();
            const auto split = static_cast<size_t>(i % 3 == 0 ? 1 : whole(1, static_cast<int>(points.size()) - 1));
            ASSERT_NO_FATAL_FAILURE(expect_all(points, split)) << "round " << i << ", " << points.size() << " points";
        }
    }

    std::mt19937 random{3};
};

TEST_F(HullTest, RandomPoints) {
    expect_many(600, 200, [&] { return Point{real(-1, 1), real(-1, 1), real(-1, 1)}; });
}

TEST_F(HullTest, GridPoints) {
    for (const int size : {1, 2, 3, 5}) {
        SCOPED_TRACE(size);
        expect_many(500, 120, [&] {
            return Point{double(whole(0, size)), double(whole(0, size)), double(whole(0, size))};
        });
    }
}

TEST_F(HullTest, CosphericalPoints) {
    expect_many(300, 150, [&] {
        const double u = real(0, 2 * std::numbers::pi), z = real(-1, 1), r = std::sqrt(1 - z * z);
        return Point{r * std::cos(u), r * std::sin(u), z};
    });
    // Exactly cospherical: all permutations and signs of (1, 2, 2) and (3, 0, 0).
    expect_many(300, 60, [&] {
        Point p = whole(0, 3) == 0 ? Point{3, 0, 0} : Point{1, 2, 2};
        std::shuffle(p.begin(), p.end(), random);
        for (double& x : p) x = whole(0, 1) == 0 ? x : -x;
        return p;
    });
}

TEST_F(HullTest, NearlyFlatSets) {
    expect_many(300, 60, [&] {
        const double x = real(-1, 1), y = real(-1, 1);
        double z = 0.3 * x - 0.7 * y;
        if (whole(0, 2) == 0) z = std::nextafter(z, 2.0);
        return Point{x, y, z};
    });
}

// Of more triangles than are replaced at once, with corners that stop being extreme and points on edges, all in one plane.
TEST_F(HullTest, LargePlanarPolygons) {
    for (int round = 0; round < 4; ++round) {
        Points points;
        const double scale = round == 0 ? 1000 : 1;  // else so many corners would not be extreme
        const auto add_ring = [&](double radius, double z, size_t count) {
            for (size_t i = 0; i < count; ++i) {
                const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
                points.push_back({2 * std::round(scale * radius * std::cos(angle)), 2 * std::round(scale * radius * std::sin(angle)), z});
            }
        };
        add_ring(3000, 0, round == 0 ? 2200 : 400);
        for (size_t i = 0; i < 60; ++i) points.push_back(0.5 * (points[i] + points[i + 1]));
        add_ring(2990, 0, 60);
        round % 2 == 0 ? points.push_back({0, 0, 1000}) : add_ring(1000, 1000, 40);
        if (round >= 2)
            for (Point& p : points) p[2] += p[0] - 2 * p[1];
        std::shuffle(points.begin(), points.end(), random);
        ASSERT_NO_FATAL_FAILURE(expect_all(points, points.size() / 2)) << "round " << round;
    }
}

// The rim of a cone, in a circle's plane, which is one facet of the hull.
Points cone(size_t count) {
    Points points = {{0, 0, 1}};
    for (size_t i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
        points.push_back({std::cos(angle), std::sin(angle), 0});
    }
    return points;
}

// A prism with two polygons of as many corners.
Points drum(size_t count) {
    Points points;
    for (const double z : {0.0, 0.3})
        for (Point p : cone(count)) {
            p[2] = z;
            if (p[0] != 0 || p[1] != 0) points.push_back(p);
        }
    return points;
}

// Along the curve that numbers vertices and in a random order, also if most corners don't stay extreme.
TEST_F(HullTest, VisitsOfFacetsGrowAsNLogN) {
    using Shape = std::function<Points(size_t)>;
    const auto shuffled = [&](Points points) {
        std::shuffle(points.begin(), points.end(), random);
        return points;
    };
    const auto nested = [&](size_t count) {  // the first half is in the hull of the second
        Points points = drum(count / 2), outer = shuffled(drum(count / 2));
        for (Point& p : points) p = {0.999 * p[0], 0.999 * p[1], p[2]};
        points.insert(points.end(), outer.begin(), outer.end());
        return points;
    };
    const auto alternating = [](size_t count) {  // between the two polygons
        const Points points = drum(count);
        Points result;
        for (size_t i = 0; i < count; ++i) result.insert(result.end(), {points[i], points[count + i]});
        return result;
    };
    const auto tilted = [&](size_t count) {  // the first tetrahedron is almost flat
        Points points = drum(count);
        for (Point& p : points) p[2] += 0.37 * p[0] - 0.21 * p[1];
        std::swap(points[1], points.back());  // else the first half is flat
        return points;
    };
    const std::vector<Shape> shapes = {cone, [&](size_t n) { return shuffled(cone(n)); }, [&](size_t n) { return shuffled(drum(n)); }, nested,
                                       drum, alternating, tilted};
    for (size_t shape = 0; shape < shapes.size(); ++shape) {
        const auto count_visits = [&](size_t count) {
            const Points points = shapes[shape](count);
            HullKernel kernel(points);
            const Hull left = kernel.build(numbers(0, points.size() / 2)),
                       right = kernel.build(numbers(points.size() / 2, points.size()));
            const Hull whole = unite(kernel, left, right);
            EXPECT_EQ(whole.vertices().size(), shape == 3 ? points.size() / 2 : points.size());
            const auto sides = static_cast<double>(shape == 3 ? count / 2 : count);
            const double polygon = sides / 2 * std::sin(2 * std::numbers::pi / sides);
            EXPECT_NEAR(whole.volume(), shape < 2 ? polygon / 3 : 0.3 * polygon, 1e-12) << "shape " << shape;
            return static_cast<double>(kernel.facet_visits());
        };
        const double one = count_visits(4000), two = count_visits(8000);
        EXPECT_LT(two, 2.5 * one) << "shape " << shape;
        if (!light()) {
            EXPECT_LT(count_visits(16000), 2.5 * two) << "shape " << shape;
        }
    }
}

// A call checks for cancellation after a counted number of visits. Then the kernel is destroyed.
TEST_F(HullTest, LargeHullsCanBeCanceled) {
    const Points points = [&] {
        Points sphere(sized(60000, 30000));
        for (Point& p : sphere) {
            p = {real(-1, 1), real(-1, 1), real(-1, 1)};
            p = 1 / length(p) * p;
        }
        return sphere;
    }();
    const auto all = numbers(0, points.size());
    Progress progress;
    progress.begin();
    HullKernel kernel(points, progress);
    const Hull hull = kernel.build(all);
    const size_t visits = kernel.facet_visits();
    const auto expect_canceled = [&](const std::function<void(HullKernel&)>& call) {
        progress.cancel();
        HullKernel canceled(points, progress);
        try {
            call(canceled);
            ADD_FAILURE() << "not canceled";
        } catch (const Error& error) {
            EXPECT_EQ(error.status(), PW_ERROR_CANCELED);
        }
        EXPECT_LT(canceled.facet_visits(), visits / 2);
        progress.end();
        progress.begin();
    };
    expect_canceled([&](HullKernel& other) { (void)other.build(all); });
    expect_canceled([&](HullKernel& other) { (void)other.unite(other.build(numbers(0, 4)), all); });
    expect_canceled([&](HullKernel& other) { (void)other.union_volume(other.build(numbers(0, 4)), all); });
}

// A volume above the early-out limit may be a lower bound, must be valid, and must not affect later calls.
TEST_F(HullTest, EarlyOutReturnsALowerBound) {
    size_t bounds = 0;
    for (int i = 0; i < sized(300, 60); ++i) {
        Points points(static_cast<size_t>(whole(12, i % 4 == 0 ? 300 : 40)));
        for (Point& p : points)
            for (double& x : p) x = i % 2 == 0 ? whole(0, 4) : real(0, 4);
        const size_t half = points.size() / 2;
        HullKernel kernel(points), fresh(points);
        const Hull a = kernel.build(numbers(0, half)), b = kernel.build(numbers(half, points.size()));
        if (a.facets().empty()) continue;
        const double whole_volume = union_volume(kernel, a, b);
        for (const double part : {0.0, 0.3, 0.7, 0.95, 1.0, 1.1}) {
            const double enough = a.volume() + part * (whole_volume - a.volume());
            const HullKernel::VolumeBound bound = kernel.union_volume(a, b.vertices(), enough);
            if (bound.exact) {
                EXPECT_NEAR(bound.volume, whole_volume, 1e-12 * whole_volume);
            } else {
                EXPECT_GT(bound.volume, enough);
                EXPECT_LE(bound.volume, whole_volume * (1 + 1e-12));
                ++bounds;
            }
            const Hull united = unite(kernel, a, b);
            ASSERT_NO_FATAL_FAILURE(expect_hull(united, points, numbers(0, points.size())));
            // The same hull, facet for facet, as without the query.
            const Hull twin = unite(fresh, fresh.build(numbers(0, half)), b);
            ASSERT_EQ(united.facets().size(), twin.facets().size());
            for (size_t f = 0; f < twin.facets().size(); ++f)
                ASSERT_EQ(united.facets()[f].corners, twin.facets()[f].corners);
        }
    }
    EXPECT_GT(bounds, 100U);
}

TEST_F(HullTest, NestedHulls) {
    for (int i = 0; i < sized(100, 20); ++i) {
        Points points;
        for (int k = 0; k < 8; ++k) points.push_back({k % 2 * 4.0, k / 2 % 2 * 4.0, k / 4 * 4.0});
        for (int k = 0; k < 10; ++k)  // inside, or on the boundary
            points.push_back(i % 2 == 0 ? Point{real(0, 4), real(0, 4), real(0, 4)}
                                        : Point{double(whole(0, 4)), double(whole(0, 4)), double(whole(0, 4))});
        HullKernel kernel(points);
        const Hull outer = kernel.build(numbers(0, 8)), inner = kernel.build(numbers(8, 18));
        EXPECT_NEAR(union_volume(kernel, outer, inner), 64, 1e-12);
        EXPECT_NEAR(union_volume(kernel, inner, outer), 64, 1e-12);
        ASSERT_NO_FATAL_FAILURE(expect_hull(unite(kernel, inner, outer), points, numbers(0, 18)));
    }
}

// The state of union_volume() belongs to a hull and points, not to their addresses.
TEST_F(HullTest, ReusedMemoryIsNotMistakenForTheOldHull) {
    Points points(40);
    for (Point& p : points)
        for (double& x : p) x = whole(0, 1000);
    HullKernel kernel(points), others(points), fresh(points);
    const auto expect_united = [&](const Hull& hull, std::span<const int32_t> more) {
        std::vector<int32_t> all = list(hull.vertices());
        all.insert(all.end(), more.begin(), more.end());
        const Hull united = kernel.unite(hull, more), should = fresh.build(all);
        EXPECT_EQ(list(united.vertices()), list(should.vertices()));
        EXPECT_NEAR(united.volume(), should.volume(), 1e-9 * should.volume());
    };
    std::vector<int32_t> more = numbers(10, 20);
    const Hull first = kernel.build(numbers(0, 10));
    (void)kernel.union_volume(first, more);
    std::ranges::copy(numbers(20, 30), more.begin());
    expect_united(first, more);

    // Tetrahedra, whose blocks have the same size.
    Hull one = others.build(numbers(0, 4));
    const int32_t* const place = one.vertices().data();
    (void)kernel.union_volume(one, more);
    one = {};
    const Hull another = others.build(numbers(30, 34));
    ASSERT_EQ(another.vertices().data(), place);
    expect_united(another, more);
}

}  // namespace
}  // namespace partwheel::test
