// Hierarchical tet clustering (the paper's Listing 1): hulls from hulls, costs only where the queue asks for them.
#include "cluster.h"

#include "hull.h"
#include "pair_of_threads.h"

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

namespace partwheel {

double ranked_concavity(double hull_volume, double volume) {
    const double concavity = hull_volume - volume;
    if (!(concavity > convex_tolerance * hull_volume)) return 0;
    constexpr uint64_t last = uint64_t{1} << (53 - concavity_bits);
    return std::bit_cast<double>((std::bit_cast<uint64_t>(concavity) + last / 2) & ~(last - 1));
}

namespace {

// Volumes of hulls that were come by differently agree to far better than this: what a lower bound gives away so that
// it stays one in spite of rounding.
constexpr double bound_slack = 1e-11;

constexpr size_t nearest_components = 16;

// An edge that costs more than so many times what the next merges cost is not priced exactly yet.
constexpr double dear = 2;

// A second thread is asked for help from so many tests of a point against a facet on: some microseconds.
constexpr size_t worth_sharing = 1500;

struct Link {
    int32_t cluster;  // the neighbour
    int32_t edge;
};

struct alignas(64) Cluster {
    Hull hull;               // none while it is one tetrahedron
    double hull_volume = 0;
    double volume = 0;
    int32_t size = 1;    // in tetrahedra; 0 once it has gone into another
    int32_t low = 0;     // its lowest tetrahedron
    int32_t number = 0;  // in the tree, see Merge
    std::vector<Link> links;
};

struct Edge {
    int32_t a, b;            // clusters
    double hull_volume = 0;  // of their union, or a lower bound of it
    bool exact = false;
    bool tried = false;  // the bound has been worked out for these clusters
};

// The edges, cheapest first: a heap with four children a node that knows where each edge is, so that costs change in
// place.
class EdgeQueue {
public:
    // Most comparisons are settled by one number: concavity, or C2 among convex unions.
    struct Item {
        uint64_t rank;
        uint64_t balance;
        uint64_t tie;
        int32_t edge;

        Item() = default;
        Item(const Cost& cost, int32_t e)
            // Doubles that are not negative are ordered as their bits; the free sign bit tells the class.
            : rank(cost.concavity > 0 ? not_convex | std::bit_cast<uint64_t>(cost.concavity)
                                      : std::bit_cast<uint64_t>(cost.balance)),
              balance(std::bit_cast<uint64_t>(cost.balance)),
              tie(uint64_t{static_cast<uint32_t>(cost.low)} << 32 | static_cast<uint32_t>(cost.high)), edge(e) {}

        double concavity() const { return rank & not_convex ? std::bit_cast<double>(rank & ~not_convex) : 0; }
        bool operator<(const Item& other) const {
            if (rank != other.rank) [[likely]]
                return rank < other.rank;
            return balance != other.balance ? balance < other.balance : tie < other.tie;
        }

    private:
        static constexpr uint64_t not_convex = uint64_t{1} << 63;
    };

    void reserve(size_t edges) {
        heap_.reserve(edges);
        place_.reserve(edges);
    }

    // Without restoring the order, see sort().
    void append(const Cost& cost, int32_t edge) {
        place_.resize(static_cast<size_t>(edge) + 1, absent);
        heap_.emplace_back();
        put(heap_.size() - 1, {cost, edge});
    }

    void sort() {
        for (size_t i = heap_.size() / children + 1; i-- > 0;)
            if (i < heap_.size()) sink(i, Item(heap_[i]));
    }

    bool empty() const { return heap_.empty(); }
    int32_t top() const { return heap_[0].edge; }

    // The top one and some that come soon after it.
    std::span<const Item> top_items() const { return {heap_.data(), std::min(children + 1, heap_.size())}; }

    // What comes after the top one; null if there is nothing.
    const Item* runner_up() const {
        const std::span<const Item> items = top_items();
        return items.size() < 2 ? nullptr : &*std::min_element(items.begin() + 1, items.end());
    }

    // Some of those that come after the top one: the items at these places of the heap.
    std::span<const Item> items(size_t first, size_t last) const {
        return {heap_.data() + std::min(first, heap_.size()), heap_.data() + std::min(last, heap_.size())};
    }

    void prefetch(int32_t edge) const { __builtin_prefetch(&place_[static_cast<size_t>(edge)]); }

