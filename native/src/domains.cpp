// Two threads contract two halves of the dual graph, running ahead of each other; what one thread would have done in
// another order is taken back.
//
// The order to keep is the greedy one: always the cheapest edge of all. A merge that comes cheaper than one that made
// it possible follows at once, so that the merges' order is that of their stamps: the greatest price below a merge in
// the tree, its own included, then the number of steps since it was paid. Nobody needs to know the others to know it.
//
// Each cluster belongs to one of two domains: at first the half of the mesh it is in, then its larger part's. It is at
// the border if a neighbour belongs to the other. Work goes in rounds of two steps:
//
// 1. Both threads at once merge clusters inside their own domain, not at the border, in the order of their prices,
//    and leave out all other edges. They may get ahead of each other, and of merges at the border.
// 2. One thread makes the merges that were left out, in the order of their stamps, up to the first that still has a
//    merge inside a domain before it.
//
// That ends when too many are left out: one queue has the rest.
//
// A merge must find what it would have found in its turn. That holds if
//   (a) no edge of its two clusters comes before it: inside, a queue sees to that for the most part, and a merge for
//       which an edge comes first that is left out, or has been taken back, is left out, too;
//   (b) no neighbour of its two clusters is one that was made after its turn. If there is one, that is taken back, to
//       be done again, and before it what was done later next to it: that has found it there, so its turn is later,
//       too. (A merge that was done after another with a later turn is no neighbour of that, by (b) again.) And with it
//       what made it possible at a greater price: a queue inside, in the order of prices, must not have it too early.
// Enough, for if edge (x, y) should have been contracted before a merge that has taken x: either y was there when that
// was done, then (a) would have stopped it; or y was made later, then (b) took it back. A merge at the border is never
// taken back: nothing that comes before it is left to be done.
//
// Prices and hulls depend on the two clusters only, not on when they are worked out. So the tree is the same, bit for
// bit, as one thread's; only the numbers of the merges must be put in order in the end.
#include "domains.h"

#include "edge_queue.h"

#include <algorithm>
#include <atomic>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>

namespace partwheel {

namespace {

// With so few clusters left most of them are at the border.
constexpr size_t few_clusters = 64;

// Of clusters of so many tetrahedra prices take long enough to be shared. Two threads then do better with one queue once
// more than this part of the merges is made at the border, by one of them; looked at when one cluster in so many has
// been merged.
constexpr size_t tetrahedra_to_share = 50;
constexpr double most_at_border = 1.0 / 3;
constexpr size_t looks = 8;

// A round is one merge in each domain for so many clusters: short enough that few must wait long for their turn.
constexpr size_t clusters_a_merge = 800;
constexpr size_t least_merges_a_round = 4;

// A thread that is done with its round goes on, rather than wait for the other, until so many rounds' merges might
// still be taken back. Few ever are.
constexpr size_t patience = 64;
constexpr size_t least_lead = 16;

// What is convex costs the same and goes by size and then by place, so first all in one half: one thread may be so many
// times as far ahead then.
constexpr size_t convex_patience = 4;

// When a cluster is made, or an edge contracted.
struct Stamp {
    Price price;         // the greatest paid below it, its own included
    uint32_t steps = 0;  // since that was paid

    bool operator<(const Stamp& other) const {
        if (price < other.price) return true;
        return !(other.price < price) && steps < other.steps;
    }
};

// An edge that is left out: its turn.
struct Turn {
    Stamp stamp;
    Price price;

    double concavity() const { return price.concavity(); }
    bool operator<(const Turn& other) const {
        if (stamp < other.stamp) return true;
        return !(other.stamp < stamp) && price < other.price;
    }
};

// Where an edge is queued; and, but for the last, what a cluster is: of which domain, and inside it or at the border.
enum Home : uint8_t { inside_0, inside_1, left_out_0, left_out_1, across };

class Domains {
public:
    Domains(DualGraph& graph, std::vector<uint8_t> halves, Workers& workers, Progress& progress, const Pace& pace);
    std::vector<Merge> run();

private:
    using Inside = EdgeQueue<Price>;
    using LeftOut = EdgeQueue<Turn>;

