// Patches as nodes of random trees, compared with sets of parts.
#include "parts/merge/insert_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

namespace partwheel::test {
namespace {

using Set = std::set<int32_t>;

// Of each node: its parts.
std::vector<Set> part_sets(const PartTree& tree) {
    std::vector<Set> sets;
    for (size_t p = 0; p < tree.count; ++p) sets.push_back({static_cast<int32_t>(p)});
    for (const auto& [a, b] : tree.children) {
        sets.push_back(sets[idx(a)]);
        sets.back().insert(sets[idx(b)].begin(), sets[idx(b)].end());
    }
    return sets;
}

bool is_full(const PartTree& tree, size_t n) { return n < tree.count || !tree.is_intermediate[n - tree.count]; }

std::set<Set> full_sets(const PartTree& tree) {
    std::set<Set> full;
    const std::vector<Set> sets = part_sets(tree);
    for (size_t n = 0; n < sets.size(); ++n)
        if (is_full(tree, n)) full.insert(sets[n]);
    return full;
}

void append(PartTree& tree, int32_t a, int32_t b, bool is_intermediate) {
    tree.children.push_back({a, b});
    tree.costs.push_back(0);
    tree.is_intermediate.push_back(is_intermediate);
}

// A tree of 2 half + 1 parts that is its own mirror image: part p < half has the image half + p, the last one its own.
PartTree symmetric_tree(size_t half, std::mt19937& random) {
    PartTree tree{{}, 2 * half + 1, {}, {}, {}, {}};
    const auto last = static_cast<int32_t>(2 * half);
    std::map<int32_t, int32_t> image = {{last, last}};
    std::vector<int32_t> tops;
    for (size_t p = 0; p < half; ++p) {
        tops.push_back(static_cast<int32_t>(p));
        image[tops.back()] = static_cast<int32_t>(half + p);
        image[static_cast<int32_t>(half + p)] = tops.back();
    }
    const auto node = [&] { return static_cast<int32_t>(tree.count + tree.children.size()) - 1; };
    int32_t middle = last;
    while (!tops.empty()) {
        std::ranges::shuffle(tops, random);
        const int32_t a = tops.back();
        tops.pop_back();
        if (tops.empty() || random() % 4 == 0) {  // joins the middle together with its image
            append(tree, middle, a, true);
            append(tree, node(), image[a], false);
            middle = node();
            image[middle] = middle;
            continue;
        }
        int32_t& b = tops.back();
        append(tree, a, b, false);
        const int32_t joined = node();
        append(tree, image[a], image[b], false);
        image[joined] = node();
        image[node()] = joined;
        b = joined;
    }
    tree.mirror.assign(1, std::vector<int32_t>(tree.count + tree.children.size(), -1));
    for (const auto& [n, m] : image) tree.mirror[0][idx(n)] = m;
    return tree;
}

// Of each part; patch p < 3 is the image of patch 3 + p, patches 6 and 7 are their own.
std::vector<int32_t> symmetric_patches(size_t half, std::mt19937& random) {
    std::vector<int32_t> patch_of(2 * half + 1, 7);
    for (size_t p = 0; p < half; ++p) {
        const auto patch = static_cast<int32_t>(random() % 8);
        patch_of[p] = patch;
        patch_of[half + p] = patch < 3 ? patch + 3 : patch < 6 ? patch - 3 : patch;
    }
    return patch_of;
}

struct Patch {
    Set parts, around;  // around: of the smallest full node
};

std::vector<Patch> chosen_patches(const std::set<Set>& nodes, const std::vector<int32_t>& patch_of, const std::vector<uint8_t>& is_chosen) {
    std::vector<Patch> patches(is_chosen.size());
    for (size_t p = 0; p < patch_of.size(); ++p)
        if (is_chosen[idx(patch_of[p])]) patches[idx(patch_of[p])].parts.insert(static_cast<int32_t>(p));
    std::erase_if(patches, [](const Patch& patch) { return patch.parts.empty(); });
    for (Patch& patch : patches)
        for (const Set& node : nodes)
            if (std::ranges::includes(node, patch.parts) && (patch.around.empty() || node.size() < patch.around.size()))
                patch.around = node;
    return patches;
}

// The definition: each node is divided by the patches that it crosses; the smallest one around a patch stays, and so do
// its pieces.
std::set<Set> expected_sets(const std::set<Set>& nodes, const std::vector<Patch>& patches) {
    std::set<Set> expected;
    for (const Set& node : nodes) {
        Set outside = node, rest = node;
        for (const auto& [parts, around] : patches) {
            Set inside;
            std::ranges::set_intersection(node, parts, std::inserter(inside, inside.end()));
            const bool is_crossed = !inside.empty() && inside != parts;
            if (!is_crossed && around != node) continue;
            for (const int32_t p : inside) {
                rest.erase(p);
                if (is_crossed) outside.erase(p);
            }
            expected.insert(inside);
        }
        expected.insert({outside, rest});
    }
    expected.erase(Set{});
    return expected;
}

// Calls visit(tree, patch_of, random) for random symmetric trees and patches.
template <class Visit>
void for_each_model(unsigned seed, const Visit& visit) {
    std::mt19937 random(seed);
    for (int i = 0; i < 200; ++i) {
        const size_t half = 3 + random() % 12;
        PartTree tree = symmetric_tree(half, random);
        visit(std::move(tree), symmetric_patches(half, random), random);
    }
}

TEST(InsertPatches, EachChosenPatchIsANodeAndOthersAreDividedByIt) {
    for_each_model(1, [&](const PartTree& tree, const std::vector<int32_t>& patch_of, std::mt19937& random) {
        std::vector<uint8_t> is_chosen(8);
        for (uint8_t& chosen : is_chosen) chosen = random() % 2;
        const PartTree result = insert_patches(tree, patch_of, is_chosen);
        ASSERT_EQ(result.children.size() + 1, tree.count);
        const std::vector<Set> sets = part_sets(result);
        ASSERT_EQ(sets.back().size(), tree.count);
        const std::vector<Patch> patches = chosen_patches(full_sets(tree), patch_of, is_chosen);
        const std::set<Set> nodes = full_sets(result);
        for (const Patch& patch : patches) EXPECT_TRUE(nodes.contains(patch.parts));
        EXPECT_EQ(nodes, expected_sets(full_sets(tree), patches));
    });
}

TEST(InsertPatches, SymmetricPatchesKeepTheTreeSymmetric) {
    for_each_model(2, [&](const PartTree& tree, const std::vector<int32_t>& patch_of, std::mt19937&) {
        std::vector<uint8_t> is_chosen = {1, 0, 0, 0, 1, 0, 1, 0};
        choose_images(tree, patch_of, is_chosen);
        const auto has_parts = [&](int32_t patch) { return std::ranges::find(patch_of, patch) != patch_of.end(); };
        EXPECT_TRUE(is_chosen[3] == has_parts(0) && is_chosen[1] == has_parts(4));
        const PartTree result = insert_patches(tree, patch_of, is_chosen);
        const std::vector<Set> sets = part_sets(result);
        for (size_t n = 0; n < sets.size(); ++n) {
            const int32_t image = result.mirror[0][n];
            if (!is_full(result, n)) {
                EXPECT_EQ(image, -1);
                continue;
            }
            ASSERT_GE(image, 0);
            Set mirrored;
            for (const int32_t p : sets[n]) mirrored.insert(tree.mirror[0][idx(p)]);
            EXPECT_EQ(sets[idx(image)], mirrored);
        }
    });
}

TEST(InsertPatches, NoPieceIsWithoutSurface) {
    for_each_model(4, [&](const PartTree& tree, std::vector<int32_t> patch_of, std::mt19937& random) {
        std::vector<uint8_t> has_surface(tree.count);
        for (uint8_t& has : has_surface) has = random() % 3 > 0;
        join_inner_parts(tree, has_surface, patch_of);
        const std::set<Set> before = full_sets(tree);
        for (const Set& node : full_sets(insert_patches(tree, patch_of, std::vector<uint8_t>(8, 1)))) {
            const bool has_any = std::ranges::any_of(node, [&](int32_t p) { return has_surface[idx(p)] != 0; });
            EXPECT_TRUE(has_any || before.contains(node));
        }
    });
}

TEST(InsertPatches, APatchIsChosenUnlessItDividesABetterNode) {
    std::uniform_real_distribution<double> unit(0, 1);
    for_each_model(3, [&](PartTree tree, const std::vector<int32_t>& patch_of, std::mt19937& random) {
        std::ranges::fill(tree.is_intermediate, 0);
        const std::vector<Set> sets = part_sets(tree);
        std::vector<double> area_of(tree.count), areas, scores, strengths(8);
        for (double& area : area_of) area = unit(random);
        const auto area = [&](const Set& parts) {
            double sum = 0;
            for (const int32_t p : parts) sum += area_of[idx(p)];
            return sum;
        };
        for (const Set& set : sets) {
            areas.push_back(area(set));
            scores.push_back(unit(random));
        }
        for (double& strength : strengths) strength = unit(random);
        const std::vector<uint8_t> is_chosen = choose_patches(tree, patch_of, areas, scores, strengths);
        for (size_t patch = 0; patch < 8; ++patch) {
            Set parts;
            for (size_t p = 0; p < tree.count; ++p)
                if (idx(patch_of[p]) == patch) parts.insert(static_cast<int32_t>(p));
            bool expected = true;
            for (size_t n = 0; n < sets.size(); ++n) {
                Set inside;
                std::ranges::set_intersection(sets[n], parts, std::inserter(inside, inside.end()));
                const double share = area(inside) / area(sets[n]);
                if (inside != parts && share > 1 - same_look && share < same_look) expected &= scores[n] < 0.55 * std::pow(strengths[patch], 4);
            }
            EXPECT_EQ(is_chosen[patch] != 0, expected);
        }
    });
}

}  // namespace
}  // namespace partwheel::test
