// The parts joined bottom-up, the likeliest pair first, then the components; and what that makes of the tree.
#include "tree/regroup/fitted.h"
#include "tree/regroup/parts.h"

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
    Regrouping(const TetMesh& mesh, const BinaryTree& tree, Progress& progress, std::span<const double> pair_numbers,
               RegroupTrace* trace)
        : mesh_(mesh), tree_(tree), progress_(progress), pair_numbers_(pair_numbers), trace_(trace),
          kernel_(mesh.vertices) {}
    Regrouped run();

private:
    void take_parts();
    double hull_volume(const Pair& pair);
    double cost(const Pair& pair, double hull, bool exact);
    void enter(Pair& pair);
    void price(Pair& pair);
    void join(int32_t a, int32_t b, double cost);
    void join_neighbours();
    void join_components();
    std::vector<double> scores() const;

    const TetMesh& mesh_;
    const BinaryTree& tree_;
    Progress& progress_;
    std::span<const double> pair_numbers_;
    RegroupTrace* trace_;
    HullKernel kernel_;
    Parts parts_;
    // By cost, then number; those whose cost is not the pair's any more count no longer.
    std::priority_queue<std::pair<double, int32_t>, std::vector<std::pair<double, int32_t>>, std::greater<>> queue_;
    std::vector<int32_t> pair_with_;  // scratch of join()
    Regrouped result_;
};

// Chooses and measures the parts; what stays of the paper's tree, below them, gets new numbers.
void Regrouping::take_parts() {
    const size_t leaves = mesh_.tetrahedra.size(), merges = tree_.merges.size();
    const std::vector<int32_t> chosen = choose_parts(mesh_, tree_);
    std::vector<int32_t> part_of(leaves + merges, -1), number(leaves + merges, -1);
    for (size_t p = 0; p < chosen.size(); ++p) part_of[at(chosen[p])] = static_cast<int32_t>(p);
    hand_down(tree_.merges, leaves, part_of);
    parts_ = measure_parts(mesh_, part_of, chosen.size(), tree_.merges.back().hull_volume, kernel_, progress_);
    if (trace_) trace_->part_of_tetrahedron.assign(part_of.data(), part_of.data() + leaves);

    result_.tree.components = tree_.components;
    std::iota(number.begin(), number.begin() + static_cast<std::ptrdiff_t>(leaves), 0);
    for (size_t m = 0; m < merges; ++m) {
        if (part_of[leaves + m] < 0) continue;
        Merge merge = tree_.merges[m];
        merge.left = number[at(merge.left)];
        merge.right = number[at(merge.right)];
        number[leaves + m] = static_cast<int32_t>(leaves + result_.tree.merges.size());
        result_.tree.merges.push_back(merge);
    }
    for (size_t p = 0; p < chosen.size(); ++p) parts_.all[p].number = number[at(chosen[p])];
    parts_.all.reserve(2 * parts_.fine - 1);  // join() holds references
    pair_with_.assign(2 * parts_.fine - 1, -1);
}

// Of the hull of both parts.
double Regrouping::hull_volume(const Pair& pair) {
    const auto [small, large] = std::minmax(parts_[pair.a].hull, parts_[pair.b].hull, fewer_facets);
    return kernel_.united_volume(large, small.vertices()).volume / parts_.volume_unit;
}

