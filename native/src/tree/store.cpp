// Saves a hierarchy, and loads what was saved.
#include "tree/hierarchy.h"
#include "tree/packed.h"
#include "tree/saved.h"

namespace partwheel {

namespace {

// The merges from the border that each removes, see save().
std::vector<Merge> restore_merges(std::span<const int32_t> borders, std::span<const double> concavities) {
    struct Neighbor {
        int32_t cluster, far;  // which ends or begins at a border, and where its other end is
    };
    const auto leaves = static_cast<int32_t>(borders.size() + 1);
    std::vector<Neighbor> left, right;  // of every border and of both ends; no cluster if it has been removed
    for (int32_t at = 0; at <= leaves; ++at) {
        left.push_back({at - 1, at - 1});
        right.push_back({at < leaves ? at : -1, at + 1});
    }
    std::vector<Merge> merges;
    for (size_t m = 0; m < borders.size(); ++m) {
        if (borders[m] <= 0 || borders[m] >= leaves) refuse_saved("its tree is not a tree");
        Neighbor &a = left[idx(borders[m])], &b = right[idx(borders[m])];
        if (a.cluster < 0) refuse_saved("its tree is not a tree");
        merges.push_back({a.cluster, b.cluster, concavities[m], 0});
        const auto merged = static_cast<int32_t>(idx(leaves) + m);
        right[idx(a.far)] = {merged, b.far};
        left[idx(b.far)] = {merged, a.far};
        a.cluster = b.cluster = -1;
    }
    return merges;
}

}  // namespace

std::vector<uint8_t> Hierarchy::save(Progress& progress) const {
    SavedHierarchy saved{data_, {}, {}};
    // A merge joins the slices on both sides of a border between two tetrahedra, so that border identifies it.
    for (const Merge& merge : merges_) {
        saved.borders.push_back(end_of(merge.left));
        saved.concavities.push_back(merge.concavity);
    }
    return saved.pack(progress);
}

Hierarchy Hierarchy::load(std::span<const uint8_t> bytes, Progress& progress) {
    progress.reach(0);
    SavedHierarchy saved = SavedHierarchy::unpack(bytes);
    progress.reach(0.3);
    saved.check();
    progress.reach(0.6);
    std::vector<Merge> merges = restore_merges(saved.borders, saved.concavities);
    Hierarchy h(std::move(saved), std::move(merges));
    if (!std::isfinite(h.data_.summary.volume)) refuse_saved("its measures are impossible");
    if (std::ranges::find(h.shell_nodes_, -1) != h.shell_nodes_.end()) refuse_saved("a shell is not a node");
    return h;
}

}  // namespace partwheel
