// Merges together with their mirror images.
#include "parts/mirror/mirror_tree.h"

#include "base/adjacency.h"
#include "base/sorted.h"
#include "parts/boundary.h"

namespace partwheel {

namespace {

// Copied parts that no merge reaches dissolve into their neighbors if they have less than this share of the area.
constexpr double max_leftover_share = 0.1;

// With marks: a node across the plane, such as a collar, whose sides differ in area by at most this factor is united
// with its image, because its merge with the old other half is gone.
constexpr double max_imbalance = 2;

class SymmetricMerger {
public:
    SymmetricMerger(const TetLabels& parts, std::span<const double> areas)
        : parent_(areas.size(), -1) {
        for (const double area : areas) areas_.push_back(static_cast<float>(area));
        mirror = parts.mirror;
    }

    // The largest node so far that contains this one; -1 stays.
    int32_t top(int32_t node) const {
        while (node >= 0 && parent_[idx(node)] >= 0) node = parent_[idx(node)];
        return node;
    }

    // Merges connected pairs at once, and likewise their images.
    void merge(std::vector<std::array<int32_t, 2>> pairs, double cost) {
        for (const std::vector<int32_t>& image_of : mirror)
            for (size_t i = 0, n = pairs.size(); i < n; ++i) {
                const std::array<int32_t, 2> image = {image_of[idx(pairs[i][0])], image_of[idx(pairs[i][1])]};
                if (is_top(image[0]) && is_top(image[1]) && image[0] != image[1] &&
                    std::ranges::find(pairs, image) == pairs.end())
                    pairs.push_back(image);
            }
        std::vector<int32_t> members;
        for (const auto& pair : pairs) members.insert(members.end(), pair.begin(), pair.end());
        sort_unique(members);
        const auto position = [&](int32_t node) {
            return static_cast<size_t>(std::ranges::lower_bound(members, node) - members.begin());
        };
        UnionFind sets(members.size());
        for (const auto& pair : pairs) sets.unite(position(pair[0]), position(pair[1]));
        std::map<size_t, std::vector<int32_t>> groups;
        for (size_t i = 0; i < members.size(); ++i) groups[sets.find(i)].push_back(members[i]);
        for (const auto& [set, group] : groups) {
            const auto node = static_cast<int32_t>(parent_.size());
            double area = 0;
            for (const int32_t member : group) {
                parent_[idx(member)] = node;
                area += areas_[idx(member)];
            }
            parent_.push_back(-1);
            areas_.push_back(static_cast<float>(area));
            merges.push_back({connected_order(group, pairs), cost});
        }
        for (std::vector<int32_t>& image_of : mirror) {
            image_of.resize(parent_.size(), -1);
            for (const auto& [set, group] : groups) set_image(image_of, group);
        }
    }

    // Merges the node with those of its images that it doesn't contain yet.
    void merge_with_images(int32_t node, double cost) {
        for (size_t plane = 0; node >= 0 && plane < mirror.size(); ++plane)
            if (const int32_t image = mirror[plane][idx(node)]; is_top(image) && image != node) {
                merge({{node, image}}, cost);
                node = top(node);
            }
    }

    // The nodes that are in no other, largest first.
    std::vector<int32_t> tops() const {
        std::vector<int32_t> nodes;
        for (size_t p = 0; p < parent_.size(); ++p)
            if (parent_[p] < 0) nodes.push_back(static_cast<int32_t>(p));
        std::ranges::stable_sort(nodes, [&](int32_t a, int32_t b) { return areas_[idx(a)] > areas_[idx(b)]; });
        return nodes;
    }

    double area(int32_t node) const { return areas_[idx(node)]; }

    struct GroupMerge {
        std::vector<int32_t> members;
        double cost;
    };
    std::vector<GroupMerge> merges;            // merge i creates node parts + i
    std::vector<std::vector<int32_t>> mirror;  // by plane: the image of each node, or -1

private:
    // The group in an order in which each member forms a pair with an earlier one; the one in most pairs comes first.
    static std::vector<int32_t> connected_order(const std::vector<int32_t>& group,
                                                std::span<const std::array<int32_t, 2>> pairs) {
        const auto pair_count = [&](int32_t member) {
            return std::ranges::count_if(pairs, [&](const auto& pair) { return pair[0] == member || pair[1] == member; });
        };
        std::vector<int32_t> order = {*std::ranges::max_element(group, {}, pair_count)};
        for (size_t i = 0; i < order.size(); ++i)
            for (const auto& [a, b] : pairs)
                for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)})
                    if (from == order[i] && std::ranges::find(order, to) == order.end()) order.push_back(to);
        return order;
    }

    bool is_top(int32_t node) const { return node >= 0 && parent_[idx(node)] < 0; }

    // Takes the image of the group's largest member that has one.
    void set_image(std::vector<int32_t>& image_of, const std::vector<int32_t>& group) const {
        const int32_t node = parent_[idx(group[0])];
        double max_area = -1;
        for (const int32_t member : group) {
            const int32_t image = top(image_of[idx(member)]);
            if (image < 0 || areas_[idx(member)] <= max_area) continue;
            max_area = areas_[idx(member)];
            image_of[idx(node)] = image;
        }
        if (max_area >= 0) image_of[idx(image_of[idx(node)])] = node;
    }

    std::vector<double> areas_;  // in single precision, so that areas that are equal by symmetry tie
    std::vector<int32_t> parent_;
};