    struct Numbered {
        Merge merge;
        Stamp stamp;
        int32_t number;
    };
    struct Done {
        Contraction contraction;
        Numbered numbered;
        Stamp made_stay, made_go;  // as they were
        size_t place = 0;          // among those not final
    };

    // Merges that are not final, by their stamps, each of which is another. Nearly all come in that order; those that
    // don't have a list apart, so that no other must make room, and who is taken out leaves a gap.
    class NotFinal {
    public:
        bool empty() const { return in_order_.empty() && late_.empty(); }
        size_t size() const { return in_order_.size() + late_.size(); }  // with the gaps
        const Stamp& latest() const { return latest_; }  // the least of all if there is none
        Done& last();
        void add(std::unique_ptr<Done> done);
        std::unique_ptr<Done> take_out(const Done& done);
        std::unique_ptr<Done> take_first_before(const Stamp& stamp);  // null if there is none

    private:
        static constexpr size_t is_late = std::numeric_limits<size_t>::max();
        const Stamp& latest_of_late() const { return late_.rbegin()->first; }

        std::deque<std::unique_ptr<Done>> in_order_;  // no gap at either end
        size_t before_ = 0;                           // places before the first of these
        std::map<Stamp, std::unique_ptr<Done>> late_;
        Stamp latest_;
    };

    // What one thread works with.
    struct alignas(apart) Scratch {
        Worker* worker;
        std::vector<int32_t> removed{}, cheaper{};
    };

    struct alignas(apart) Domain {
        Inside inside;
        LeftOut left_out;
        NotFinal done;                             // inside
        std::vector<std::unique_ptr<Done>> spare;  // with their memory
        std::vector<Done*> by_number;              // null for what is final or has been taken back
        LargeVector<Numbered> settled;             // final, in the order of their stamps
        size_t goal = 0, merged = 0;               // merges in this round
        std::atomic<bool> finished{false};

        explicit Domain(EdgePlaces& places) : inside(places), left_out(places) {}
    };

    Stamp& made(int32_t cluster) { return made_[static_cast<size_t>(cluster)]; }
    const Stamp& made(int32_t cluster) const { return made_[static_cast<size_t>(cluster)]; }
    uint8_t& site(int32_t cluster) { return sites_[static_cast<size_t>(cluster)]; }
    uint8_t site(int32_t cluster) const { return sites_[static_cast<size_t>(cluster)]; }
    uint8_t owner(int32_t cluster) const { return site(cluster) & 1; }

    uint8_t site_of_owned(int32_t cluster) const;
    bool look_whether_at_border(int32_t cluster);
    Home home(int32_t edge) const;
    Price price(int32_t edge) const { return Price(graph_.cost(graph_.edge(edge))); }
    Turn turn(int32_t edge, const Price& own) const;
    LeftOut& left_out(uint8_t home) { return home == across ? across_ : domains_[home - left_out_0].left_out; }
    void remove(int32_t edge);
    uint8_t& hindered(int32_t cluster) { return hindered_[static_cast<size_t>(cluster)]; }
    void note_left_out(int32_t edge) { hindered(graph_.edge(edge).a) = hindered(graph_.edge(edge).b) = 1; }
    void place(int32_t edge, const Price& own);
    void place(int32_t edge) { place(edge, price(edge)); }
    template <class Queue>
    void prefetch(const Queue& queue) const;
    void evaluate(int32_t edge, double concavity, Scratch& scratch);
    template <class Queue>
    bool price_top(const Queue& queue, Scratch& scratch);
    std::pair<int32_t, Numbered> contract(int32_t edge, const Stamp& stamp, int32_t number, Scratch& scratch,
                                          Contraction* undo);
    void place_links(int32_t merged, const Price& paid, Scratch& scratch);
    bool may_merge(int32_t edge, const Turn& turn, const Domain& domain, Scratch& scratch);
    void settle(size_t d);
    void advance(size_t d);
    void round(const std::array<size_t, 2>& goals);
    void catch_up();
    static void prefetch_spare(const std::vector<std::unique_ptr<Done>>& spare);
    void merge_inside(size_t d, int32_t edge, const Turn& turn);
    LeftOut* next_left_out();
    bool inside_before(const Stamp& stamp) const;
    bool goes_on(const Domain& d) const { return !d.inside.empty() && !(last_ && *last_ < d.inside.top()); }
    bool either_goes_on() const { return goes_on(domains_[0]) || goes_on(domains_[1]); }
    Done*& done(int32_t number);
    Done* standing(int32_t cluster);
    bool take_back_after(const Turn& turn, int32_t edge);
    void take_back(Done& first);
    void undo(Done& done);
    void merge_left_out();
    void merge_at_border(int32_t edge, const Turn& turn);
    Stamp settled_before();
    int32_t final_number(int32_t number) const;
    std::vector<Merge> in_order();
    std::vector<Merge> finish();

