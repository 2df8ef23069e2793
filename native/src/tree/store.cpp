// Saves a hierarchy, and loads what was saved.
#include "tree/hierarchy.h"
#include "tree/packed.h"
#include "tree/saved.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace partwheel {

namespace {

// The fields that a saved hierarchy and a summary share.
auto shared_fields(auto& s) {
    return std::tie(s.components, s.cavities, s.added_vertices, s.proxy_triangles, s.deviation, s.hull_volume);
}

}  // namespace

std::vector<uint8_t> Hierarchy::save(Progress& progress) const {
    SavedHierarchy saved;
    saved.fill_method = summary_.fill_method;
    shared_fields(saved) = shared_fields(summary_);
    saved.notes = notes_;
    // A merge joins the slices on both sides of a border between two tetrahedra, so that border identifies it.
    for (const Merge& merge : merges_) {
        const size_t leaves = tetrahedra_.size(), left = idx(merge.left);
        saved.borders.push_back(left < leaves ? merge.left + 1 : merge_last_[left - leaves]);
        saved.concavities.push_back(merge.concavity);
    }
    saved.vertices = vertices_;
    saved.source = source_;
    saved.tetrahedra = tetrahedra_;
    saved.leaf = leaf_;
    saved.face_area = face_area_;
    saved.outer_faces = outer_faces_;
    saved.scores = scores_;
    saved.shell_fills = shell_fills_;
    return saved.pack(progress);
}

Hierarchy Hierarchy::load(std::span<const uint8_t> bytes, Progress& progress) {
    progress.reach(0);
    SavedHierarchy saved = SavedHierarchy::unpack(bytes);
    progress.reach(0.3);
    saved.check();
    progress.reach(0.6);
    Hierarchy h;
    h.restore_merges(saved.borders, saved.concavities);
    h.summary_.fill_method = static_cast<pw_fill_method>(saved.fill_method);
    shared_fields(h.summary_) = shared_fields(saved);
    h.notes_ = std::move(saved.notes);
    h.vertices_ = std::move(saved.vertices);
    h.source_ = std::move(saved.source);
    h.tetrahedra_ = std::move(saved.tetrahedra);
    h.leaf_ = std::move(saved.leaf);
    h.face_area_ = std::move(saved.face_area);
    h.outer_faces_ = std::move(saved.outer_faces);
    h.scores_ = std::move(saved.scores);
    h.shell_fills_ = std::move(saved.shell_fills);
    h.derive();
    if (!std::isfinite(h.summary_.volume)) refuse_saved("its measures are impossible");
    if (std::ranges::find(h.shell_nodes_, -1) != h.shell_nodes_.end()) refuse_saved("a shell is not a node");
    return h;
}

// The merges from the border that each removes, see save().
void Hierarchy::restore_merges(std::span<const int32_t> borders, std::span<const double> concavities) {
    struct Neighbor {
        int32_t cluster, far;  // which ends or begins at a border, and where its other end is
    };
    const auto leaves = static_cast<int32_t>(borders.size() + 1);
    std::vector<Neighbor> left, right;  // of every border and of both ends; no cluster if it has been removed
    for (int32_t at = 0; at <= leaves; ++at) {
        left.push_back({at - 1, at - 1});
        right.push_back({at < leaves ? at : -1, at + 1});
    }
    for (size_t m = 0; m < borders.size(); ++m) {
        if (borders[m] <= 0 || borders[m] >= leaves) refuse_saved("its tree is not a tree");
        Neighbor &a = left[idx(borders[m])], &b = right[idx(borders[m])];
        if (a.cluster < 0) refuse_saved("its tree is not a tree");
        merges_.push_back({a.cluster, b.cluster, concavities[m], 0});
        const auto merged = static_cast<int32_t>(idx(leaves) + m);
        right[idx(a.far)] = {merged, b.far};
        left[idx(b.far)] = {merged, a.far};
        a.cluster = b.cluster = -1;
    }
}

}  // namespace partwheel
