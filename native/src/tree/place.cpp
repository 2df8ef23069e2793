// Tetrahedra moved to where a copy of their shell is.
#include "tree/place.h"

#include "base/corners.h"

namespace partwheel {

namespace {

// Turns the tetrahedra inside out. The outer facets opposite their first two corners change places.
void reverse_tetrahedra(HierarchyData& data) {
    const std::vector<std::array<int32_t, 4>> neighbors = find_neighbors(data.tetrahedra);
    auto outer = data.outer_faces.begin();
    for (size_t t = 0; t < neighbors.size(); ++t) {
        std::swap(data.tetrahedra[t][0], data.tetrahedra[t][1]);
        if (neighbors[t][0] < 0 && neighbors[t][1] < 0) std::iter_swap(outer, outer + 1);
        outer += std::ranges::count(neighbors[t], -1);
    }
}

// The sum does not depend on the order of triangles and corners.
double area_of(const SubMesh& shell) {
    std::vector<double> areas;
    for (const Triangle& t : shell.triangles) {
        auto corners = corner_points(shell.vertices, t);
        std::ranges::sort(corners);
        areas.push_back(area(corners[0], corners[1], corners[2]));
    }
    std::ranges::sort(areas);
    return std::accumulate(areas.begin(), areas.end(), 0.0);
}

}  // namespace

std::optional<Hierarchy> place_copy(const Hierarchy& original, const Congruence& congruence, const SubMesh& from,
                                    const SubMesh& to) {
    HierarchyData data = original.data();
    for (size_t v = 0; v < data.vertices.size(); ++v) {
        int32_t& source = data.source[v];
        if (source >= 0) source = congruence.vertices[idx(source)];
        data.vertices[v] = source >= 0 ? to.vertices[idx(source)] : transform_point(congruence.motion, data.vertices[v]);
    }
    const double scale = area_of(to) / area_of(from);
    for (size_t f = 0; f < data.leaf.size(); ++f) {
        data.leaf[idx(congruence.faces[f])] = original.data().leaf[f];
        data.face_area[idx(congruence.faces[f])] = scale * original.data().face_area[f];
    }
    for (int32_t& f : data.outer_faces)
        if (f >= 0) f = congruence.faces[idx(f)];
    if (congruence.is_mirrored) reverse_tetrahedra(data);
    if (has_reversed_tetrahedra(data)) return {};
    const std::span<const Merge> merges = original.merges();
    return Hierarchy(std::move(data), {merges.begin(), merges.end()});
}

}  // namespace partwheel
