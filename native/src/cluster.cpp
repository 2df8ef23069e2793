// Hierarchical tet clustering (the paper's Listing 1): hulls from hulls, costs only where the queue asks for them.
#include "cluster.h"

#include "domains.h"
#include "dual_graph.h"
#include "edge_queue.h"
#include "halves.h"

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace partwheel {

namespace {

constexpr size_t nearest_components = 16;

// While one thread makes a hull, the other prices so many edges, of those at the first so many places of the queue.
constexpr size_t most_beside_union = 3, places_beside_union = 21;

class Clustering {
public:
    Clustering(const TetMesh& mesh, Progress& progress, int threads)
        : mesh_(mesh), progress_(progress), workers_(mesh.vertices, threads), graph_(make_graph()) {
        graph_.price_all(progress, workers_.pair());
        tree_.merges.reserve(mesh.tetrahedra.size());
    }
    BinaryTree run();

private:
    using Queue = EdgeQueue<Price>;

    DualGraph make_graph();
    void queue_edges();
    void evaluate(std::span<const int32_t> edges, double concavity);
    void update(std::span<const int32_t> edges);
    std::span<const int32_t> unpriced(std::span<const Queue::Item> items, size_t most, int32_t apart_from = -1);
    void unite_ahead(int32_t contracted);
    void contract_all();
    void contract(int32_t edge);
    void join_components();

    const TetMesh& mesh_;
    Progress& progress_;
    Workers workers_;
    std::vector<uint8_t> halves_;  // none for one thread
    DualGraph graph_;
    EdgePlaces places_;
    Queue queue_{places_};
    std::vector<int32_t> unpriced_;  // scratch of contract() and unpriced()
    std::vector<int32_t> removed_;   // scratch of contract()
    BinaryTree tree_;
};

// While a second thread, if there is one, looks for the halves to begin with.
DualGraph Clustering::make_graph() {
    std::optional<DualGraph> graph;
    in_halves(workers_.pair(), 0, 2, [&](size_t i) {
        if (i == 0)
            graph.emplace(mesh_);
        else if (workers_.threads)
            halves_ = halves(mesh_);
    });
    return std::move(*graph);
}

// Those between clusters that remain.
void Clustering::queue_edges() {
    places_.reserve(graph_.edges_count());
    places_.resize(graph_.edges_count());
    if (tree_.merges.empty()) queue_.reserve(graph_.edges_count());  // else few are left
    for (size_t c = 0; c < graph_.clusters_count(); ++c)
        for (const Link& link : graph_.at(static_cast<int32_t>(c)).links)
            if (!places_.queued(link.edge)) queue_.append(Price(graph_.cost(graph_.edge(link.edge))), link.edge);
    queue_.sort();
}

// Finds the exact volumes of the edges' hulls; or, at the first try, only that they cost more than this concavity.
void Clustering::evaluate(std::span<const int32_t> edges, double concavity) {
    graph_.find_prices(edges, concavity, workers_);
    update(edges);
}

void Clustering::update(std::span<const int32_t> edges) {
    for (const int32_t edge : edges) queue_.update(Price(graph_.cost(graph_.edge(edge))), edge);
}

// The first of these that are not exact, and have no cluster of that edge.
std::span<const int32_t> Clustering::unpriced(std::span<const Queue::Item> items, size_t most, int32_t apart_from) {
    const auto touches = [&](int32_t c) {
        return apart_from >= 0 && (c == graph_.edge(apart_from).a || c == graph_.edge(apart_from).b);
    };
    unpriced_.clear();
    for (const Queue::Item& item : items)
        if (const DualEdge& e = graph_.edge(item.edge);
            unpriced_.size() < most && !e.exact && !touches(e.a) && !touches(e.b))
            unpriced_.push_back(item.edge);
    return unpriced_;
}

// Has one thread make the hull of an edge that is to be contracted, while the other prices what comes soon in the queue.
void Clustering::unite_ahead(int32_t contracted) {
    if (queue_.empty() || !graph_.worth_uniting_ahead(contracted, workers_)) return;
    const auto edges = unpriced(queue_.items(0, places_beside_union), most_beside_union, contracted);
    if (edges.empty()) return;
    graph_.unite_and_find_prices(contracted, edges, dear * queue_.top().concavity(), workers_);
    update(edges);
}

void Clustering::contract_all() {
    while (!queue_.empty()) {
        const int32_t top = queue_.top().edge;
        prefetch_soon(graph_, queue_);
        if (!graph_.edge(top).exact) {
            const auto items = queue_.top_items();
            evaluate(unpriced(items.first(workers_.two() ? items.size() : 1), items.size()), far_beyond_second(queue_));
            continue;
        }
        contract(top);
        if (tree_.merges.size() % 256 == 0)
            progress_.advance(0.1 + 0.9 * static_cast<double>(tree_.merges.size()) /
                                        static_cast<double>(graph_.clusters_count()));
    }
}

void Clustering::contract(int32_t contracted) {
    const Price price = queue_.top();
    queue_.remove(contracted);
    unite_ahead(contracted);
    prefetch_around(graph_, places_, contracted);
    removed_.clear();
    int32_t merged;
    const auto number = static_cast<int32_t>(graph_.clusters_count() + tree_.merges.size());
    tree_.merges.push_back(graph_.contract(contracted, number, workers_.first, removed_, merged));
    for (const int32_t edge : removed_) queue_.remove(edge);
    // Those that may be cheaper than the merge just made are the next that the queue would ask for.
    unpriced_.clear();
    for (const Link& link : graph_.at(merged).links) {
        graph_.refresh(link.edge);
        const Price bound(graph_.cost(graph_.edge(link.edge)));
        if (bound < price) {
            graph_.prefetch(link.edge, merged);
            unpriced_.push_back(link.edge);
        } else {
            queue_.update(bound, link.edge);
        }
    }
    evaluate(unpriced_, dear * price.concavity());
}

// Called when no edge is left: makes candidates of the clusters that remain.
void Clustering::join_components() {
    std::vector<int32_t> rest;
    for (int32_t c = 0; c < static_cast<int32_t>(graph_.clusters_count()); ++c)
        if (graph_.at(c).size > 0) rest.push_back(c);
    std::sort(rest.begin(), rest.end(), [&](int32_t a, int32_t b) { return graph_.at(a).low < graph_.at(b).low; });
    for (const int32_t c : rest)
        if (!graph_.at(c).hull) graph_.set_hull(c, workers_.first.hulls.build(graph_.corners(c)));
    std::vector<int32_t> edges;
    const auto join = [&](int32_t i, int32_t j) {
        edges.push_back(graph_.add_edge(rest[static_cast<size_t>(i)], rest[static_cast<size_t>(j)], workers_.first.links));
    };
    const auto price_all = [&] {
        queue_edges();
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
        const auto [low, high] = workers_.first.hulls.bounds(graph_.at(rest[static_cast<size_t>(i)]).hull);
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
    if (workers_.threads)
        tree_.merges = merge_in_domains(graph_, std::move(halves_), workers_, progress_);
    queue_edges();
    contract_all();
    tree_.components = graph_.clusters_count() - tree_.merges.size();
    while (tree_.merges.size() + 1 < graph_.clusters_count()) {
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