    void update(const Cost& cost, int32_t edge) { settle(place_[static_cast<size_t>(edge)], {cost, edge}); }

    void remove(int32_t edge) {
        const size_t i = std::exchange(place_[static_cast<size_t>(edge)], absent);
        const Item last = heap_.back();
        heap_.pop_back();
        if (i < heap_.size()) settle(i, last);
    }

private:
    static constexpr uint32_t absent = 0xffffffff;
    static constexpr size_t children = 4;

    void put(size_t i, const Item& item) {
        heap_[i] = item;
        place_[static_cast<size_t>(item.edge)] = static_cast<uint32_t>(i);
    }

    // Puts the item where it belongs, above or below the gap at i.
    void settle(size_t i, const Item& item) {
        while (i > 0 && item < heap_[(i - 1) / children]) {
            put(i, heap_[(i - 1) / children]);
            i = (i - 1) / children;
        }
        sink(i, item);
    }

    void sink(size_t i, const Item& item) {
        for (;;) {
            const size_t first = children * i + 1, end = std::min(first + children, heap_.size());
            if (first >= end) break;
            size_t least = first;
            for (size_t c = first + 1; c < end; ++c) least = heap_[c] < heap_[least] ? c : least;
            if (!(heap_[least] < item)) break;
            put(i, heap_[least]);
            i = least;
        }
        put(i, item);
    }

    std::vector<Item> heap_;
    std::vector<uint32_t> place_;  // of each edge in heap_
};

class Clustering {
public:
    Clustering(const TetMesh& mesh, Progress& progress, int threads);
    BinaryTree run();

private:
    Cluster& at(int32_t c) { return clusters_[static_cast<size_t>(c)]; }
    const Cluster& at(int32_t c) const { return clusters_[static_cast<size_t>(c)]; }
    Edge& edge_at(int32_t e) { return edges_[static_cast<size_t>(e)]; }
    const Edge& edge_at(int32_t e) const { return edges_[static_cast<size_t>(e)]; }
    const Point& point(int32_t v) const { return mesh_.vertices[static_cast<size_t>(v)]; }

    int32_t add_edge(int32_t a, int32_t b);
    Cost cost(const Edge& edge) const;
    std::span<const int32_t> corners(int32_t c) const;
    std::pair<int32_t, int32_t> by_size(const Edge& edge) const;
    double union_of_neighbours(int32_t a, int32_t b) const;
    double enough(const Edge& edge, double concavity) const;
    void evaluate(std::span<const int32_t> edges, double concavity);
    std::span<const int32_t> first_unpriced();
    void prefetch_next() const;
    void contract_all();
    void contract(int32_t edge);
    Hull unite(const Edge& edge);
    void join_components();

