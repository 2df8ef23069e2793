// Hierarchical tet clustering (the paper's Listing 1): hulls from hulls, exact costs only where the queue needs them.
#include "cluster/cluster.h"

#include "base/sorted.h"
#include "cluster/dual_graph.h"
#include "mesh/bvh.h"

namespace partwheel {

namespace {

constexpr size_t nearest_components = 16;

// An edge that costs more than this many times the next one gets no exact cost yet.
constexpr double lazy_cost_factor = 2;

// The `count` boxes nearest to box i, without i itself, by ascending distance. Among boxes at the same distance the
// lowest indices win, so that the result depends on the boxes alone.
std::vector<int32_t> nearest_boxes(std::span<const Box> boxes, const Bvh& tree, size_t i, size_t count) {
    using Neighbor = std::pair<double, size_t>;  // squared distance, index
    std::vector<Neighbor> best;                  // a heap whose front is the worst
    const auto distance = [&](const Box& box) { return squared_distance(boxes[i], box); };
    const auto may_improve = [&](double squared, size_t first) {
        return best.size() < count || Neighbor(squared, first) < best.front();
    };
    tree.nearest_first(distance, may_improve, [&](size_t index, double squared) {
        if (index == i) return;
        if (best.size() == count) {
            std::pop_heap(best.begin(), best.end());
            best.pop_back();
        }
        best.push_back({squared, index});
        std::push_heap(best.begin(), best.end());
    });
    std::sort_heap(best.begin(), best.end());
    std::vector<int32_t> indices;
    for (const auto& [squared, index] : best) indices.push_back(static_cast<int32_t>(index));
    return indices;
}

class Clustering {
public:
    Clustering(const TetMesh& mesh, Progress& progress, size_t threads) : progress_(progress), graph_(mesh, progress) {
        graph_.compute_initial_costs(progress, threads);
        tree_.merges.reserve(mesh.tetrahedra.size());
    }

    BinaryTree run() {
        queue_edges();
        contract_all();
        tree_.components = graph_.cluster_count() - tree_.merges.size();
        while (tree_.merges.size() + 1 < graph_.cluster_count()) {
            connect_components();
            contract_all();
        }
        return std::move(tree_);
    }

private:
    // Queues the edges between the remaining clusters.
    void queue_edges() {
        queue_.set_edge_count(graph_.edge_count());
        if (tree_.merges.empty()) queue_.reserve(graph_.edge_count());  // otherwise few remain
        for (size_t c = 0; c < graph_.cluster_count(); ++c)
            for (const Link& link : graph_.at(static_cast<int32_t>(c)).links)
                if (!queue_.has(link.edge)) queue_.append(graph_.cost(link.edge), link.edge);
        queue_.sort();
    }

    // The next edges of the queue are scattered in memory: prefetches them in stages as they rise.
    void prefetch_soon(const EdgeQueue::Item* second) const {
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

    // Prefetches the neighbors of an edge that is about to be contracted.
    void prefetch_around(int32_t contracted) const {
        for (const int32_t c : {graph_.edge(contracted).a, graph_.edge(contracted).b})
            for (const Link& link : graph_.at(c).links) {
                prefetch_line(&graph_.at(link.cluster));
                prefetch_line(&graph_.edge(link.edge));
                queue_.prefetch(link.edge);
            }
    }

    // Computes the costs of edges (see DualGraph::compute_costs) and updates the queue.
    void update_costs(std::span<const int32_t> edges, double concavity) {
        graph_.compute_costs(edges, concavity);
        for (const int32_t edge : edges) queue_.update(graph_.cost(edge), edge);
    }

    void contract_all() {
        for (size_t step = 1; !queue_.empty(); ++step) {
            if (step % 64 == 0)
                progress_.advance(0.1 + 0.9 * static_cast<double>(tree_.merges.size()) /
                                            static_cast<double>(graph_.cluster_count()));
            const int32_t top = queue_.top().edge;
            const EdgeQueue::Item* const second = queue_.runner_up();
            prefetch_soon(second);
            if (!graph_.edge(top).exact) {  // enough to know that it costs far more than the second
                update_costs({&top, 1},
                             second ? lazy_cost_factor * second->concavity() : std::numeric_limits<double>::infinity());
                continue;
            }
            contract(top);
        }
    }

    void contract(int32_t contracted) {
        const MergeCost cost = queue_.top();
        queue_.remove(contracted);
        prefetch_around(contracted);
        removed_.clear();
        int32_t merged;
        const auto number = static_cast<int32_t>(graph_.cluster_count() + tree_.merges.size());
        tree_.merges.push_back(graph_.contract(contracted, number, removed_, merged));
        for (const int32_t edge : removed_) queue_.remove(edge);
        // Edges that may be cheaper than this merge are the next that the queue would need.
        pending_edges_.clear();
        for (const Link& link : graph_.at(merged).links) {
            graph_.invalidate_cost(link.edge);
            const MergeCost bound = graph_.cost(link.edge);
            if (bound < cost) {
                graph_.prefetch(link.edge, merged);
                pending_edges_.push_back(link.edge);
            } else {
                queue_.update(bound, link.edge);
            }
        }
        update_costs(pending_edges_, lazy_cost_factor * cost.concavity());
    }

    // Called when no edge is left: adds edges between the remaining clusters.
    void connect_components() {
        std::vector<int32_t> remaining;
        for (int32_t c = 0; c < static_cast<int32_t>(graph_.cluster_count()); ++c)
            if (graph_.at(c).size > 0) remaining.push_back(c);
        std::sort(remaining.begin(), remaining.end(),
                  [&](int32_t a, int32_t b) { return graph_.at(a).low < graph_.at(b).low; });
        for (const int32_t c : remaining) graph_.make_hull(c);
        std::vector<int32_t> edges;
        const auto connect = [&](int32_t i, int32_t j) {
            edges.push_back(graph_.add_edge(remaining[idx(i)], remaining[idx(j)]));
        };
        const auto compute_initial_costs = [&] {
            queue_edges();
            update_costs(edges, std::numeric_limits<double>::infinity());
        };
        const auto count = static_cast<int32_t>(remaining.size());
        if (count <= all_pairs_components) {
            for (int32_t i = 0; i < count; ++i)
                for (int32_t j = i + 1; j < count; ++j) connect(i, j);
            compute_initial_costs();
            return;
        }

        std::vector<Box> boxes;
        for (const int32_t c : remaining) boxes.push_back(graph_.bounds(c));
        const Bvh tree(boxes);
        std::vector<std::pair<int32_t, int32_t>> pairs;
        for (int32_t i = 0; i < count; ++i)
            for (const int32_t j : nearest_boxes(boxes, tree, idx(i), nearest_components)) pairs.push_back(std::minmax(i, j));
        sort_unique(pairs);
        for (const auto& [i, j] : pairs) connect(i, j);
        compute_initial_costs();
    }

    Progress& progress_;
    DualGraph graph_;
    EdgeQueue queue_;
    std::vector<int32_t> pending_edges_, removed_;  // scratch of contract()
    BinaryTree tree_;
};

}  // namespace

BinaryTree cluster(const TetMesh& mesh, Progress& progress, size_t threads) {
    return Clustering(mesh, progress, threads).run();
}

}  // namespace partwheel
