// Mirror planes: of shapes whose planes are known, wherever they stand and however they are turned; and parts that are
// copied across them.
#include "support/shapes.h"
#include "mesh/symmetry.h"
#include "parts/boundary.h"
#include "parts/mirror/mirror_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace partwheel::test {
namespace {

using partwheel::operator*;
using partwheel::operator-;

std::vector<Plane> planes_of(const TriMesh& mesh) {
    Progress progress;
    progress.begin();
    return mirror_planes(mesh.vertices, mesh.triangles, progress);
}

TriMesh sheared(TriMesh mesh) {
    for (Point& p : mesh.vertices) p = {p[0] + 0.4 * p[1] + 0.3 * p[2], p[1] + 0.35 * p[2], p[2]};
    return mesh;
}

// Squares of half a unit: a corner's tetrahedra are small beside the whole.
TriMesh l_shape() {
    return surface_of("L", block({0, 0, 0}, {12, 4, 2}) + block({0, 4, 0}, {4, 7, 2}), {0.5, 0.5, 0.5});
}

TEST(Symmetry, PlanesAreFoundInAnyPosition) {
    const TriMesh box = surface_of("box", block({0, 0, 0}, {8, 5, 3}));
    const Point middle = {4, 2.5, 1.5};
    for (const double angle : {0.0, 0.3, 1.1}) {
        const TriMesh turned = rotated(box, angle, {1, 2, 3});
        const TriMesh axes = rotated({"axes", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, middle}, {}, {}, 0}, angle, {1, 2, 3});
        const std::vector<Plane> planes = planes_of(moved(turned, {5, -3, 2}));
        ASSERT_EQ(planes.size(), 3U) << angle;
        std::array<int, 3> met{};
        for (const Plane& plane : planes) {
            EXPECT_NEAR(length(plane.normal), 1, 1e-12);
            EXPECT_NEAR(plane.height(partwheel::operator+(axes.vertices[3], Point{5, -3, 2})), 0, 0.02);
            for (size_t k = 0; k < 3; ++k) met[k] += std::fabs(dot(plane.normal, axes.vertices[k])) > 0.999;
        }
        EXPECT_EQ(met, (std::array<int, 3>{1, 1, 1}));
    }
}

TEST(Symmetry, ShapesWithFewerPlanesHaveThose) {
    const std::vector<Plane> of_l = planes_of(l_shape());
    ASSERT_EQ(of_l.size(), 1U);  // halfway up
    EXPECT_NEAR(std::fabs(of_l[0].normal[2]), 1, 1e-3);
    EXPECT_NEAR(std::fabs(of_l[0].offset), 0.5, 0.02);
    EXPECT_TRUE(planes_of(sheared(l_shape())).empty());
    EXPECT_TRUE(planes_of(sheared(surface_of("box", block({0, 0, 0}, {8, 5, 3})))).empty());
    EXPECT_TRUE(planes_of({}).empty());
}

// Of a bar of cubes along x, each cube on the left is a part, the right side is one part with a lower score. The two
// cubes that meet in the plane are convex together: they become one.
TEST(Symmetry, PartsOfTheBetterSideAreCopied) {
    const int length = 12;
    const TetMesh mesh = tets_of(block({0, 0, 0}, {length, 2, 2}));
    const auto cube = [&](size_t t) {
        double x = 0;
        for (const int32_t v : mesh.tetrahedra[t]) x += mesh.vertices[static_cast<size_t>(v)][0] / 4;
        return static_cast<int>(x);
    };
    std::vector<int32_t> part_of;  // fine on the left, one part on the right from the middle on
    std::vector<double> scores;
    for (size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        part_of.push_back(std::min(cube(t), length / 2));
        scores.push_back(cube(t) < length / 2 ? 0.9 : 0.1);
    }
    Progress progress;
    progress.begin();
    const Plane middle{{1, 0, 0}, length / 2.0};
    const TetLabels found = copy_symmetric_labels(mesh, std::vector<Plane>{middle}, part_of, length / 2 + 1, scores, progress);
    ASSERT_EQ(found.count, static_cast<size_t>(length - 1));
    ASSERT_EQ(found.mirror.size(), 1U);
    std::map<int, int32_t> part;  // of each cube
    for (size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        const auto [place, is_new] = part.insert({cube(t), found.label[t]});
        EXPECT_EQ(place->second, found.label[t]) << "cube " << cube(t);
    }
    for (int x = 0; x < length; ++x) EXPECT_EQ(found.mirror[0][static_cast<size_t>(part[x])], part[length - 1 - x]);
}

