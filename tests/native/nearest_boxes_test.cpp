// NearestBoxes against brute force, with many ties.
#include "cluster/nearest_boxes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

using namespace partwheel;

namespace {

double squared_distance(const Box& a, const Box& b) {
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) {
        const double gap = a.low[k] > b.high[k] ? a.low[k] - b.high[k] : b.low[k] > a.high[k] ? b.low[k] - a.high[k] : 0;
        sum += gap * gap;
    }
    return sum;
}

std::vector<int32_t> by_comparing_all(const std::vector<Box>& boxes, size_t i, size_t count) {
    std::vector<std::pair<double, int32_t>> order;
    for (size_t j = 0; j < boxes.size(); ++j)
        if (j != i) order.emplace_back(squared_distance(boxes[i], boxes[j]), static_cast<int32_t>(j));
    std::sort(order.begin(), order.end());
    std::vector<int32_t> numbers;
    for (size_t j = 0; j < std::min(count, order.size()); ++j) numbers.push_back(order[j].second);
    return numbers;
}

void expect_nearest(const std::vector<Box>& boxes) {
    const NearestBoxes tree(boxes);
    for (size_t i = 0; i < boxes.size(); ++i) EXPECT_EQ(tree.nearest(i, 16), by_comparing_all(boxes, i, 16));
}

}  // namespace

TEST(NearestBoxes, TiesInAGridAreBrokenByIndex) {
    std::vector<Box> boxes;
    for (int x = 0; x < 6; ++x)
        for (int y = 0; y < 6; ++y)
            for (int z = 0; z < 6; ++z)
                boxes.push_back({{2.0 * x, 2.0 * y, 2.0 * z}, {2.0 * x + 1, 2.0 * y + 1, 2.0 * z + 1}});
    expect_nearest(boxes);
    std::shuffle(boxes.begin(), boxes.end(), std::mt19937(1));
    expect_nearest(boxes);
}

TEST(NearestBoxes, OverlappingBoxesAreTakenInOrder) {
    expect_nearest(std::vector<Box>(100, Box{{0, 0, 0}, {1, 1, 1}}));
}

TEST(NearestBoxes, MatchBruteForceOnRandomBoxes) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> any(0, 1);
    std::vector<Box> boxes(300);
    for (Box& box : boxes) {
        box.add({any(random), any(random), any(random)});
        box.add({box.low[0] + 0.1 * any(random), box.low[1] + 0.1 * any(random), box.low[2] + 0.1 * any(random)});
    }
    expect_nearest(boxes);
}

TEST(NearestBoxes, OfFewBoxesAllOthersAreReturned) {
    expect_nearest({});
    expect_nearest({{{0, 0, 0}, {1, 1, 1}}});
    expect_nearest({{{0, 0, 0}, {1, 1, 1}}, {{5, 0, 0}, {6, 1, 1}}});
}
