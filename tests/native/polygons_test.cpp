// polygon_faults() on shapes with known defects.
#include "base/error.h"
#include "edit/polygons.h"

#include <gtest/gtest.h>

#include <vector>

namespace partwheel::test {
namespace {

using Polygons = std::vector<std::vector<int32_t>>;

const Polygons cube = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

// The same with its vertices counted from another number on, but for one that stays.
Polygons other_cube(int32_t from, int32_t kept = -1) {
    Polygons other = cube;
    for (auto& polygon : other)
        for (int32_t& v : polygon)
            if (v != kept) v += from;
    return other;
}

void expect_faults(const Polygons& polygons, size_t vertices, size_t non_manifold_edges, size_t inconsistent_edges,
                   size_t non_manifold_vertices) {
    std::vector<int32_t> corners, begin;
    for (const auto& polygon : polygons) {
        begin.push_back(static_cast<int32_t>(corners.size()));
        corners.insert(corners.end(), polygon.begin(), polygon.end());
    }
    const PolygonFaults faults = polygon_faults(corners, begin, vertices);
    EXPECT_EQ(faults.non_manifold_edges, non_manifold_edges);
    EXPECT_EQ(faults.inconsistent_edges, inconsistent_edges);
    EXPECT_EQ(faults.non_manifold_vertices, non_manifold_vertices);
}

TEST(Polygons, FaultsAreCounted) {
    expect_faults(cube, 8, 0, 0, 0);
    expect_faults({}, 0, 0, 0, 0);
    expect_faults(cube, 9, 0, 0, 1);  // a loose vertex

    Polygons some(cube.begin() + 1, cube.end());
    expect_faults(some, 8, 4, 0, 0);

    Polygons turned = cube;
    turned[0] = {0, 1, 3, 2};
    expect_faults(turned, 8, 0, 4, 0);

    Polygons twice = cube;
    twice.push_back(cube[0]);
    expect_faults(twice, 8, 4, 0, 0);

    Polygons two = cube;
    const Polygons apart = other_cube(8);
    two.insert(two.end(), apart.begin(), apart.end());
    expect_faults(two, 16, 0, 0, 0);

    Polygons touching = cube;
    const Polygons at_a_corner = other_cube(8, 7);
    touching.insert(touching.end(), at_a_corner.begin(), at_a_corner.end());
    expect_faults(touching, 16, 0, 0, 2);  // 7 has two fans, 15 no polygon
}

TEST(Polygons, InvalidPolygonsAreRefused) {
    const auto refused = [](std::vector<int32_t> corners, std::vector<int32_t> begin, size_t vertices) {
        try {
            polygon_faults(corners, begin, vertices);
        } catch (const Error& error) {
            return error.status() == PW_ERROR_INDEX;
        }
        return false;
    };
    EXPECT_TRUE(refused({0, 1, 3}, {0}, 3));
    EXPECT_TRUE(refused({0, 1, -1}, {0}, 3));
    EXPECT_TRUE(refused({0, 1, 2}, {1}, 3));
    EXPECT_TRUE(refused({0, 1, 2}, {0, 3}, 3));
    EXPECT_TRUE(refused({0, 1, 2, 0, 1, 2}, {0, 3, 2}, 3));
    EXPECT_TRUE(refused({0, 1, 2}, {}, 3));
    EXPECT_FALSE(refused({0, 1, 2}, {0}, 3));
}

}  // namespace
}  // namespace partwheel::test
