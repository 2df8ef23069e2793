// The parts joined bottom-up, the likeliest pair first, then the components; and what that makes of the tree.
#include "cluster/within.h"
#include "parts/mirror/mirror_tree.h"
#include "parts/merge/network_weights.h"
#include "parts/merge/parts.h"
#include "parts/snap/snap.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>

namespace partwheel {

namespace {

class Regrouping {
public:
    Regrouping(const TetMesh& mesh, std::span<const SurfaceEdge> folds, const BinaryTree& tree, Progress& progress,
               std::span<const double> pair_numbers, MergeTrace* trace)
        : mesh_(mesh), folds_(folds), tree_(tree), progress_(progress), pair_numbers_(pair_numbers), trace_(trace),
          kernel_(mesh.vertices) {}

    std::vector<int32_t> choose();
    void join_by_cost();
    std::vector<double> scores();
    std::vector<double> worth(const std::vector<double>& scores) const;
    PartTree joins(std::vector<int32_t> part_of) const;
    std::span<const Merge> below() const {  // the parts
        return std::span(result_.tree.merges).first(mesh_.tetrahedra.size() - parts_.fine);
    }
    ScoredTree planted(const PartTree& joins, std::span<const Merge> below);
    ScoredTree result(const std::vector<double>& scores);

private:
    void measure(std::span<const int32_t> part_of, std::span<const int32_t> numbers, std::vector<Hull> hulls = {});
    std::vector<int32_t> keep_chosen(std::span<const int32_t> chosen, std::span<const int32_t> part_of);
    double hull_volume(const Pair& pair);
    double cost(const Pair& pair, double hull, bool exact);
    void enter(Pair& pair);
    void price(Pair& pair);
    int32_t join(int32_t a, int32_t b, double cost);
    void join_neighbours();
    void join_components();

