// The search for convex parts.
#include "convex/search.h"

#include <algorithm>
#include <set>
#include <tuple>

namespace partwheel::convex {

namespace {

constexpr double least_gain = 1e-5;  // of all volume: less may be what points were moved by, see pieces.cpp
constexpr size_t crowd = 8;          // of the tetrahedra at first: planes cut them to ever smaller ones
constexpr double least_hope = 0.003; // of all volume, that two hulls are more than their solid: else they stay as they are
constexpr size_t most_rounds = 4;
constexpr double promising = 0.2;  // of what two hulls are more than their solid: a plane that is worse by less may be refined
constexpr size_t most_exchanges = 64;

std::array<size_t, 2> in_order(size_t a, size_t b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace

double Search::cost() const {
    double sum = 0;
    for (const Entry& each : pieces_) sum += each.piece.cost();
    return sum;
}

bool Search::crowded() const {
    size_t sum = 0;
    for (const Entry& each : pieces_) sum += each.piece.tetrahedra.size();
    return sum > crowd * tetrahedra_at_first_ + 1000;
}

double Search::gain(Entry& entry) {
    if (!entry.division) {
        tick_();
        entry.division = made_.best_division(entry.piece);
    }
    return entry.division->cost == HUGE_VAL ? 0 : entry.piece.cost() - entry.division->cost;
}

size_t Search::most_gaining() {
    size_t best = 0;
    for (size_t i = 1; i < pieces_.size(); ++i)
        if (gain(pieces_[i]) > gain(pieces_[best])) best = i;
    return best;
}

// False if nothing came of it; it will not be tried again.
bool Search::divide(size_t i) {
    const CutPlane plane = pieces_[i].division->plane;
    auto [below, above] = made_.divided(pieces_[i].piece.tetrahedra, plane);
    if (below.tetrahedra.empty() || above.tetrahedra.empty()) {
        pieces_[i].division = Division{};
        return false;
    }
    steps_.push_back({Step::divide, i, 0, plane});
    pieces_[i] = entry(std::move(below));
    pieces_.push_back(entry(std::move(above)));
    return true;
}

void Search::divide_until(size_t count) {
    const double least = least_gain * cost();
    while (pieces_.size() < count) {
        const size_t best = most_gaining();
        if (gain(pieces_[best]) <= least) return;
        divide(best);
    }
}

void Search::divide_until_good(const Good& good, size_t most) {
    for (size_t i = 0; i < pieces_.size();) {
        if (pieces_.size() >= most || good(pieces_[i].piece)) {
            ++i;
            continue;
        }
        gain(pieces_[i]);
        if (pieces_[i].division->cost == HUGE_VAL || !divide(i)) ++i;
    }
}

void Search::join(size_t a, size_t b) {
    steps_.push_back({Step::join, a, b, {}});
    pieces_[a] = entry(made_.joined(pieces_[a].piece, pieces_[b].piece));
    pieces_.erase(pieces_.begin() + static_cast<std::ptrdiff_t>(b));
}

// The cheapest first; of pieces that touch, or of all. Costs that were asked for before are known.
std::vector<Search::Pair> Search::pairs(bool all) {
    std::vector<Pair> found;
    decltype(known_) known;
    for (size_t a = 0; a < pieces_.size(); ++a)
        for (size_t b = a + 1; b < pieces_.size(); ++b) {
            const Piece &x = pieces_[a].piece, &y = pieces_[b].piece;
            if (!all && !made_.touch(x, y)) continue;
            const auto key = in_order(pieces_[a].stamp, pieces_[b].stamp);
            const auto place = std::ranges::lower_bound(known_, key, {}, &decltype(known_)::value_type::first);
            const double cost = place != known_.end() && place->first == key
                                    ? place->second
                                    : made_.joined_cost(x, y) - x.cost() - y.cost();
            known.push_back({key, cost});
            found.push_back({a, b, cost});
        }
    std::ranges::sort(known);
    known_ = std::move(known);
    std::ranges::sort(found, {}, [](const Pair& p) { return std::tuple(p.cost, p.a, p.b); });
    return found;
}

void Search::join_until(size_t count) {
    const double nothing = least_gain * cost();
    while (pieces_.size() > 1) {
        tick_();
        auto found = pairs(false);
        if (pieces_.size() > count && found.empty()) found = pairs(true);
        if (found.empty() || (pieces_.size() <= count && found.front().cost > nothing)) return;
        join(found.front().a, found.front().b);
    }
}

void Search::join_while_good(const Good& good) {
    std::set<std::array<size_t, 2>> refused;  // by stamps
    for (;;) {
        const auto found = pairs(false);
        const auto best = std::ranges::find_if(found, [&](const Pair& p) {
            const auto key = in_order(pieces_[p.a].stamp, pieces_[p.b].stamp);
            if (refused.contains(key)) return false;
            tick_();
            if (good(made_.joined(pieces_[p.a].piece, pieces_[p.b].piece))) return true;
            refused.insert(key);
            return false;
        });
        if (best == found.end()) return;
        join(best->a, best->b);
    }
}

void Search::move_borders() {
    const double all = cost();
    std::set<std::array<size_t, 2>> tried;  // by stamps
    for (size_t round = 0, moved = 1; round < most_rounds && moved && !crowded(); ++round) {
        moved = 0;
        for (size_t a = 0; a < pieces_.size(); ++a)
            for (size_t b = a + 1; b < pieces_.size(); ++b) {
                const Piece &x = pieces_[a].piece, &y = pieces_[b].piece;
                const double now = x.cost() + y.cost();
                if (now - x.solid - y.solid < least_hope * all || !made_.touch(x, y) ||
                    !tried.insert({pieces_[a].stamp, pieces_[b].stamp}).second)
                    continue;
                tick_();
                Division best = made_.best_division(x, y);
                if (best.cost < now + promising * (now - x.solid - y.solid)) best = made_.refined(x, y, best);
                if (!(best.cost < now - least_gain * all)) continue;
                std::vector<Tetrahedron> both = x.tetrahedra;
                both.insert(both.end(), y.tetrahedra.begin(), y.tetrahedra.end());
                auto [below, above] = made_.divided(std::move(both), best.plane);
                if (below.tetrahedra.empty() || above.tetrahedra.empty() ||
                    !(below.cost() + above.cost() < now - least_gain * all))
                    continue;
                steps_.push_back({Step::move, a, b, best.plane});
                pieces_[a] = entry(std::move(below));
                pieces_[b] = entry(std::move(above));
                ++moved;
            }
    }
}

void Search::exchange() {
    const double least = least_gain * cost();
    for (size_t i = 0; i < most_exchanges && !crowded(); ++i) {
        const size_t best = most_gaining();
        const auto found = pairs(false);
        const auto cheapest = std::ranges::find_if(found, [&](const Pair& p) { return p.a != best && p.b != best; });
        if (cheapest == found.end() || gain(pieces_[best]) - cheapest->cost <= least) return;
        if (divide(best)) join(cheapest->a, cheapest->b);  // what is new is the last
    }
}

}  // namespace partwheel::convex
