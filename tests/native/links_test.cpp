// Links of one pool against vectors.
#include "cluster/links.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace partwheel::test {
namespace {

struct Pair {
    Links links;
    std::vector<Link> should;

    void check() const {
        ASSERT_EQ(links.size(), should.size());
        for (size_t i = 0; i < should.size(); ++i) {
            ASSERT_EQ(links.begin()[i].cluster, should[i].cluster);
            ASSERT_EQ(links.begin()[i].edge, should[i].edge);
        }
    }
};

TEST(Links, BehaveLikeAVector) {
    constexpr size_t lists = 60;
    std::mt19937 random(7);
    Pool pool;
    std::vector<Link> elsewhere(lists / 2 * Links::inline_capacity);
    std::vector<Pair> pairs(lists);
    for (size_t i = 0; i < lists / 2; ++i) pairs[i].links = Links(&elsewhere[i * Links::inline_capacity]);
    int32_t next = 0;
    size_t longest = 0;
    for (size_t step = 0; step < 200000; ++step) {
        Pair& pair = pairs[random() % lists];
        switch (random() % 16) {
            case 0:
                if (random() % 8 != 0) break;
                pair.links.release(pool);
                pair.should.clear();
                break;
            case 1: {
                Pair& other = pairs[random() % lists];
                if (&other == &pair) break;
                other.links.release(pool);
                other.links = std::move(pair.links);
                other.should = std::exchange(pair.should, {});
                break;
            }
            case 2:
            case 3: {
                if (pair.should.empty()) break;
                const int32_t cluster = pair.should[random() % pair.should.size()].cluster;
                pair.links.erase(pair.links.find(cluster));
                pair.should.erase(std::ranges::find(pair.should, cluster, &Link::cluster));
                break;
            }
            case 4: {
                if (pair.should.empty()) break;
                const int32_t cluster = pair.should[random() % pair.should.size()].cluster;
                pair.links.erase_of(cluster);
                std::erase_if(pair.should, [&](const Link& l) { return l.cluster == cluster; });
                ASSERT_EQ(pair.links.find(cluster), pair.links.end());
                break;
            }
            default: {
                const Link link = {static_cast<int32_t>(random() % 50), next++};
                pair.links.push_back(link, pool);
                pair.should.push_back(link);
            }
        }
        longest = std::max(longest, pair.should.size());
        if (step % 64 == 0)
            for (const Pair& p : pairs) p.check();
    }
    ASSERT_GT(longest, 4 * Links::inline_capacity);  // so that lists have grown several times
}

// More than a chunk at once, and chunks without end.
TEST(Links, MayBeLong) {
    Pool pool;
    std::vector<Links> lists(3);
    for (int32_t i = 0; i < 100000; ++i)
        for (Links& links : lists) links.push_back({i, -i}, pool);
    for (const Links& links : lists) {
        ASSERT_EQ(links.size(), 100000u);
        for (int32_t i = 0; i < 100000; ++i) ASSERT_EQ(links.begin()[i].cluster, i);
    }
}

}  // namespace
}  // namespace partwheel::test
