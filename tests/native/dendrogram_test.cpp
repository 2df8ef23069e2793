// The dendrogram against direct transcriptions: Listing 2 by Eq. 3, cuts by enumeration, the rules of the wheel.
#include "cluster/cluster.h"
#include "tree/dendrogram.h"

#include "support/shapes.h"
#include "support/sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <list>
#include <memory>
#include <new>
#include <numeric>
#include <random>
#include <set>
#include <span>

// Current and peak memory use, counted at allocation. Each block is preceded by its size.
namespace {

std::atomic<size_t> in_use{0}, largest_total{0};
constexpr size_t before_piece = 2 * sizeof(std::max_align_t);

}  // namespace

void* operator new(size_t size) {
    auto* piece = static_cast<unsigned char*>(std::malloc(size + before_piece));
    if (!piece) throw std::bad_alloc();
    std::memcpy(piece, &size, sizeof size);
    const size_t total = in_use += size;
    if (total > largest_total) largest_total = total;
    return piece + before_piece;
}

// std::stable_sort asks for its buffer with this one.
void* operator new(size_t size, const std::nothrow_t&) noexcept {
    try {
        return operator new(size);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}

void operator delete(void* piece) noexcept {
    if (!piece) return;
    auto* const whole = static_cast<unsigned char*>(piece) - before_piece;
    size_t size = 0;
    std::memcpy(&size, whole, sizeof size);
    in_use -= size;
    std::free(whole);
}

void operator delete(void* piece, size_t) noexcept { operator delete(piece); }

namespace partwheel::test {
namespace {

// ---- Listing 2, as the paper has it: nodes with lists of children, recursion from the root ----

// The paper's Eq. 3. Instead of adding 1 to the concavity, which would absorb small ones, the class orders convex
// clusters before others.
struct PaperCost {
    int concave = 0;
    double value = 0;  // Eq. 1 or Eq. 2
    auto operator<=>(const PaperCost&) const = default;
};

struct Node {
    int32_t number = 0;
    PaperCost cost;
    double tetrahedra = 1;
    bool leaf = false;
    std::list<Node*> children;
};

void to_dendrogram(Node* r) {
    for (auto c = r->children.begin(); c != r->children.end();) {  // including children inserted meanwhile
        if (!(*c)->leaf && (*c)->cost >= r->cost) {
            for (Node* cc : (*c)->children) r->children.push_back(cc);
            (*c)->children.clear();
            c = r->children.erase(c);
        } else {
            ++c;
        }
    }
    for (Node* c : r->children) to_dendrogram(c);
}

struct Tree {
    std::vector<std::unique_ptr<Node>> nodes;
    Node* root() const { return nodes.back().get(); }
};

// With the costs of Eq. 3, or with the concavity alone in one class.
Tree tree_of(const std::vector<Merge>& merges, bool equation_3 = true) {
    Tree tree;
    const auto all = static_cast<double>(merges.size() + 1);
    for (size_t i = 0; i < 2 * merges.size() + 1; ++i) {
        auto node = std::make_unique<Node>();
        node->number = static_cast<int32_t>(i);
        node->leaf = i <= merges.size();
        if (!node->leaf) {
            const Merge& m = merges[i - merges.size() - 1];
            Node *left = tree.nodes[static_cast<size_t>(m.left)].get(),
                 *right = tree.nodes[static_cast<size_t>(m.right)].get();
            node->children = {left, right};
            node->tetrahedra = left->tetrahedra + right->tetrahedra;
            const double t1 = left->tetrahedra, t2 = right->tetrahedra;
            if (!equation_3)
                node->cost = {0, m.concavity};
            else if (m.concavity > 0)
                node->cost = {1, m.concavity};
            else
                node->cost = {0, (t1 * t1 + t2 * t2) / (all * all)};
        }
        tree.nodes.push_back(std::move(node));
    }
    return tree;
}

void collect(const Node* node, std::set<int32_t>& inner) {
    if (!node->leaf) inner.insert(node->number);
    for (const Node* c : node->children) collect(c, inner);
}

std::vector<uint8_t> pruned_by_the_paper(const std::vector<Merge>& merges) {
    const Tree tree = tree_of(merges);
    to_dendrogram(tree.root());
    std::set<int32_t> inner;
    collect(tree.root(), inner);
    std::vector<uint8_t> kept(merges.size(), 0);
    for (const int32_t n : inner)
        if (static_cast<size_t>(n) > merges.size()) kept[static_cast<size_t>(n) - merges.size() - 1] = 1;
    return kept;
}

// ---- Random trees ----

class DendrogramTest : public testing::Test {
protected:
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); }

    // Concavities are small integers with many ties, or arbitrary; many clusters are convex.
    std::vector<Merge> random_tree(int leaves, bool ties) {
        std::vector<int32_t> open(static_cast<size_t>(leaves));
        std::iota(open.begin(), open.end(), 0);
        std::vector<Merge> merges;
        const bool chain = whole(0, 3) == 0;
        while (open.size() > 1) {
            std::array<int32_t, 2> side{};
            for (int32_t& s : side) {
                const auto last = static_cast<int>(open.size()) - 1;
                const auto i = static_cast<size_t>(chain && &s == &side[0] ? last : whole(0, last));
                s = open[i];
                open.erase(open.begin() + static_cast<std::ptrdiff_t>(i));
            }
            Merge m;
            m.left = side[0];
            m.right = side[1];
            m.concavity = ties ? whole(0, 3) : std::max(0.0, std::uniform_real_distribution<double>(-0.5, 1)(random));
            open.push_back(leaves + static_cast<int32_t>(merges.size()));
            merges.push_back(m);
        }
        return merges;
    }

    std::mt19937 random{7};
};

TEST_F(DendrogramTest, PrunesLikeListing2) {
    for (int i = 0; i < sized(2000, 300); ++i) {
        const auto merges = random_tree(whole(2, i % 10 == 0 ? 300 : 20), i % 2 == 0);
        ASSERT_EQ(prune(merges), pruned_by_the_paper(merges)) << "round " << i;
    }
}

Merge merge_of(int32_t left, int32_t right, double concavity) {
    Merge m;
    m.left = left;
    m.right = right;
    m.concavity = concavity;
    return m;
}

TEST_F(DendrogramTest, PruningKeepsNodesOfRisingCost) {
    // Concavities 1, 2, 3 up a chain: all stay. 2, 2, 3: the lower of the equal ones goes. 3, 1, 2: a child that
    // costs more than its parent goes, but is compared with its remaining ancestor, not with a removed one.
    const std::vector<std::pair<std::array<double, 3>, std::vector<uint8_t>>> cases{
        {{1, 2, 3}, {1, 1, 1}}, {{2, 2, 3}, {0, 1, 1}}, {{3, 1, 2}, {0, 1, 1}},
        {{1, 5, 2}, {1, 0, 1}}, {{3, 5, 2}, {0, 0, 1}}};
    for (const auto& [c, expected] : cases) {
        const std::vector<Merge> chain{merge_of(0, 1, c[0]), merge_of(4, 2, c[1]), merge_of(5, 3, c[2])};
        EXPECT_EQ(prune(chain), expected);
        EXPECT_EQ(prune_scored(chain, {}), expected);
    }
    EXPECT_TRUE(prune(std::vector<Merge>{}).empty());
    EXPECT_TRUE(prune_scored(std::vector<Merge>{}, {}).empty());
}

TEST_F(DendrogramTest, ConvexNodesInConvexNodesFollowEq3) {
    // C2 of two tetrahedra of four is 2/16, of three 5/16, of all 10/16: it grows. By concavity alone they are equal.
    const std::vector<Merge> convex{merge_of(0, 1, 0), merge_of(4, 2, 0), merge_of(5, 3, 0)};
    EXPECT_EQ(node_costs(convex),
              (std::vector<NodeCost>{{false, 2.0 / 16}, {false, 5.0 / 16}, {false, 10.0 / 16}}));
    EXPECT_EQ(prune(convex), (std::vector<uint8_t>{1, 1, 1}));
    EXPECT_EQ(prune_scored(convex, {}), (std::vector<uint8_t>{0, 0, 1}));
    // Any concave node costs more than a convex one: it goes.
    const std::vector<Merge> dented{merge_of(0, 1, 0), merge_of(4, 2, 1e-300), merge_of(5, 3, 0)};
    EXPECT_EQ(prune(dented), (std::vector<uint8_t>{1, 0, 1}));
}

TEST_F(DendrogramTest, Figure4) {
    // Unions of two or three of the four sub-tetrahedra are not convex, all four are. So only the root stays.
    Progress progress;
    progress.begin();
    const auto merges = cluster(figure_4(), progress).merges;
    ASSERT_EQ(merges.size(), 3U);
    EXPECT_GT(merges[0].concavity, 0);
    EXPECT_EQ(merges[2].concavity, 0);
    EXPECT_NEAR(merges[2].hull_volume, 8.0 / 3, 1e-12);
    EXPECT_EQ(prune(merges), (std::vector<uint8_t>{0, 0, 1}));
}

// ---- Cuts ----

// Every cut of the subtree: sets of cluster numbers, depth first.
std::vector<std::vector<int32_t>> all_cuts(const Node* node) {
    std::vector<std::vector<int32_t>> cuts{{node->number}};
    if (node->leaf) return cuts;
    for (const auto& left : all_cuts(node->children.front()))
        for (const auto& right : all_cuts(node->children.back())) {
            cuts.push_back(left);
            cuts.back().insert(cuts.back().end(), right.begin(), right.end());
        }
    return cuts;
}

TEST_F(DendrogramTest, LeastConcavityCutsAreOptimal) {
    for (int i = 0; i < sized(400, 60); ++i) {
        const auto leaves = static_cast<size_t>(whole(1, 12));
        const auto merges = random_tree(static_cast<int>(leaves), i % 2 == 0);
        const Tree tree = tree_of(merges, false);
        const auto total = [&](const std::vector<int32_t>& cut) {
            double sum = 0;
            for (const int32_t n : cut) sum += tree.nodes[static_cast<size_t>(n)]->cost.value;
            return sum;
        };
        const auto cuts = all_cuts(tree.root());
        const std::set<std::vector<int32_t>> known(cuts.begin(), cuts.end());
        for (size_t parts = 1; parts <= leaves; ++parts) {
            double best = std::numeric_limits<double>::infinity();
            for (const auto& cut : cuts)
                if (cut.size() == parts) best = std::min(best, total(cut));
            const auto cut = cut_least_concavity(merges, parts);
            ASSERT_EQ(cut.size(), parts);
            ASSERT_TRUE(known.contains(cut)) << "no cut of the tree in depth-first order";
            ASSERT_NEAR(total(cut), best, 1e-12);
        }
    }
}

// A long chain of pairs: each merge has a choice for each number of parts, once at 2 bytes each.
TEST_F(DendrogramTest, LeastConcavityNeedsLittleMemory) {
    const int pairs = sized(6000, 1500);
    const auto leaves = static_cast<size_t>(2 * pairs);
    const size_t parts = std::min<size_t>(leaves, 4096);
    std::vector<Merge> merges;
    for (int p = 0; p < pairs; ++p) merges.push_back({2 * p, 2 * p + 1, 1.0 + p % 7, 0});
    for (int p = 1, chain = 2 * pairs; p < pairs; ++p) {
        merges.push_back({chain, 2 * pairs + p, 10.0 * p + p % 5, 0});
        chain = static_cast<int>(leaves + merges.size() - 1);
    }
    largest_total = in_use.load();
    const size_t before = in_use;
    EXPECT_EQ(cut_least_concavity(merges, parts).size(), parts);
    EXPECT_LE(largest_total - before, leaves * parts / 12 + 100 * leaves);
}

// ---- The scored tree ----

TEST_F(DendrogramTest, ScoredMergesStayAndHideNothing) {
    for (int i = 0; i < sized(400, 60); ++i) {
        const auto merges = random_tree(whole(2, 40), i % 2 == 0);
        const auto top = static_cast<size_t>(whole(0, static_cast<int>(merges.size())));
        // Listing 2 for each part by itself, by concavity.
        std::vector<uint8_t> expected(merges.size(), 0);
        const Tree tree = tree_of(merges, false);
        std::vector<double> scores;  // 0 marks intermediate merges
        for (size_t m = merges.size() - top; m < merges.size(); ++m) {
            scores.push_back(whole(0, 3) == 0 ? 0 : 0.5);
            expected[m] = scores.back() > 0;
        }
        std::vector<uint8_t> held(merges.size(), 0);
        for (size_t m = 0; m < merges.size(); ++m)
            for (const int32_t child : {merges[m].left, merges[m].right})
                if (static_cast<size_t>(child) > merges.size() && m + top < merges.size())
                    held[static_cast<size_t>(child) - merges.size() - 1] = 1;
        for (size_t m = 0; m + top < merges.size(); ++m) {
            if (held[m]) continue;
            Node* part = tree.nodes[merges.size() + 1 + m].get();
            to_dendrogram(part);
            std::set<int32_t> inner;
            collect(part, inner);
            for (const int32_t n : inner) expected[static_cast<size_t>(n) - merges.size() - 1] = 1;
        }
        ASSERT_EQ(prune_scored(merges, scores), expected) << "round " << i;
    }
}

TEST_F(DendrogramTest, BestScoringCutIsOptimal) {
    for (int i = 0; i < sized(300, 60); ++i) {
        const auto merges = random_tree(whole(1, 12), false);
        const Tree tree = tree_of(merges);
        std::vector<double> areas, scores;
        for (size_t c = 0; c < 2 * merges.size() + 1; ++c) {
            areas.push_back(whole(1, 4));
            scores.push_back(std::uniform_real_distribution<double>(0.01, 1)(random));
            const bool inside = c > merges.size() && c < 2 * merges.size();
            if (inside && whole(0, 3) == 0) scores.back() = 0;  // an intermediate merge
        }
        areas.back() = 5;  // nothing else is nearly the whole
        const auto a_step = [&](int32_t n) { return scores[static_cast<size_t>(n)] == 0; };
        const auto value = [&](const std::vector<int32_t>& cut) {
            double sum = 0;
            for (const int32_t n : cut) sum += areas[static_cast<size_t>(n)] * scores[static_cast<size_t>(n)];
            return sum - 0.005 * areas.back() * static_cast<double>(cut.size());
        };
        double best = -HUGE_VAL;
        const auto cuts = all_cuts(tree.root());
        for (const auto& cut : cuts)
            if (std::ranges::none_of(cut, a_step)) best = std::max(best, value(cut));
        const auto cut = best_scoring_cut(merges, merges.size(), areas, scores);
        ASSERT_EQ(std::count(cuts.begin(), cuts.end(), cut), 1);
        ASSERT_TRUE(std::ranges::none_of(cut, a_step));
        ASSERT_NEAR(value(cut), best, 1e-12);
    }
    // What is below the parts is not divided, whatever its value.
    const std::vector<Merge> one(1, {0, 1, 0, 0});
    EXPECT_EQ(best_scoring_cut(one, 0, std::vector<double>{1, 1, 2}, std::vector<double>{1, 1, 0.1}), std::vector<int32_t>{2});
    EXPECT_EQ(best_scoring_cut(one, 1, std::vector<double>{1, 1, 2}, std::vector<double>{1, 1, 0.1}),
              (std::vector<int32_t>{0, 1}));
}

TEST_F(DendrogramTest, APartMustGainHalfAPercentOfTheArea) {
    // 0, 1 and 2 merge at once, then with 3.
    const std::vector<Merge> merges = {{0, 1, 0, 0}, {4, 2, 0, 0}, {5, 3, 0, 0}};
    const std::vector<double> areas = {50, 0.2, 0.2, 49.6, 50.2, 50.4, 100};
    const auto cut = [&](double score) {
        return best_scoring_cut(merges, 3, areas, std::vector<double>{score, 0.5, 0.5, 0.8, 0, 0.49, 0.1});
    };
    EXPECT_EQ(cut(0.50), (std::vector<int32_t>{5, 3}));        // divided 0.5 better, for two more parts
    EXPECT_EQ(cut(0.54), (std::vector<int32_t>{0, 1, 2, 3}));  // divided 2.5 better
}

// A torso, two slivers in its armpits, the rest.
TEST_F(DendrogramTest, SliversStayWithWhatTheyLieOn) {
    const std::vector<Merge> merges = {{0, 1, 0, 0}, {4, 2, 0, 0}, {5, 3, 0, 0}};
    const auto cut = [&](double sliver, double sliver_score, double joined_score) {
        const std::vector<double> areas = {40, sliver, sliver, 60 - 2 * sliver, 40 + sliver, 40 + 2 * sliver, 100};
        return best_scoring_cut(merges, 3, areas, std::vector<double>{0.9, sliver_score, sliver_score, 0.8, joined_score, 0.4, 0.1});
    };
    const std::vector<int32_t> together = {5, 3}, apart = {0, 1, 2, 3};
    EXPECT_EQ(cut(0.2, 0.1, 0.4), together);
    EXPECT_EQ(cut(0.2, 0.1, 0), together);  // merged with both at once
    EXPECT_EQ(cut(0.2, 0.6, 0.4), apart);   // small, but a good part, such as a lamp
    EXPECT_EQ(cut(4, 0.29, 0.4), apart);    // worth a part
    EXPECT_EQ(cut(1.2, 0.29, 0.4), (std::vector<int32_t>{4, 2, 3}));  // both are more than 0.05 of the area
}

TEST_F(DendrogramTest, WhatIsNearlyTheWholeScoresNoMoreThanIt) {
    // 0 and 1, then a piece as large as a face.
    const std::vector<Merge> merges = {{0, 1, 0, 0}, {3, 2, 0, 0}};
    const auto cut = [&](double piece, double whole) {
        return best_scoring_cut(merges, 2, std::vector<double>{50, 50 - piece, piece, 100 - piece, 100},
                                std::vector<double>{0.5, 0.4, 0.1, 0.6, whole});
    };
    EXPECT_EQ(cut(0.1, 0.3), (std::vector<int32_t>{0, 1, 2}));  // 0.3, not 0.6 for all but the piece
    EXPECT_EQ(cut(0.1, 0.55), std::vector<int32_t>{4});
    EXPECT_EQ(cut(5, 0.3), (std::vector<int32_t>{3, 2}));  // the piece can be seen
}

TEST_F(DendrogramTest, StopsDifferAndTheStartStopIsTheBest) {
    for (int i = 0; i < sized(2000, 300); ++i) {
        std::vector<double> areas = {whole(1, 5) / 5.0}, scores = {0};
        const int length = whole(1, 30), below = whole(0, length - 1);
        for (int k = 1; k < length; ++k) {
            areas.push_back(areas.back() * (whole(0, 2) == 0 ? 1 : 1 + whole(0, 100) / 100.0));
            scores.push_back(0);
        }
        for (int k = below; k < length; ++k) scores[static_cast<size_t>(k)] = whole(1, 5) / 5.0;
        const WheelStops wheel = wheel_stops(areas, scores);
        ASSERT_FALSE(wheel.stops.empty());
        ASSERT_EQ(wheel.stops.back(), length - 1);
        ASSERT_LT(wheel.start, wheel.stops.size());
        const auto area = [&](size_t s) { return areas[static_cast<size_t>(wheel.stops[s])]; };
        for (size_t s = 0; s + 1 < wheel.stops.size(); ++s) {
            ASSERT_LT(wheel.stops[s], wheel.stops[s + 1]);
            ASSERT_LT(area(s), area(s + 1));  // a notch always adds visible faces
            if (s + 2 < wheel.stops.size()) {
                ASSERT_LE(area(s), 0.85 * area(s + 1) * (1 + 1e-12));
            }
        }
        // Below the parts each stop has at most half the area of the next, and all such nodes are stops.
        int32_t next = *std::ranges::find_if(wheel.stops, [&](int32_t n) { return scores[static_cast<size_t>(n)] > 0; });
        std::vector<int32_t> halves;
        for (int32_t k = below - 1; k >= 0; --k)
            if (areas[static_cast<size_t>(k)] <= 0.5 * areas[static_cast<size_t>(next)]) halves.push_back(next = k);
        std::ranges::reverse(halves);
        ASSERT_TRUE(std::ranges::equal(halves, std::span(wheel.stops).first(halves.size())));
        ASSERT_GT(scores[static_cast<size_t>(wheel.stops[halves.size()])], 0);
        // Nothing on the path is better than what the click takes, but for what can't be distinguished from the root.
        const double best = *std::max_element(scores.begin(), scores.end());
        const auto clicked = static_cast<size_t>(wheel.stops[wheel.start]);
        ASSERT_TRUE(scores[clicked] == best || areas[clicked] == areas.back());
    }
}

// A shell with 80 % of an assembly, and parts of it.
struct LargeShell {
    std::vector<double> areas = {1, 10, 30, 60, 80, 100}, scores = {0, 0.2, 0.5, 0.4, 0.9, 0.8};
    size_t shell = 4;

    int32_t clicked() const {
        const WheelStops wheel = assembly_wheel_stops(areas, scores, shell);
        return wheel.stops[wheel.start];
    }
    size_t largest() const { return largest_click(assembly_wheel_stops(areas, scores, shell).stops, areas, scores, shell); }
};

TEST_F(DendrogramTest, AClickTakesAtMostHalfOfAnAssembly) {
    LargeShell large;
    EXPECT_EQ(large.clicked(), 2);
    EXPECT_EQ(large.largest(), 2U);
    large.scores[1] = 0.6;
    EXPECT_EQ(large.clicked(), 1);  // the best score up to that
    EXPECT_EQ(large.largest(), 2U);
    large.areas[4] = 50, large.areas[3] = 40;
    EXPECT_EQ(large.clicked(), 4);
    large.areas = {80}, large.scores = {0.9}, large.shell = 0;  // no other shells
    EXPECT_EQ(large.clicked(), 0);
}

TEST_F(DendrogramTest, AClickTakesALargeShellWhoseSmallerPartsHavePoorScores) {
    LargeShell large;
    large.scores[2] = 0.26;
    EXPECT_EQ(large.clicked(), 4);
    EXPECT_EQ(large.largest(), 4U);
}

TEST_F(DendrogramTest, AClickTakesALargePartMadeByHand) {
    LargeShell large;
    large.scores[3] = 1;
    EXPECT_EQ(large.clicked(), 3);
    EXPECT_EQ(large.largest(), 4U);
}

TEST_F(DendrogramTest, TheCloserTheViewTheSmallerTheStart) {
    for (int i = 0; i < sized(500, 100); ++i) {
        const int length = whole(1, 12), shell = whole(0, length - 1);
        std::vector<int32_t> stops;
        std::vector<double> scores, extents = {whole(1, 9) / 9.0};
        for (int k = 0; k < length; ++k) {
            stops.push_back(k);
            scores.push_back(whole(0, 10) / 10.0);
            if (k > 0) extents.push_back(extents.back() * (1 + whole(0, 50) / 50.0));
        }
        const auto value = [&](size_t s, double view) {
            const double distance = std::log(extents[s] / view) - std::log(0.5);
            return scores[s] - 0.6 * distance * distance;
        };
        const double least = 0.3 * *std::max_element(scores.begin(), scores.begin() + shell + 1);
        size_t before = 0;
        for (double view = 1e-2; view < 1e4; view *= 1.7) {
            const size_t start = start_in_view(stops, scores, extents, static_cast<size_t>(shell), view);
            ASSERT_LE(start, static_cast<size_t>(shell));
            ASSERT_GE(scores[start], least);
            for (size_t s = 0; s <= static_cast<size_t>(shell); ++s)
                ASSERT_TRUE(scores[s] < least || value(start, view) >= value(s, view) - 1e-9);
            ASSERT_GE(start, before);
            before = start;
        }
    }
}

}  // namespace
}  // namespace partwheel::test
