// Merges parts bottom-up, the cheapest pair first, then the components, and builds the scored tree.
#include "cluster/within.h"
#include "parts/mirror/mirror_tree.h"
#include "parts/merge/insert_patches.h"
#include "parts/merge/network_weights.h"
#include "parts/merge/parts.h"
#include "parts/snap/snap.h"

#include <queue>

namespace partwheel {

namespace {

// What marks all along a border add to the cost of merging across it, a logit. Hard marks come after all others. Hints
// cost less than creases, because their patches become nodes in any case; see insert_patches().
constexpr double crease_cost = 3, hint_cost = 1.5, hard_mark_cost = 1e9;
// A node is marked if more than this share of its border is.
constexpr double min_marked_share = 0.5;
// How much of the overlap of patches with their best nodes symmetry may cost.
constexpr double max_lost_overlap = 0.015;
// Nodes of the best cut that score at least this don't dissolve when borders move.
constexpr double min_limb_score = 0.8;
// Parts without surface merge at costs of this size, before all others.
constexpr double no_surface_cost = 1e6, no_surface_mark_factor = 1e4;

class PartMerger {
public:
    PartMerger(const TetMesh& mesh, std::span<const SurfaceEdge> edges, const BinaryTree& tree, Progress& progress,
               const Regions* regions, std::span<const double> pair_weights, MergeTrace* trace)
        : mesh_(mesh), edges_(edges), tree_(tree), progress_(progress), regions_(regions),
          pair_cost_(pair_weights, pair_feature_count), node_logit_(node_network, node_feature_count), trace_(trace),
          kernel_(mesh.vertices, progress) {}

    // Returns the tree of the initial parts.
    PartTree merge_by_cost() {
        const Progress::Section first(progress_, 0, 0.6);
        std::vector<int32_t> label = set_initial_parts();
        merge_neighbors();
        merge_components();
        PartTree tree{std::move(label), parts_.initial_count, children_, {}, std::vector<uint8_t>(children_.size(), 0), {}};
        for (size_t j = 0; j < children_.size(); ++j) tree.costs.push_back(parts_.nodes[parts_.initial_count + j].own_cost);
        return tree;
    }

    // The scores of all nodes.
    std::vector<double> compute_scores() {
        summarize_children(parts_);
        std::vector<double> scores;
        for (size_t n = 0; n < parts_.nodes.size(); ++n) {
            const auto features = as_array(node_features(parts_, n));
            if (trace_) trace_->nodes.push_back(features);
            const double logit = node_logit_(features);
            scores.push_back((1 + logit / (1 + std::abs(logit))) / 2);
            if (regions_ && !parts_.nodes[n].joins_patches)  // what is marked all along is what people see
                scores.back() += mark_score(parts_.nodes[n].border.marked_share()) * (1 - scores.back());
        }
        if (regions_) raise_marked(scores);
        return scores;
    }

    // Raises the scores of nodes whose border is marked above those of nodes that look the same: of these the wheel
    // stops only at the best.
    void raise_marked(std::vector<double>& scores) const {
        const auto is_marked = [&](size_t n) { return parts_.nodes[n].border.marked_share() > min_marked_share; };
        std::vector<double> least(scores);
        for (size_t n = 0; n < scores.size(); ++n)
            for (int32_t p = parts_.nodes[n].parent; p >= 0; p = parts_[p].parent) {
                if (!(parts_.nodes[n].area > same_look * parts_[p].area)) break;
                if (is_marked(n) == is_marked(idx(p))) continue;
                const auto [marked, other] = is_marked(n) ? std::pair(n, idx(p)) : std::pair(idx(p), n);
                least[marked] = std::max(least[marked], std::nextafter(scores[other], 1));
            }
        scores = std::move(least);
    }

    // For each initial part: the node that contains it in the cut with the largest sum of area x score.
    std::vector<int32_t> best_cut(const std::vector<double>& scores) const {
        std::vector<double> best;
        std::vector<int32_t> node_of = iota(parts_.nodes.size());
        for (size_t n = 0; n < parts_.nodes.size(); ++n) best.push_back(parts_.nodes[n].area * scores[n]);
        for (size_t j = 0; j < children_.size(); ++j) {
            const double if_divided = best[idx(children_[j][0])] + best[idx(children_[j][1])];
            double& if_whole = best[parts_.initial_count + j];
            if (if_divided > if_whole) {
                if_whole = if_divided;
                node_of[parts_.initial_count + j] = -1;  // divided
            }
        }
        for (size_t j = children_.size(); j-- > 0;)
            if (const int32_t node = node_of[parts_.initial_count + j]; node >= 0)
                for (const int32_t child : children_[j]) node_of[idx(child)] = node;
        node_of.resize(parts_.initial_count);
        return node_of;
    }