TEST(Symmetry, PartsAcrossThePlaneAreTheirOwnImages) {
    const int length = 9;  // the middle cube lies across
    const TetMesh mesh = tets_of(block({0, 0, 0}, {length, 2, 2}));
    std::vector<int32_t> part_of;
    for (const Tetrahedron& tet : mesh.tetrahedra) {
        double x = 0;
        for (const int32_t v : tet) x += mesh.vertices[static_cast<size_t>(v)][0] / 4;
        part_of.push_back(x < 3 ? 0 : x < 6 ? 1 : 2);
    }
    Progress progress;
    progress.begin();
    const TetLabels found =
        copy_symmetric_labels(mesh, std::vector<Plane>{{{1, 0, 0}, length / 2.0}}, part_of, 3, std::vector<double>(part_of.size(), 1),
                 progress);
    ASSERT_EQ(found.count, 3U);  // the same parts, whatever their numbers
    std::vector<int32_t> number(3, -1);
    for (size_t t = 0; t < part_of.size(); ++t) {
        int32_t& n = number[static_cast<size_t>(part_of[t])];
        if (n < 0) n = found.label[t];
        EXPECT_EQ(n, found.label[t]);
    }
    const std::vector<int32_t>& image = found.mirror[0];
    EXPECT_EQ(image[static_cast<size_t>(number[0])], number[2]);
    EXPECT_EQ(image[static_cast<size_t>(number[1])], number[1]);
    EXPECT_EQ(image[static_cast<size_t>(number[2])], number[0]);
}

// Of a plate whose middle and two ends have ragged borders, but for a quarter of the plate, the original: afterward nearly all of
// the surface has its mirror image in the image of its part, in both planes.
TEST(Symmetry, BordersMoveTowardTheirImages) {
    const Point size = {12, 8, 1};
    const TetMesh mesh = tets_of(block({0, 0, 0}, {24, 16, 2}), {0.5, 0.5, 0.5});
    const std::vector<Plane> planes = {{{1, 0, 0}, size[0] / 2}, {{0, 1, 0}, size[1] / 2}};
    PartTree tree{{}, 3, {{0, 1}, {2, 3}}, {1, 2}, {0, 0}, {{1, 0, 2, 3, 4}, {0, 1, 2, 3, 4}}};
    std::mt19937 random(1);
    for (const Tetrahedron& tet : mesh.tetrahedra) {
        const Point p = centroid(mesh.vertices, tet);
        const bool is_original = planes[0].height(p) > 0 && planes[1].height(p) > 0;
        const double x = p[0] + (is_original ? 0 : 0.5 * (static_cast<double>(random() % 100) / 50 - 1));
        tree.label.push_back(x < 3 ? 0 : x > 9 ? 1 : 2);
    }
    const BoundaryFacets facets(mesh);
    const auto shares = [&](const std::vector<int32_t>& label) {
        std::vector<double> alike;
        for (size_t k = 0; k < planes.size(); ++k) {
            double common = 0;
            for (size_t f = 0; f < facets.triangles.size(); ++f) {
                const Point image = planes[k].mirrored(centroid(mesh.vertices, facets.triangles[f]));
                size_t nearest = 0;
                double least = 1e300;
                for (size_t g = 0; g < facets.triangles.size(); ++g) {
                    const Point off = centroid(mesh.vertices, facets.triangles[g]) - image;
                    if (dot(off, off) < least) least = dot(off, off), nearest = g;
                }
                const auto part = [&](size_t g) { return static_cast<size_t>(label[static_cast<size_t>(facets.tetrahedra[g])]); };
                common += tree.mirror[k][part(f)] == static_cast<int32_t>(part(nearest));
            }
            alike.push_back(common / static_cast<double>(facets.triangles.size()));
        }
        return alike;
    };
    Progress progress;
    progress.begin();
    const std::vector<double> scores(tree.label.size(), 1);  // as good on all sides: those above the planes are the original
    const std::vector<int32_t> aligned = align_borders(mesh, planes, tree, scores, progress);
    for (size_t t = 0; t < aligned.size(); ++t) {
        const Point p = centroid(mesh.vertices, mesh.tetrahedra[t]);
        if (planes[0].height(p) > 0 && planes[1].height(p) > 0) {
            EXPECT_EQ(aligned[t], tree.label[t]);
        }
    }
    const std::vector<double> before = shares(tree.label), after = shares(aligned);
    for (size_t k = 0; k < planes.size(); ++k) {
        EXPECT_LT(before[k], 0.96) << k;
        EXPECT_GT(after[k], 0.98) << k;
    }
}

// Each part but the last has taken the next one's only tetrahedron, so the first is lost; what it gets back is all that
// the second has, and so on.
TEST(Symmetry, PartsThatTakeEachOthersTetrahedraAreAllRestored) {
    PartTree tree;
    tree.label = {0, 1, 2, 3, 4, 4};
    tree.count = 5;
    std::vector<int32_t> label = {1, 2, 3, 4, 4, 4};
    restore_lost_parts(tree, label);
    EXPECT_EQ(label, (std::vector<int32_t>{0, 1, 2, 3, 4, 4}));
    label = {0, 1, 2, 2, 3, 4};  // none is lost
    restore_lost_parts(tree, label);
    EXPECT_EQ(label, (std::vector<int32_t>{0, 1, 2, 2, 3, 4}));
    label = {0, 1, 2, 3, 3, 3};  // the last one alone
    restore_lost_parts(tree, label);
    EXPECT_EQ(label, tree.label);
}

