// Source faces and tetrahedra, by the area that they share.
#include "tree/face_leaves.h"

#include "base/corners.h"
#include "parts/majority.h"

namespace partwheel {

void assign_faces(const Surface& surface, const TetMesh& mesh, std::span<const int32_t> leaf_of_tet,
                  std::vector<int32_t>& leaf, std::vector<double>& face_area) {
    std::vector<FaceSample> samples = surface.samples;
    const auto leaf_behind = [&](const FaceSample& piece) {
        return leaf_of_tet[idx(mesh.tet_of_triangle[idx(piece.triangle)])];
    };
    std::ranges::sort(samples, {}, [&](const FaceSample& s) { return std::tuple(s.face, leaf_behind(s), s); });
    leaf.assign(surface.face_count, -1);
    face_area.assign(surface.face_count, 0);
    std::vector<double> most(surface.face_count, -1);
    for (size_t i = 0; i < samples.size();) {
        const int32_t f = samples[i].face, l = leaf_behind(samples[i]);
        double shared = 0;
        for (; i < samples.size() && samples[i].face == f && leaf_behind(samples[i]) == l; ++i) shared += samples[i].area;
        const auto face = idx(f);
        face_area[face] += shared;
        if (shared > most[face]) {
            most[face] = shared;
            leaf[face] = l;
        }
    }
    for (size_t f = 0; f < surface.original.size(); ++f) leaf[f] = leaf[idx(surface.original[f])];
}

std::vector<int32_t> faces_of_outer_facets(const Surface& surface, const TetMesh& mesh,
                                           std::span<const int32_t> leaf_of_tet) {
    std::vector<Vote> votes;
    for (const FaceSample& sample : surface.samples) votes.push_back({sample.triangle, sample.face, sample.weight()});
    std::vector<int32_t> face(surface.triangles.size(), -1);
    for_each_majority(std::move(votes), [&](int32_t t, int32_t f) { face[idx(t)] = f; });
    struct Outer {
        int32_t leaf;
        size_t corner;
        int32_t face;
    };
    std::vector<Outer> outer;
    for (size_t t = 0; t < surface.triangles.size(); ++t) {
        const auto tet = idx(mesh.tet_of_triangle[t]);
        const size_t corner = opposite_corner(mesh.tetrahedra[tet], surface.triangles[t]);
        if (mesh.neighbors[tet][corner] >= 0) continue;  // a wall with the solid on both sides
        outer.push_back({leaf_of_tet[tet], corner, face[t]});
    }
    std::ranges::sort(outer, {}, [](const Outer& o) { return std::tie(o.leaf, o.corner); });
    std::vector<int32_t> faces;
    for (const Outer& o : outer) faces.push_back(o.face);
    return faces;
}

}  // namespace partwheel