// hull: the volume of the hull of both parts, exact or a guess.
double Regrouping::cost(const Pair& pair, double hull, bool exact) {
    const auto inputs = in_order(measures(parts_, pair, hull));
    if (trace_ && exact) trace_->pairs.push_back({pair.a, pair.b, inputs});
    // Rounded, so that pairs that cost the same by symmetry tie, whatever rounding errors their measures carry.
    return static_cast<double>(static_cast<float>(fitted(pair_numbers_, inputs)));
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

void Regrouping::join(int32_t ia, int32_t ib, double cost) {
    const auto number = static_cast<int32_t>(parts_.all.size());
    parts_.all.emplace_back();
    Part &a = parts_[ia], &b = parts_[ib], &u = parts_.all.back();
    u.volume = a.volume + b.volume;
    u.area = a.area + b.area;
    u.take_logs();
    u.low = std::min(a.low, b.low);
    u.own_cost = std::clamp(cost, -largest_cost, largest_cost);
    u.worst_cost = std::max({u.own_cost, a.worst_cost, b.worst_cost});
    const auto [small, large] = std::minmax(a.hull, b.hull, fewer_facets);
    u.hull = kernel_.unite(large, small.vertices());
    u.hull_volume = u.hull.volume() / parts_.volume_unit;
    u.number = static_cast<int32_t>(mesh_.tetrahedra.size() + result_.tree.merges.size());
    const Part &first = a.low < b.low ? a : b, &second = a.low < b.low ? b : a;
    result_.tree.merges.push_back({first.number, second.number,
                                   ranked_concavity(u.hull.volume(), u.volume * parts_.volume_unit), u.hull.volume()});
    if (trace_) trace_->merges.push_back({ia, ib});

    for (const int32_t old : {ia, ib})
        for (const int32_t p : parts_[old].pairs) {
            Pair& pair = parts_.pairs[at(p)];
            if (!pair.alive) continue;
            const int32_t other = pair.a == old ? pair.b : pair.a;
            int32_t& twin = pair_with_[at(other)];
            if (other == ia || other == ib) {
                pair.alive = false;
            } else if (twin < 0) {
                twin = p;
                pair.a = other;
                pair.b = number;
                u.pairs.push_back(p);
            } else {
                Pair& kept = parts_.pairs[at(twin)];
                kept.border += pair.border;
                kept.hull = std::max(kept.hull, pair.hull);
                kept.cost = std::min(kept.cost, pair.cost);
                pair.alive = false;
            }
        }
    for (const int32_t p : u.pairs) {
        pair_with_[at(parts_.pairs[at(p)].a)] = -1;
        u.rim += parts_.pairs[at(p)].border;
    }
    for (const int32_t p : u.pairs) enter(parts_.pairs[at(p)]);
    a.above = b.above = number;
    a.beside = ib;
    b.beside = ia;
    a.hull = Hull();
    b.hull = Hull();
}

void Regrouping::join_neighbours() {
    for (Pair& pair : parts_.pairs) enter(pair);
    if (trace_)  // fitting needs to see the dear ones too
        for (const Pair& pair : parts_.pairs)
            if (pair.guessed) cost(pair, hull_volume(pair), true);
    while (!queue_.empty()) {
        const auto [cost, number] = queue_.top();
        queue_.pop();
        Pair& pair = parts_.pairs[at(number)];
        if (!pair.alive || pair.cost != cost) continue;
        if (pair.guessed) {
            price(pair);
            continue;
        }
        join(pair.a, pair.b, pair.cost);
        const size_t joined = parts_.all.size() - parts_.fine;
        progress_.advance(0.2 + 0.8 * static_cast<double>(joined) / static_cast<double>(parts_.fine));
    }
}

// As in the paper's tree.
void Regrouping::join_components() {
    const size_t leaves = mesh_.tetrahedra.size(), merges = tree_.merges.size(), joins = tree_.components - 1;
    std::vector<int32_t> component(leaves, -1);  // at its lowest tetrahedron
    for (size_t p = 0; p < parts_.all.size(); ++p)
        if (parts_.all[p].above < 0) component[at(parts_.all[p].low)] = static_cast<int32_t>(p);
    std::vector<int32_t> low(leaves);
    std::iota(low.begin(), low.end(), 0);
    for (size_t m = 0; m < merges; ++m) {
        const int32_t a = low[at(tree_.merges[m].left)], b = low[at(tree_.merges[m].right)];
        low.push_back(std::min(a, b));
        if (m + joins < merges) continue;
        join(component[at(a)], component[at(b)], largest_cost);
        component[at(low.back())] = static_cast<int32_t>(parts_.all.size()) - 1;
    }
}

std::vector<double> Regrouping::scores() const {
    std::vector<double> of_cluster(mesh_.tetrahedra.size() + result_.tree.merges.size());
    for (size_t n = 0; n < parts_.all.size(); ++n) {
        const auto inputs = in_order(measures(parts_, n));
        if (trace_) trace_->nodes.push_back(inputs);
        const double logit = fitted(fitted_node_numbers, inputs);
        of_cluster[at(parts_.all[n].number)] = (1 + logit / (1 + std::abs(logit))) / 2;
    }
    std::vector<double> ordered;
    for (const int32_t c : cut_undoing_last(result_.tree.merges, parts_.fine)) ordered.push_back(of_cluster[at(c)]);
    ordered.insert(ordered.end(), of_cluster.end() - static_cast<std::ptrdiff_t>(parts_.fine - 1), of_cluster.end());
    return ordered;
}

Regrouped Regrouping::run() {
    take_parts();
    join_neighbours();
    join_components();
    result_.scores = scores();
    return std::move(result_);
}

}  // namespace

Regrouped regroup(const TetMesh& mesh, const BinaryTree& tree, Progress& progress,
                  std::span<const double> pair_numbers, RegroupTrace* trace) {
    if (tree.merges.empty()) return {tree, {1.0}};
    const std::span<const double> numbers = pair_numbers.empty() ? fitted_pair_numbers : pair_numbers;
    return Regrouping(mesh, tree, progress, numbers, trace).run();
}

}  // namespace partwheel