// Three parts that merge at once, and their images; then all.
TEST(Symmetry, AMergeOfSeveralHasNoPartialUnions) {
    const TetLabels parts{{}, 6, {{3, 4, 5, 0, 1, 2}}, {0, 1, 2, 3, 4, 5}};
    const PartTree old_tree{{}, 6, {{0, 1}, {6, 2}, {3, 4}, {8, 5}, {7, 9}}, {1, 1, 1, 1, 2}, {1, 0, 1, 0, 0}, {}};
    std::vector<int32_t> leftover;
    const PartTree tree = merge_symmetrically(parts, std::vector<double>(6, 1), old_tree, 0, leftover);
    EXPECT_EQ(tree.children, old_tree.children);
    EXPECT_EQ(tree.is_intermediate, old_tree.is_intermediate);
    EXPECT_EQ(tree.mirror[0], (std::vector<int32_t>{3, 4, 5, 0, 1, 2, -1, 9, -1, 7, 10}));
}

// For random images: all parts merge, each once, or leftover parts are reported.
TEST(Symmetry, SymmetricMergesEndInOneRoot) {
    std::mt19937 random(1);
    const auto draw = [&](size_t n) { return static_cast<int32_t>(random() % n); };
    size_t whole = 0, n_incomplete = 0;
    for (int round = 0; round < 3000; ++round) {
        const size_t count = 2 + random() % 12;
        TetLabels parts{{}, count, {}, {}};
        for (size_t plane = 0; plane < 1 + random() % 3; ++plane) {
            std::vector<int32_t> image(count, -1);
            for (size_t p = 0; p < count; ++p)
                if (const int32_t q = draw(count); image[p] < 0 && image[static_cast<size_t>(q)] < 0) {
                    image[p] = q;
                    image[static_cast<size_t>(q)] = static_cast<int32_t>(p);
                }
            parts.mirror.push_back(image);
        }
        std::vector<double> areas;
        for (size_t p = 0; p < count; ++p) areas.push_back(draw(4) == 0 ? 0.001 : 1);
        const size_t before = 1 + random() % 12;
        for (size_t p = 0; p < before; ++p) parts.new_part.push_back(draw(count + 1) - 1);
        PartTree old_tree;
        old_tree.count = before;
        std::vector<int32_t> tops;
        for (size_t p = 0; p < before; ++p) tops.push_back(static_cast<int32_t>(p));
        while (tops.size() > 1) {
            std::shuffle(tops.begin(), tops.end(), random);
            old_tree.children.push_back({tops[0], tops[1]});
            tops.erase(tops.begin(), tops.begin() + 2);
            tops.push_back(static_cast<int32_t>(before + old_tree.children.size() - 1));
        }
        old_tree.costs.assign(old_tree.children.size(), 0.5);
        old_tree.is_intermediate.assign(old_tree.children.size(), 0);
        for (size_t j = 1; j < old_tree.children.size(); ++j)  // a merge of several: the next one takes it up
            old_tree.is_intermediate[j - 1] = old_tree.children[j][0] == static_cast<int32_t>(before + j - 1);
        for (const double max_leftover : {0.02, 0.0}) {
            std::vector<int32_t> leftover;
            const PartTree tree = merge_symmetrically(parts, areas, old_tree, max_leftover, leftover);
            if (!leftover.empty()) {
                ASSERT_TRUE(tree.children.empty() && max_leftover > 0);
                ++n_incomplete;
                continue;
            }
            ASSERT_EQ(tree.children.size(), count - 1);
            ASSERT_EQ(tree.is_intermediate.size(), count - 1);
            std::vector<int> used(2 * count - 1, 0);
            for (size_t j = 0; j < tree.children.size(); ++j)
                for (const int32_t half : tree.children[j]) {
                    ASSERT_LT(static_cast<size_t>(half), count + j);
                    ++used[static_cast<size_t>(half)];
                }
            ASSERT_EQ(used.back(), 0);
            ASSERT_EQ(std::count(used.begin(), used.end(), 1), static_cast<std::ptrdiff_t>(used.size()) - 1);
            ASSERT_TRUE(tree.is_intermediate.empty() || !tree.is_intermediate.back());
            for (const std::vector<int32_t>& image : tree.mirror) ASSERT_EQ(image.size(), used.size());
            ++whole;
        }
    }
    EXPECT_GT(whole, 3000U);
    EXPECT_GT(n_incomplete, 100U);
}

}  // namespace
}  // namespace partwheel::test
