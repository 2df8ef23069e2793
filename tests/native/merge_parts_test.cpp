// merge_parts() on bars of square frusta, whose features are known by formula.
#include "cluster/cluster.h"
#include "parts/merge/merge_policy.h"
#include "parts/merge/network_weights.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>
#include <tuple>

namespace partwheel::test {
namespace {

// A bar along x in pieces of length 1, whose square cross-sections have these half widths, one more than pieces.
struct Bar {
    std::vector<double> half;

    size_t pieces() const { return half.size() - 1; }
    double unit() const { return std::max(static_cast<double>(pieces()), 2 * *std::ranges::max_element(half)); }
    double slope(size_t piece) const { return half[piece + 1] - half[piece]; }
    double volume(size_t piece) const {
        const double a = half[piece], b = half[piece + 1];
        return 4 * (a * a + a * b + b * b) / 3 / std::pow(unit(), 3);
    }
    double area(size_t piece) const {
        double sum = 4 * (half[piece] + half[piece + 1]) * std::hypot(1, slope(piece));
        if (piece == 0) sum += 4 * half.front() * half.front();
        if (piece + 1 == pieces()) sum += 4 * half.back() * half.back();
        return sum / unit() / unit();
    }
    double interface(size_t border) const { return 4 * half[border] * half[border] / unit() / unit(); }
    double length(size_t border) const { return 8 * half[border] / unit(); }
    // The sine of half the angle by which the sides bend there, below 0 where they are concave.
    double bend(size_t border) const {
        return std::sin((std::atan(slope(border - 1)) - std::atan(slope(border))) / 2);
    }
};

TetMesh mesh_of(const Bar& bar) {
    TetMesh mesh = tets_of(block({0, 0, 0}, {static_cast<int>(bar.pieces()), 1, 1}));
    for (Point& p : mesh.vertices)
        for (size_t k : {1, 2}) p[k] = (p[k] - 0.5) * 2 * bar.half[static_cast<size_t>(p[0])];
    return tet_mesh(mesh.vertices, mesh.tetrahedra);
}

// Each piece is one convex cluster, and those are joined in this order of the pieces by merges that are concave, so
// that the parts are the pieces.
BinaryTree tree_of(const TetMesh& mesh, const std::vector<size_t>& order) {
    BinaryTree tree;
    tree.components = 1;
    const auto leaves = static_cast<int32_t>(mesh.tetrahedra.size());
    const auto join = [&](int32_t a, int32_t b, double concavity) {
        tree.merges.push_back({a, b, concavity, 1});
        return leaves + static_cast<int32_t>(tree.merges.size()) - 1;
    };
    std::vector<int32_t> pieces;
    for (const size_t piece : order) {
        int32_t whole = -1;
        for (int32_t t = 0; t < leaves; ++t) {
            double x = 0;
            for (const int32_t v : mesh.tetrahedra[static_cast<size_t>(t)])
                x += mesh.vertices[static_cast<size_t>(v)][0] / 4;
            if (static_cast<size_t>(x) == piece) whole = whole < 0 ? t : join(whole, t, 0);
        }
        pieces.push_back(whole);
    }
    int32_t whole = pieces.front();
    for (size_t i = 1; i < pieces.size(); ++i) whole = join(whole, pieces[i], 1);
    return tree;
}

struct Result {
    ScoredTree tree;
    MergeTrace trace;
    std::vector<size_t> part_of_piece;