// Divides the merges of groups into binary merges.
PartTree binary_tree(const SymmetricMerger& merger, const TetLabels& parts) {
    PartTree result{parts.label, parts.count, {}, {}, {}, {}};
    std::vector<int32_t> new_id = iota(parts.count);  // of each node of the merger
    for (const auto& [members, cost] : merger.merges) {
        int32_t node = new_id[idx(members[0])];
        for (size_t i = 1; i < members.size(); ++i) {
            result.children.push_back({node, new_id[idx(members[i])]});
            result.costs.push_back(cost);
            result.is_intermediate.push_back(i + 1 < members.size());
            node = static_cast<int32_t>(parts.count + result.children.size() - 1);
        }
        new_id.push_back(node);
    }
    for (const std::vector<int32_t>& image_of : merger.mirror)
        result.mirror.push_back(renumber_images(image_of, new_id, parts.count + result.children.size()));
    return result;
}

}  // namespace

PartTree merge_symmetrically(const TetLabels& parts, std::span<const double> areas, const PartTree& old_tree,
                             double max_leftover, std::vector<int32_t>& leftover) {
    SymmetricMerger merger(parts, areas);
    std::vector<int32_t> new_node = parts.new_part;  // of each node of the old tree
    // Likewise, with marks: the area of its parts that are still there, and of those that copies have replaced.
    std::vector<double> kept_area(parts.old_area), lost_area(parts.old_area);
    for (size_t p = 0; p < kept_area.size(); ++p) (parts.new_part[p] < 0 ? kept_area : lost_area)[p] = 0;
    std::vector<std::array<int32_t, 2>> pairs;  // of a merge of several that is not complete
    for (size_t j = 0; j < old_tree.children.size(); ++j) {
        const auto& [left, right] = old_tree.children[j];
        const int32_t a = merger.top(new_node[idx(left)]), b = merger.top(new_node[idx(right)]);
        if (a >= 0 && b >= 0 && a != b) pairs.push_back({a, b});
        new_node.push_back(a >= 0 ? a : b);
        if (!old_tree.is_intermediate[j] && !pairs.empty()) merger.merge(std::exchange(pairs, {}), old_tree.costs[j]);
        if (kept_area.empty()) continue;
        kept_area.push_back(kept_area[idx(left)] + kept_area[idx(right)]);
        lost_area.push_back(lost_area[idx(left)] + lost_area[idx(right)]);
        if (old_tree.is_intermediate[j]) continue;
        if (const auto [less, more] = std::minmax(kept_area.back(), lost_area.back()); less > 0 && more < max_imbalance * less)
            merger.merge_with_images(merger.top(new_node.back()), old_tree.costs[j]);
    }
    // Sides that only meet in a plane merge last, each time together with their images.
    double total_area = 0;
    for (const double area : areas) total_area += area;
    std::vector<int32_t> tops = merger.tops();
    while (tops.size() > 1 && merger.area(tops[1]) >= max_leftover * total_area) {
        merger.merge({{tops[0], tops[1]}}, old_tree.costs.empty() ? 0 : old_tree.costs.back());
        tops = merger.tops();
    }
    leftover.clear();
    if (tops.size() == 1) return binary_tree(merger, parts);
    for (size_t p = 0; p < parts.count; ++p)
        if (merger.top(static_cast<int32_t>(p)) != tops[0]) leftover.push_back(static_cast<int32_t>(p));
    return {};
}

PartTree mirror_tree(const TetMesh& mesh, std::span<const Plane> planes, const PartTree& tree,
                     std::span<const double> scores, Progress& progress, const Regions* regions) {
    TetLabels parts = copy_symmetric_labels(mesh, planes, tree.label, tree.count, scores, progress, regions);
    std::vector<int32_t> leftover;
    for (double max_leftover = max_leftover_share;;) {
        const std::vector<double> areas = surface_areas(mesh, parts.label, parts.count);
        PartTree result = merge_symmetrically(parts, areas, tree, max_leftover, leftover);
        if (leftover.empty()) return result;
        const size_t old_count = parts.count;
        parts = dissolve_parts(mesh, std::move(parts), leftover, progress);
        if (parts.count == old_count) max_leftover = 0;  // none of them has a neighbor
    }
}

std::map<int32_t, double> patch_overlaps(const TetMesh& mesh, const PartTree& tree, std::span<const int32_t> patch_of) {
    std::map<int32_t, double> area, best;  // of each patch
    std::vector<std::map<int32_t, double>> inside(tree.count);  // each node: its area in each patch
    double total = 0;
    for_each_boundary_facet(mesh, [&](size_t t, size_t k) {
        const double size = facet_area(mesh, t, k);
        area[patch_of[t]] += size;
        inside[idx(tree.label[t])][patch_of[t]] += size;
        total += size;
    });
    const auto compare = [&](const std::map<int32_t, double>& node) {
        double size = 0;
        for (const auto& [patch, common] : node) size += common;
        for (const auto& [patch, common] : node)
            best[patch] = std::max(best[patch], common / (size + area[patch] - common));
    };
    for (const auto& part : inside) compare(part);
    for (size_t j = 0; j < tree.children.size(); ++j) {
        std::map<int32_t, double> node = std::move(inside[idx(tree.children[j][0])]);
        for (const auto& [patch, common] : inside[idx(tree.children[j][1])]) node[patch] += common;
        if (!tree.is_intermediate[j]) compare(node);
        inside.push_back(std::move(node));
    }
    for (auto& [patch, overlap] : best) overlap *= area[patch] / total;
    return best;
}

}  // namespace partwheel
