// Shells that are copies of another one: they are found whatever their order, and get the original's tetrahedra and parts.
#include "pipeline.h"
#include "prepare/congruent.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace partwheel::test {
namespace {

using partwheel::operator+, partwheel::operator-, test::operator+, test::operator-;

// Without any symmetry, so that there is one way to place it.
TriMesh irregular() { return without_faces(perturbed(stretched(star_prism(5, 0.4, 1, 0.5), {1, 0.7, 0.9}), 0.03, 1)); }

TriMesh mirrored(const TriMesh& mesh) { return inside_out(stretched(mesh, {-1, 1, 1})); }

// One after the other along the x-axis.
TriMesh in_a_row(const std::vector<TriMesh>& shells) {
    TriMesh row = shells[0];
    for (size_t i = 1; i < shells.size(); ++i)
        row = together("row", row, moved(shells[i], {4.0 * static_cast<double>(i), 0.3 * static_cast<double>(i), 0}));
    return row;
}

TriMesh single_precision(TriMesh mesh) {
    for (Point& p : mesh.vertices)
        for (double& x : p) x = static_cast<float>(x);
    return mesh;
}

const Point axis = {0.3, 1, 0.2};

std::vector<SubMesh> divided(const TriMesh& mesh) {
    return divide_into_shells(mesh.view(), find_shells(mesh.view()), {}).shells;
}

std::vector<std::optional<Congruence>> congruent(const std::vector<SubMesh>& shells, const Patches& patches = {}) {
    return find_congruent_shells(shells, patches, unobserved_progress());
}

TEST(Congruent, CopiesInAnyOrderAreFoundMovedTurnedAndMirrored) {
    const TriMesh shape = irregular();
    TriMesh dented = shape;
    dented.vertices[7][1] *= 1.001;
    const Shuffled mesh = shuffled(single_precision(in_a_row({
        rotated(mirrored(shape), 2, axis), stretched(shape, {1.001, 1.001, 1.001}), dented, mirrored(shape),
        rotated(shape, 1, axis), shape, shape})), 5);
    const std::vector<SubMesh> shells = divided(mesh.mesh);
    const auto found = congruent(shells);
    ASSERT_EQ(found.size(), 7U);
    for (const size_t s : {1U, 2U, 6U}) EXPECT_FALSE(found[s]) << s;
    const auto vertices = static_cast<int32_t>(shape.vertices.size()), faces = static_cast<int32_t>(shape.triangles.size());
    const auto vertex_in_shape = [&](size_t s, size_t v) { return mesh.vertex[idx(shells[s].vertex_numbers[v])] % vertices; };
    const auto face_in_shape = [&](size_t s, size_t f) { return mesh.face[idx(shells[s].face_numbers[f])] % faces; };
    for (const size_t s : {0U, 3U, 4U, 5U}) {
        ASSERT_TRUE(found[s]) << s;
        EXPECT_EQ(found[s]->original, 6U);
        EXPECT_EQ(found[s]->is_mirrored, s == 0 || s == 3);
        for (size_t v = 0; v < shells[6].vertices.size(); ++v) {
            const size_t image = idx(found[s]->vertices[v]);
            EXPECT_EQ(vertex_in_shape(s, image), vertex_in_shape(6, v));
            EXPECT_LT(length(transform_point(found[s]->motion, shells[6].vertices[v]) - shells[s].vertices[image]), 1e-5);
        }
        for (size_t f = 0; f < shells[6].face_numbers.size(); ++f)
            EXPECT_EQ(face_in_shape(s, idx(found[s]->faces[f])), face_in_shape(6, f));
    }
}

TEST(Congruent, FacesAndOrientationAreThoseOfTheOriginal) {
    const TriMesh wheel = star_prism(8, 0.9, 1, 0.3), shape = irregular();
    EXPECT_TRUE(congruent(divided(in_a_row({wheel, rotated(wheel, 1, axis)})))[0]);
    EXPECT_FALSE(congruent(divided(in_a_row({wheel, without_faces(rotated(wheel, 1, axis))})))[0]);
    EXPECT_FALSE(congruent(divided(in_a_row({shape, inside_out(shape)})))[0]);
}

TEST(Congruent, PatchesAreThoseOfTheOriginal) {
    const std::vector<SubMesh> shells = divided(in_a_row({irregular(), irregular(), irregular()}));
    const size_t faces = shells[0].face_numbers.size();
    Patches patches;
    for (size_t f = 0; f < 3 * faces; ++f) patches.of_face.push_back(static_cast<int32_t>(f / faces * 2 + f % faces % 2));
    patches.group = {0, 1, 2, 3, 4, 5};
    EXPECT_TRUE(congruent(shells, patches)[0]);
    EXPECT_TRUE(congruent(shells, patches)[1]);
    std::swap(patches.of_face[faces + 4], patches.of_face[faces + 5]);
    patches.group[5] = 4;  // not divided by a hard mark
    EXPECT_FALSE(congruent(shells, patches)[0]);
    EXPECT_FALSE(congruent(shells, patches)[1]);
}

Hierarchy hierarchy_of(const TriMesh& mesh, uint32_t fill_methods, size_t threads = 1) {
    BuildOptions options;
    options.fill.fill_methods = fill_methods;
    options.fill.threads = threads;
    return build_hierarchy(mesh.view(), options, unobserved_progress());
}

// The faces of the nodes that contain a face, up to the shell's, counted from the shell's first face.
std::vector<std::set<int32_t>> faces_of_path(const Hierarchy& hierarchy, int32_t face, int32_t faces) {
    std::vector<std::set<int32_t>> path;
    for (const int32_t node : hierarchy.path(idx(face))) {
        const std::span<const int32_t> of_node = hierarchy.faces(idx(node));
        if (of_node.size() > idx(faces)) break;
        std::set<int32_t>& set = path.emplace_back();
        for (const int32_t f : of_node) set.insert(f % faces);
        EXPECT_EQ(set.size(), of_node.size()) << "a node of faces of two shells";
    }
    return path;
}

TEST(Congruent, CopiesHaveTheTetrahedraAndPartsOfTheOriginal) {
    const TriMesh shape = irregular();
    const TriMesh row = single_precision(in_a_row({shape, shape, rotated(shape, 1, axis), mirrored(shape)}));
    const Hierarchy hierarchy = hierarchy_of(row, PW_FILL_EXACT);
    const auto faces = static_cast<int32_t>(shape.triangles.size());
    double volume = 0;
    for (const Tetrahedron& t : hierarchy.tetrahedra()) {
        std::array<Point, 4> p;
        for (size_t k = 0; k < 4; ++k) p[k] = hierarchy.vertices()[idx(t[k])];
        EXPECT_GT(signed_volume6(p[0], p[1], p[2], p[3]), 0);
        volume += signed_volume6(p[0], p[1], p[2], p[3]) / 6;
    }
    EXPECT_NEAR(volume, enclosed_volume(row), 1e-9);
    // The outer facets are the triangles of the mesh.
    const auto outer = hierarchy.outer_faces();
    const auto rotated_to_lowest = [](Triangle t) {
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        return t;
    };
    std::set<Triangle> triangles, facets;
    for (const Triangle& t : row.triangles) triangles.insert(rotated_to_lowest(t));
    for (const Tetrahedron& t : hierarchy.tetrahedra())
        for (size_t k = 0; k < 4; ++k) {
            Triangle corners = facet(t, k);
            for (int32_t& v : corners) v = hierarchy.data().source[idx(v)];
            if (triangles.contains(rotated_to_lowest(corners))) {
                ASSERT_LT(facets.size(), outer.size());
                EXPECT_EQ(rotated_to_lowest(row.triangles[idx(outer[facets.size()])]), rotated_to_lowest(corners));
                facets.insert(rotated_to_lowest(corners));
            }
        }
    EXPECT_EQ(facets.size(), outer.size());
    EXPECT_EQ(facets, triangles);
    for (int32_t f = 0; f < faces; f += 5) {
        const auto path = faces_of_path(hierarchy, f, faces);
        EXPECT_EQ(path.back().size(), idx(faces));
        for (int32_t copy = 1; copy < 4; ++copy) EXPECT_EQ(faces_of_path(hierarchy, f + copy * faces, faces), path);
    }
    EXPECT_EQ(Hierarchy::load(hierarchy.save()).save(), hierarchy.save());
}

// Points are put on a shell in an order that depends on its place, so that otherwise no two of these were filled alike.
TEST(Congruent, CopiesFilledFromPointsInThreadsAreAlike) {
    const TriMesh shape = irregular();
    const TriMesh row = in_a_row({shape, rotated(shape, 1, axis), mirrored(shape)});
    const Hierarchy hierarchy = hierarchy_of(row, PW_FILL_POINTS);
    const size_t third = hierarchy.tetrahedron_count() / 3;
    ASSERT_EQ(hierarchy.tetrahedron_count(), 3 * third);
    std::array<std::vector<double>, 3> volumes;
    for (size_t t = 0; t < 3 * third; ++t) {
        const Tetrahedron& c = hierarchy.tetrahedra()[t];
        const auto at = [&](size_t k) { return hierarchy.vertices()[idx(c[k])]; };
        volumes[t / third].push_back(signed_volume6(at(0), at(1), at(2), at(3)));
    }
    for (size_t t = 0; t < third; ++t)
        for (const size_t copy : {1U, 2U}) EXPECT_NEAR(volumes[copy][t], volumes[0][t], 1e-6);
    EXPECT_EQ(hierarchy_of(row, PW_FILL_POINTS, 3).save(), hierarchy.save());
}

}  // namespace
}  // namespace partwheel::test