    const TetMesh& mesh_;
    Progress& progress_;
    HullKernel kernel_;
    std::optional<HullKernel> second_kernel_;
    std::optional<PairOfThreads> threads_;
    std::vector<Cluster> clusters_;
    std::vector<Edge> edges_;
    EdgeQueue queue_;
    struct Pricing {
        const Hull* hull;
        std::span<const int32_t> points;
        double enough;
        HullKernel::Measure measure;
    };
    std::vector<Pricing> pricings_;  // scratch of evaluate()
    std::vector<int32_t> unpriced_;  // scratch of contract() and first_unpriced()
    std::vector<int32_t> link_of_;   // scratch of contract(): cluster -> position in the merged links, or -1
    BinaryTree tree_;
};

Clustering::Clustering(const TetMesh& mesh, Progress& progress, int threads)
    : mesh_(mesh), progress_(progress), kernel_(mesh.vertices), clusters_(mesh.tetrahedra.size()),
      link_of_(mesh.tetrahedra.size(), -1) {
    if (threads > 1) {
        try {
            threads_.emplace();
            second_kernel_.emplace(mesh.vertices);
        } catch (const std::system_error&) {
            // The system gives no second thread: one does as well.
        }
    }
    const auto count = static_cast<int32_t>(mesh.tetrahedra.size());
    for (int32_t t = 0; t < count; ++t) {
        const Tetrahedron& tet = mesh.tetrahedra[static_cast<size_t>(t)];
        Cluster& c = at(t);
        c.volume = c.hull_volume = six_volumes(point(tet[0]), point(tet[1]), point(tet[2]), point(tet[3])) / 6;
        c.low = c.number = t;
        c.links.reserve(4);
    }
    edges_.reserve(2 * mesh.tetrahedra.size());
    queue_.reserve(2 * mesh.tetrahedra.size());
    tree_.merges.reserve(mesh.tetrahedra.size());
    for (int32_t t = 0; t < count; ++t) {
        for (const int32_t other : mesh.neighbours[static_cast<size_t>(t)])
            if (other > t) {
                Edge& e = edge_at(add_edge(t, other));
                e.hull_volume = union_of_neighbours(t, other);
                e.exact = true;
                queue_.append(cost(e), static_cast<int32_t>(edges_.size()) - 1);
            }
        if (t % 1024 == 0) progress_.advance(0.1 * t / count);
    }
    queue_.sort();
}

int32_t Clustering::add_edge(int32_t a, int32_t b) {
    const auto edge = static_cast<int32_t>(edges_.size());
    edges_.push_back({.a = a, .b = b});
    at(a).links.push_back({b, edge});
    at(b).links.push_back({a, edge});
    return edge;
}

// The edge's cost as far as its hull volume is known.
Cost Clustering::cost(const Edge& e) const {
    const Cluster &a = at(e.a), &b = at(e.b);
    const double hull_volume = e.exact ? e.hull_volume : e.hull_volume * (1 - bound_slack);
    const auto square = [](int32_t n) { return static_cast<double>(n) * static_cast<double>(n); };
    return {ranked_concavity(hull_volume, a.volume + b.volume), square(a.size) + square(b.size),
            std::min(a.low, b.low), std::max(a.low, b.low)};
}

// The vertices of a cluster's hull.
std::span<const int32_t> Clustering::corners(int32_t c) const {
    if (at(c).hull) return at(c).hull.vertices();
    return mesh_.tetrahedra[static_cast<size_t>(at(c).low)];
}

// The edge's clusters, the one whose hull has more facets first, or the lower one.
std::pair<int32_t, int32_t> Clustering::by_size(const Edge& e) const {
    const size_t a = at(e.a).hull.facet_count(), b = at(e.b).hull.facet_count();
    const bool ordered = a != b ? a > b : at(e.a).low < at(e.b).low;
    return ordered ? std::pair(e.a, e.b) : std::pair(e.b, e.a);
}

// The volume of the union of two tetrahedra with a common facet: theirs, and what the far corner of b sees of a.
double Clustering::union_of_neighbours(int32_t a, int32_t b) const {
    constexpr size_t facets[4][3] = {{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}};  // opposite each corner, outward
    const Tetrahedron& s = mesh_.tetrahedra[static_cast<size_t>(a)];
    const Tetrahedron& t = mesh_.tetrahedra[static_cast<size_t>(b)];
    const auto& beyond = mesh_.neighbours[static_cast<size_t>(b)];
    const Point& far = point(t[static_cast<size_t>(std::find(beyond.begin(), beyond.end(), a) - beyond.begin())]);
    double seen = 0;
    for (size_t k = 0; k < 4; ++k) {
        if (mesh_.neighbours[static_cast<size_t>(a)][k] == b) continue;
        const auto& f = facets[k];
        seen += std::max(0.0, six_volumes(point(s[f[0]]), point(s[f[1]]), point(s[f[2]]), far));
    }
    return at(a).volume + at(b).volume + seen / 6;
}

// A volume of this edge's union with which it costs more than this concavity.
double Clustering::enough(const Edge& e, double concavity) const {
    if (e.tried) return std::numeric_limits<double>::infinity();
    const double volume = at(e.a).volume + at(e.b).volume;
    // Rather more than that, for the roundings and the slack.
    if (concavity == 0) return volume / (1 - convex_tolerance) * (1 + 1e-9);
    return (volume + concavity * (1 + 1e-8)) * (1 + 1e-10);
}

// Finds the exact volumes of the edges' hulls; or, at the first try, only that they cost more than this concavity.
void Clustering::evaluate(std::span<const int32_t> edges, double concavity) {
    pricings_.clear();
    size_t tests = 0;
    for (const int32_t edge : edges) {
        const Edge& e = edge_at(edge);
        const auto [large, small] = by_size(e);
        if (!at(large).hull) at(large).hull = kernel_.build(corners(large));
        pricings_.push_back({&at(large).hull, corners(small), enough(e, concavity), {}});
        tests += at(large).hull.facet_count() * pricings_.back().points.size();
    }
    const auto price = [&](size_t i, HullKernel& kernel) {
        Pricing& p = pricings_[i];
        p.measure = kernel.united_volume(*p.hull, p.points, p.enough);
    };
    if (threads_ && edges.size() > 1 && tests >= worth_sharing)
        threads_->share(edges.size(),
                        [&](size_t i, size_t thread) { price(i, thread == 0 ? kernel_ : *second_kernel_); });
    else
        for (size_t i = 0; i < edges.size(); ++i) price(i, kernel_);
    for (size_t i = 0; i < edges.size(); ++i) {
        Edge& e = edge_at(edges[i]);
        const auto [volume, exact] = pricings_[i].measure;
        e.hull_volume = exact ? volume : std::max(e.hull_volume, volume);
        e.exact = exact;
        e.tried = true;
        queue_.update(cost(e), edges[i]);
    }
}

// The queue's first edge if it is not exact; for two threads also the others near the top that are not.
std::span<const int32_t> Clustering::first_unpriced() {
    unpriced_.clear();
    const auto items = queue_.top_items();
    for (const EdgeQueue::Item& item : items.first(threads_ ? items.size() : 1))
        if (!edge_at(item.edge).exact) unpriced_.push_back(item.edge);
    return unpriced_;
}

// What comes soon is anywhere in memory: lets it begin, step by step as it rises in the queue.
void Clustering::prefetch_next() const {
    for (const EdgeQueue::Item& item : queue_.items(5, 21)) __builtin_prefetch(&edge_at(item.edge));
    for (const EdgeQueue::Item& item : queue_.items(1, 5)) {
        __builtin_prefetch(&at(edge_at(item.edge).a));
        __builtin_prefetch(&at(edge_at(item.edge).b));
    }
    if (const EdgeQueue::Item* second = queue_.runner_up())
        for (const int32_t c : {edge_at(second->edge).a, edge_at(second->edge).b}) {
            at(c).hull.prefetch();
            __builtin_prefetch(at(c).links.data());
        }
}

void Clustering::contract_all() {
    while (!queue_.empty()) {
        const int32_t top = queue_.top();
        prefetch_next();
        if (!edge_at(top).exact) {
            const EdgeQueue::Item* second = queue_.runner_up();
            evaluate(first_unpriced(), second ? dear * second->concavity() : std::numeric_limits<double>::infinity());
            continue;
        }
        contract(top);
        if (tree_.merges.size() % 256 == 0)
            progress_.advance(0.1 + 0.9 * static_cast<double>(tree_.merges.size()) /
                                        static_cast<double>(clusters_.size()));
    }
}

Hull Clustering::unite(const Edge& e) {
    const auto [large, small] = by_size(e);
    if (at(large).hull) return kernel_.unite(at(large).hull, corners(small));
    std::array<int32_t, 8> both;
    std::copy_n(corners(small).begin(), 4, std::copy_n(corners(large).begin(), 4, both.begin()));
    return kernel_.build(both);
}

void Clustering::contract(int32_t contracted) {
    const EdgeQueue::Item price(cost(edge_at(contracted)), contracted);
    queue_.remove(contracted);
    const Edge& edge = edge_at(contracted);
    // The cluster with more links stays and takes in the other.
    const bool stay_a = at(edge.a).links.size() >= at(edge.b).links.size();
    const int32_t stay = stay_a ? edge.a : edge.b, go = stay_a ? edge.b : edge.a;
    Cluster &m = at(stay), &g = at(go);
    // The neighbours are anywhere in memory: let it begin.
    for (const Cluster* c : {&m, &g})
        for (const Link& link : c->links) {
            __builtin_prefetch(&at(link.cluster));
            __builtin_prefetch(&edge_at(link.edge));
            queue_.prefetch(link.edge);
        }

    const bool ordered = m.low < g.low;
    const Cluster &first = ordered ? m : g, &second = ordered ? g : m;
    const double volume = first.volume + second.volume;
    tree_.merges.push_back({first.number, second.number, ranked_concavity(edge.hull_volume, volume), edge.hull_volume});
    m.hull = unite(edge);
    m.hull_volume = m.hull.volume();
    m.volume = volume;
    m.size += g.size;
    m.low = std::min(m.low, g.low);
    m.number = static_cast<int32_t>(clusters_.size() + tree_.merges.size() - 1);

    std::erase_if(m.links, [&](const Link& l) { return l.cluster == go; });
    for (size_t i = 0; i < m.links.size(); ++i)
        link_of_[static_cast<size_t>(m.links[i].cluster)] = static_cast<int32_t>(i);
    for (const Link& link : g.links) {
        if (link.cluster == stay) continue;
        Cluster& other = at(link.cluster);
        Edge& moved = edge_at(link.edge);
        const auto back = std::find_if(other.links.begin(), other.links.end(),
                                       [&](const Link& l) { return l.cluster == go; });
        const int32_t twin = link_of_[static_cast<size_t>(link.cluster)];
        if (twin < 0) {
            back->cluster = stay;
            (moved.a == go ? moved.a : moved.b) = stay;
            m.links.push_back(link);
        } else {
            Edge& kept = edge_at(m.links[static_cast<size_t>(twin)].edge);
            kept.hull_volume = std::max(kept.hull_volume, moved.hull_volume);
            queue_.remove(link.edge);
            other.links.erase(back);
        }
    }
    g = Cluster{};
    g.size = 0;

    for (const Link& link : m.links) at(link.cluster).hull.prefetch();
    // Those that may be cheaper than the merge just made are the next that the queue would ask for.
    unpriced_.clear();
    for (const Link& link : m.links) {
        link_of_[static_cast<size_t>(link.cluster)] = -1;
        Edge& e = edge_at(link.edge);
        e.hull_volume = std::max({e.hull_volume, m.hull_volume, at(link.cluster).hull_volume});
        e.exact = e.tried = false;
        const Cost bound = cost(e);
        if (EdgeQueue::Item(bound, link.edge) < price)
            unpriced_.push_back(link.edge);
        else
            queue_.update(bound, link.edge);
    }
    evaluate(unpriced_, dear * price.concavity());
}

// Called when no edge is left: makes candidates of the clusters that remain.
void Clustering::join_components() {
    std::vector<int32_t> rest;
    for (size_t c = 0; c < clusters_.size(); ++c)
        if (clusters_[c].size > 0) rest.push_back(static_cast<int32_t>(c));
    std::sort(rest.begin(), rest.end(), [&](int32_t a, int32_t b) { return at(a).low < at(b).low; });
    for (const int32_t c : rest)
        if (!at(c).hull) at(c).hull = kernel_.build(corners(c));
    std::vector<int32_t> edges;
    const auto join = [&](int32_t i, int32_t j) {
        edges.push_back(add_edge(rest[static_cast<size_t>(i)], rest[static_cast<size_t>(j)]));
        queue_.append(cost(edge_at(edges.back())), edges.back());
    };
    const auto price_all = [&] {
        queue_.sort();
        evaluate(edges, std::numeric_limits<double>::infinity());
    };
    const auto count = static_cast<int32_t>(rest.size());
    if (count <= all_pairs_components) {
        for (int32_t i = 0; i < count; ++i)
            for (int32_t j = i + 1; j < count; ++j) join(i, j);
        price_all();
        return;
    }

    namespace bg = boost::geometry;
    using Corner = bg::model::point<double, 3, bg::cs::cartesian>;
    using Box = bg::model::box<Corner>;
    std::vector<std::pair<Box, int32_t>> boxes;
    for (int32_t i = 0; i < count; ++i) {
        const auto [low, high] = kernel_.bounds(at(rest[static_cast<size_t>(i)]).hull);
        boxes.push_back({Box({low[0], low[1], low[2]}, {high[0], high[1], high[2]}), i});
    }
    const bg::index::rtree<std::pair<Box, int32_t>, bg::index::rstar<16>> tree(boxes);
    std::vector<std::pair<int32_t, int32_t>> pairs;
    for (const auto& [box, i] : boxes)
        for (auto q = tree.qbegin(bg::index::nearest(box, nearest_components + 1)); q != tree.qend(); ++q)
            if (q->second != i) pairs.push_back(std::minmax(i, q->second));
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    for (const auto& [i, j] : pairs) join(i, j);
    price_all();
}

BinaryTree Clustering::run() {
    contract_all();
    tree_.components = clusters_.size() - tree_.merges.size();
    while (tree_.merges.size() + 1 < clusters_.size()) {
        join_components();
        contract_all();
    }
    return std::move(tree_);
}

}  // namespace

BinaryTree cluster(const TetMesh& mesh, Progress& progress, int threads) {
    return Clustering(mesh, progress, threads).run();
}

}  // namespace partwheel