    const TetMesh& mesh_;
    std::span<const SurfaceEdge> folds_;
    const BinaryTree& tree_;
    Progress& progress_;
    std::span<const double> pair_numbers_;
    MergeTrace* trace_;
    HullKernel kernel_;
    Parts parts_;
    std::vector<std::array<int32_t, 2>> joined_;  // of which two each part that was not there at first was made
    // By cost, then number; those whose cost is not the pair's any more count no longer.
    std::priority_queue<std::pair<double, int32_t>, std::vector<std::pair<double, int32_t>>, std::greater<>> queue_;
    std::vector<int32_t> pair_with_;  // scratch of join()
    ScoredTree result_;
};

// Clusters of the paper's tree become parts.
std::vector<int32_t> Regrouping::choose() {
    const size_t leaves = mesh_.tetrahedra.size();
    const std::vector<int32_t> chosen = choose_initial_parts(mesh_, tree_);
    std::vector<int32_t> part_of(leaves + tree_.merges.size(), -1);
    for (size_t p = 0; p < chosen.size(); ++p) part_of[idx(chosen[p])] = static_cast<int32_t>(p);
    propagate_to_leaves(tree_.merges, leaves, part_of);
    const std::vector<int32_t> numbers = keep_chosen(chosen, part_of);
    part_of.resize(leaves);
    measure(part_of, numbers);
    return part_of;
}

void Regrouping::measure(std::span<const int32_t> part_of, std::span<const int32_t> numbers, std::vector<Hull> hulls) {
    parts_ = compute_part_features(mesh_, folds_, part_of, numbers.size(), tree_.merges.back().hull_volume, std::move(hulls),
                           kernel_, progress_);
    for (size_t p = 0; p < numbers.size(); ++p) parts_.all[p].number = numbers[p];
    result_.tree.components = tree_.components;
    parts_.all.reserve(2 * parts_.fine - 1);  // join() holds references
    pair_with_.assign(2 * parts_.fine - 1, -1);
}

// What stays of the paper's tree, below the parts chosen, gets new numbers. Returns those of the parts.
std::vector<int32_t> Regrouping::keep_chosen(std::span<const int32_t> chosen, std::span<const int32_t> part_of) {
    const size_t leaves = mesh_.tetrahedra.size(), merges = tree_.merges.size();
    std::vector<int32_t> number(leaves + merges, -1), of_chosen;
    std::iota(number.begin(), number.begin() + static_cast<std::ptrdiff_t>(leaves), 0);
    for (size_t m = 0; m < merges; ++m) {
        if (part_of[leaves + m] < 0) continue;
        Merge merge = tree_.merges[m];
        merge.left = number[idx(merge.left)];
        merge.right = number[idx(merge.right)];
        number[leaves + m] = static_cast<int32_t>(leaves + result_.tree.merges.size());
        result_.tree.merges.push_back(merge);
    }
    for (const int32_t c : chosen) of_chosen.push_back(number[idx(c)]);
    return of_chosen;
}

// Of the hull of both parts.
double Regrouping::hull_volume(const Pair& pair) {
    const auto [small, large] = std::minmax(parts_[pair.a].hull, parts_[pair.b].hull, has_fewer_facets);
    return kernel_.union_volume(large, small.vertices()).volume / parts_.volume_unit;
}

// hull: the volume of the hull of both parts, exact or a guess.
double Regrouping::cost(const Pair& pair, double hull, bool exact) {
    const auto inputs = in_order(measures(parts_, pair, hull));
    if (trace_ && exact) trace_->pairs.push_back({pair.a, pair.b, inputs});
    // Rounded, so that pairs that cost the same by symmetry tie, whatever rounding errors their measures carry.
    return static_cast<double>(static_cast<float>(mlp_forward(pair_numbers_, inputs)));
}

// Enters a pair, new or grown, by what it would cost if its hull were as small as it can be. Pairs seldom get cheaper
// by growing, or by a larger hull: so the dear ones, which are most, never need their hull.
void Regrouping::enter(Pair& pair) {
    const Part &a = parts_[pair.a], &b = parts_[pair.b];
    pair.guessed = a.area > 0 && b.area > 0;
    if (pair.guessed)
        pair.cost = std::max(pair.cost, cost(pair, std::max(pair.hull, a.hull_volume + b.hull_volume), false));
    else  // without any surface it is no part: it goes first, with the neighbour that it shares most with
        pair.cost = -1e6 - pair.border.interface / parts_.whole.area;
    queue_.push({pair.cost, static_cast<int32_t>(&pair - parts_.pairs.data())});
}

// What it does cost.
void Regrouping::price(Pair& pair) {
    pair.hull = hull_volume(pair);
    pair.cost = cost(pair, pair.hull, true);
    pair.guessed = false;
    queue_.push({pair.cost, static_cast<int32_t>(&pair - parts_.pairs.data())});
}

int32_t Regrouping::join(int32_t ia, int32_t ib, double cost) {
    const auto number = static_cast<int32_t>(parts_.all.size());
    parts_.all.emplace_back();
    Part &a = parts_[ia], &b = parts_[ib], &u = parts_.all.back();
    u.volume = a.volume + b.volume;
    u.area = a.area + b.area;
    u.take_logs();
    u.low = std::min(a.low, b.low);
    u.own_cost = std::clamp(cost, -largest_cost, largest_cost);
    u.worst_cost = std::max({u.own_cost, a.worst_cost, b.worst_cost});
    u.dear = a.dear + b.dear + (u.own_cost > 0 && u.own_cost < largest_cost);
    const auto [small, large] = std::minmax(a.hull, b.hull, has_fewer_facets);
    u.hull = kernel_.unite(large, small.vertices());
    u.hull_volume = u.hull.volume() / parts_.volume_unit;
    u.number = static_cast<int32_t>(mesh_.tetrahedra.size() + result_.tree.merges.size());
    const Part &first = a.low < b.low ? a : b, &second = a.low < b.low ? b : a;
    result_.tree.merges.push_back({first.number, second.number,
                                   ranked_concavity(u.hull.volume(), u.volume * parts_.volume_unit), u.hull.volume()});
    joined_.push_back({ia, ib});

    for (const int32_t old : {ia, ib})
        for (const int32_t p : parts_[old].pairs) {
            Pair& pair = parts_.pairs[idx(p)];
            if (!pair.alive) continue;
            const int32_t other = pair.a == old ? pair.b : pair.a;
            int32_t& twin = pair_with_[idx(other)];
            if (other == ia || other == ib) {
                pair.alive = false;
            } else if (twin < 0) {
                twin = p;
                pair.a = other;
                pair.b = number;
                u.pairs.push_back(p);
            } else {
                Pair& kept = parts_.pairs[idx(twin)];
                kept.border += pair.border;
                kept.hull = std::max(kept.hull, pair.hull);
                kept.cost = std::min(kept.cost, pair.cost);
                pair.alive = false;
            }
        }
    for (const int32_t p : u.pairs) {
        pair_with_[idx(parts_.pairs[idx(p)].a)] = -1;
        u.rim += parts_.pairs[idx(p)].border;
    }
    a.above = b.above = number;
    a.beside = ib;
    b.beside = ia;
    a.hull = Hull();
    b.hull = Hull();
    return number;
}

void Regrouping::join_neighbours() {
    for (Pair& pair : parts_.pairs) enter(pair);
    if (trace_)  // fitting needs to see the dear ones too
        for (const Pair& pair : parts_.pairs)
            if (pair.guessed) cost(pair, hull_volume(pair), true);
    while (!queue_.empty()) {
        const auto [cost, number] = queue_.top();
        queue_.pop();
        Pair& pair = parts_.pairs[idx(number)];
        if (!pair.alive || pair.cost != cost) continue;
        if (pair.guessed) {
            price(pair);
            continue;
        }
        for (const int32_t p : parts_[join(pair.a, pair.b, pair.cost)].pairs) enter(parts_.pairs[idx(p)]);
        const size_t joined = parts_.all.size() - parts_.fine;
        progress_.advance(0.2 + 0.8 * static_cast<double>(joined) / static_cast<double>(parts_.fine));
    }
}

// As in the paper's tree.
void Regrouping::join_components() {
    const size_t leaves = mesh_.tetrahedra.size(), merges = tree_.merges.size(), joins = tree_.components - 1;
    std::vector<int32_t> component(leaves, -1);  // at its lowest tetrahedron
    for (size_t p = 0; p < parts_.all.size(); ++p)
        if (parts_.all[p].above < 0) component[idx(parts_.all[p].low)] = static_cast<int32_t>(p);
    std::vector<int32_t> low(leaves);
    std::iota(low.begin(), low.end(), 0);
    for (size_t m = 0; m < merges; ++m) {
        const int32_t a = low[idx(tree_.merges[m].left)], b = low[idx(tree_.merges[m].right)];
        low.push_back(std::min(a, b));
        if (m + joins < merges) continue;
        join(component[idx(a)], component[idx(b)], largest_cost);
        component[idx(low.back())] = static_cast<int32_t>(parts_.all.size()) - 1;
    }
}

void Regrouping::join_by_cost() {
    join_neighbours();
    join_components();
}

// The score of each part, also of those that were joined.
std::vector<double> Regrouping::scores() {
    summarize_subtrees(parts_);
    std::vector<double> all;
    for (size_t n = 0; n < parts_.all.size(); ++n) {
        const auto inputs = in_order(measures(parts_, n));
        if (trace_) trace_->nodes.push_back(inputs);
        const double logit = mlp_forward(fitted_node_numbers, inputs);
        all.push_back((1 + logit / (1 + std::abs(logit))) / 2);
    }
    return all;
}

// What each part at first is worth: the score of what it lies in, where the surface is cut so that scores are best.
std::vector<double> Regrouping::worth(const std::vector<double>& scores) const {
    std::vector<double> best, value(scores);
    for (size_t n = 0; n < parts_.all.size(); ++n) best.push_back(parts_.all[n].area * scores[n]);
    for (size_t j = 0; j < joined_.size(); ++j) {
        const double apart = best[idx(joined_[j][0])] + best[idx(joined_[j][1])];
        double& whole = best[parts_.fine + j];
        if (apart > whole) {
            whole = apart;
            value[parts_.fine + j] = -1;  // divided
        }
    }
    for (size_t j = joined_.size(); j-- > 0;)
        if (const double of_both = value[parts_.fine + j]; of_both >= 0)
            for (const int32_t half : joined_[j]) value[idx(half)] = of_both;
    value.resize(parts_.fine);
    return value;
}

// What was joined, and in which order.
PartTree Regrouping::joins(std::vector<int32_t> part_of) const {
    PartTree joins{std::move(part_of), parts_.fine, joined_, {}, std::vector<uint8_t>(joined_.size(), 0), {}};
    for (size_t j = 0; j < joined_.size(); ++j) joins.costs.push_back(parts_.all[parts_.fine + j].own_cost);
    return joins;
}

// Other parts joined in a given order. below: the merges that made the parts at first, which stay as far as they can.
ScoredTree Regrouping::planted(const PartTree& joins, std::span<const Merge> below) {
    RestrictedTree within = restrict_tree_to_labels(mesh_, below, joins.of, joins.count, kernel_);
    result_.tree.merges = std::move(within.merges);
    std::vector<int32_t> numbers;
    std::vector<Hull> hulls;
    for (Subtree& part : within.parts) {
        numbers.push_back(part.cluster);
        hulls.push_back(std::move(part.hull));
    }
    measure(joins.of, numbers, std::move(hulls));
    for (size_t j = 0; j < joins.joined.size(); ++j) join(joins.joined[j][0], joins.joined[j][1], joins.costs[j]);
    // What is beside or above a step is so to what it is a step to.
    const auto step = [&](int32_t n) { return idx(n) >= joins.count && joins.steps[idx(n) - joins.count]; };
    for (Part& part : parts_.all)
        while (part.above >= 0 && step(part.above)) part.above = parts_[part.above].above;
    // Images score the same.
    const std::vector<double> own = scores();
    std::vector<double> shared = own;
    for (size_t n = 0; n < own.size(); ++n) {
        std::vector<int32_t> all = {static_cast<int32_t>(n)};
        for (const std::vector<int32_t>& image : joins.images)
            for (size_t i = 0, before = all.size(); i < before; ++i)
                if (const int32_t there = image[idx(all[i])]; there >= 0 && std::ranges::find(all, there) == all.end())
                    all.push_back(there);
        std::ranges::sort(all);
        double sum = 0;
        for (const int32_t each : all) sum += own[idx(each)];
        shared[n] = step(static_cast<int32_t>(n)) ? 0 : sum / static_cast<double>(all.size());
    }
    return result(shared);
}

ScoredTree Regrouping::result(const std::vector<double>& scores) {
    std::vector<double> of_cluster(mesh_.tetrahedra.size() + result_.tree.merges.size());
    for (size_t n = 0; n < scores.size(); ++n) of_cluster[idx(parts_.all[n].number)] = scores[n];
    for (const int32_t c : cut_undoing_last(result_.tree.merges, parts_.fine))
        result_.scores.push_back(of_cluster[idx(c)]);
    result_.scores.insert(result_.scores.end(), of_cluster.end() - static_cast<std::ptrdiff_t>(parts_.fine - 1),
                          of_cluster.end());
    return std::move(result_);
}

}  // namespace

ScoredTree merge_parts(const TetMesh& mesh, const BinaryTree& tree, std::span<const Plane> planes, Progress& progress,
                  std::span<const double> pair_numbers, MergeTrace* trace) {
    if (tree.merges.empty()) return {tree, {1.0}};
    const std::span<const double> numbers = pair_numbers.empty() ? fitted_pair_numbers : pair_numbers;
    const std::vector<SurfaceEdge> folds = surface_edges(mesh);
    progress.advance(0);
    Regrouping by_cost(mesh, folds, tree, progress, numbers, trace);
    const std::vector<int32_t> part_of = by_cost.choose();
    by_cost.join_by_cost();
    const PartTree first = by_cost.joins(part_of);
    const std::vector<double> of_parts = by_cost.worth(by_cost.scores());
    std::vector<double> worth;
    for (const int32_t p : part_of) worth.push_back(of_parts[idx(p)]);
    PartTree last = mirror_tree(mesh, planes, snapped(mesh, first, progress), worth, progress);
    if (!planes.empty()) last = reassign_small_components(mesh, last, progress);
    if (trace) {
        trace->first = first;
        trace->last = last;
        trace->nodes.clear();
    }
    return Regrouping(mesh, folds, tree, progress, numbers, trace).planted(last, by_cost.below());
}

}  // namespace partwheel
