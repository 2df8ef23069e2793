// Solids of parts.
#include "edit/solid.h"

#include "edit/move_border.h"
#include "tree/saved.h"

namespace partwheel {

SolidBuilder::SolidBuilder(std::span<const Tetrahedron> tetrahedra, std::span<const Point> vertices,
                           std::span<const int32_t> outer_faces, std::span<const int32_t> leaf,
                           std::span<const uint8_t> exact, Progress& progress)
    : facets_{tetrahedra, vertices, find_neighbors(tetrahedra), {tetrahedra.size(), {-1, -1, -1, -1}}},
      owner_(tetrahedra.size()) {
    progress.reach(0.3);
    auto next = outer_faces.begin();
    for (size_t t = 0; t < tetrahedra.size(); ++t) {
        int32_t face_at_tet = -1;  // -2: several
        for (size_t c = 0; c < 4; ++c) {
            if (facets_.neighbors[t][c] >= 0) continue;
            if (next == outer_faces.end()) throw_inconsistent_tetrahedra();
            const int32_t face = facets_.faces[t][c] = *next++;
            face_at_tet = face_at_tet == -1 || face_at_tet == face ? face : -2;
        }
        owner_[t] = exact[t] && face_at_tet >= 0 ? leaf[idx(face_at_tet)] : static_cast<int32_t>(t);
        if (owner_[t] != static_cast<int32_t>(t)) reassigned_.emplace_back(owner_[t], static_cast<int32_t>(t));
    }
    if (next != outer_faces.end()) throw_inconsistent_tetrahedra();
    std::sort(reassigned_.begin(), reassigned_.end());
}

std::vector<int32_t> SolidBuilder::tets_of_slice(size_t first, size_t last) const {
    std::vector<int32_t> tets;
    if (first > last) {
        for (size_t t = 0; t < owner_.size(); ++t)
            if (idx(owner_[t]) < last || idx(owner_[t]) >= first) tets.push_back(static_cast<int32_t>(t));
        return tets;
    }
    for (size_t t = first; t < last; ++t)
        if (idx(owner_[t]) >= first && idx(owner_[t]) < last) tets.push_back(static_cast<int32_t>(t));
    const auto from =
        std::lower_bound(reassigned_.begin(), reassigned_.end(), std::pair(static_cast<int32_t>(first), -1));
    for (auto m = from; m != reassigned_.end() && idx(m->first) < last; ++m)
        if (idx(m->second) < first || idx(m->second) >= last) tets.push_back(m->second);
    return tets;
}

std::vector<int32_t> SolidBuilder::tets_of_slices(std::span<const std::array<int32_t, 2>> slices) const {
    std::vector<int32_t> tets;
    for (const auto& [first, last] : slices) {
        const std::vector<int32_t> of_slice = tets_of_slice(idx(first), idx(last));
        tets.insert(tets.end(), of_slice.begin(), of_slice.end());
    }
    return tets;
}

std::vector<int32_t> SolidBuilder::tets_of_faces(size_t first, size_t last, std::span<const uint8_t> inside,
                                                 Progress& progress) const {
    const bool is_complement = first > last;
    if (is_complement) std::swap(first, last);
    std::vector<uint8_t> in(owner_.size(), 0);
    for (const int32_t t : tets_of_slice(first, last)) in[idx(t)] = 1;
    in = move_border(facets_, std::move(in), inside, progress);
    std::vector<int32_t> tets;
    for (size_t t = 0; t < in.size(); ++t)
        if ((in[t] != 0) != is_complement) tets.push_back(static_cast<int32_t>(t));
    return tets;
}

}  // namespace partwheel
