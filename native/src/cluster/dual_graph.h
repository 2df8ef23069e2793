// The dual graph of a tet mesh under contraction: clusters, the edges between them, and their costs.
#pragma once

#include "base/memory.h"
#include "base/progress.h"
#include "cluster/binary_tree.h"
#include "cluster/edge_queue.h"
#include "hull/hull.h"
#include "cluster/links.h"
#include "fill/tetrahedra.h"

namespace partwheel {

// The relative amount by which a lower bound of a volume is reduced, so that it stays a bound in spite of rounding.
// Volumes of one hull that were computed in different ways agree far better than this.
inline constexpr double bound_slack = 1e-11;

struct alignas(64) Cluster {
    Hull hull;  // empty while the cluster is a single tetrahedron
    double hull_volume = 0;
    double volume = 0;
    Links links;
    uint32_t facets = 0;  // of the hull; a copy that saves most callers a cache miss
    int32_t size = 1;     // in tetrahedra; 0 once it was merged into another cluster
    int32_t low = 0;      // its lowest tetrahedron
    int32_t number = 0;   // in the merge tree, see Merge
};
static_assert(sizeof(Cluster) == 64);

struct DualEdge {
    int32_t a, b;            // clusters
    double hull_volume = 0;  // of their union, or a lower bound
    bool exact = false;
    bool bound_evaluated = false;  // hull_volume is a bound computed for these two clusters
};

class DualGraph {
public:
    // One cluster per tetrahedron; costs are not computed yet.
    DualGraph(const TetMesh& mesh, Progress& progress);

    // The exact costs of all edges, before any contraction. threads: the maximum number; 0: as many as help.
    void compute_initial_costs(Progress& progress, size_t threads);

    size_t cluster_count() const { return clusters_.size(); }  // including those merged into others
    size_t edge_count() const { return edges_.size(); }
    Cluster& at(int32_t c) { return clusters_[static_cast<size_t>(c)]; }
    const Cluster& at(int32_t c) const { return clusters_[static_cast<size_t>(c)]; }
    DualEdge& edge(int32_t e) { return edges_[static_cast<size_t>(e)]; }
    const DualEdge& edge(int32_t e) const { return edges_[static_cast<size_t>(e)]; }

    int32_t add_edge(int32_t a, int32_t b);

    // Gives a cluster its hull if it is still a single tetrahedron.
    void make_hull(int32_t c) {
        if (!at(c).hull) set_hull(c, hulls_.build(corners(c)));
    }

    // The bounding box of a cluster that has a hull.
    Box bounds(int32_t c) const { return hulls_.bounds(at(c).hull); }

    // The cost of the edge, or a lower bound.
    MergeCost cost(int32_t edge) const {
        const DualEdge& e = this->edge(edge);
        const Cluster &a = at(e.a), &b = at(e.b);
        const double hull_volume = e.exact ? e.hull_volume : e.hull_volume * (1 - bound_slack);
        const auto square = [](int32_t n) { return static_cast<double>(n) * static_cast<double>(n); };
        return {ranked_concavity(hull_volume, a.volume + b.volume), square(a.size) + square(b.size),
                std::min(a.low, b.low), std::max(a.low, b.low)};
    }

    // Prefetches what compute_costs() reads first of the edge's cluster other than `excluded`.
    void prefetch(int32_t edge, int32_t excluded) const {
        const DualEdge& e = this->edge(edge);
        const Cluster& other = at(e.a == excluded ? e.b : e.a);
        if (other.hull)
            other.hull.prefetch();
        else
            prefetch_line(&mesh_.tetrahedra[static_cast<size_t>(other.low)]);
    }

    // Computes the exact hull volumes of the edges; at the first evaluation, stops once an edge is known to cost more
    // than this concavity.
    void compute_costs(std::span<const int32_t> edges, double concavity);

    // Merges the edge's clusters into one of the two, which gets that number. Edges that become duplicates are
    // appended to `removed`; the ones that stay keep the better bound of the two. The caller calls invalidate_cost()
    // for them.
    Merge contract(int32_t edge, int32_t number, std::vector<int32_t>& removed, int32_t& merged);

    // For an edge of a cluster that was just merged: its cost is now only a bound.
    void invalidate_cost(int32_t number) {
        DualEdge& e = edge(number);
        e.hull_volume = std::max({e.hull_volume, at(e.a).hull_volume, at(e.b).hull_volume});
        e.exact = e.bound_evaluated = false;
    }

private:
    std::span<const int32_t> corners(int32_t c) const;  // the vertices of the cluster's hull
    void set_hull(int32_t c, Hull hull) {
        at(c).facets = static_cast<uint32_t>(hull.facet_count());
        at(c).hull = std::move(hull);
    }
    const Point& point(int32_t v) const { return mesh_.vertices[static_cast<size_t>(v)]; }
    std::pair<int32_t, int32_t> larger_hull_first(const DualEdge& edge) const;
    double union_volume_of_neighbors(int32_t a, int32_t b) const;
    double early_out_volume(const DualEdge& edge, double concavity) const;
    Hull unite(const DualEdge& edge);

    const TetMesh& mesh_;
    HullKernel hulls_;  // declared before the clusters: must outlive all hulls, as links_ must outlive all Links
    Pool links_;
    LargeVector<Link> first_links_;  // the initial memory of each cluster's links
    LargeVector<Cluster> clusters_;
    LargeVector<DualEdge> edges_;
    LargeVector<int32_t> link_of_;  // scratch of contract(): cluster -> index in the merged links, or -1
};

}  // namespace partwheel
