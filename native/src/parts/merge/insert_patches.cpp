// Both passes go through the tree from the parts up, and keep what lies in each patch until a node contains all of it.
#include "parts/merge/insert_patches.h"

#include "parts/majority.h"

namespace partwheel {

namespace {

// A patch must not divide a node with more than this share of its score: good limbs stay.
constexpr double max_divided_score = 0.55;

// The number of parts of each patch.
std::vector<size_t> count_parts(std::span<const int32_t> patch_of, size_t patches) {
    std::vector<size_t> count(patches, 0);
    for (const int32_t patch : patch_of)
        if (patch >= 0) ++count[idx(patch)];
    return count;
}

// Extends the mirror images of the parts to all nodes: the image of a node has the images of its children.
void map_images(PartTree& tree) {
    const auto full_parent = [&](const std::vector<int32_t>& parent, int32_t n) {
        n = parent[idx(n)];
        while (n >= 0 && tree.is_intermediate[idx(n) - tree.count]) n = parent[idx(n)];
        return n;
    };
    const size_t nodes = tree.count + tree.children.size();
    std::vector<int32_t> parent(nodes, -1);
    for (size_t j = 0; j < tree.children.size(); ++j)
        for (const int32_t child : tree.children[j]) parent[idx(child)] = static_cast<int32_t>(tree.count + j);
    constexpr int32_t differ = -2;
    for (std::vector<int32_t>& image : tree.mirror) {
        image.resize(tree.count);
        std::ranges::replace_if(image, [&](int32_t n) { return n >= static_cast<int32_t>(tree.count); }, -1);
        image.resize(nodes, -1);
        for (size_t n = 0; n < nodes; ++n) {
            if (image[n] == differ || (n >= tree.count && tree.is_intermediate[n - tree.count])) image[n] = -1;
            const int32_t p = full_parent(parent, static_cast<int32_t>(n));
            if (image[n] < 0 || p < 0) continue;
            const int32_t q = full_parent(parent, image[n]);
            image[idx(p)] = image[idx(p)] == -1 || image[idx(p)] == q ? q : differ;
        }
    }
}

class PatchInserter {
public:
    PatchInserter(const PartTree& tree, std::span<const int32_t> patch_of, std::span<const uint8_t> is_chosen)
        : tree_(tree), parts_(count_parts(patch_of, is_chosen.size())), result_{tree.label, tree.count, {}, {}, {}, tree.mirror} {
        for (size_t p = 0; p < tree.count; ++p) {
            const int32_t patch = patch_of[p], node = static_cast<int32_t>(p);
            if (patch >= 0 && is_chosen[idx(patch)] && parts_[idx(patch)] > 1)
                pieces_.push_back({-1, {{patch, {node, 1}}}});
            else
                pieces_.push_back({node, {}});
        }
    }

    PartTree run() {
        for (size_t j = 0; j < tree_.children.size(); ++j) merge(j);
        map_images(result_);
        return std::move(result_);
    }

private:
    struct Piece {
        int32_t node = -1;
        size_t parts = 0;
    };
    struct Pieces {
        int32_t outside = -1;
        std::map<int32_t, Piece> inside;  // by patch
    };

    void merge(size_t j) {
        const bool is_intermediate = tree_.is_intermediate[j];
        Pieces &a = pieces_[idx(tree_.children[j][0])], &b = pieces_[idx(tree_.children[j][1])];
        Pieces united{join(a.outside, b.outside, j, is_intermediate), std::move(a.inside)};
        for (const auto& [patch, piece] : std::exchange(b.inside, {})) {
            Piece& sum = united.inside[patch];
            sum = {join(sum.node, piece.node, j, is_intermediate), sum.parts + piece.parts};
        }
        if (!is_intermediate) {
            set_full(united.outside);
            for (const auto& [patch, piece] : united.inside) set_full(piece.node);
            unite_whole_patches(united, j);
        }
        pieces_.push_back(std::move(united));
    }

    // With the rest of the node, in one merge: symmetric patches must not be divided by the order of their merges.
    void unite_whole_patches(Pieces& node, size_t j) {
        std::vector<int32_t> whole;
        std::erase_if(node.inside, [&](const auto& piece) {
            const bool is_whole = piece.second.parts == parts_[idx(piece.first)];
            if (is_whole) whole.push_back(piece.second.node);
            return is_whole;
        });
        for (size_t i = 0; i < whole.size(); ++i) node.outside = join(node.outside, whole[i], j, i + 1 < whole.size());
    }