    PairFeatures pair(size_t piece, size_t next) const {
        for (const auto& pair : trace.pairs)
            if (std::minmax(pair.a, pair.b) == std::minmax(part(piece), part(next)))
                return std::bit_cast<PairFeatures>(pair.features);
        throw std::runtime_error("no such pair");
    }
    NodeFeatures node(size_t n) const { return std::bit_cast<NodeFeatures>(trace.nodes[n]); }
    NodeFeatures node_of_piece(size_t piece) const { return node(part_of_piece[piece]); }
    int32_t part(size_t piece) const { return static_cast<int32_t>(part_of_piece[piece]); }
};

Result merge_bar(const Bar& bar, const std::vector<size_t>& order) {
    const TetMesh mesh = mesh_of(bar);
    Progress progress;
    progress.begin();
    Result result;
    result.tree = merge_parts(mesh, tree_of(mesh, order), {}, progress, {}, &result.trace);
    for (size_t piece = 0; piece < bar.pieces(); ++piece) {
        const auto at_piece = [&](const Tetrahedron& t) {
            return std::ranges::all_of(t, [&](int32_t v) {
                const double x = mesh.vertices[static_cast<size_t>(v)][0];
                return x >= static_cast<double>(piece) && x <= static_cast<double>(piece + 1);
            });
        };
        const auto first = std::ranges::find_if(mesh.tetrahedra, at_piece) - mesh.tetrahedra.begin();
        result.part_of_piece.push_back(
            static_cast<size_t>(result.trace.first.label[static_cast<size_t>(first)]));
    }
    return result;
}

void expect_near(const auto& a, const auto& b) {
    const auto x = as_array(a), y = as_array(b);
    for (size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], y[i], 1e-9) << "feature " << i;
}

const Bar waist{{1, 0.5, 1}}, belly{{0.5, 1, 0.5}}, straight{{0.6, 0.6, 0.6}};
const Bar cone{{0.4, 0.6, 1.1}}, turned{{1.1, 0.6, 0.4}};

TEST(MergeParts, CreasesHaveTheSignAndSizeOfTheBend) {
    for (const Bar& bar : {waist, belly, straight, cone, turned}) {
        SCOPED_TRACE(testing::PrintToString(bar.half));
        const Result r = merge_bar(bar, {0, 1});
        ASSERT_EQ(r.trace.nodes.size(), 3U);
        const PairFeatures m = r.pair(0, 1);
        EXPECT_NEAR(m.crease, bar.bend(1), 1e-12);
        EXPECT_EQ(m.concave, bar.bend(1) < -0.02 ? 1 : 0);
        EXPECT_NEAR(m.sharpness, std::abs(bar.bend(1)), 1e-12);
        EXPECT_EQ(m.ridge, bar.bend(1) > 0.2 ? 1 : 0);
        EXPECT_EQ(m.valley, bar.bend(1) < -0.2 ? 1 : 0);
        for (const size_t piece : {0, 1}) {
            EXPECT_NEAR(r.node_of_piece(piece).own.crease, bar.bend(1), 1e-12);
            EXPECT_EQ(r.node_of_piece(piece).own.concave, m.concave);
            EXPECT_EQ(r.node_of_piece(piece).own.curvature, m.curvature);
        }
    }
    EXPECT_LT(waist.bend(1), -0.4);
    EXPECT_GT(belly.bend(1), 0.4);
}

TEST(MergeParts, AConcaveCreaseIsALikelierBorderThanAConvexOne) {
    // The output of the network, for the whole bar and with only the crease changed.
    const Mlp pair_cost(pair_network, pair_feature_count);
    const Result w = merge_bar(waist, {0, 1}), b = merge_bar(belly, {0, 1}), s = merge_bar(straight, {0, 1});
    EXPECT_GT(w.node(2).own.own_cost, s.node(2).own.own_cost + 1);
    EXPECT_GT(w.node(2).own.own_cost, b.node(2).own.own_cost + 1);
    for (const PairFeatures& m : {w.pair(0, 1), b.pair(0, 1), s.pair(0, 1)}) {
        PairFeatures concave = m, convex = m;
        concave.crease = -0.4;
        concave.concave = 1;
        concave.curvature = -0.3;
        convex.crease = 0.4;
        convex.concave = 0;
        convex.curvature = 0.3;
        EXPECT_GT(pair_cost(as_array(concave)), pair_cost(as_array(convex)) + 1);
    }
}

TEST(MergeParts, FeaturesFollowTheirFormulas) {
    for (const Bar& bar : {waist, cone, turned}) {
        SCOPED_TRACE(testing::PrintToString(bar.half));
        const PairFeatures m = merge_bar(bar, {0, 1}).pair(0, 1);
        // s is the piece with the smaller area, wherever it stands.
        const size_t s = bar.area(0) <= bar.area(1) ? 0 : 1, l = 1 - s;
        const double area = bar.area(0) + bar.area(1), volume = bar.volume(0) + bar.volume(1);
        const double section = std::log2(bar.interface(1)), length = std::log2(bar.length(1));
        const auto thickness = [&](size_t piece) { return std::log2(bar.volume(piece) / bar.area(piece)); };
        EXPECT_NEAR(m.area_s, std::log2(bar.area(s) / area), 1e-9);
        EXPECT_NEAR(m.volume_s, std::log2(bar.volume(s) / volume), 1e-9);
        EXPECT_NEAR(m.area_both, 0, 1e-9);
        EXPECT_NEAR(m.volume_both, 0, 1e-9);
        EXPECT_NEAR(m.area_step, std::log2(bar.area(l) / bar.area(s)), 1e-9);
        EXPECT_NEAR(m.thickness_step, thickness(s) - thickness(l), 1e-9);
        EXPECT_NEAR(m.thickness_s, thickness(s) - std::log2(volume) / 3, 1e-9);
        EXPECT_NEAR(m.thickness_l, thickness(l) - std::log2(volume) / 3, 1e-9);
        EXPECT_NEAR(m.interface_to_volume_s, section - 2 * std::log2(bar.volume(s)) / 3, 1e-9);
        EXPECT_NEAR(m.interface_to_volume_l, section - 2 * std::log2(bar.volume(l)) / 3, 1e-9);
        EXPECT_NEAR(m.interface_to_area_s, section - std::log2(bar.area(s)), 1e-9);
        EXPECT_NEAR(m.length_to_area_s, length - std::log2(bar.area(s)) / 2, 1e-9);
        EXPECT_NEAR(m.section_to_thickness_s, section - length - thickness(s), 1e-9);
        EXPECT_NEAR(m.section_to_thickness_l, section - length - thickness(l), 1e-9);
        EXPECT_NEAR(m.isoperimetric_ratio, 2 * length - section, 1e-9);
        EXPECT_NEAR(m.defect_s, 0, 1e-12);
        EXPECT_NEAR(m.defect_l, 0, 1e-12);
        for (const double whole : {m.length_share_s, m.length_share_l, m.interface_share_s, m.interface_share_l})
            EXPECT_EQ(whole, 1);
    }
    // The hull of the bar with a waist is the box around it.
    const double volume = waist.volume(0) + waist.volume(1), hull = 1;  // 2 x 2 x 2, of which the side is the unit
    const PairFeatures m = merge_bar(waist, {0, 1}).pair(0, 1);
    EXPECT_NEAR(m.defect_both, 1 - volume / hull, 1e-9);
    EXPECT_NEAR(m.defect_added, m.defect_both, 1e-9);
    EXPECT_NEAR(m.excess_to_s, std::log2(1e-4 + (hull - volume) / waist.volume(0)), 1e-9);
}

TEST(MergeParts, FeaturesAreSymmetricInTheTwoParts) {
    for (const auto& [bar, mirrored] : {std::pair(cone, turned), std::pair(waist, waist)}) {
        const Result there = merge_bar(bar, {0, 1}), back = merge_bar(bar, {1, 0}), image = merge_bar(mirrored, {0, 1});
        expect_near(there.pair(0, 1), back.pair(0, 1));
        expect_near(there.pair(0, 1), image.pair(0, 1));
        for (const size_t piece : {0, 1}) {
            expect_near(there.node_of_piece(piece), back.node_of_piece(piece));
            expect_near(there.node_of_piece(piece), image.node_of_piece(1 - piece));
        }
        expect_near(there.node(2), image.node(2));
        EXPECT_NEAR(there.tree.scores[2], image.tree.scores[2], 1e-9);
    }
}

TEST(MergeParts, NodeFeaturesIncludeParentAndSibling) {
    const Result r = merge_bar(cone, {0, 1});
    const NodeFeatures small = r.node_of_piece(0), large = r.node_of_piece(1), whole = r.node(2);
    const double area = cone.area(0) + cone.area(1), volume = cone.volume(0) + cone.volume(1);
    EXPECT_NEAR(small.own.area, std::log2(cone.area(0) / area), 1e-9);
    EXPECT_NEAR(large.own.volume, std::log2(cone.volume(1) / volume), 1e-9);
    EXPECT_NEAR(small.sibling_area, std::log2(cone.area(1) / cone.area(0)), 1e-9);
    EXPECT_NEAR(large.sibling_area, -small.sibling_area, 1e-9);
    EXPECT_NEAR(small.sibling_volume, std::log2(cone.volume(1) / cone.volume(0)), 1e-9);
    EXPECT_NEAR(large.sibling_volume, small.sibling_volume, 1e-9);
    EXPECT_NEAR(small.parent_area, std::log2(area / cone.area(0)), 1e-9);
    EXPECT_EQ(small.sibling_thickness, large.own.thickness);
    EXPECT_EQ(small.parent_defect, whole.own.defect);
    EXPECT_EQ(small.own.own_cost, -8);
    EXPECT_EQ(whole.own.own_cost, whole.own.max_cost);
    EXPECT_EQ(small.parent_cost, whole.own.own_cost);
    EXPECT_EQ(small.cost_step, whole.own.own_cost + 8);
    EXPECT_EQ(small.min_ancestor_cost, whole.own.own_cost);
    EXPECT_EQ(small.max_ancestor_cost, whole.own.own_cost);
    EXPECT_EQ(whole.max_ancestor_cost, 8);
    EXPECT_EQ(whole.parent_cost, 8);
    EXPECT_EQ(std::pair(small.is_root, whole.is_root), std::pair(0.0, 1.0));
    EXPECT_NEAR(small.parts_after_merge, 1, 1e-9);
    EXPECT_NEAR(whole.parts_after_merge, 0, 1e-9);
    EXPECT_NEAR(small.parts_before_parent, 1, 1e-9);
    EXPECT_NEAR(whole.parts_before_parent, 0, 1e-9);
}

TEST(MergeParts, TheWeakestBorderMergesFirst) {
    // A waist at one border, next to nothing at the other; then the whole thing turned round.
    const Bar bar{{1, 0.5, 1, 0.95}}, back{{0.95, 1, 0.5, 1}};
    for (const std::vector<size_t>& order : {std::vector<size_t>{0, 1, 2}, {2, 1, 0}, {1, 0, 2}}) {
        for (const auto& [b, near, middle, far, waist_at, seam_at] :
             {std::tuple(bar, 2, 1, 0, 1, 2), std::tuple(back, 0, 1, 2, 2, 1)}) {
            const Result r = merge_bar(b, order);
            ASSERT_EQ(r.trace.last.children.size(), 2U);
            using Parts = std::set<int32_t>;
            const auto merge_of = [&](size_t j) { return Parts(r.trace.last.children[j].begin(), r.trace.last.children[j].end()); };
            const auto part = [&](int piece) { return r.part(static_cast<size_t>(piece)); };
            EXPECT_EQ(merge_of(0), (Parts{part(near), part(middle)}));
            EXPECT_EQ(merge_of(1), (Parts{part(far), 3}));
            // What is left of the rim is the waist; the middle has both.
            const auto w = static_cast<size_t>(waist_at), s = static_cast<size_t>(seam_at);
            EXPECT_NEAR(r.node(3).own.crease, b.bend(w), 1e-9);
            EXPECT_NEAR(r.node_of_piece(static_cast<size_t>(middle)).own.crease,
                        (b.bend(w) * b.length(w) + b.bend(s) * b.length(s)) / (b.length(w) + b.length(s)), 1e-9);
            // The middle's area is the least, as it has no end.
            const PairFeatures m = r.pair(static_cast<size_t>(far), static_cast<size_t>(middle));
            EXPECT_NEAR(m.length_share_s, b.length(w) / (b.length(w) + b.length(s)), 1e-9);
            EXPECT_NEAR(m.interface_share_s, b.interface(w) / (b.interface(w) + b.interface(s)), 1e-9);
            EXPECT_EQ(std::pair(m.length_share_l, m.interface_share_l), std::pair(1.0, 1.0));
            EXPECT_EQ(r.node(4).own.max_cost, r.node(4).own.own_cost);
        }
    }
}

TEST(MergeParts, TheTreeEndsWithTheMergesOfParts) {
    const Bar bar{{1, 0.5, 1, 0.95}};
    for (const std::vector<size_t>& order : {std::vector<size_t>{0, 1, 2}, {2, 1, 0}, {1, 0, 2}}) {
        const TetMesh mesh = mesh_of(bar);
        const Result r = merge_bar(bar, order);
        const std::vector<Merge>& merges = r.tree.tree.merges;
        const size_t leaves = mesh.tetrahedra.size();
        ASSERT_EQ(merges.size(), leaves - 1);
        std::vector<int32_t> lowest(leaves), size(leaves, 1);
        std::iota(lowest.begin(), lowest.end(), 0);
        for (const Merge& m : merges) {
            const auto left = static_cast<size_t>(m.left), right = static_cast<size_t>(m.right);
            lowest.push_back(std::min(lowest[left], lowest[right]));
            size.push_back(size[left] + size[right]);
            if (size.back() > 6) {
                EXPECT_LT(lowest[left], lowest[right]);
            }
        }
        EXPECT_EQ(size.back(), static_cast<int32_t>(leaves));
        // Its hull is the box of 2 x 2 x 2 about the waist and the frustum after it.
        const double volume = (bar.volume(0) + bar.volume(1) + bar.volume(2)) * std::pow(bar.unit(), 3);
        EXPECT_NEAR(merges.back().hull_volume, 8 + bar.volume(2) * std::pow(bar.unit(), 3), 1e-12);
        EXPECT_NEAR(merges.back().concavity, merges.back().hull_volume - volume, 1e-7);
        ASSERT_EQ(r.tree.scores.size(), 5U);
        for (size_t j : {3, 4}) {  // those of the joined come last, and are what the network says
            const double z = Mlp(node_network, node_feature_count)(as_array(r.node(j)));
            EXPECT_NEAR(r.tree.scores[j], (1 + z / (1 + std::abs(z))) / 2, 1e-12);
        }
    }
}

TEST(MergeParts, JoinsOfComponentsAreNoRejectedMerges) {
    const TetMesh mesh = tets_of(block({0, 0, 0}, {2, 1, 1}) + block({5, 0, 0}, {6, 1, 1}));
    Progress progress;
    progress.begin();
    MergeTrace trace;
    const ScoredTree result = merge_parts(mesh, cluster(mesh, progress), {}, progress, {}, &trace);
    ASSERT_EQ(result.tree.components, 2U);
    const auto node = [&](size_t n) { return std::bit_cast<NodeFeatures>(trace.nodes[n]); };
    double rejected = 0;
    for (size_t n = 0; n < trace.nodes.size(); ++n) rejected += node(n).own.own_cost > 0 && node(n).own.own_cost < 8;
    EXPECT_EQ(node(trace.nodes.size() - 1).own.own_cost, 8);
    EXPECT_NEAR(node(trace.nodes.size() - 1).rejected_merges, std::log2(1 + rejected), 1e-12);
}

TEST(MergeParts, HiddenUnitsAreSoftsigns) {
    const std::vector<double> numbers{0.5, 2, -1, 3, 0.25, 1, 1, -2, 0.125};  // two hidden units of two inputs
    const Mlp mlp(numbers, 2);
    const double z = 0.5 + 2 * 0.3 - 0.7, y = 0.25 + 0.3 + 0.7;
    EXPECT_NEAR(mlp(std::vector<double>{0.3, 0.7}), 3 * z / (1 + z) - 2 * y / (1 + y) + 0.125, 1e-15);
    EXPECT_NEAR(mlp(std::vector<double>{-3, 0}), 3 * -5.5 / 6.5 - 2 * -2.75 / 3.75 + 0.125, 1e-15);
}

}  // namespace
}  // namespace partwheel::test
