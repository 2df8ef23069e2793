// Hierarchical tet clustering (the paper's Listing 1): hulls from hulls, costs only where the queue asks for them.
#include "cluster.h"

#include "hull.h"

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace partwheel {

double ranked_concavity(double hull_volume, double volume) {
    const double concavity = hull_volume - volume;
    if (!(concavity > convex_tolerance * hull_volume)) return 0;
    int exponent = 0;
    const double mantissa = std::frexp(concavity, &exponent);
    return std::ldexp(std::nearbyint(std::ldexp(mantissa, concavity_bits)), exponent - concavity_bits);
}

namespace {

// Volumes of hulls that were come by differently agree to far better than this: what a lower bound gives away so that
// it stays one in spite of rounding.
constexpr double bound_slack = 1e-11;

constexpr size_t nearest_components = 16;

struct Link {
    int32_t cluster;  // the neighbour
    int32_t edge;
};

struct Cluster {
    Hull hull;
    double volume = 0;
    int32_t size = 1;    // in tetrahedra
    int32_t low = 0;     // its lowest tetrahedron
    int32_t number = 0;  // in the tree, see Merge
    std::vector<Link> links;
    bool alive = true;
};

struct Edge {
    int32_t a = 0, b = 0;    // clusters
    double hull_volume = 0;  // of their union, or a lower bound of it
    bool exact = false;
    Cost cost{};  // as it stands in the queue: of the exact hull volume or of the bound
};

// The edges, cheapest first: a heap with four children a node that knows where each edge is, so that costs change in
// place. Most comparisons are settled by one number: concavity, or C2 among convex unions; the rest by the whole cost.
class EdgeQueue {
public:
    explicit EdgeQueue(const std::vector<Edge>& edges) : edges_(edges) {}

    bool empty() const { return heap_.empty(); }
    int32_t top() const { return heap_[0].edge; }

    // The edge is new, or its cost has changed.
    void update(int32_t edge) {
        if (place_.size() < edges_.size()) place_.resize(edges_.size(), absent);
        size_t i = place_[static_cast<size_t>(edge)];
        if (i == absent) {
            i = heap_.size();
            heap_.emplace_back();
        }
        settle(i, {rank(cost(edge)), edge});
    }

    void remove(int32_t edge) {
        const size_t i = place_[static_cast<size_t>(edge)];
        if (i == absent) return;
        place_[static_cast<size_t>(edge)] = absent;
        const Item last = heap_.back();
        heap_.pop_back();
        if (i < heap_.size()) settle(i, last);
    }

private:
    static constexpr uint32_t absent = 0xffffffff;
    static constexpr size_t children = 4;

    struct Item {
        uint64_t rank;
        int32_t edge;
    };

    const Cost& cost(int32_t edge) const { return edges_[static_cast<size_t>(edge)].cost; }

    // Doubles that are not negative are ordered as their bits; the free sign bit tells the class.
    static uint64_t rank(const Cost& cost) {
        constexpr uint64_t not_convex = uint64_t{1} << 63;
        return cost.concavity > 0 ? not_convex | std::bit_cast<uint64_t>(cost.concavity)
                                  : std::bit_cast<uint64_t>(cost.balance);
    }

    bool before(const Item& x, const Item& y) const {
        return x.rank != y.rank ? x.rank < y.rank : cost(x.edge) < cost(y.edge);
    }

    void put(size_t i, const Item& item) {
        heap_[i] = item;
        place_[static_cast<size_t>(item.edge)] = static_cast<uint32_t>(i);
    }

    // Puts the item where it belongs, above or below the gap at i.
    void settle(size_t i, const Item& item) {
        while (i > 0 && before(item, heap_[(i - 1) / children])) {
            put(i, heap_[(i - 1) / children]);
            i = (i - 1) / children;
        }
        for (;;) {
            const size_t first = children * i + 1, end = std::min(first + children, heap_.size());
            if (first >= end) break;
            size_t least = first;
            for (size_t c = first + 1; c < end; ++c)
                if (before(heap_[c], heap_[least])) least = c;
            if (!before(heap_[least], item)) break;
            put(i, heap_[least]);
            i = least;
        }
        put(i, item);
    }

    const std::vector<Edge>& edges_;
    std::vector<Item> heap_;
    std::vector<uint32_t> place_;  // of each edge in heap_
};

class Clustering {
public:
    Clustering(const TetMesh& mesh, Progress& progress);
    BinaryTree run();

private:
    Cluster& at(int32_t c) { return clusters_[static_cast<size_t>(c)]; }
    const Cluster& at(int32_t c) const { return clusters_[static_cast<size_t>(c)]; }

    void add_edge(int32_t a, int32_t b);
    Edge& edge_at(int32_t e) { return edges_[static_cast<size_t>(e)]; }
    void reprice(int32_t edge);
    void evaluate(int32_t edge);
    void contract_all();
    void contract(int32_t edge);
    void join_components();

    Progress& progress_;
    HullKernel kernel_;
    std::vector<Cluster> clusters_;
    std::vector<Edge> edges_;
    EdgeQueue queue_{edges_};
    std::vector<int32_t> link_of_;  // scratch of contract(): cluster -> position in the merged links, or -1
    BinaryTree tree_;
};

Clustering::Clustering(const TetMesh& mesh, Progress& progress)
    : progress_(progress), kernel_(mesh.vertices), clusters_(mesh.tetrahedra.size()),
      link_of_(mesh.tetrahedra.size(), -1) {
    const auto count = static_cast<int32_t>(mesh.tetrahedra.size());
    for (int32_t t = 0; t < count; ++t) {
        Cluster& c = at(t);
        const Tetrahedron& tet = mesh.tetrahedra[static_cast<size_t>(t)];
        c.hull = kernel_.build(tet);
        c.volume = c.hull.volume;
        c.low = c.number = t;
        c.links.reserve(4);
    }
    edges_.reserve(2 * mesh.tetrahedra.size());
    for (int32_t t = 0; t < count; ++t) {
        for (int32_t other : mesh.neighbours[static_cast<size_t>(t)])
            if (other > t) add_edge(t, other);
        if (t % 1024 == 0) progress_.advance(0.2 * t / count);
    }
}

void Clustering::add_edge(int32_t a, int32_t b) {
    const auto edge = static_cast<int32_t>(edges_.size());
    edges_.push_back({.a = a, .b = b});
    at(a).links.push_back({b, edge});
    at(b).links.push_back({a, edge});
    evaluate(edge);
}

// Sets the edge's cost from what is known of its hull volume.
void Clustering::reprice(int32_t edge) {
    Edge& e = edge_at(edge);
    const Cluster &a = at(e.a), &b = at(e.b);
    const double hull_volume = e.exact ? e.hull_volume : e.hull_volume * (1 - bound_slack);
    const auto square = [](int32_t n) { return static_cast<double>(n) * static_cast<double>(n); };
    e.cost = {ranked_concavity(hull_volume, a.volume + b.volume), square(a.size) + square(b.size),
              std::min(a.low, b.low), std::max(a.low, b.low)};
    queue_.update(edge);
}

void Clustering::evaluate(int32_t edge) {
    Edge& e = edge_at(edge);
    const bool ordered = at(e.a).low < at(e.b).low;
    const Cluster &first = at(ordered ? e.a : e.b), &second = at(ordered ? e.b : e.a);
    e.hull_volume = kernel_.united_volume(first.hull, second.hull);
    e.exact = true;
    reprice(edge);
}

void Clustering::contract_all() {
    while (!queue_.empty()) {
        const int32_t top = queue_.top();
        if (!edge_at(top).exact) {
            evaluate(top);
            if (queue_.top() != top) continue;
        }
        contract(top);
        if (tree_.merges.size() % 256 == 0)
            progress_.advance(0.2 + 0.8 * static_cast<double>(tree_.merges.size()) /
                                        static_cast<double>(clusters_.size()));
    }
}

void Clustering::contract(int32_t contracted) {
    queue_.remove(contracted);
    const Edge& edge = edge_at(contracted);
    // The cluster with more links stays and takes in the other.
    const bool stay_a = at(edge.a).links.size() >= at(edge.b).links.size();
    const int32_t stay = stay_a ? edge.a : edge.b, go = stay_a ? edge.b : edge.a;
    Cluster &m = at(stay), &g = at(go);

    const bool ordered = m.low < g.low;
    Cluster &first = ordered ? m : g, &second = ordered ? g : m;
    Merge merge;
    merge.left = first.number;
    merge.right = second.number;
    merge.concavity = ranked_concavity(edge.hull_volume, first.volume + second.volume);
    merge.hull_volume = edge.hull_volume;
    m.hull = kernel_.unite(first.hull, second.hull);
    m.volume = first.volume + second.volume;
    m.size += g.size;
    m.low = first.low;
    m.number = static_cast<int32_t>(clusters_.size() + tree_.merges.size());
    tree_.merges.push_back(merge);

    std::erase_if(m.links, [&](const Link& l) { return l.cluster == go; });
    for (size_t i = 0; i < m.links.size(); ++i) link_of_[static_cast<size_t>(m.links[i].cluster)] = static_cast<int32_t>(i);
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
    for (const Link& link : m.links) link_of_[static_cast<size_t>(link.cluster)] = -1;
    g = Cluster{};
    g.alive = false;

    for (const Link& link : m.links) {
        Edge& e = edge_at(link.edge);
        e.hull_volume = std::max({e.hull_volume, m.hull.volume, at(link.cluster).hull.volume});
        e.exact = false;
        reprice(link.edge);
    }
}

// Called when no edge is left: makes candidates of the clusters that remain.
void Clustering::join_components() {
    std::vector<int32_t> rest;
    for (size_t c = 0; c < clusters_.size(); ++c)
        if (clusters_[c].alive) rest.push_back(static_cast<int32_t>(c));
    std::sort(rest.begin(), rest.end(), [&](int32_t a, int32_t b) { return at(a).low < at(b).low; });
    const auto count = static_cast<int32_t>(rest.size());
    if (count <= all_pairs_components) {
        for (int32_t i = 0; i < count; ++i)
            for (int32_t j = i + 1; j < count; ++j) add_edge(rest[static_cast<size_t>(i)], rest[static_cast<size_t>(j)]);
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
    for (const auto& [i, j] : pairs) add_edge(rest[static_cast<size_t>(i)], rest[static_cast<size_t>(j)]);
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

BinaryTree cluster(const TetMesh& mesh, Progress& progress, int /*threads: not yet*/) { return Clustering(mesh, progress).run(); }

}  // namespace partwheel
