// Nearest triangles, against CGAL's distances to all of them.
#include "mesh/nearest.h"

#include "support/shapes.h"

#include <CGAL/Simple_cartesian.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace partwheel::test {
namespace {

using partwheel::operator-;
using Kernel = CGAL::Simple_cartesian<double>;

double squared_distance(const Point& p, const Corners& corners) {
    const auto point = [](const Point& q) { return Kernel::Point_3(q[0], q[1], q[2]); };
    const Kernel::Triangle_3 triangle(point(corners[0]), point(corners[1]), point(corners[2]));
    return triangle.is_degenerate() ? HUGE_VAL : CGAL::squared_distance(point(p), triangle);
}

std::vector<Point> points_around(const TriMesh& mesh, int count) {
    const Box box = Box::around(mesh.vertices);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-0.5, 1.5);
    std::vector<Point> points(mesh.vertices.begin(), mesh.vertices.end());  // of many triangles at once
    for (int i = 0; i < count; ++i) {
        Point p;
        for (size_t k = 0; k < 3; ++k) p[k] = box.low[k] + any(random) * (box.high[k] - box.low[k]);
        points.push_back(p);
    }
    return points;
}

TEST(NearestTriangle, AsNearAsTheNearestOfAll) {
    for (const TriMesh& mesh : {cube(), torus(20, 12, 2, 0.6), star_prism(7, 0.1, 1, 1), stretched(torus(9, 7, 2, 0.6), {1, 1, 99}),
                                together("twins", sphere(6, 9), sphere(6, 9))}) {
        NearestTriangle nearest(mesh.vertices, mesh.triangles);
        const NearestTriangle fresh(mesh.vertices, mesh.triangles);
        for (const Point& p : points_around(mesh, 300)) {
            double least = HUGE_VAL;
            for (const Triangle& t : mesh.triangles)
                least = std::min(least, squared_distance(p, corner_points(mesh.vertices, t)));
            const Near near = nearest(p);
            const double rounding = 1e-9 * (1 + least);
            ASSERT_NEAR(near.squared, least, rounding) << mesh.name;
            ASSERT_NEAR(squared_distance(p, corner_points(mesh.vertices, mesh.triangles[idx(near.triangle)])), least, rounding);
            ASSERT_NEAR(squared(p - near.point), least, rounding);
            ASSERT_EQ(fresh(p, HUGE_VAL).triangle, near.triangle) << "the query before changes the result";
            for (const double factor : {0.99, 1.01}) {
                const double distance = factor * std::sqrt(least);
                if (least < 1e-12) continue;
                ASSERT_EQ(nearest.within(p, distance), factor > 1);
                ASSERT_EQ(fresh(p, distance).triangle, factor > 1 ? near.triangle : -1);
            }
        }
    }
}

TEST(NearestTriangle, NumberingDoesNotMatter) {
    const TriMesh mesh = torus(20, 12, 2, 0.6), other = shuffled(mesh, 5).mesh;
    NearestTriangle nearest(mesh.vertices, mesh.triangles), nearest_other(other.vertices, other.triangles);
    const auto corners = [](const TriMesh& of, int32_t triangle) {
        Corners sorted = corner_points(of.vertices, of.triangles[idx(triangle)]);
        std::ranges::sort(sorted);
        return sorted;
    };
    for (const Point& p : points_around(mesh, 300))
        ASSERT_EQ(corners(mesh, nearest(p).triangle), corners(other, nearest_other(p).triangle));
}

TEST(NearestTriangle, OutsideOfASphere) {
    const TriMesh mesh = sphere(20, 30);
    const NearestTriangle nearest(mesh.vertices, mesh.triangles);
    for (const Point& p : points_around(mesh, 1000)) {
        if (std::fabs(length(p) - 1) > 0.02) {
            ASSERT_EQ(nearest.is_outside(p), length(p) > 1);
        }
    }
}

}  // namespace
}  // namespace partwheel::test
