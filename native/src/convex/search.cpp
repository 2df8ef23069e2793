// The search for convex parts.
#include "convex/search.h"

namespace partwheel::convex {

namespace {

constexpr double min_gain = 1e-5;  // of the total volume: less may come from the perturbation of points, see pieces.cpp
constexpr size_t max_growth = 8;   // of the number of tetrahedra: planes cut them into ever smaller ones
// Relative to the total volume: pairs whose hulls exceed their solid by less stay as they are.
constexpr double min_excess = 0.003;
constexpr double tie = 1e-6;  // of the weight of concave edges
constexpr size_t max_rounds = 4;
constexpr double refinement_margin = 0.2;  // of the excess of two hulls: a plane that is worse by less is refined
constexpr size_t max_trades = 64;

std::array<size_t, 2> ordered_key(size_t a, size_t b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace

double Search::cost() const {
    double sum = 0;
    for (const Candidate& candidate : pieces_) sum += candidate.piece.cost();
    return sum;
}

size_t Search::count_bad() const {
    return static_cast<size_t>(std::ranges::count_if(pieces_, [&](const Candidate& c) { return !is_good(c.piece); }));
}

bool Search::is_too_fine() const {
    size_t sum = 0;
    for (const Candidate& candidate : pieces_) sum += candidate.piece.tetrahedra.size();
    return sum > max_growth * initial_tetrahedra_ + 1000;
}

double Search::gain(Candidate& candidate) {
    if (!candidate.division) {
        tick_();
        candidate.division = factory_.find_best_division(candidate.piece);
    }
    return candidate.division->cost == HUGE_VAL ? 0 : candidate.piece.cost() - candidate.division->cost;
}

size_t Search::piece_with_largest_gain() {
    size_t best = 0;
    for (size_t i = 1; i < pieces_.size(); ++i)
        if (gain(pieces_[i]) > gain(pieces_[best])) best = i;
    return best;
}

// Returns false, and won't try again, if one side would be empty.
bool Search::divide(size_t i) {
    const Plane plane = pieces_[i].division->plane;
    auto [below, above] = factory_.divide(pieces_[i].piece.tetrahedra, plane);
    if (below.tetrahedra.empty() || above.tetrahedra.empty()) {
        pieces_[i].division = Division{};
        return false;
    }
    steps_.push_back({Step::divide, i, 0, plane});
    pieces_[i] = make_candidate(std::move(below));
    pieces_.push_back(make_candidate(std::move(above)));
    return true;
}

void Search::divide_until(size_t count) {
    const double threshold = min_gain * cost();
    while (pieces_.size() < count) {
        const size_t best = piece_with_largest_gain();
        if (gain(pieces_[best]) > threshold)
            divide(best);
        else if (!divide_with_pair(threshold))
            return;
    }
}

// The piece with the largest excess of those that were not tried.
bool Search::divide_with_pair(double threshold) {
    const double total = cost();
    for (;;) {
        Candidate* best = nullptr;
        const auto excess = [](const Candidate& c) { return c.piece.cost() - c.piece.volume; };
        for (Candidate& c : pieces_)
            if (!c.is_pair_evaluated && excess(c) > min_excess * total && (!best || excess(c) > excess(*best)))
                best = &c;
        if (!best) return false;
        best->is_pair_evaluated = true;
        const Division pair = factory_.find_best_pair(best->piece, farthest_(best->piece), tick_);
        if (!(pair.cost < best->piece.cost() - threshold)) continue;
        best->division = pair;
        if (divide(static_cast<size_t>(best - pieces_.data()))) return true;
    }
}

bool Search::divide_further(size_t i) {
    if (gain(pieces_[i]) <= min_gain * pieces_[i].piece.cost())
        pieces_[i].division = factory_.find_best_pair(pieces_[i].piece, farthest_(pieces_[i].piece), tick_);
    return pieces_[i].division->cost < HUGE_VAL && divide(i);
}

// The cheapest of the walls that resolve the most concave edges inside the piece. If none resolves any, one that costs
// less than the piece.
std::optional<Division> Search::find_best_wall(const ConvexPiece& piece, std::span<const ConcaveEdge> edges,
                                               std::span<const Plane> walls, double threshold) {
    std::vector<std::pair<double, Plane>> by_weight;
    for (const Plane& wall : walls) by_weight.push_back({resolved_weight(edges, wall), wall});
    std::ranges::stable_sort(by_weight, std::greater{}, [](const auto& w) { return w.first; });
    for (size_t begin = 0, end = 0; begin < by_weight.size(); begin = end) {
        const double heaviest = by_weight[begin].first;
        std::vector<Plane> equal;
        for (; end < by_weight.size() && by_weight[end].first >= (1 - tie) * heaviest; ++end)
            equal.push_back(by_weight[end].second);
        std::vector<Division> divisions = factory_.evaluate_walls(piece.mesh, equal);
        if (divisions.empty()) continue;
        const Division best = *std::ranges::min_element(divisions, {}, &Division::cost);
        if (heaviest > 0 || best.cost < piece.cost() - threshold) return best;
    }
    return std::nullopt;
}

void Search::divide_at_walls(const ConcaveEdges& concave, size_t max_count) {
    const double threshold = min_gain * cost();
    std::vector<std::vector<ConcaveEdge>> edges{concave.edges};  // inside each piece
    for (size_t i = 0; i < pieces_.size();) {
        const ConvexPiece& piece = pieces_[i].piece;
        std::optional<Division> wall;
        if (piece.cost() - piece.volume > threshold && pieces_.size() < max_count && !is_too_fine() &&
            !is_good_enough(piece)) {
            tick_();
            wall = find_best_wall(piece, edges[i], concave.walls, threshold);
        }
        pieces_[i].division = wall;
        if (!wall || !divide(i)) {
            pieces_[i].division.reset();
            ++i;
            continue;
        }
        std::vector<ConcaveEdge> below, above;
        divide_edges(edges[i], wall->plane, below, above);
        edges[i] = std::move(below);
        edges.push_back(std::move(above));
    }
}

void Search::divide_until_good(size_t max_count) {
    for (size_t i = 0; i < pieces_.size();) {
        if (pieces_.size() >= max_count || is_good(pieces_[i].piece) || !divide_further(i)) ++i;
    }
}

void Search::merge(size_t a, size_t b) {
    steps_.push_back({Step::merge, a, b, {}});
    pieces_[a] = make_candidate(factory_.unite(pieces_[a].piece, pieces_[b].piece));
    pieces_.erase(pieces_.begin() + static_cast<std::ptrdiff_t>(b));
}

// Cheapest first, of pieces whose boxes touch, or of all. Reuses cached costs.
std::vector<Search::Pair> Search::sorted_pairs(bool include_distant) {
    std::vector<Pair> pairs;
    decltype(cost_cache_) cache;
    for (size_t a = 0; a < pieces_.size(); ++a)
        for (size_t b = a + 1; b < pieces_.size(); ++b) {
            const ConvexPiece &x = pieces_[a].piece, &y = pieces_[b].piece;
            if (!include_distant && !factory_.may_touch(x, y)) continue;
            const auto key = ordered_key(pieces_[a].stamp, pieces_[b].stamp);
            const auto place = std::ranges::lower_bound(cost_cache_, key, {}, &decltype(cost_cache_)::value_type::first);
            const double cost = place != cost_cache_.end() && place->first == key
                                    ? place->second
                                    : factory_.union_cost(x, y) - x.cost() - y.cost();
            cache.push_back({key, cost});
            pairs.push_back({a, b, cost});
        }
    std::ranges::sort(cache);
    cost_cache_ = std::move(cache);
    std::ranges::sort(pairs, {}, [](const Pair& p) { return std::tuple(p.cost, p.a, p.b); });
    return pairs;
}

void Search::merge_until(size_t count) {
    const double threshold = min_gain * cost();
    while (pieces_.size() > 1) {
        tick_();
        auto pairs = sorted_pairs(false);
        if (pieces_.size() > count && pairs.empty()) pairs = sorted_pairs(true);
        if (pairs.empty() || (pieces_.size() <= count && pairs.front().cost > threshold)) return;
        merge(pairs.front().a, pairs.front().b);
    }
}

bool Search::is_union_good(const Pair& pair) {
    if (!is_good_) return true;
    const auto key = ordered_key(pieces_[pair.a].stamp, pieces_[pair.b].stamp);
    if (bad_unions_.contains(key)) return false;
    tick_();
    if (is_good_(factory_.unite(pieces_[pair.a].piece, pieces_[pair.b].piece))) return true;
    bad_unions_.insert(key);
    return false;
}

void Search::merge_while_good(size_t count) {
    while (pieces_.size() > count) {
        const auto pairs = sorted_pairs(false);
        const auto best = std::ranges::find_if(pairs, [&](const Pair& p) { return is_union_good(p); });
        if (best == pairs.end()) return;
        merge(best->a, best->b);
    }
}

void Search::refine_borders() {
    const double total = cost();
    std::set<std::array<size_t, 2>> evaluated;  // by stamps
    for (size_t round = 0, n_changed = 1; round < max_rounds && n_changed && !is_too_fine(); ++round) {
        n_changed = 0;
        for (size_t a = 0; a < pieces_.size(); ++a)
            for (size_t b = a + 1; b < pieces_.size(); ++b) {
                const ConvexPiece &x = pieces_[a].piece, &y = pieces_[b].piece;
                const double old_cost = x.cost() + y.cost();
                if (old_cost - x.volume - y.volume < min_excess * total || !factory_.may_touch(x, y) ||
                    !evaluated.insert({pieces_[a].stamp, pieces_[b].stamp}).second)
                    continue;
                tick_();
                Division best = factory_.find_best_division(x, y);
                if (best.cost < old_cost + refinement_margin * (old_cost - x.volume - y.volume))
                    best = factory_.refine_division(x, y, best);
                if (!(best.cost < old_cost - min_gain * total)) continue;
                std::vector<Tetrahedron> both = x.tetrahedra;
                both.insert(both.end(), y.tetrahedra.begin(), y.tetrahedra.end());
                auto [below, above] = factory_.divide(std::move(both), best.plane);
                if (below.tetrahedra.empty() || above.tetrahedra.empty() ||
                    !(below.cost() + above.cost() < old_cost - min_gain * total) || !is_good(below) || !is_good(above))
                    continue;
                steps_.push_back({Step::redivide, a, b, best.plane});
                pieces_[a] = make_candidate(std::move(below));
                pieces_[b] = make_candidate(std::move(above));
                ++n_changed;
            }
    }
}

void Search::trade_pieces() {
    const double threshold = min_gain * cost();
    for (size_t i = 0; i < max_trades && !is_too_fine(); ++i) {
        const size_t best = piece_with_largest_gain();
        const auto pairs = sorted_pairs(false);
        const auto cheapest = std::ranges::find_if(
            pairs, [&](const Pair& p) { return p.a != best && p.b != best && is_union_good(p); });
        if (cheapest == pairs.end() || gain(pieces_[best]) - cheapest->cost <= threshold) return;
        if (divide(best)) merge(cheapest->a, cheapest->b);  // the new piece is the last one
    }
}

}  // namespace partwheel::convex
