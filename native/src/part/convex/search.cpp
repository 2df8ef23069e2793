// The search for convex parts.
#include "part/convex/search.h"

#include <algorithm>
#include <set>
#include <tuple>

namespace partwheel::convex {

namespace {

constexpr double gap = 1e-6;         // working: boxes that are nearer may touch
constexpr double least_gain = 1e-9;  // of all volume: less is rounding
constexpr size_t most_rounds = 4;
constexpr size_t most_exchanges = 64;

}  // namespace

double Search::cost() const {
    double sum = 0;
    for (const Entry& each : pieces_) sum += each.piece.cost();
    return sum;
}

std::vector<Piece> Search::take() {
    std::vector<Piece> taken;
    for (Entry& each : pieces_) taken.push_back(std::move(each.piece));
    pieces_.clear();
    return taken;
}

double Search::gain(Entry& entry) {
    if (!entry.division) entry.division = made_.best_division(entry.piece.tetrahedra, {});
    return entry.division->cost == HUGE_VAL ? 0 : entry.piece.cost() - entry.division->cost;
}

// False if nothing came of it; it will not be tried again.
bool Search::divide(size_t i) {
    auto [below, above] = made_.divided(pieces_[i].piece.tetrahedra, pieces_[i].division->plane);
    if (below.hull.facet_count() == 0 || above.hull.facet_count() == 0) {
        pieces_[i].division = Division{};
        return false;
    }
    pieces_[i] = entry(std::move(below));
    pieces_.push_back(entry(std::move(above)));
    return true;
}

void Search::divide_until(size_t count) {
    const double least = least_gain * cost();
    while (pieces_.size() < count) {
        size_t best = 0;
        for (size_t i = 1; i < pieces_.size(); ++i)
            if (gain(pieces_[i]) > gain(pieces_[best])) best = i;
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
    pieces_[a] = entry(made_.joined(pieces_[a].piece, pieces_[b].piece));
    pieces_.erase(pieces_.begin() + static_cast<std::ptrdiff_t>(b));
}

// With what joining adds. Costs that were asked for before are known.
std::vector<Search::Pair> Search::pairs(bool all) {
    std::vector<Pair> found;
    decltype(known_) known;
    for (size_t a = 0; a < pieces_.size(); ++a)
        for (size_t b = a + 1; b < pieces_.size(); ++b) {
            const Piece &x = pieces_[a].piece, &y = pieces_[b].piece;
            if (!all && !made_.touch(x, y, gap)) continue;
            std::array<size_t, 2> key = {pieces_[a].stamp, pieces_[b].stamp};
            std::ranges::sort(key);
            const auto place = std::ranges::lower_bound(known_, key, {}, &decltype(known_)::value_type::first);
            const double cost = place != known_.end() && place->first == key
                                    ? place->second
                                    : made_.joined_cost(x, y) - x.cost() - y.cost();
            known.push_back({key, cost});
            found.push_back({a, b, cost});
        }
    std::ranges::sort(known);
    known_ = std::move(known);
    return found;
}

void Search::join_until(size_t count, const Good& good) {
    std::set<std::array<size_t, 2>> refused;  // by stamps
    while (pieces_.size() > count) {
        auto found = pairs(false);
        if (found.empty() && !good) found = pairs(true);
        const auto stamps = [&](const Pair& p) {
            return std::array{pieces_[p.a].stamp, pieces_[p.b].stamp};
        };
        std::ranges::sort(found, {}, [](const Pair& p) { return std::tuple(p.cost, p.a, p.b); });
        const auto best = std::ranges::find_if(found, [&](const Pair& p) {
            if (!good) return true;
            if (refused.contains(stamps(p))) return false;
            if (good(made_.joined(pieces_[p.a].piece, pieces_[p.b].piece))) return true;
            refused.insert(stamps(p));
            return false;
        });
        if (best == found.end()) return;
        join(best->a, best->b);
    }
}

void Search::move_borders(const Good& good) {
    const double least = least_gain * cost();
    std::set<std::array<size_t, 2>> tried;
    for (size_t round = 0; round < most_rounds; ++round) {
        bool moved = false;
        for (size_t a = 0; a < pieces_.size(); ++a)
            for (size_t b = a + 1; b < pieces_.size(); ++b) {
                const Piece &x = pieces_[a].piece, &y = pieces_[b].piece;
                if (!made_.touch(x, y, gap) || !tried.insert({pieces_[a].stamp, pieces_[b].stamp}).second) continue;
                const double now = x.cost() + y.cost();
                // Two that are convex by themselves can't gain.
                std::vector<Tetrahedron> both = x.tetrahedra;
                both.insert(both.end(), y.tetrahedra.begin(), y.tetrahedra.end());
                const Box p = made_.kernel().bounds(x.hull), q = made_.kernel().bounds(y.hull);
                const std::array<Point, 1> between = {q.low + q.high - p.low - p.high};
                const Division best = made_.best_division(both, between);
                if (!(best.cost < now - least)) continue;
                auto [below, above] = made_.divided(both, best.plane);
                if (below.hull.facet_count() == 0 || above.hull.facet_count() == 0) continue;
                if (!(below.cost() + above.cost() < now - least)) continue;
                if (good && !(good(below) && good(above))) continue;
                pieces_[a] = entry(std::move(below));
                pieces_[b] = entry(std::move(above));
                moved = true;
            }
        if (!moved) return;
    }
}

void Search::exchange() {
    const double least = least_gain * cost();
    for (size_t i = 0; i < most_exchanges; ++i) {
        size_t best = 0;
        for (size_t k = 1; k < pieces_.size(); ++k)
            if (gain(pieces_[k]) > gain(pieces_[best])) best = k;
        const auto found = pairs(false);
        const Pair* least_pair = nullptr;
        for (const Pair& p : found)
            if (p.a != best && p.b != best && (!least_pair || p.cost < least_pair->cost)) least_pair = &p;
        if (!least_pair || gain(pieces_[best]) - least_pair->cost <= least) return;
        if (!divide(best)) continue;  // the new one is the last
        join(least_pair->a, least_pair->b);
    }
}

}  // namespace partwheel::convex