    std::vector<double> areas() const {
        std::vector<double> result;
        for (const Part& part : parts_.nodes) result.push_back(part.area);
        return result;
    }

    std::span<const Merge> merges_within_parts() const {
        return std::span(result_.tree.merges).first(mesh_.tetrahedra.size() - parts_.initial_count);
    }

    // Merges other parts in the order of their tree, and scores the nodes. Keeps as much of merges_within_parts as
    // possible. label: the part of each tetrahedron, that of the tree or nearly so. Features and scores are those of
    // the tree's labels: its borders are as smooth as those that the networks were fitted to.
    ScoredTree rebuild(const PartTree& tree, std::span<const int32_t> label, std::span<const Merge> merges_within_parts) {
        RestrictedTree within = restrict_tree_to_labels(mesh_, merges_within_parts, label, tree.count, kernel_);
        result_.tree.merges = std::move(within.merges);
        std::vector<int32_t> clusters;
        std::vector<Hull> hulls;
        for (Subtree& part : within.parts) {
            clusters.push_back(part.cluster);
            hulls.push_back(std::move(part.hull));
        }
        set_parts(tree.label, clusters, std::move(hulls));
        for (size_t j = 0; j < tree.children.size(); ++j) {
            merge(tree.children[j][0], tree.children[j][1], tree.costs[j]);
            progress_.advance_by(1 / static_cast<double>(tree.children.size()));
        }
        // Intermediate merges are no nodes: parents are those of the complete merge.
        const auto is_intermediate = [&](int32_t n) {
            return idx(n) >= tree.count && tree.is_intermediate[idx(n) - tree.count];
        };
        for (Part& part : parts_.nodes)
            while (part.parent >= 0 && is_intermediate(part.parent)) part.parent = parts_[part.parent].parent;
        // The score of a node is the mean over its images, itself included.
        const std::vector<double> own_scores = compute_scores();
        std::vector<double> scores = own_scores;
        for (size_t n = 0; n < own_scores.size(); ++n) {
            std::vector<int32_t> images = {static_cast<int32_t>(n)};
            for (const std::vector<int32_t>& mirror : tree.mirror)
                for (size_t i = 0, count = images.size(); i < count; ++i)
                    if (const int32_t image = mirror[idx(images[i])];
                        image >= 0 && std::ranges::find(images, image) == images.end())
                        images.push_back(image);
            std::ranges::sort(images);
            double sum = 0;
            for (const int32_t image : images) sum += own_scores[idx(image)];
            scores[n] = is_intermediate(static_cast<int32_t>(n)) ? 0 : sum / static_cast<double>(images.size());
        }
        return take_result(scores);
    }

private:
    // Returns the part of each tetrahedron.
    std::vector<int32_t> set_initial_parts() {
        const size_t leaves = mesh_.tetrahedra.size();
        const std::vector<int32_t> parts = choose_initial_parts(mesh_, tree_, regions_);
        std::vector<int32_t> label(leaves + tree_.merges.size(), -1);
        for (size_t p = 0; p < parts.size(); ++p) label[idx(parts[p])] = static_cast<int32_t>(p);
        propagate_to_leaves(tree_.merges, leaves, label);
        const std::vector<int32_t> clusters = copy_merges_within_parts(parts, label);
        label.resize(leaves);
        set_parts(label, clusters);
        return label;
    }

    void set_parts(std::span<const int32_t> label, std::span<const int32_t> clusters, std::vector<Hull> hulls = {}) {
        parts_ = build_parts(mesh_, edges_, label, clusters.size(), tree_.merges.back().hull_volume,
                             std::move(hulls), regions_, kernel_, progress_);
        for (size_t p = 0; p < clusters.size(); ++p) parts_.nodes[p].cluster = clusters[p];
        result_.tree.components = tree_.components;
        parts_.nodes.reserve(2 * parts_.initial_count - 1);  // merge() holds references
        pair_with_.assign(2 * parts_.initial_count - 1, -1);
    }

