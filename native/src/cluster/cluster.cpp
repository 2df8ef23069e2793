// Hierarchical tet clustering (the paper's Listing 1): hulls from hulls, costs only where the queue asks for them.
#include "cluster/cluster.h"

#include "cluster/dual_graph.h"
#include "cluster/nearest_boxes.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace partwheel {

namespace {

constexpr size_t nearest_components = 16;

// An edge that costs more than so many times what the next merges cost is not priced exactly yet.
constexpr double dear = 2;

class Clustering {
public:
    Clustering(const TetMesh& mesh, Progress& progress, size_t threads) : progress_(progress), graph_(mesh, progress) {
        graph_.price_all(progress, threads);
        tree_.merges.reserve(mesh.tetrahedra.size());
    }
    BinaryTree run();

private:
    void queue_edges();
    void prefetch_soon(const EdgeQueue::Item* second) const;
    void prefetch_around(int32_t contracted) const;
    void evaluate(std::span<const int32_t> edges, double concavity);
    void contract_all();
    void contract(int32_t edge);
    void join_components();

    Progress& progress_;
    DualGraph graph_;
    EdgeQueue queue_;
    std::vector<int32_t> unpriced_, removed_;  // scratch of contract()
    BinaryTree tree_;
};

// Those between clusters that remain.
void Clustering::queue_edges() {
    queue_.number_edges(graph_.edges_count());
    if (tree_.merges.empty()) queue_.reserve(graph_.edges_count());  // else few are left
    for (size_t c = 0; c < graph_.clusters_count(); ++c)
        for (const Link& link : graph_.at(static_cast<int32_t>(c)).links)
            if (!queue_.has(link.edge)) queue_.append(graph_.price(link.edge), link.edge);
    queue_.sort();
}

// Finds the exact volumes of the edges' hulls; or, at the first try, only that they cost more than this concavity.
void Clustering::evaluate(std::span<const int32_t> edges, double concavity) {
    graph_.find_prices(edges, concavity);
    for (const int32_t edge : edges) queue_.update(graph_.price(edge), edge);
}

// What comes soon in the queue is anywhere in memory: lets it begin, step by step as it rises.
void Clustering::prefetch_soon(const EdgeQueue::Item* second) const {
    for (const auto& item : queue_.items(5, 21)) prefetch_line(&graph_.edge(item.edge));
    for (const auto& item : queue_.items(1, 5)) {
        prefetch_line(&graph_.at(graph_.edge(item.edge).a));
        prefetch_line(&graph_.at(graph_.edge(item.edge).b));
    }
    if (!second) return;
    for (const int32_t c : {graph_.edge(second->edge).a, graph_.edge(second->edge).b}) {
        graph_.at(c).hull.prefetch();
        prefetch_line(graph_.at(c).links.begin());
    }
}

// The same for the neighbours of an edge that is about to be contracted.
void Clustering::prefetch_around(int32_t contracted) const {
    for (const int32_t c : {graph_.edge(contracted).a, graph_.edge(contracted).b})
        for (const Link& link : graph_.at(c).links) {
            prefetch_line(&graph_.at(link.cluster));
            prefetch_line(&graph_.edge(link.edge));
            queue_.prefetch(link.edge);
        }
}

void Clustering::contract_all() {
    for (size_t step = 1; !queue_.empty(); ++step) {
        if (step % 64 == 0)
            progress_.advance(0.1 + 0.9 * static_cast<double>(tree_.merges.size()) /
                                        static_cast<double>(graph_.clusters_count()));
        const int32_t top = queue_.top().edge;
        const EdgeQueue::Item* const second = queue_.runner_up();
        prefetch_soon(second);
        if (!graph_.edge(top).exact) {  // no more need be known than that it costs far more than the second
            evaluate({&top, 1}, second ? dear * second->concavity() : std::numeric_limits<double>::infinity());
            continue;
        }
        contract(top);
    }
}

void Clustering::contract(int32_t contracted) {
    const Price price = queue_.top();
    queue_.remove(contracted);
    prefetch_around(contracted);
    removed_.clear();
    int32_t merged;
    const auto number = static_cast<int32_t>(graph_.clusters_count() + tree_.merges.size());
    tree_.merges.push_back(graph_.contract(contracted, number, removed_, merged));
    for (const int32_t edge : removed_) queue_.remove(edge);
    // Those that may be cheaper than the merge just made are the next that the queue would ask for.
    unpriced_.clear();
    for (const Link& link : graph_.at(merged).links) {
        graph_.refresh(link.edge);
        const Price bound = graph_.price(link.edge);
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
    for (const int32_t c : rest) graph_.make_hull(c);
    std::vector<int32_t> edges;
    const auto join = [&](int32_t i, int32_t j) {
        edges.push_back(graph_.add_edge(rest[at(i)], rest[at(j)]));
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

    std::vector<Box> boxes;
    for (const int32_t c : rest) boxes.push_back(graph_.bounds(c));
    const NearestBoxes tree(std::move(boxes));
    std::vector<std::pair<int32_t, int32_t>> pairs;
    for (int32_t i = 0; i < count; ++i)
        for (const int32_t j : tree.nearest(at(i), nearest_components)) pairs.push_back(std::minmax(i, j));
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    for (const auto& [i, j] : pairs) join(i, j);
    price_all();
}

BinaryTree Clustering::run() {
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

BinaryTree cluster(const TetMesh& mesh, Progress& progress, size_t threads) {
    return Clustering(mesh, progress, threads).run();
}

}  // namespace partwheel
