// The dual graph of a tet mesh while it is contracted: clusters, the edges between them, their prices.
#pragma once

#include "base/memory.h"
#include "base/progress.h"
#include "cluster/binary_tree.h"
#include "cluster/edge_queue.h"
#include "cluster/hull/hull.h"
#include "cluster/links.h"
#include "fill/tetrahedra.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace partwheel {

// Volumes of hulls that were come by differently agree to far better than this: what a lower bound gives away so that
// it stays one in spite of rounding.
inline constexpr double bound_slack = 1e-11;

struct alignas(64) Cluster {
    Hull hull;  // none while it is one tetrahedron
    double hull_volume = 0;
    double volume = 0;
    Links links;
    uint32_t facets = 0;  // of the hull: here, for most who ask have no other need to fetch that
    int32_t size = 1;     // in tetrahedra; 0 once it has gone into another
    int32_t low = 0;      // its lowest tetrahedron
    int32_t number = 0;   // in the tree, see Merge
};
static_assert(sizeof(Cluster) == 64);

struct DualEdge {
    int32_t a, b;            // clusters
    double hull_volume = 0;  // of their union, or a lower bound of it
    bool exact = false;
    bool tried = false;  // the bound has been worked out for these clusters
};

class DualGraph {
public:
    // One tetrahedron a cluster; the edges are not priced.
    DualGraph(const TetMesh& mesh, Progress& progress);

    // Of a graph as it was made. threads: at most so many; 0: as many as help.
    void price_all(Progress& progress, size_t threads);

    size_t clusters_count() const { return clusters_.size(); }  // those that have gone into others included
    size_t edges_count() const { return edges_.size(); }
    Cluster& at(int32_t c) { return clusters_[static_cast<size_t>(c)]; }
    const Cluster& at(int32_t c) const { return clusters_[static_cast<size_t>(c)]; }
    DualEdge& edge(int32_t e) { return edges_[static_cast<size_t>(e)]; }
    const DualEdge& edge(int32_t e) const { return edges_[static_cast<size_t>(e)]; }

    int32_t add_edge(int32_t a, int32_t b);

    // For a cluster that may still be one tetrahedron.
    void make_hull(int32_t c) {
        if (!at(c).hull) set_hull(c, hulls_.build(corners(c)));
    }

    // The box around a cluster that has its hull.
    Box bounds(int32_t c) const { return hulls_.bounds(at(c).hull); }

    // What the edge costs as far as its hull volume is known.
    Price price(int32_t edge) const {
        const DualEdge& e = this->edge(edge);
        const Cluster &a = at(e.a), &b = at(e.b);
        const double hull_volume = e.exact ? e.hull_volume : e.hull_volume * (1 - bound_slack);
        const auto square = [](int32_t n) { return static_cast<double>(n) * static_cast<double>(n); };
        return {ranked_concavity(hull_volume, a.volume + b.volume), square(a.size) + square(b.size),
                std::min(a.low, b.low), std::max(a.low, b.low)};
    }

    // Asks memory for what pricing and working out that price reads first, but for this cluster's, ahead of that.
    void prefetch(int32_t edge, int32_t but) const {
        const DualEdge& e = this->edge(edge);
        const Cluster& other = at(e.a == but ? e.b : e.a);
        if (other.hull)
            other.hull.prefetch();
        else
            prefetch_line(&mesh_.tetrahedra[static_cast<size_t>(other.low)]);
    }

    // Finds the exact volumes of the edges' hulls; or, at the first try, only that they cost more than this concavity.
    void find_prices(std::span<const int32_t> edges, double concavity);

    // Merges the edge's clusters into one of the two, which gets that number, and returns what was merged. The edges
    // of the other that lead where the merged one leads already are appended to `removed`. Those that stay keep the
    // better bound of the two: refresh() is up to the caller.
    Merge contract(int32_t edge, int32_t number, std::vector<int32_t>& removed, int32_t& merged);

    // The edge of a cluster just merged: what is known of its price now is a bound.
    void refresh(int32_t number) {
        DualEdge& e = edge(number);
        e.hull_volume = std::max({e.hull_volume, at(e.a).hull_volume, at(e.b).hull_volume});
        e.exact = e.tried = false;
    }

private:
    std::span<const int32_t> corners(int32_t c) const;  // the vertices of a cluster's hull
    void set_hull(int32_t c, Hull hull) {
        at(c).facets = static_cast<uint32_t>(hull.facet_count());
        at(c).hull = std::move(hull);
    }
    const Point& point(int32_t v) const { return mesh_.vertices[static_cast<size_t>(v)]; }
    std::pair<int32_t, int32_t> by_size(const DualEdge& edge) const;
    double union_of_neighbours(int32_t a, int32_t b) const;
    double enough(const DualEdge& edge, double concavity) const;
    Hull unite(const DualEdge& edge);

    const TetMesh& mesh_;
    HullKernel hulls_;  // outlives all hulls, as links_ does all lists of links
    Pool links_;
    LargeVector<Link> first_links_;  // where each cluster's links are at first
    LargeVector<Cluster> clusters_;
    LargeVector<DualEdge> edges_;
    LargeVector<int32_t> link_of_;  // scratch of contract(): cluster -> position in the merged links, or -1
};

}  // namespace partwheel