    // Copies the paper's merges within the parts, with new ids. Returns the new ids of the parts.
    std::vector<int32_t> copy_merges_within_parts(std::span<const int32_t> parts, std::span<const int32_t> label) {
        const size_t leaves = mesh_.tetrahedra.size(), merges = tree_.merges.size();
        std::vector<int32_t> new_id = iota(leaves), new_parts;
        new_id.resize(leaves + merges, -1);
        for (size_t m = 0; m < merges; ++m) {
            if (label[leaves + m] < 0) continue;
            Merge merge = tree_.merges[m];
            merge.left = new_id[idx(merge.left)];
            merge.right = new_id[idx(merge.right)];
            new_id[leaves + m] = static_cast<int32_t>(leaves + result_.tree.merges.size());
            result_.tree.merges.push_back(merge);
        }
        for (const int32_t c : parts) new_parts.push_back(new_id[idx(c)]);
        return new_parts;
    }

    double union_hull_volume(const Pair& pair) {
        const auto [small, large] = std::minmax(parts_[pair.a].hull, parts_[pair.b].hull, has_fewer_facets);
        return kernel_.union_volume(large, small.vertices()).volume / parts_.volume_unit;
    }

    // hull_volume: of both parts together, or a lower bound.
    double pair_cost(const Pair& pair, double hull_volume, bool is_exact) {
        const auto features = as_array(pair_features(parts_, pair, hull_volume));
        if (trace_ && is_exact) trace_->pairs.push_back({pair.a, pair.b, features});
        // Single precision: pairs that are equal by symmetry tie despite the rounding errors of their features.
        return static_cast<double>(static_cast<float>(pair_cost_(features))) + mark_cost(pair);
    }

    double mark_cost(const Pair& pair) const {
        if (!regions_) return 0;
        const int32_t a = parts_[pair.a].group, b = parts_[pair.b].group;
        if (a != b || a == several_groups) return hard_mark_cost;
        return (regions_->has_hints ? hint_cost : crease_cost) * pair.border.marked_share();
    }

    void push(const Pair& pair) {
        queue_.push({pair.cost, static_cast<int32_t>(&pair - parts_.pairs.data())});
    }

    // Queues a pair that is new or has grown at the cost for the smallest possible hull. Pairs rarely become cheaper by
    // growing or with a larger hull, so most of them, the expensive ones, never need their hull.
    void push_at_lower_bound(Pair& pair) {
        const Part &a = parts_[pair.a], &b = parts_[pair.b];
        pair.is_estimate = a.area > 0 && b.area > 0;
        if (pair.is_estimate)
            pair.cost =
                std::max(pair.cost, pair_cost(pair, std::max(pair.hull_volume, a.hull_volume + b.hull_volume), false));
        else  // a part without surface first merges with the neighbor that shares the largest interface
            pair.cost = -no_surface_cost - pair.border.interface / parts_.model.area + no_surface_mark_factor * mark_cost(pair);
        push(pair);
    }

    void push_at_exact_cost(Pair& pair) {
        pair.hull_volume = union_hull_volume(pair);
        pair.cost = pair_cost(pair, pair.hull_volume, true);
        pair.is_estimate = false;
        push(pair);
    }

