// The index: triangle intersections against CGAL, concurrent queries, arguments of the C API.
// tests/core/test_index.py compares its answers with brute force.
#include "base/predicates.h"
#include "mesh/triangles.h"
#include "partwheel_edit.h"
#include "support/built.h"
#include "support/shapes.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <thread>
#include <vector>

namespace partwheel {
namespace {

// On a small lattice, so that most of them share planes, edges or corners; a few less flat.
TEST(Index, TriangleIntersectionsMatchCgal) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    std::mt19937 draw(1);
    size_t met = 0, count = 0;
    for (const uint32_t size : {2U, 3U, 4U, 1000U}) {
        const auto corners = [&] {
            Corners t;
            do
                for (Point& p : t)
                    for (double& x : p) x = static_cast<double>(draw() % size) / 3;
            while (collinear(t[0], t[1], t[2]));
            return t;
        };
        const auto triangle = [](const Corners& t) {
            const auto point = [](const Point& p) { return Kernel::Point_3(p[0], p[1], p[2]); };
            return Kernel::Triangle_3(point(t[0]), point(t[1]), point(t[2]));
        };
        for (int i = 0; i < 20000; ++i, ++count) {
            const Corners a = corners(), b = corners();
            const auto place = common_point(a, b);
            ASSERT_EQ(place.has_value(), CGAL::do_intersect(triangle(a), triangle(b)));
            met += place.has_value();
        }
    }
    EXPECT_GT(met, count / 10);
    EXPECT_LT(met, count);
}

// With their first corner in common, or two.
TEST(Index, IntersectionsOfAdjacentTrianglesMatchCgal) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    std::mt19937 draw(2);
    const auto point = [](const Point& p) { return Kernel::Point_3(p[0], p[1], p[2]); };
    std::array<size_t, 3> met{}, count{};
    while (count[1] < 20000) {
        const uint32_t size = count[1] % 4 == 0 ? 1000 : 3;
        Corners a, b;
        for (Corners* t : {&a, &b})
            for (Point& p : *t)
                for (double& x : p) x = static_cast<double>(draw() % size) / 3;
        for (const size_t shared : {size_t{1}, size_t{2}}) {
            std::copy_n(a.begin(), shared, b.begin());
            if (collinear(a[0], a[1], a[2]) || collinear(b[0], b[1], b[2])) continue;
            const auto p = point(a[0]), q = point(a[1]), r = point(a[2]), s = point(b[1]), t = point(b[2]);
            const bool expected =
                shared == 2 ? CGAL::coplanar(p, q, r, t) && CGAL::coplanar_orientation(p, q, r, t) == CGAL::POSITIVE
                            : CGAL::do_intersect(Kernel::Segment_3(q, r), Kernel::Triangle_3(p, s, t)) ||
                                  CGAL::do_intersect(Kernel::Segment_3(s, t), Kernel::Triangle_3(p, q, r));
            ASSERT_EQ(common_point(a, b, shared).has_value(), expected);
            met[shared] += expected;
            ++count[shared];
        }
    }
    for (const size_t shared : {size_t{1}, size_t{2}}) {
        EXPECT_GT(met[shared], count[shared] / 20);
        EXPECT_LT(met[shared], count[shared]);
    }
}

struct FreeIndex {
    void operator()(pw_index* index) const { pw_index_free(index); }
};
using IndexHandle = std::unique_ptr<pw_index, FreeIndex>;

IndexHandle make(const test::Handle& hierarchy, int32_t threads) {
    pw_index* index = nullptr;
    EXPECT_EQ(pw_index_create(nullptr, hierarchy.get(), nullptr, 0, threads, &index), PW_OK);
    return IndexHandle(index);
}

TEST(Index, ConcurrentQueriesGiveTheSameAnswers) {
    const test::Handle hierarchy = test::build(test::snowman(12, 16));
    const IndexHandle index = make(hierarchy, 3);
    std::mt19937 draw(2);
    std::vector<double> points(3 * 3000);
    for (double& x : points) x = std::uniform_real_distribution(-2.0, 2.0)(draw);
    const size_t count = points.size() / 3;
    struct Answers {
        std::vector<int32_t> held, near;
        std::vector<double> away, nearest;
        bool operator==(const Answers&) const = default;
    };
    const auto ask = [&](const pw_index* of) {
        Answers a{std::vector<int32_t>(count), std::vector<int32_t>(count), std::vector<double>(count), std::vector<double>(3 * count)};
        EXPECT_EQ(pw_index_locate(nullptr, of, points.data(), count, a.held.data()), PW_OK);
        EXPECT_EQ(pw_index_nearest(nullptr, of, points.data(), count, a.near.data(), a.away.data(), a.nearest.data()), PW_OK);
        return a;
    };
    const Answers expected = ask(make(hierarchy, 1).get());
    std::vector<Answers> answers(4);
    std::vector<std::thread> threads;
    for (Answers& a : answers) threads.emplace_back([&] { a = ask(index.get()); });
    for (std::thread& thread : threads) thread.join();
    for (const Answers& a : answers) EXPECT_TRUE(a == expected);
    EXPECT_NE(expected.held, std::vector<int32_t>(count, -1));
}

}  // namespace
}  // namespace partwheel