    DualGraph& graph_;
    Workers& workers_;
    PairOfThreads& threads_;
    Progress& progress_;
    const Pace& pace_;
    EdgePlaces places_;
    std::array<Domain, 2> domains_{Domain(places_), Domain(places_)};
    LeftOut across_{places_};
    std::array<Scratch, 2> scratch_;
    std::vector<uint8_t> sites_;
    std::vector<uint8_t> hindered_;  // whether an edge of the cluster may be left out: if not, none is
    LargeVector<Stamp> made_;
    LargeVector<Numbered> at_border_;  // merges there, in the order of their stamps
    Stamp latest_at_border_;
    LargeVector<int32_t> number_of_;   // as one thread numbers them, by our numbers, the leaves' left out
    size_t left_;                      // clusters
    Stamp settled_;                    // what has been done before that is final
    std::optional<Price> last_;        // of the merges to be made; none: all
    size_t lead_ = 0;                  // so many merges of a domain at most that are not final, but for convex ones
};

void Domains::NotFinal::add(std::unique_ptr<Done> done) {
    const Stamp& stamp = done->numbered.stamp;
    if (stamp < latest_) {
        done->place = is_late;
        late_.emplace(stamp, std::move(done));
    } else {
        latest_ = stamp;
        done->place = before_ + in_order_.size();
        in_order_.push_back(std::move(done));
    }
}

Domains::Done& Domains::NotFinal::last() {
    return late_.empty() || latest_of_late() < latest_ ? *in_order_.back() : *late_.rbegin()->second;
}

std::unique_ptr<Domains::Done> Domains::NotFinal::take_out(const Done& done) {
    std::unique_ptr<Done> taken = done.place == is_late ? std::move(late_.extract(done.numbered.stamp).mapped())
                                                        : std::move(in_order_[done.place - before_]);
    while (!in_order_.empty() && !in_order_.back()) in_order_.pop_back();
    for (; !in_order_.empty() && !in_order_.front(); ++before_) in_order_.pop_front();
    if (!(taken->numbered.stamp < latest_)) {
        latest_ = in_order_.empty() ? Stamp{} : in_order_.back()->numbered.stamp;
        if (!late_.empty()) latest_ = std::max(latest_, latest_of_late());
    }
    return taken;
}

std::unique_ptr<Domains::Done> Domains::NotFinal::take_first_before(const Stamp& stamp) {
    Done* first = in_order_.empty() ? nullptr : in_order_.front().get();
    if (!late_.empty() && (!first || late_.begin()->first < first->numbered.stamp)) first = late_.begin()->second.get();
    return first && first->numbered.stamp < stamp ? take_out(*first) : nullptr;
}

Domains::Domains(DualGraph& graph, std::vector<uint8_t> halves, Workers& workers, Progress& progress, const Pace& pace)
    : graph_(graph), workers_(workers), threads_(*workers.threads), progress_(progress), pace_(pace),
      scratch_{{{&workers.first}, {&*workers.second}}}, sites_(std::move(halves)),
      hindered_(graph.clusters_count(), 0), made_(graph.clusters_count()), left_(graph.clusters_count()) {
    places_.resize(graph.edges_count());
    std::vector<uint8_t> sites(left_);
    in_halves(&threads_, 0, left_, [&](size_t c) { sites[c] = site_of_owned(static_cast<int32_t>(c)); });
    sites_ = std::move(sites);
    const auto edges = static_cast<int32_t>(graph.edges_count());
    threads_.share(2, [&](size_t d, size_t) {
        domains_[d].inside.reserve(graph.edges_count() * 5 / 8);
        for (int32_t e = 0; e < edges; ++e)
            if (owner(graph.edge(e).a) == d && home(e) == inside_0 + d) {
                graph.edge(e).home = static_cast<uint8_t>(inside_0 + d);
                domains_[d].inside.append(price(e), e);
            }
        domains_[d].inside.sort();
    });
    for (int32_t e = 0; e < edges; ++e)
        if (!places_.queued(e)) place(e);
}

// What a cluster is if only owners are known.
uint8_t Domains::site_of_owned(int32_t cluster) const {
    const auto& links = graph_.at(cluster).links;
    const bool at_border = std::any_of(links.begin(), links.end(),
                                       [&](const Link& l) { return owner(l.cluster) != owner(cluster); });
    return static_cast<uint8_t>((at_border ? left_out_0 : inside_0) + owner(cluster));
}

// Notes it; returns whether it has changed.
bool Domains::look_whether_at_border(int32_t cluster) {
    const uint8_t now = site_of_owned(cluster);
    return std::exchange(site(cluster), now) != now;
}

Home Domains::home(int32_t edge) const {
    const uint8_t a = site(graph_.edge(edge).a), b = site(graph_.edge(edge).b);
    return static_cast<Home>(((a ^ b) & 1) != 0 ? across : a | b);
}

// As far as the edge's price is known.
Turn Domains::turn(int32_t edge, const Price& own) const {
    const Stamp &a = made(graph_.edge(edge).a), &b = made(graph_.edge(edge).b), &later = a < b ? b : a;
    return {later.price < own ? Stamp{own, 0} : Stamp{later.price, later.steps + 1}, own};
}

void Domains::remove(int32_t edge) {
    const uint8_t at = graph_.edge(edge).home;
    if (at <= inside_1)
        domains_[at].inside.remove(edge);
    else
        left_out(at).remove(edge);
}

// Puts the edge where it belongs now.
void Domains::place(int32_t edge, const Price& own) {
    const Home to = home(edge);
    uint8_t& at = graph_.edge(edge).home;
    bool queued = places_.queued(edge);
    if (queued && at != to) {
        remove(edge);
        queued = false;
    }
    at = to;
    const auto put = [&](auto& queue, const auto& key) { queued ? queue.update(key, edge) : queue.insert(key, edge); };
    if (to <= inside_1) return put(domains_[to].inside, own);
    note_left_out(edge);
    put(left_out(to), turn(edge, own));
}

void Domains::evaluate(int32_t edge, double concavity, Scratch& scratch) {
    graph_.find_price(edge, concavity, *scratch.worker);
    place(edge);
}

// What comes soon in the queue.
template <class Queue>
void Domains::prefetch(const Queue& queue) const {
    prefetch_soon(graph_, queue);
    for (const auto& item : queue.items(1, 3))
        for (const int32_t c : {graph_.edge(item.edge).a, graph_.edge(item.edge).b}) prefetch_line(&made(c));
}

// If the price of the queue's first edge is not known yet: finds it, or that it comes later.
template <class Queue>
bool Domains::price_top(const Queue& queue, Scratch& scratch) {
    if (graph_.edge(queue.top().edge).exact) return false;
    evaluate(queue.top().edge, far_beyond_second(queue), scratch);
    return true;
}

// Contracts an edge that is in no queue any more; returns the cluster.
std::pair<int32_t, Domains::Numbered> Domains::contract(int32_t edge, const Stamp& stamp, int32_t number,
                                                        Scratch& scratch, Contraction* undo) {
    scratch.removed.clear();
    int32_t merged;
    const uint8_t either = hindered(graph_.edge(edge).a) | hindered(graph_.edge(edge).b);
    const Merge merge = graph_.contract(edge, number, *scratch.worker, scratch.removed, merged, undo);
    made(merged) = stamp;
    hindered(merged) |= either;
    for (const int32_t e : scratch.removed) remove(e);
    return {merged, {merge, stamp, number}};
}

// Puts the edges of a cluster that has just been made, at this price, where they belong; but those that may be cheaper
// into scratch.cheaper: these are the next that a queue would ask for.
void Domains::place_links(int32_t merged, const Price& paid, Scratch& scratch) {
    scratch.cheaper.clear();
    for (const Link& link : graph_.at(merged).links) {
        graph_.refresh(link.edge);
        if (const Price bound = price(link.edge); bound < paid) {
            graph_.prefetch(link.edge, merged);
            scratch.cheaper.push_back(link.edge);
        } else {
            place(link.edge, bound);
        }
    }
}

// ---- Inside a domain: each thread in its own -----------------------------------------------------------------------

// (a) and (b) for an edge that is its domain's cheapest inside. If it is cheaper than what made it possible, its turn is
// later than its price says, and others inside may come before it, where something has been taken back.
bool Domains::may_merge(int32_t edge, const Turn& own, const Domain& in, Scratch& scratch) {
    const auto [a, b] = std::pair(graph_.edge(edge).a, graph_.edge(edge).b);
    const bool late = own.stamp < in.done.latest();
    if (!late && own.stamp.steps == 0 && !hindered(a) && !hindered(b)) return true;
    const auto before = [&](int32_t e) {
        if (const uint8_t home = graph_.edge(e).home; home > inside_1) return left_out(home).key(e) < own;
        if (own.stamp.steps == 0) return false;
        const Price other = price(e);
        return other < own.stamp.price && turn(e, other) < own;
    };
    for (const int32_t c : {a, b})
        for (const Link& link : graph_.at(c).links) {
            if (late && own.stamp < made(link.cluster)) return false;
            while (before(link.edge)) {
                if (graph_.edge(link.edge).exact) return false;
                evaluate(link.edge, dear * own.concavity(), scratch);
            }
        }
    return true;
}

// Forgets how to take back what never will be.
void Domains::settle(size_t d) {
    Domain& own = domains_[d];
    while (auto first = own.done.take_first_before(settled_)) {
        own.settled.push_back(first->numbered);
        done(first->numbered.number) = nullptr;
        own.spare.push_back(std::move(first));
    }
}

void Domains::advance(size_t d) {
    Domain& own = domains_[d];
    const Domain& other = domains_[1 - d];
    Scratch& scratch = scratch_[d];
    scratch.worker->hulls.forget();
    for (own.merged = 0; goes_on(own);) {
        // What belongs before or right after the latest merge is not left for later: others would wait for it.
        const bool may_stop = own.done.empty() || own.done.latest().price < own.inside.top();
        const size_t lead = own.inside.top().concavity() > 0 ? lead_ : convex_patience * lead_;
        if (may_stop && own.done.size() >= lead) break;
        if (may_stop && own.merged >= own.goal) {
            own.finished.store(true, std::memory_order_relaxed);
            if (pace_ || other.finished.load(std::memory_order_relaxed)) break;
        }
        prefetch(own.inside);
        const auto top = own.inside.top();
        if (price_top(own.inside, scratch)) continue;
        const Turn now = turn(top.edge, top);
        prefetch_around(graph_, places_, top.edge);
        if (may_merge(top.edge, now, own, scratch)) {
            merge_inside(d, top.edge, now);
        } else {
            own.inside.remove(top.edge);
            graph_.edge(top.edge).home = static_cast<uint8_t>(left_out_0 + d);
            note_left_out(top.edge);
            own.left_out.insert(now, top.edge);
        }
    }
    own.finished.store(true, std::memory_order_relaxed);
}

// What has lain for long is in no cache: the memory of the one before the last, and the record before that.
void Domains::prefetch_spare(const std::vector<std::unique_ptr<Done>>& spare) {
    if (spare.size() < 3) return;
    const Done& next = *spare.end()[-2];
    next.contraction.stayed.hull.prefetch();
    next.contraction.gone.hull.prefetch();
    const auto* after = reinterpret_cast<const char*>(spare.end()[-3].get());
    for (size_t i = 0; i < sizeof(Done); i += 64) prefetch_line(after + i);
}

void Domains::merge_inside(size_t d, int32_t edge, const Turn& now) {
    Domain& own = domains_[d];
    Scratch& scratch = scratch_[d];
    own.inside.remove(edge);
    std::unique_ptr<Done> done;
    if (own.spare.empty()) {
        done = std::make_unique<Done>();
    } else {
        prefetch_spare(own.spare);
        done = std::move(own.spare.back());
        own.spare.pop_back();
        DualGraph::forget(done->contraction, *scratch.worker);
    }
    const auto [a, b] = std::pair(graph_.edge(edge).a, graph_.edge(edge).b);
    const Stamp made_a = made(a), made_b = made(b);
    const auto number = static_cast<int32_t>(graph_.clusters_count() + 3 * own.by_number.size() + d);
    own.by_number.push_back(done.get());
    const auto [merged, numbered] = contract(edge, now.stamp, number, scratch, &done->contraction);
    done->numbered = numbered;
    done->made_stay = merged == a ? made_a : made_b;
    done->made_go = merged == a ? made_b : made_a;
    own.done.add(std::move(done));
    ++own.merged;
    place_links(merged, now.price, scratch);
    graph_.find_prices(scratch.cheaper, dear * now.concavity(), *scratch.worker);
    for (const int32_t e : scratch.cheaper) place(e);
}

// ---- Between the rounds: one thread --------------------------------------------------------------------------------

// The queue whose first edge comes first; null if there is none.
Domains::LeftOut* Domains::next_left_out() {
    LeftOut* next = nullptr;
    for (LeftOut* queue : {&domains_[0].left_out, &domains_[1].left_out, &across_})
        if (!queue->empty() && (!next || queue->top() < next->top())) next = queue;
    return next;
}

// Whether a merge inside a domain may have its turn before that.
bool Domains::inside_before(const Stamp& stamp) const {
    return std::any_of(domains_.begin(), domains_.end(), [&](const Domain& d) {
        return !d.inside.empty() && !(stamp.price < d.inside.top());
    });
}

// The place for the merge with this number, which is one inside.
Domains::Done*& Domains::done(int32_t number) {
    const size_t n = static_cast<size_t>(number) - graph_.clusters_count();
    return domains_[n % 3].by_number[n / 3];
}

// The merge inside that made the cluster, if it may be taken back.
Domains::Done* Domains::standing(int32_t cluster) {
    const int32_t number = graph_.at(cluster).number;
    const size_t leaves = graph_.clusters_count(), n = static_cast<size_t>(number);
    return n < leaves || (n - leaves) % 3 == 2 ? nullptr : done(number);
}

// (b) for a merge whose cluster is still there. All that goes with it is on a list of its own, not on the thread's
// stack, for it may be much.
void Domains::take_back(Done& first) {
    const auto done_later = [&](const Done& done) -> const Done* {
        for (const Link& link : graph_.at(done.contraction.stay).links)
            if (const Done* other = standing(link.cluster); other && other->numbered.number > done.numbered.number)
                return other;
        return nullptr;
    };
    std::vector<int32_t> waiting{first.numbered.number};
    while (!waiting.empty()) {
        Done* const next = done(waiting.back());
        if (!next) {  // it went with another
            waiting.pop_back();
        } else if (const Done* later = done_later(*next)) {
            waiting.push_back(later->numbered.number);
        } else {
            waiting.pop_back();
            undo(*next);
            if (next->numbered.stamp.steps == 0) continue;
            for (const int32_t part : {next->contraction.stay, next->contraction.go})
                if (const Done* before = standing(part);
                    before && !(before->numbered.stamp.price < next->numbered.stamp.price))
                    waiting.push_back(before->numbered.number);
        }
    }
}

void Domains::undo(Done& done) {
    Contraction& c = done.contraction;
    for (const Link& link : graph_.at(c.stay).links) remove(link.edge);
    graph_.undo(c, *scratch_[0].worker);
    made(c.stay) = done.made_stay;
    made(c.go) = done.made_go;
    for (const int32_t part : {c.stay, c.go})
        for (const Link& link : graph_.at(part).links) place(link.edge);
    this->done(done.numbered.number) = nullptr;
    ++left_;
    Domain& own = domains_[owner(c.stay)];
    own.spare.push_back(own.done.take_out(done));
}

// (b) for an edge that was left out; whether anything had to be taken back.
bool Domains::take_back_after(const Turn& now, int32_t edge) {
    const auto contradicts = [&]() -> Done* {
        for (const int32_t c : {graph_.edge(edge).a, graph_.edge(edge).b})
            for (const Link& link : graph_.at(c).links)
                if (now.stamp < made(link.cluster)) return standing(link.cluster);
        return nullptr;
    };
    bool any = false;
    for (; Done* done = contradicts(); any = true) take_back(*done);
    return any;
}

void Domains::merge_left_out() {
    scratch_[0].worker->hulls.forget();
    while (LeftOut* queue = next_left_out()) {
        const auto top = queue->top();
        if (inside_before(top.stamp)) break;
        prefetch(*queue);
        if (price_top(*queue, scratch_[0]) || take_back_after(top, top.edge)) continue;
        queue->remove(top.edge);
        prefetch_around(graph_, places_, top.edge);
        merge_at_border(top.edge, top);
    }
}

void Domains::merge_at_border(int32_t edge, const Turn& now) {
    const auto [a, b] = std::pair(graph_.edge(edge).a, graph_.edge(edge).b);
    const uint8_t larger = graph_.at(a).size >= graph_.at(b).size ? owner(a) : owner(b);
    const auto number = static_cast<int32_t>(graph_.clusters_count() + 3 * at_border_.size() + 2);
    const auto [merged, numbered] = contract(edge, now.stamp, number, scratch_[0], nullptr);
    at_border_.push_back(numbered);
    latest_at_border_ = now.stamp;
    --left_;
    site(merged) = larger;
    look_whether_at_border(merged);
    place_links(merged, now.price, scratch_[0]);
    graph_.find_prices(scratch_[0].cheaper, dear * now.concavity(), workers_);
    for (const int32_t e : scratch_[0].cheaper) place(e);
    for (const Link& link : graph_.at(merged).links)
        if (look_whether_at_border(link.cluster))
            for (const Link& other : graph_.at(link.cluster).links) place(other.edge);
}

// What has been done before that won't be taken back any more.
Stamp Domains::settled_before() {
    Stamp first;
    first.price.rank = std::numeric_limits<uint64_t>::max();
    if (const LeftOut* next = next_left_out()) first = next->top().stamp;
    for (const Domain& d : domains_)
        if (!d.inside.empty()) first = std::min(first, Stamp{d.inside.top(), 0});
    return std::max(first, latest_at_border_);
}

// The number that one thread gives to what has this one; the same for a leaf.
int32_t Domains::final_number(int32_t number) const {
    const auto leaves = static_cast<int32_t>(graph_.clusters_count());
    return number < leaves ? number : number_of_[static_cast<size_t>(number - leaves)];
}

// All merges, numbered as one thread does: each thread takes a part of their order, up to the same stamp in all lists.
std::vector<Merge> Domains::in_order() {
    const std::array<std::span<const Numbered>, 3> lists = {domains_[0].settled, domains_[1].settled, at_border_};
    const auto& longest = *std::ranges::max_element(lists, {}, [](const auto& list) { return list.size(); });
    if (longest.empty()) return {};
    std::array<size_t, 3> middle;
    for (size_t k = 0; k < 3; ++k) {
        const auto at = std::ranges::lower_bound(lists[k], longest[longest.size() / 2].stamp, std::less(), &Numbered::stamp);
        middle[k] = static_cast<size_t>(at - lists[k].begin());
    }
    std::vector<Merge> merges(lists[0].size() + lists[1].size() + lists[2].size());
    number_of_.resize(3 * std::max({domains_[0].by_number.size(), domains_[1].by_number.size(), at_border_.size()}));
    const auto leaves = static_cast<int32_t>(graph_.clusters_count());
    threads_.share(2, [&](size_t half, size_t) {
        auto rest = lists;
        for (size_t k = 0; k < 3; ++k) rest[k] = half == 0 ? rest[k].first(middle[k]) : rest[k].subspan(middle[k]);
        for (size_t i = half == 0 ? 0 : middle[0] + middle[1] + middle[2];; ++i) {
            std::span<const Numbered>* next = nullptr;
            for (auto& list : rest)
                if (!list.empty() && (!next || list.front().stamp < next->front().stamp)) next = &list;
            if (!next) break;
            number_of_[static_cast<size_t>(next->front().number - leaves)] = leaves + static_cast<int32_t>(i);
            merges[i] = next->front().merge;
            *next = next->subspan(1);
        }
    });
    in_halves(&threads_, 0, merges.size(), [&](size_t i) {
        merges[i].left = final_number(merges[i].left);
        merges[i].right = final_number(merges[i].right);
    });
    return merges;
}

// Takes back what is not final, and numbers what is left.
std::vector<Merge> Domains::finish() {
    for (size_t d = 0; d < 2; ++d) settle(d);
    for (Domain& d : domains_)
        while (!d.done.empty()) take_back(d.done.last());
    auto merges = in_order();
    const auto leaves = static_cast<int32_t>(graph_.clusters_count());
    for (int32_t c = 0; c < leaves; ++c)
        if (Cluster& left = graph_.at(c); left.size > 0) left.number = final_number(left.number);
    threads_.share(2, [this](size_t d, size_t) {  // it is many small blocks
        auto& spare = domains_[d].spare;
        for (; !spare.empty(); spare.pop_back()) {
            prefetch_spare(spare);
            DualGraph::forget(spare.back()->contraction, *scratch_[d].worker);
        }
    });
    return merges;
}

void Domains::round(const std::array<size_t, 2>& goals) {
    for (size_t d = 0; d < 2; ++d) {
        domains_[d].goal = goals[d];
        domains_[d].finished = false;
    }
    threads_.share(2, [this](size_t d, size_t) {
        settle(d);
        advance(d);
    });
    left_ -= domains_[0].merged + domains_[1].merged;
    merge_left_out();
    settled_ = settled_before();
    progress_.advance(0.1 + 0.9 * (1 - static_cast<double>(left_) / static_cast<double>(graph_.clusters_count())));
}

// Lets each domain catch up with the other: what is not final in the end would have to be taken back.
void Domains::catch_up() {
    last_ = std::max(domains_[0].done.latest().price, domains_[1].done.latest().price);
    while (either_goes_on()) round({left_, left_});
}

std::vector<Merge> Domains::run() {
    size_t inside = 0, at_border = 0;  // merges since the last look
    const auto mostly_at_border = [&] {
        const size_t all = inside + at_border;
        if (all * looks < left_) return false;
        const bool mostly = static_cast<double>(at_border) > most_at_border * static_cast<double>(all);
        inside = at_border = 0;
        return mostly;
    };
    const auto pays = [&] {
        if (left_ <= few_clusters || (mostly_at_border() && left_ * tetrahedra_to_share < graph_.clusters_count()))
            return false;
        return pace_ || threads_.pays();
    };
    while (pays() && either_goes_on()) {
        const size_t goal = std::max(left_ / clusters_a_merge, least_merges_a_round), before = at_border_.size();
        lead_ = std::max(left_ * patience / clusters_a_merge, least_lead);
        round(pace_ ? pace_(goal) : std::array{goal, goal});
        inside += domains_[0].merged + domains_[1].merged;
        at_border += at_border_.size() - before;
    }
    catch_up();
    return finish();
}

}  // namespace

std::vector<Merge> merge_in_domains(DualGraph& graph, std::vector<uint8_t> halves, Workers& workers,
                                    Progress& progress, const Pace& pace) {
    return Domains(graph, std::move(halves), workers, progress, pace).run();
}

}  // namespace partwheel
