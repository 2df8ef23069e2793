// CsrArray, for_each_edge() and UnionFind against maps; Morton codes against a loop over bits.
#include "base/morton.h"
#include "base/adjacency.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

namespace partwheel::test {
namespace {

TEST(CsrArray, RowsKeepTheOrderOfTheirItems) {
    std::mt19937 random(1);
    std::vector<size_t> key(1000);
    for (size_t& k : key) k = random() % 40;
    std::map<size_t, std::vector<int>> expected;
    for (size_t i = 0; i < key.size(); ++i) expected[key[i]].push_back(static_cast<int>(i));
    const CsrArray<int> groups(50, [&](const auto& put) {  // ten empty rows
        for (size_t i = 0; i < key.size(); ++i) put(key[i], static_cast<int>(i));
    });
    EXPECT_EQ(groups.items().size(), key.size());
    for (size_t k = 0; k < 50; ++k) {
        const std::span<const int> row = groups.row(k);
        EXPECT_EQ(std::vector<int>(row.begin(), row.end()), expected[k]) << k;
    }
}

TEST(CsrArray, MayBeEmpty) {
    const CsrArray<int> none(0, [](const auto&) {});
    EXPECT_TRUE(none.items().empty());
    for_each_edge(0, 0, [](size_t) { return std::pair(0, 0); }, [](int32_t, std::span<const Side>) { FAIL(); });
}

// Both ways along an edge, several at one edge, and from a vertex to itself.
TEST(ForEachEdge, VisitsEachEdgeOnceInOrderWithAllSides) {
    std::mt19937 random(2);
    std::vector<std::pair<int32_t, int32_t>> edges(500);
    for (auto& [from, to] : edges) from = static_cast<int32_t>(random() % 12), to = static_cast<int32_t>(random() % 12);
    using SideKey = std::tuple<int32_t, bool>;  // number, is_ascending
    std::map<std::pair<int32_t, int32_t>, std::vector<SideKey>> expected;
    for (size_t i = 0; i < edges.size(); ++i) {
        const auto [from, to] = edges[i];
        expected[{std::min(from, to), std::max(from, to)}].emplace_back(static_cast<int32_t>(i), from < to);
    }
    auto next = expected.begin();
    for_each_edge(12, edges.size(), [&](size_t i) { return edges[i]; }, [&](int32_t low, std::span<const Side> sides) {
        ASSERT_NE(next, expected.end());
        std::vector<SideKey> visited;
        for (const Side& side : sides) {
            EXPECT_EQ(std::pair(low, side.high), next->first);
            visited.emplace_back(side.number, side.is_ascending);
        }
        EXPECT_EQ(visited, next->second);
        ++next;
    });
    EXPECT_EQ(next, expected.end());
}

TEST(UnionFind, TheRepresentativeIsTheLowestMember) {
    std::mt19937 random(3);
    UnionFind union_find(200);
    std::vector<size_t> set(200);  // by brute force: the lowest member of each set
    for (size_t i = 0; i < set.size(); ++i) set[i] = i;
    for (int step = 0; step < 150; ++step) {
        const size_t a = random() % 200, b = random() % 200;
        const auto [low, high] = std::pair(std::min(set[a], set[b]), std::max(set[a], set[b]));
        union_find.unite(a, b);
        std::replace(set.begin(), set.end(), size_t{high}, size_t{low});
        for (size_t i = 0; i < set.size(); ++i) ASSERT_EQ(union_find.find(i), set[i]);
    }
}

TEST(MortonCode, InterleavesTheBitsOfTheCoordinates) {
    std::mt19937_64 random(4);
    for (int step = 0; step < 1000; ++step) {
        std::array<uint64_t, 3> cell;
        for (uint64_t& c : cell) c = step == 0 ? (1U << morton_bits) - 1 : random() >> (64 - morton_bits);
        uint64_t expected = 0;
        for (int bit = morton_bits - 1; bit >= 0; --bit)
            for (const uint64_t c : cell) expected = expected << 1 | (c >> bit & 1);
        ASSERT_EQ(morton_code(cell), expected);
    }
}

}  // namespace
}  // namespace partwheel::test