    // Returns the new node.
    int32_t merge(int32_t ia, int32_t ib, double cost) {
        const auto node = static_cast<int32_t>(parts_.nodes.size());
        parts_.nodes.emplace_back();
        Part &a = parts_[ia], &b = parts_[ib], &u = parts_.nodes.back();
        u.volume = a.volume + b.volume;
        u.area = a.area + b.area;
        u.update_logs();
        u.lowest_tet = std::min(a.lowest_tet, b.lowest_tet);
        u.group = a.group == b.group ? a.group : several_groups;
        u.joins_patches = a.joins_patches || b.joins_patches;
        u.own_cost = std::clamp(cost, -max_cost, max_cost);
        u.subtree_cost = std::max({u.own_cost, a.subtree_cost, b.subtree_cost});
        u.rejected_merges = a.rejected_merges + b.rejected_merges + (u.own_cost > 0 && u.own_cost < max_cost);
        u.hull = kernel_.unite(a.hull, b.hull);
        u.hull_volume = u.hull.volume() / parts_.volume_unit;
        u.cluster = static_cast<int32_t>(mesh_.tetrahedra.size() + result_.tree.merges.size());
        const Part &left = a.lowest_tet < b.lowest_tet ? a : b, &right = a.lowest_tet < b.lowest_tet ? b : a;
        result_.tree.merges.push_back({left.cluster, right.cluster,
                                       ranked_concavity(u.hull.volume(), u.volume * parts_.volume_unit), u.hull.volume()});
        children_.push_back({ia, ib});

        for (const int32_t child : {ia, ib})
            for (const int32_t p : parts_[child].pairs) {
                Pair& pair = parts_.pairs[idx(p)];
                if (!pair.is_alive) continue;
                const int32_t neighbor = pair.a == child ? pair.b : pair.a;
                int32_t& first_pair = pair_with_[idx(neighbor)];
                if (neighbor == ia || neighbor == ib) {
                    pair.is_alive = false;
                    u.joins_patches |= pair.border.marked_share() > min_marked_share;
                } else if (first_pair < 0) {
                    first_pair = p;
                    pair.a = neighbor;
                    pair.b = node;
                    u.pairs.push_back(p);
                } else {
                    Pair& united = parts_.pairs[idx(first_pair)];
                    united.border += pair.border;
                    united.hull_volume = std::max(united.hull_volume, pair.hull_volume);
                    united.cost = std::min(united.cost, pair.cost);
                    pair.is_alive = false;
                }
            }
        for (const int32_t p : u.pairs) {
            pair_with_[idx(parts_.pairs[idx(p)].a)] = -1;
            u.border += parts_.pairs[idx(p)].border;
        }
        a.parent = b.parent = node;
        a.sibling = ib;
        b.sibling = ia;
        a.hull = Hull();
        b.hull = Hull();
        return node;
    }

    void merge_neighbors() {
        for (Pair& pair : parts_.pairs) push_at_lower_bound(pair);
        if (trace_)  // fitting also needs the exact features of expensive pairs
            for (const Pair& pair : parts_.pairs)
                if (pair.is_estimate) pair_cost(pair, union_hull_volume(pair), true);
        while (!queue_.empty()) {
            const auto [cost, id] = queue_.top();
            queue_.pop();
            Pair& pair = parts_.pairs[idx(id)];
            if (!pair.is_alive || pair.cost != cost) continue;
            if (pair.is_estimate) {
                push_at_exact_cost(pair);
                continue;
            }
            for (const int32_t p : parts_[merge(pair.a, pair.b, pair.cost)].pairs) push_at_lower_bound(parts_.pairs[idx(p)]);
            const size_t merges = parts_.nodes.size() - parts_.initial_count;
            progress_.advance(0.2 + 0.8 * static_cast<double>(merges) / static_cast<double>(parts_.initial_count));
        }
    }

    // In the order of the paper's tree.
    void merge_components() {
        const size_t leaves = mesh_.tetrahedra.size(), merges = tree_.merges.size(), last_merges = tree_.components - 1;
        std::vector<int32_t> component(leaves, -1);  // node, by the lowest tetrahedron
        for (size_t p = 0; p < parts_.nodes.size(); ++p)
            if (parts_.nodes[p].parent < 0) component[idx(parts_.nodes[p].lowest_tet)] = static_cast<int32_t>(p);
        std::vector<int32_t> lowest_tet = iota(leaves);
        for (size_t m = 0; m < merges; ++m) {
            const int32_t a = lowest_tet[idx(tree_.merges[m].left)], b = lowest_tet[idx(tree_.merges[m].right)];
            lowest_tet.push_back(std::min(a, b));
            if (m + last_merges < merges) continue;
            merge(component[idx(a)], component[idx(b)], max_cost);
            component[idx(lowest_tet.back())] = static_cast<int32_t>(parts_.nodes.size()) - 1;
        }
    }

    ScoredTree take_result(const std::vector<double>& scores) {
        std::vector<double> cluster_score(mesh_.tetrahedra.size() + result_.tree.merges.size());
        for (size_t n = 0; n < scores.size(); ++n) cluster_score[idx(parts_.nodes[n].cluster)] = scores[n];
        for (const int32_t c : cut_undoing_last(result_.tree.merges, parts_.initial_count))
            result_.scores.push_back(cluster_score[idx(c)]);
        result_.scores.insert(result_.scores.end(),
                              cluster_score.end() - static_cast<std::ptrdiff_t>(parts_.initial_count - 1),
                              cluster_score.end());
        return std::move(result_);
    }

