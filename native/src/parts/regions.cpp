// Tetrahedra divided and labeled by the patches of their surface.
#include "parts/regions.h"

#include "base/adjacency.h"
#include "base/predicates.h"
#include "cluster/within.h"
#include "mesh/nearest.h"
#include "parts/boundary.h"
#include "parts/majority.h"

namespace partwheel {

namespace {

// Keeps only the largest connected component of each patch: the others would be parts of their own.
void keep_largest_components(const Surface& surface, std::vector<int32_t>& patch) {
    UnionFind sets(patch.size());
    for_each_edge(surface.vertices.size(), surface.triangles, [&](int32_t, std::span<const Side> sides) {
        for (size_t i = 1; i < sides.size(); ++i) {
            const size_t t = idx(sides[i - 1].number / 3), u = idx(sides[i].number / 3);
            if (patch[t] == patch[u]) sets.unite(t, u);
        }
    });
    std::vector<Vote> votes;  // of each patch, for a component
    for (size_t t = 0; t < patch.size(); ++t)
        if (patch[t] >= 0)
            votes.push_back({patch[t], static_cast<int32_t>(sets.find(t)), area(surface.vertices, surface.triangles[t])});
    std::vector<bool> is_largest(patch.size(), false);
    for_each_majority(std::move(votes), [&](int32_t, int32_t component) { is_largest[idx(component)] = true; });
    for (size_t t = 0; t < patch.size(); ++t)
        if (!is_largest[sets.find(t)]) patch[t] = -1;
}

// Moves samples to triangles of their own patch: to another one of their face, or to the nearest.
void move_samples(Surface& surface, std::span<const int32_t> of_face, std::span<const int32_t> patch) {
    const auto is_right = [&](const FaceSample& sample) {
        const int32_t p = of_face[idx(sample.face)];
        return p < 0 || patch[idx(sample.triangle)] == p;
    };
    std::vector<Vote> votes;
    for (const FaceSample& sample : surface.samples)
        if (is_right(sample)) votes.push_back({sample.face, sample.triangle, sample.area});
    std::vector<int32_t> best(of_face.size(), -1);  // triangle of each face
    for_each_majority(std::move(votes), [&](int32_t face, int32_t triangle) { best[idx(face)] = triangle; });
    std::vector<std::pair<int32_t, size_t>> wrong;  // patch, sample
    for (size_t i = 0; i < surface.samples.size(); ++i) {
        FaceSample& sample = surface.samples[i];
        if (is_right(sample)) continue;
        if (const int32_t triangle = best[idx(sample.face)]; triangle >= 0)
            sample.triangle = triangle;
        else
            wrong.emplace_back(of_face[idx(sample.face)], i);
    }
    std::ranges::sort(wrong);
    for (size_t i = 0; i < wrong.size();) {
        const int32_t p = wrong[i].first;
        std::vector<Triangle> triangles;
        std::vector<int32_t> number;
        for (size_t t = 0; t < patch.size(); ++t)
            if (patch[t] == p) {
                triangles.push_back(surface.triangles[t]);
                number.push_back(static_cast<int32_t>(t));
            }
        std::optional<NearestTriangle> nearest;
        if (!triangles.empty()) nearest.emplace(surface.vertices, triangles);
        for (; i < wrong.size() && wrong[i].first == p; ++i) {
            FaceSample& sample = surface.samples[wrong[i].second];
            const auto [a, b, c] = corner_points(surface.vertices, surface.triangles[idx(sample.triangle)]);
            if (nearest) sample.triangle = number[idx((*nearest)(1.0 / 3 * (a + b + c)).triangle)];
        }
    }
}

// Tetrahedra behind triangles of different patches; not those that rounding would turn inside out.
std::vector<bool> find_tetrahedra_to_divide(const TetMesh& mesh, std::span<const int32_t> patch_of_triangle) {
    std::vector<int32_t> patch(mesh.tetrahedra.size(), -1);
    std::vector<bool> is_divided(mesh.tetrahedra.size(), false);
    for (size_t i = 0; i < patch_of_triangle.size(); ++i) {
        const auto t = idx(mesh.tet_of_triangle[i]);
        if (patch[t] >= 0 && patch_of_triangle[i] >= 0 && patch[t] != patch_of_triangle[i]) is_divided[t] = true;
        if (patch_of_triangle[i] >= 0) patch[t] = patch_of_triangle[i];
    }
    for (size_t t = 0; t < is_divided.size(); ++t) {
        const std::array<Point, 4> corners = corner_points(mesh.vertices, mesh.tetrahedra[t]);
        const Point center = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
        for (size_t k = 0; is_divided[t] && k < 4; ++k) {
            const auto side = [&](const Point& p) {
                const auto& [i, j, l] = facet_corners[k];
                return orientation(corners[i], corners[j], corners[l], p);
            };
            is_divided[t] = side(center) == side(corners[k]);
        }
    }
    return is_divided;
}

}  // namespace

std::vector<int32_t> assign_patches(Surface& surface, std::span<const int32_t> of_face) {
    std::vector<Vote> votes;
    for (const FaceSample& sample : surface.samples)
        votes.push_back({sample.triangle, of_face[idx(sample.face)], sample.weight()});
    std::vector<int32_t> patch(surface.triangles.size(), -1);
    assign_majority(std::move(votes), patch);
    // Triangles of the source keep their faces, even if the repair has separated parts of a patch. Faces that the repair
    // has removed go to their own patch.
    const bool is_source = surface.fill_method == PW_FILL_EXACT || surface.fill_method == PW_FILL_REPAIRED;
    if (!is_source || surface.proxy_triangles > 0) keep_largest_components(surface, patch);
    move_samples(surface, of_face, patch);
    return patch;
}

void divide_tetrahedra(TetMesh& mesh, const Surface& surface, std::span<const int32_t> patch_of_triangle, Progress& progress) {
    const size_t count = mesh.tetrahedra.size();
    const std::vector<bool> is_divided = find_tetrahedra_to_divide(mesh, patch_of_triangle);
    // The quarter opposite corner 0 takes the place of the whole; first[t] is the one opposite corner 1.
    std::vector<int32_t> first(count, -1);
    const auto quarter = [&](size_t t, size_t k) {
        return static_cast<int32_t>(k == 0 || !is_divided[t] ? t : idx(first[t]) + k - 1);
    };
    const auto quarter_with = [&](size_t t, const Triangle& triangle) {
        return quarter(t, opposite_corner(mesh.tetrahedra[t], triangle));
    };
    size_t next = count;
    for (size_t t = 0; t < count; ++t) {
        if (!is_divided[t]) continue;
        first[t] = static_cast<int32_t>(next);
        next += 3;
    }
    if (next == count) return;
    std::vector<std::array<Corner, 4>> corners(next);
    std::vector<Point> vertices = mesh.vertices;
    // Beyond the facet of t opposite corner k: the neighbor, or the quarter of it that has that facet.
    const auto beyond = [&](size_t t, size_t k) {
        const int32_t n = mesh.neighbors[t][k];
        return n < 0 || !is_divided[idx(n)] ? n : quarter_with(idx(n), facet(mesh.tetrahedra[t], k));
    };
    for (size_t t = 0; t < count; ++t) {
        if (!is_divided[t]) {
            for (size_t k = 0; k < 4; ++k) corners[t][k] = {mesh.tetrahedra[t][k], beyond(t, k)};
            continue;
        }
        const auto center = static_cast<int32_t>(vertices.size());
        const auto [a, b, c, d] = corner_points(mesh.vertices, mesh.tetrahedra[t]);
        vertices.push_back(0.25 * (a + b + c + d));
        for (size_t k = 0; k < 4; ++k)
            for (size_t j = 0; j < 4; ++j)
                corners[idx(quarter(t, k))][j] =
                    j == k ? Corner{center, beyond(t, k)} : Corner{mesh.tetrahedra[t][j], quarter(t, j)};
    }
    std::vector<int32_t> behind = mesh.tet_of_triangle, number;
    for (size_t i = 0; i < behind.size(); ++i)
        if (is_divided[idx(behind[i])]) behind[i] = quarter_with(idx(behind[i]), surface.triangles[i]);
    const size_t cavities = mesh.cavities;
    mesh = canonical(std::move(vertices), std::move(corners), progress, &number);
    for (int32_t& t : behind) t = number[idx(t)];
    mesh.tet_of_triangle = std::move(behind);
    mesh.cavities = cavities;
}

Regions::Regions(const TetMesh& mesh, const Surface& surface, const Patches& patches,
                 std::span<const int32_t> patch_of_triangle, Progress& progress)
    : patches_(patches), patch_(mesh.tetrahedra.size(), -1) {
    std::vector<Vote> votes;
    for (size_t i = 0; i < patch_of_triangle.size(); ++i)
        if (patch_of_triangle[i] >= 0)
            votes.push_back({mesh.tet_of_triangle[i], patch_of_triangle[i], area(surface.vertices, surface.triangles[i])});
    propagate_labels(mesh, std::move(votes), patch_, progress);
    has_hints = std::ranges::any_of(patch_, [&](int32_t patch) { return patch >= 0 && patches.has_hints[idx(patch)]; });
    const BoundaryFacets facets(mesh);
    UnionFind regions(mesh.tetrahedra.size()), components(mesh.tetrahedra.size());
    const auto join = [&](int32_t a, int32_t b, bool is_connected) {
        if (patch_[idx(a)] == patch_[idx(b)]) regions.unite(idx(a), idx(b));
        if (is_connected) components.unite(idx(a), idx(b));
    };
    for (size_t t = 0; t < mesh.tetrahedra.size(); ++t)
        for (const int32_t n : mesh.neighbors[t])
            if (n >= 0) join(static_cast<int32_t>(t), n, true);
    for_each_edge(mesh.vertices.size(), facets.triangles, [&](int32_t, std::span<const Side> sides) {
        for (size_t i = 0; i + 1 < sides.size(); i += 2) {
            const int32_t a = facets.tetrahedra[idx(sides[i].number / 3)], b = facets.tetrahedra[idx(sides[i + 1].number / 3)];
            join(a, b, group(a) == group(b));
        }
    });
    for (size_t t = 0; t < patch_.size(); ++t) {
        const size_t lowest = regions.find(t);
        of_tet.push_back(lowest == t ? static_cast<int32_t>(count++) : of_tet[lowest]);
        if (lowest == t) component.push_back(of_tet[components.find(t)]);
    }
}

std::vector<double> Regions::mean_strengths() const {
    std::vector<double> length(patches_.group.size(), 0), marked(length);
    for (const Patches::Border& border : patches_.borders)
        for (const int32_t patch : {border.a, border.b}) {
            if (patch < 0) continue;
            length[idx(patch)] += border.length;
            marked[idx(patch)] += border.length * double{border.strength};
        }
    for (size_t p = 0; p < length.size(); ++p) marked[p] = length[p] > 0 ? marked[p] / length[p] : 0;
    return marked;
}

bool Regions::is_divided_by_hard_marks() const {
    for (size_t t = 1; t < patch_.size(); ++t)
        if (group(static_cast<int32_t>(t)) != group(0)) return true;
    return false;
}

BinaryTree cluster_in_regions(const TetMesh& mesh, const Regions& regions, Progress& progress, size_t threads) {
    HullKernel kernel(mesh.vertices, progress);  // outlives all hulls
    RestrictedTree within = cluster_within_labels(mesh, regions.of_tet, regions.count, kernel, progress, threads);
    std::vector<Subtree> components(regions.count);
    BinaryTree tree{std::move(within.merges), 0};
    const auto add = [&](Subtree& to, Subtree&& from) {
        to = merge_subtrees(std::move(to), std::move(from), kernel, mesh.tetrahedra.size(), tree.merges);
    };
    for (size_t r = 0; r < regions.count; ++r) {
        tree.components += idx(regions.component[r]) == r;
        add(components[idx(regions.component[r])], std::move(within.parts[r]));
    }
    for (size_t r = 1; r < regions.count; ++r) add(components[0], std::move(components[r]));
    return tree;
}

}  // namespace partwheel