    // For the old merge j. A single child replaces the merge.
    int32_t join(int32_t a, int32_t b, size_t j, bool is_intermediate) {
        if (a < 0 || b < 0) return std::max(a, b);
        result_.children.push_back({a, b});
        result_.costs.push_back(tree_.costs[j]);
        result_.is_intermediate.push_back(is_intermediate);
        return static_cast<int32_t>(tree_.count + result_.children.size()) - 1;
    }

    // The last merge of several may have had nothing to add to a piece.
    void set_full(int32_t node) {
        if (node >= static_cast<int32_t>(tree_.count)) result_.is_intermediate[idx(node) - tree_.count] = 0;
    }

    const PartTree& tree_;
    const std::vector<size_t> parts_;  // of each patch
    PartTree result_;
    std::vector<Pieces> pieces_;  // of each node of the tree
};

}  // namespace

std::vector<int32_t> patches_of_parts(const TetMesh& mesh, const PartTree& tree, const Regions& regions) {
    std::vector<int32_t> patch_of = majority_patches(mesh, tree.label, tree.count, regions.patches());
    std::vector<uint8_t> has_surface(tree.count, 0);
    for_each_boundary_facet(mesh, [&](size_t t, size_t) { has_surface[idx(tree.label[t])] = 1; });
    join_inner_parts(tree, has_surface, patch_of);
    return patch_of;
}

void join_inner_parts(const PartTree& tree, std::span<const uint8_t> has_surface, std::span<int32_t> patch_of) {
    std::vector<int32_t> at_surface;  // of each node: one of its parts with surface; -1: it has none
    for (size_t p = 0; p < tree.count; ++p) at_surface.push_back(has_surface[p] ? static_cast<int32_t>(p) : -1);
    for (const auto& [a, b] : tree.children) at_surface.push_back(std::max(at_surface[idx(a)], at_surface[idx(b)]));
    for (size_t j = tree.children.size(); j-- > 0;)  // nodes without one take that of the node around them
        for (const int32_t child : tree.children[j])
            if (at_surface[idx(child)] < 0) at_surface[idx(child)] = at_surface[tree.count + j];
    for (size_t p = 0; p < tree.count; ++p)
        if (at_surface[p] >= 0) patch_of[p] = patch_of[idx(at_surface[p])];
}

std::vector<uint8_t> choose_patches(const PartTree& tree, std::span<const int32_t> patch_of, std::span<const double> areas,
                                    std::span<const double> scores, std::span<const double> strengths) {
    struct Inside {
        double area = 0;
        size_t parts = 0;
    };
    std::vector<double> best_divided(strengths.size(), 0);
    const std::vector<size_t> parts = count_parts(patch_of, best_divided.size());
    std::vector<std::map<int32_t, Inside>> inside(tree.count);  // each node, by patch
    for (size_t p = 0; p < tree.count; ++p)
        if (patch_of[p] >= 0) inside[p][patch_of[p]] = {areas[p], 1};
    for (size_t j = 0; j < tree.children.size(); ++j) {
        const size_t n = tree.count + j;
        const auto& [a, b] = tree.children[j];
        std::map<int32_t, Inside> united = std::move(inside[idx(a)]);
        for (const auto& [patch, piece] : std::exchange(inside[idx(b)], {})) {
            united[patch].area += piece.area;
            united[patch].parts += piece.parts;
        }
        std::erase_if(united, [&](const auto& piece) { return piece.second.parts == parts[idx(piece.first)]; });
        for (const auto& [patch, piece] : united)
            if (std::max(piece.area, areas[n] - piece.area) < same_look * areas[n])
                best_divided[idx(patch)] = std::max(best_divided[idx(patch)], scores[n]);
        inside.push_back(std::move(united));
    }
    std::vector<uint8_t> is_chosen;
    for (size_t patch = 0; patch < parts.size(); ++patch)
        is_chosen.push_back(best_divided[patch] < max_divided_score * mark_score(strengths[patch]));
    return is_chosen;
}

PartTree insert_patches(const PartTree& tree, std::span<const int32_t> patch_of, std::span<const uint8_t> is_chosen) {
    return PatchInserter(tree, patch_of, is_chosen).run();
}

void choose_images(const PartTree& tree, std::span<const int32_t> patch_of, std::vector<uint8_t>& is_chosen) {
    for (const std::vector<int32_t>& image : tree.mirror)
        for (size_t p = 0; p < tree.count; ++p) {
            const int32_t q = image[p];
            if (q < 0 || idx(q) >= tree.count || patch_of[p] < 0 || patch_of[idx(q)] < 0) continue;
            is_chosen[idx(patch_of[idx(q)])] |= is_chosen[idx(patch_of[p])];
        }
}

}  // namespace partwheel