    const TetMesh& mesh_;
    std::span<const SurfaceEdge> edges_;
    const BinaryTree& tree_;
    Progress& progress_;
    const Regions* regions_;
    Mlp pair_cost_, node_logit_;
    MergeTrace* trace_;
    HullKernel kernel_;
    Parts parts_;
    std::vector<std::array<int32_t, 2>> children_;  // of each merge
    // (cost, pair); an entry is stale if its cost is no longer the pair's.
    std::priority_queue<std::pair<double, int32_t>, std::vector<std::pair<double, int32_t>>, std::greater<>> queue_;
    std::vector<int32_t> pair_with_;  // of each part, scratch of merge()
    ScoredTree result_;
};

// Symmetric in these planes; unchanged if that would cost patches too much of their nodes. is_chosen: of each patch, whether
// it has a node.
PartTree make_symmetric(const TetMesh& mesh, std::span<const Plane> planes, const PartTree& tree,
                        std::span<const double> tet_scores, const Regions* regions, std::vector<uint8_t> is_chosen,
                        Progress& progress) {
    const bool has_hints = regions && regions->has_hints;
    PartTree symmetric = mirror_tree(mesh, planes, tree, tet_scores, progress, regions);
    symmetric = reassign_small_components(mesh, symmetric, progress, has_hints ? regions : nullptr);
    if (has_hints) {
        const std::vector<int32_t> patch_of = patches_of_parts(mesh, symmetric, *regions);
        choose_images(symmetric, patch_of, is_chosen);
        symmetric = insert_patches(symmetric, patch_of, is_chosen);
    }
    if (!regions) return symmetric;
    std::map<int32_t, double> kept = patch_overlaps(mesh, symmetric, regions->patches());
    double lost = 0;  // what large patches gain doesn't make up for small ones
    for (const auto& [patch, overlap] : patch_overlaps(mesh, tree, regions->patches()))
        lost += std::max(0.0, overlap - kept[patch]);
    return lost > max_lost_overlap ? tree : symmetric;
}

}  // namespace

ScoredTree merge_parts(const TetMesh& mesh, const BinaryTree& tree, std::span<const Plane> planes, Progress& progress,
                       std::span<const double> pair_weights, MergeTrace* trace, const Regions* regions) {
    if (tree.merges.empty()) return {tree, {1.0}};
    const std::span<const double> weights = pair_weights.empty() ? pair_network : pair_weights;
    const std::vector<SurfaceEdge> edges = compute_surface_edges(mesh, regions);
    progress.advance(0);
    PartMerger by_cost(mesh, edges, tree, progress, regions, weights, trace);
    PartTree merged = by_cost.merge_by_cost();
    const std::vector<double> scores = by_cost.compute_scores();
    const std::vector<int32_t> best_cut = by_cost.best_cut(scores);
    std::vector<double> tet_scores;
    for (const int32_t p : merged.label) tet_scores.push_back(scores[idx(best_cut[idx(p)])]);
    std::vector<int32_t> limb_of = best_cut;
    std::ranges::replace_if(limb_of, [&](int32_t n) { return scores[idx(n)] < min_limb_score; }, -1);
    std::vector<uint8_t> is_chosen;
    if (regions && regions->has_hints) {
        const std::vector<int32_t> patch_of = patches_of_parts(mesh, merged, *regions);
        is_chosen = choose_patches(merged, patch_of, by_cost.areas(), scores, regions->mean_strengths());
        merged = insert_patches(merged, patch_of, is_chosen);
    }
    const PartTree snapped = snap_borders(mesh, merged, limb_of, progress, regions);
    const PartTree last =
        planes.empty() ? snapped : make_symmetric(mesh, planes, snapped, tet_scores, regions, is_chosen, progress);
    if (trace) {
        trace->first = merged;
        trace->last = last;
        trace->nodes.clear();
    }
    const std::vector<int32_t> aligned = regions ? last.label : align_borders(mesh, planes, last, tet_scores, progress);
    return PartMerger(mesh, edges, tree, progress, regions, weights, trace).rebuild(last, aligned, by_cost.merges_within_parts());
}

}  // namespace partwheel
