// EdgeQueue against a sorted set.
#include "cluster/edge_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <random>
#include <set>
#include <vector>

namespace partwheel::test {
namespace {

constexpr int32_t edges = 3000;

struct Entry {
    MergeCost cost;
    int32_t edge;
    bool operator<(const Entry& other) const { return cost < other.cost; }
};

// Costs as in clustering: many ties in the concavity, none overall.
class Prices {
public:
    explicit Prices(unsigned seed) : random_(seed) {}
    MergeCost operator()(int32_t edge, double least = 0) {
        const double spread = std::uniform_real_distribution<>(0, 1)(random_);
        const double concavity = spread < 0.3 ? least : least + spread * spread * spread;
        return MergeCost(concavity, static_cast<double>(random_() % 5), edge, edge + 1);
    }
    size_t below(size_t n) { return random_() % n; }

private:
    std::mt19937 random_;
};

// The queue and a sorted set, with the same edges in both.
struct Both {
    EdgeQueue queue;
    std::set<Entry> sorted;
    std::vector<MergeCost> cost = std::vector<MergeCost>(edges);
    std::vector<int32_t> queued;

    Both() { queue.set_edge_count(edges); }

    void fill(int32_t count, Prices& costs) {
        for (int32_t e = 0; e < count; ++e) {
            const MergeCost key = costs(e);
            queue.append(key, e);
            sorted.insert({key, e});
            cost[static_cast<size_t>(e)] = key;
            queued.push_back(e);
        }
        queue.sort();
    }
    void update(int32_t edge, const MergeCost& key) {
        queue.update(key, edge);
        sorted.erase({cost[static_cast<size_t>(edge)], edge});
        sorted.insert({key, edge});
        cost[static_cast<size_t>(edge)] = key;
    }
    void remove(size_t i) {
        const int32_t edge = queued[i];
        queued[i] = queued.back();
        queued.pop_back();
        queue.remove(edge);
        sorted.erase({cost[static_cast<size_t>(edge)], edge});
    }
    void compare() {
        ASSERT_EQ(queue.size(), sorted.size());
        ASSERT_EQ(queue.empty(), sorted.empty());
        if (sorted.empty()) return;
        ASSERT_EQ(queue.top().edge, sorted.begin()->edge);
        const auto* second = queue.runner_up();
        ASSERT_EQ(second != nullptr, sorted.size() > 1);
        if (second) {
            ASSERT_EQ(second->edge, std::next(sorted.begin())->edge);
        }
    }
    void compare_price(int32_t edge) {
        const MergeCost &is = queue.cost(edge), &should = cost[static_cast<size_t>(edge)];
        ASSERT_TRUE(queue.has(edge) && !(is < should) && !(should < is));
    }
};

// All that is in it, cheapest first, each found where it is said to be.
void expect_drained(Both& both) {
    while (!both.sorted.empty()) {
        ASSERT_NO_FATAL_FAILURE(both.compare());
        const int32_t top = both.queue.top().edge;
        both.queue.remove(top);
        both.sorted.erase(both.sorted.begin());
        ASSERT_FALSE(both.queue.has(top));
    }
    ASSERT_NO_FATAL_FAILURE(both.compare());
}

TEST(EdgeQueue, SortsAppendedEdges) {
    for (const int32_t count : {0, 1, 2, 5, 31, 33, 127, 129, 200, edges}) {
        Prices costs(static_cast<unsigned>(count));
        Both both;
        both.fill(count, costs);
        ASSERT_NO_FATAL_FAILURE(expect_drained(both)) << count;
    }
}

TEST(EdgeQueue, KeepsItsOrderUnderAnyChange) {
    for (unsigned seed = 0; seed < 6; ++seed) {
        Prices costs(seed);
        Both both;
        // Filled, changed and emptied again and again; seeds differ in how much is changed.
        for (int step = 0; step < 40000; ++step) {
            if (both.queued.empty()) both.fill(static_cast<int32_t>(costs.below(edges)) + 1, costs);
            if (costs.below(3 + seed) == 0) {
                both.remove(costs.below(both.queued.size()));
            } else {
                const int32_t edge = both.queued[costs.below(both.queued.size())];
                ASSERT_NO_FATAL_FAILURE(both.compare_price(edge));
                both.update(edge, costs(edge));
            }
            ASSERT_NO_FATAL_FAILURE(both.compare()) << seed << " " << step;
        }
        ASSERT_NO_FATAL_FAILURE(expect_drained(both));
    }
}

// As in clustering: the top is removed or its cost rises; other costs rise, few fall.
TEST(EdgeQueue, KeepsItsOrderWhileCostsRise) {
    Prices costs(1);
    Both both;
    both.fill(edges, costs);
    for (int step = 0; !both.queued.empty(); ++step) {
        ASSERT_NO_FATAL_FAILURE(both.compare()) << step;
        const Entry top = *both.sorted.begin();
        if (costs.below(2) == 0) {
            both.remove(static_cast<size_t>(std::find(both.queued.begin(), both.queued.end(), top.edge) -
                                            both.queued.begin()));
        } else {
            both.update(top.edge, costs(top.edge, top.cost.concavity()));
        }
        for (int i = 0; i < 4 && !both.queued.empty(); ++i) {
            const int32_t edge = both.queued[costs.below(both.queued.size())];
            both.update(edge, costs(edge, 0.9 * both.cost[static_cast<size_t>(edge)].concavity()));
        }
    }
    EXPECT_TRUE(both.queue.empty());
}

// An edge whose cost falls and rises again may leave a tombstone among the deferred edges.
TEST(EdgeQueue, SurvivesManyMoreChangesThanItsSize) {
    Prices costs(2);
    Both both;
    both.fill(200, costs);
    for (int step = 0; step < 100000; ++step) {
        const int32_t edge = both.queued[costs.below(both.queued.size())];
        both.update(edge, costs(edge));
        both.update(edge, costs(edge, 2));  // later than all that is in the heap
        if (step % 100 == 0) {
            ASSERT_NO_FATAL_FAILURE(both.compare()) << step;
        }
    }
    ASSERT_NO_FATAL_FAILURE(expect_drained(both));
}

}  // namespace
}  // namespace partwheel::test
