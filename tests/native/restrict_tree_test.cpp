// restrict_tree_to_labels() after labels have changed, against brute force.
#include "cluster/within.h"

#include "support/reference_hull.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <tuple>

namespace partwheel::test {
namespace {

using Set = std::set<int32_t>;  // of tetrahedra

size_t idx(int32_t i) { return static_cast<size_t>(i); }

double reference_volume(const TetMesh& mesh, const Set& tetrahedra) {
    std::set<int32_t> corners;
    for (const int32_t t : tetrahedra) corners.insert(mesh.tetrahedra[idx(t)].begin(), mesh.tetrahedra[idx(t)].end());
    std::vector<Point> points;
    for (const int32_t v : corners) points.push_back(mesh.vertices[idx(v)]);
    return static_cast<double>(reference_hull_volume(points));
}

double volume(const TetMesh& mesh, const Set& tetrahedra) {
    double sum = 0;
    for (const int32_t t : tetrahedra) {
        const auto corner = [&](size_t k) { return mesh.vertices[idx(mesh.tetrahedra[idx(t)][k])]; };
        sum += partwheel::signed_volume6(corner(0), corner(1), corner(2), corner(3)) / 6;
    }
    return sum;
}

std::vector<Set> sets_of(size_t leaves, std::span<const Merge> merges) {
    std::vector<Set> sets;
    for (size_t t = 0; t < leaves; ++t) sets.push_back({static_cast<int32_t>(t)});
    for (const Merge& merge : merges) {
        sets.push_back(sets[idx(merge.left)]);
        sets.back().insert(sets[idx(merge.right)].begin(), sets[idx(merge.right)].end());
    }
    return sets;
}

// A tree and a labeling.
struct Parts {
    TetMesh mesh;
    std::vector<Merge> merges;  // within the parts
    std::vector<int32_t> of;
    size_t count;
};

Parts parts_of(TetMesh mesh, size_t count) {
    Progress progress;
    progress.begin();
    const BinaryTree tree = cluster(mesh, progress);
    const size_t leaves = mesh.tetrahedra.size();
    std::vector<int32_t> noted(leaves + tree.merges.size(), -1);
    int32_t part = 0;
    for (const int32_t c : cut_undoing_last(tree.merges, count)) noted[idx(c)] = part++;
    propagate_to_leaves(tree.merges, leaves, noted);
    noted.resize(leaves);
    return {std::move(mesh), {tree.merges.begin(), tree.merges.end() - static_cast<std::ptrdiff_t>(count - 1)}, noted,
            count};
}

// Checks the merges.
std::vector<Merge> kept(const Parts& before, const std::vector<int32_t>& part) {
    HullKernel kernel(before.mesh.vertices);
    RestrictedTree within = restrict_tree_to_labels(before.mesh, before.merges, part, before.count, kernel);
    const size_t leaves = before.mesh.tetrahedra.size();
    std::vector<Set> wanted(before.count);
    for (size_t t = 0; t < leaves; ++t) wanted[idx(part[t])].insert(static_cast<int32_t>(t));

    const std::vector<Set> sets = sets_of(leaves, within.merges);
    std::vector<bool> merged(sets.size(), false);
    for (size_t m = 0; m < within.merges.size(); ++m) {
        const auto& [left, right, concavity, hull_volume] = within.merges[m];
        const Set& both = sets[leaves + m];
        for (const int32_t half : {left, right}) {
            EXPECT_TRUE(idx(half) < leaves + m && !merged[idx(half)]);
            merged[idx(half)] = true;
        }
        EXPECT_LT(*sets[idx(left)].begin(), *sets[idx(right)].begin());
        for (const int32_t t : both) EXPECT_EQ(part[idx(t)], part[idx(*both.begin())]);
        const double hull = reference_volume(before.mesh, both);
        EXPECT_NEAR(hull_volume / hull, 1, 1e-9);
        EXPECT_NEAR(concavity, ranked_concavity(hull, volume(before.mesh, both)), 1e-8 * hull);
    }
    EXPECT_EQ(within.parts.size(), before.count);
    for (size_t p = 0; p < before.count; ++p) {
        Subtree& whole = within.parts[p];
        if (wanted[p].empty()) {
            EXPECT_EQ(whole.cluster, -1);
            continue;
        }
        EXPECT_EQ(sets[idx(whole.cluster)], wanted[p]);
        EXPECT_FALSE(merged[idx(whole.cluster)]);
        EXPECT_EQ(whole.low, *wanted[p].begin());
        EXPECT_NEAR(whole.volume / volume(before.mesh, wanted[p]), 1, 1e-9);
        EXPECT_NEAR(whole.hull.volume() / reference_volume(before.mesh, wanted[p]), 1, 1e-9);
    }
    return within.merges;
}

// The clusters of more than one tetrahedron within one part.
std::set<Set> clusters_in(const Parts& parts, std::span<const Merge> merges, std::span<const int32_t> part,
                          const std::set<int32_t>& some) {
    std::set<Set> result;
    const size_t leaves = parts.mesh.tetrahedra.size();
    const std::vector<Set> sets = sets_of(leaves, merges);
    for (size_t m = 0; m < merges.size(); ++m)
        if (some.contains(part[idx(*sets[leaves + m].begin())])) result.insert(sets[leaves + m]);
    return result;
}

std::vector<Parts> models() {
    const Cells u = block({0, 0, 0}, {5, 2, 2}) + block({0, 2, 0}, {1, 5, 2}) + block({4, 2, 0}, {5, 5, 2});
    return {parts_of(perturbed(tets_of(u), 0.1, 1), 7), parts_of(tets_of(block({0, 0, 0}, {4, 3, 2})), 5),
            parts_of(perturbed(tets_of(block({0, 0, 0}, {2, 2, 2}) + block({4, 0, 0}, {6, 2, 2})), 0.1, 2), 4)};
}

TEST(RestrictTree, UnchangedLabelsKeepTheTree) {
    for (const Parts& before : models()) {
        const std::vector<Merge> merges = kept(before, before.of);
        ASSERT_EQ(merges.size(), before.merges.size());
        for (size_t m = 0; m < before.merges.size(); ++m) {
            const Merge &a = merges[m], &b = before.merges[m];
            EXPECT_EQ(std::tuple(a.left, a.right, a.concavity, a.hull_volume),
                      std::tuple(b.left, b.right, b.concavity, b.hull_volume));
        }
    }
}

TEST(RestrictTree, PartsExchangeTetrahedra) {
    std::mt19937 random(3);
    for (const Parts& before : models()) {
        const size_t leaves = before.mesh.tetrahedra.size();
        for (int round = 0; round < 10; ++round) {
            std::vector<int32_t> part = before.of;
            std::set<int32_t> same, changed;
            for (size_t p = 0; p < before.count; ++p) same.insert(static_cast<int32_t>(p));
            for (int i = 0; i < 1 + 3 * round; ++i) {
                const size_t t = random() % leaves;
                const auto to = static_cast<int32_t>(random() % (before.count - 1));
                for (const int32_t p : {part[t], to}) same.erase(p), changed.insert(p);
                part[t] = to;
            }
            const std::vector<Merge> merges = kept(before, part);
            // Unchanged parts keep their clusters.
            EXPECT_EQ(clusters_in(before, merges, part, same),
                      clusters_in(before, before.merges, before.of, same));
            // So do clusters within one part; a cluster across several leaves its share in each.
            const std::set<Set> now = clusters_in(before, merges, part, changed);
            for (const Set& old : clusters_in(before, before.merges, before.of, changed)) {
                std::map<int32_t, Set> shares;
                for (const int32_t t : old) shares[part[idx(t)]].insert(t);
                for (const auto& [p, share] : shares) EXPECT_TRUE(share.size() == 1 || now.contains(share));
            }
            // Shares of different parts merge last, lowest first.
            for (const int32_t p : changed) {
                std::map<int32_t, Set> from;
                for (size_t t = 0; t < leaves; ++t)
                    if (part[t] == p) from[before.of[t]].insert(static_cast<int32_t>(t));
                std::map<int32_t, Set> by_lowest;
                for (const auto& [old, share] : from) by_lowest[*share.begin()] = share;
                Set whole;
                for (const auto& [low, share] : by_lowest) {
                    whole.insert(share.begin(), share.end());
                    EXPECT_TRUE(whole.size() == 1 || now.contains(whole));
                }
            }
        }
    }
}

TEST(RestrictTree, PartsMayBecomeEmpty) {
    for (const Parts& before : models()) {
        std::vector<int32_t> part = before.of;
        for (int32_t& p : part) p = std::max(p, 1);
        kept(before, part);
        kept(before, std::vector<int32_t>(part.size(), 2));
    }
}

}  // namespace
}  // namespace partwheel::test
