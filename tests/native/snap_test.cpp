// snap_borders(): borders move into grooves, small splits stay, connected sets stay connected.
#include "parts/snap/snap.h"

#include "parts/boundary.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <set>
#include <tuple>

namespace partwheel::test {
namespace {

using Labels = std::vector<int32_t>;  // the part of each tetrahedron

size_t idx(int32_t i) { return static_cast<size_t>(i); }

Point middle(const TetMesh& mesh, size_t t) {
    Point sum{};
    for (const int32_t v : mesh.tetrahedra[t])
        for (size_t k = 0; k < 3; ++k) sum[k] += mesh.vertices[idx(v)][k] / 4;
    return sum;
}

Labels where(const TetMesh& mesh, const std::function<int(const Point&)>& part) {
    Labels label;
    for (size_t t = 0; t < mesh.tetrahedra.size(); ++t) label.push_back(part(middle(mesh, t)));
    return label;
}

// A bar along x: cross-sections there, squares of these half widths, one piece of n x n cells from each to the next.
struct Section {
    double x, half;
};
TetMesh bar(const std::vector<Section>& sections, int n = 2) {
    TetMesh mesh = tets_of(block({0, 0, 0}, {static_cast<int>(sections.size()) - 1, n, n}));
    for (Point& p : mesh.vertices) {
        const Section& section = sections[static_cast<size_t>(p[0])];
        p = {section.x, (2 * p[1] / n - 1) * section.half, (2 * p[2] / n - 1) * section.half};
    }
    return tet_mesh(mesh.vertices, mesh.tetrahedra);
}

// Of this many pieces of length 1, with a groove.
TetMesh grooved_bar(int pieces, int groove) {
    std::vector<Section> sections;
    for (int x = 0; x <= pieces; ++x) sections.push_back({1.0 * x, x == groove ? 0.7 : 1.0});
    return bar(sections);
}

PartTree tree_of(Labels label, std::vector<std::array<int32_t, 2>> children) {
    PartTree tree{std::move(label), children.size() + 1, children, {}, std::vector<uint8_t>(children.size(), 0), {}};
    for (size_t j = 0; j < children.size(); ++j) tree.costs.push_back(static_cast<double>(j));
    return tree;
}

PartTree snap(const TetMesh& mesh, const PartTree& tree, const Labels& limb_of = {}) {
    Progress progress;
    progress.begin();
    return partwheel::snap_borders(mesh, tree, limb_of, progress);
}
Labels snap_two(const TetMesh& mesh, const Labels& label) { return snap(mesh, tree_of(label, {{0, 1}})).label; }

std::vector<std::set<int32_t>> parts_below(const PartTree& tree) {  // of each node
    std::vector<std::set<int32_t>> below;
    for (size_t p = 0; p < tree.count; ++p) below.push_back({static_cast<int32_t>(p)});
    for (const auto& [a, b] : tree.children) {
        below.push_back(below[idx(a)]);
        below.back().insert(below[idx(b)].begin(), below[idx(b)].end());
    }
    return below;
}

size_t pieces(const TetMesh& mesh, const std::vector<bool>& of) {
    std::vector<bool> seen(of.size(), false);
    size_t count = 0;
    for (size_t start = 0; start < of.size(); ++start) {
        if (!of[start] || seen[start]) continue;
        ++count;
        std::vector<size_t> todo = {start};
        seen[start] = true;
        while (!todo.empty()) {
            const size_t t = todo.back();
            todo.pop_back();
            for (const int32_t n : mesh.neighbors[t])
                if (n >= 0 && of[idx(n)] && !seen[idx(n)]) {
                    seen[idx(n)] = true;
                    todo.push_back(idx(n));
                }
        }
    }
    return count;
}

// Parts around random tetrahedra, merged in random order; nodes need not be connected.
PartTree random_tree(const TetMesh& mesh, size_t count, std::mt19937& random) {
    std::vector<Point> seeds;
    for (size_t p = 0; p < count; ++p) seeds.push_back(middle(mesh, random() % mesh.tetrahedra.size()));
    Labels label = where(mesh, [&](const Point& p) {
        const auto distance = [&](const Point& seed) {
            return std::hypot(seed[0] - p[0], seed[1] - p[1], seed[2] - p[2]);
        };
        return static_cast<int>(std::ranges::min_element(seeds, {}, distance) - seeds.begin());
    });
    std::vector<int32_t> roots(count);
    std::iota(roots.begin(), roots.end(), 0);
    std::vector<std::array<int32_t, 2>> children;
    while (roots.size() > 1) {
        for (size_t i = roots.size() - 1; i > 0; --i) std::swap(roots[i], roots[random() % (i + 1)]);
        children.push_back({roots[roots.size() - 2], roots.back()});
        roots.pop_back();
        roots.back() = static_cast<int32_t>(count + children.size() - 1);
    }
    return relabel(tree_of(label, children), label);
}

std::vector<TetMesh> random_meshes() {
    const Cells u = block({0, 0, 0}, {9, 3, 3}) + block({0, 3, 0}, {3, 9, 3}) + block({6, 3, 0}, {9, 9, 3});
    return {perturbed(tets_of(u), 0.1, 1), perturbed(grooved_bar(16, 8), 0.05, 2),
            perturbed(tets_of(block({0, 0, 0}, {6, 6, 6}) - block({2, 2, 0}, {4, 4, 6})), 0.1, 3)};
}

TEST(SnapBorders, BordersMoveIntoTheGroove) {
    const TetMesh mesh = grooved_bar(16, 8);
    const Labels expected = where(mesh, [](const Point& p) { return p[0] > 8; });
    for (const double x : {6.0, 7.0, 8.0, 9.0, 10.0}) {
        EXPECT_EQ(snap_two(mesh, where(mesh, [&](const Point& p) { return p[0] > x; })), expected) << x;
        const auto beyond_wave = [&](const Point& p) { return p[0] > x + 0.8 * std::sin(7 * p[1] + 5 * p[2]); };
        EXPECT_EQ(snap_two(mesh, where(mesh, beyond_wave)), expected) << x;
        const auto the_other_way = [&](const Point& p) { return p[0] < x; };
        EXPECT_EQ(snap_two(mesh, where(mesh, the_other_way)), where(mesh, [](const Point& p) { return p[0] < 8; }));
    }
    // Beyond the band nothing draws it: an end of 1 has an area of 12, and so a reach of 2.1.
    const Labels far = where(mesh, [](const Point& p) { return p[0] > 1; });
    EXPECT_EQ(snap_two(mesh, far), far);
    // Of two grooves it takes the nearer one.
    std::vector<Section> sections;
    for (int x = 0; x <= 16; ++x) sections.push_back({1.0 * x, x == 6 || x == 11 ? 0.7 : 1.0});
    const TetMesh two = bar(sections);
    for (const double x : {7.0, 8.0})
        EXPECT_EQ(snap_two(two, where(two, [&](const Point& p) { return p[0] > x; })),
                  where(two, [](const Point& p) { return p[0] > 6; }));
    for (const double x : {9.0, 10.0})
        EXPECT_EQ(snap_two(two, where(two, [&](const Point& p) { return p[0] > x; })),
                  where(two, [](const Point& p) { return p[0] > 11; }));
}

// A rail on posts on a floor. Without limbs, posts dissolve: the cut below them is cheaper.
TEST(SnapBorders, LimbsDontDissolve) {
    Cells cells = block({0, 0, 0}, {14, 2, 4}) + block({0, 0, 7}, {14, 2, 9});
    for (const int x : {0, 4, 8, 12}) cells = cells + block({x, 0, 4}, {x + 2, 2, 7});
    TetMesh mesh = tets_of(cells);
    for (Point& p : mesh.vertices)
        if (p[2] == 4 && std::fmod(p[0], 4) == 0) p[0] += 0.5;  // the posts are narrower there
    mesh = tet_mesh(mesh.vertices, mesh.tetrahedra);
    // The floor, four posts, the rail.
    const Labels label = where(mesh, [](const Point& p) { return p[2] < 4 ? 0 : p[2] > 7 ? 5 : 1 + static_cast<int>(p[0] / 4); });
    const PartTree tree = tree_of(label, {{0, 1}, {6, 2}, {7, 3}, {8, 4}, {9, 5}});
    EXPECT_LT(snap(mesh, tree).count, 6);
    EXPECT_EQ(snap(mesh, tree, {0, 1, 2, 3, 4, 5}).count, 6);
}

TEST(SnapBorders, SmallSplitsStay) {
    // A body, and a thin end of length 1 with a groove at 0.8: of the shorter body it is more than 0.01 of the area.
    for (const double body : {4.0, 16.0}) {
        std::vector<Section> sections;
        for (int x = 0; x <= 16; ++x) sections.push_back({body * x / 16, 1});
        for (int i = 0; i <= 10; ++i) sections.push_back({body + 0.1 + 0.1 * i, i == 8 ? 0.07 : 0.1});
        const TetMesh mesh = bar(sections);
        const auto split = [&](double x) {
            return where(mesh, [&](const Point& p) { return p[0] < body + 0.1 ? 0 : p[0] < body + 0.1 + x ? 1 : 2; });
        };
        const PartTree result = snap(mesh, tree_of(split(0.7), {{1, 2}, {0, 3}}));
        EXPECT_EQ(result.label, split(body < 10 ? 0.8 : 0.7)) << body;
    }
}

TEST(SnapBorders, ConnectedNodesStayConnected) {
    std::mt19937 random(1);
    size_t moved = 0, torn = 0;
    for (const TetMesh& mesh : random_meshes())
        for (int round = 0; round < 20; ++round) {
            const PartTree tree = random_tree(mesh, 2 + random() % 20, random), result = snap(mesh, tree);
            moved += result.label != tree.label;
            ASSERT_EQ(result.label.size(), mesh.tetrahedra.size());
            ASSERT_EQ(std::set<int32_t>(result.label.begin(), result.label.end()).size(), result.count);
            ASSERT_EQ(result.children.size(), result.count - 1);
            const auto pieces_of = [&](const PartTree& part_tree, const std::set<int32_t>& parts) {
                std::vector<bool> in;
                for (const int32_t p : part_tree.label) in.push_back(parts.contains(p));
                return pieces(mesh, in);
            };
            for (const std::set<int32_t>& parts : parts_below(tree)) torn += pieces_of(tree, parts) > 1;
            for (const std::set<int32_t>& parts : parts_below(result)) ASSERT_EQ(pieces_of(result, parts), 1);
        }
    EXPECT_GE(moved, 50);
    EXPECT_GE(torn, 50);
}

// A bar of three patches. A node consists of both ends, and a part of one whole end and most of the other.
TEST(SnapBorders, ComponentsMoveBelowASplitAlongMarks) {
    TetMesh mesh = grooved_bar(12, 5);
    const BoundaryFacets facets(mesh);
    mesh.tet_of_triangle = facets.tetrahedra;
    Surface surface;
    surface.vertices = mesh.vertices;
    surface.triangles = facets.triangles;
    const Labels patch_of_tet = where(mesh, [](const Point& p) { return static_cast<int>(p[0] / 4); });
    std::vector<int32_t> patch_of_triangle;
    for (const int32_t t : facets.tetrahedra) patch_of_triangle.push_back(patch_of_tet[idx(t)]);
    Patches patches;
    patches.group = {0, 0, 0};
    patches.has_hints = {true, true, true};
    patches.borders = {{0, 1, 8, 0.9F}, {1, 2, 8, 0.9F}};
    Progress progress;
    progress.begin();
    const Regions regions(mesh, surface, patches, patch_of_triangle, progress);

    const Labels label = where(mesh, [](const Point& p) { return p[0] < 1 ? 0 : p[0] < 4 || p[0] > 8 ? 1 : 2; });
    const PartTree result = snap_borders(mesh, tree_of(label, {{0, 1}, {3, 2}}), {}, progress, &regions);
    EXPECT_EQ(result.label, where(mesh, [](const Point& p) { return p[0] < 4 ? 0 : p[0] > 8 ? 1 : 2; }));
}

TEST(SnapBorders, SmallComponentsMoveAndLargeOnesStay) {
    const TetMesh mesh = grooved_bar(12, 5);
    const auto cleaned = [&](const Labels& label) {
        Progress progress;
        progress.begin();
        return reassign_small_components(mesh, tree_of(label, {{0, 1}}), progress).label;
    };
    // Beside the groove; a piece of the first that is as long as four is beyond.
    const Labels meant = where(mesh, [](const Point& p) { return p[0] < 4 || p[0] > 8 ? 0 : 1; });
    EXPECT_EQ(cleaned(meant), meant);
    Labels flecked = meant;
    for (const double x : {1.5, 6.5})
        for (size_t t = 0; t < flecked.size(); ++t)
            if (const Point p = middle(mesh, t); std::abs(p[0] - x) < 0.5 && p[1] > 0 && p[2] > 0) flecked[t] = 1 - flecked[t];
    EXPECT_NE(flecked, meant);
    EXPECT_EQ(cleaned(flecked), meant);
}

}  // namespace
}  // namespace partwheel::test
