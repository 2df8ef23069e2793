// Costs of dual edges from the hulls of their clusters; edge contraction.
#include "cluster/dual_graph.h"

#include "base/error.h"
#include "base/parallel.h"

namespace partwheel {

namespace {

// Edges between two checks for cancellation, and per task of a thread; about 60 ns each.
constexpr size_t edges_per_step = 65536, edges_per_chunk = 4096;

}  // namespace

DualGraph::DualGraph(const TetMesh& mesh, Progress& progress)
    : mesh_(mesh), hulls_(mesh.vertices, progress), first_links_(Links::inline_capacity * mesh.tetrahedra.size()),
      clusters_(mesh.tetrahedra.size()), link_of_(mesh.tetrahedra.size(), -1) {
    const auto count = static_cast<int32_t>(mesh.tetrahedra.size());
    for (int32_t t = 0; t < count; ++t) {
        const Tetrahedron& tet = mesh.tetrahedra[static_cast<size_t>(t)];
        Cluster& c = at(t);
        c.volume = c.hull_volume = signed_volume6(point(tet[0]), point(tet[1]), point(tet[2]), point(tet[3])) / 6;
        c.low = c.number = t;
        c.links = Links(&first_links_[Links::inline_capacity * static_cast<size_t>(t)]);
    }
    edges_.reserve(2 * mesh.tetrahedra.size());
    progress.advance(0);
    for (int32_t t = 0; t < count; ++t) {
        for (const int32_t other : mesh.neighbors[static_cast<size_t>(t)])
            if (other > t) add_edge(t, other);
        if (t % 65536 == 0) progress.advance(0);
    }
}

void DualGraph::compute_initial_costs(Progress& progress, size_t threads) {
    ThreadPool pool(threads, std::min(edges_per_step, edges_.size()) / edges_per_chunk + 1);
    for (size_t first = 0; first < edges_.size(); first += edges_per_step) {
        const size_t last = std::min(first + edges_per_step, edges_.size());
        pool.parallel_for(last - first, edges_per_chunk, [&](size_t begin, size_t end) {
            for (DualEdge& e : std::span(edges_).subspan(first + begin, end - begin)) {
                e.hull_volume = union_volume_of_neighbors(e.a, e.b);
                e.exact = true;
            }
        });
        progress.advance(0.1 * static_cast<double>(last) / static_cast<double>(edges_.size()));
    }
}

int32_t DualGraph::add_edge(int32_t a, int32_t b) {
    const int32_t edge = checked_index(edges_.size());  // checked, because merging components adds many
    edges_.push_back({.a = a, .b = b});
    at(a).links.push_back({b, edge}, links_);
    at(b).links.push_back({a, edge}, links_);
    return edge;
}

std::span<const int32_t> DualGraph::corners(int32_t c) const {
    if (at(c).hull) return at(c).hull.vertices();
    return mesh_.tetrahedra[static_cast<size_t>(at(c).low)];
}

// The edge's clusters: the one whose hull has more facets first; in a tie, the one with the lowest tetrahedron.
std::pair<int32_t, int32_t> DualGraph::larger_hull_first(const DualEdge& e) const {
    const uint32_t a = at(e.a).facets, b = at(e.b).facets;
    const bool a_is_first = a != b ? a > b : at(e.a).low < at(e.b).low;
    return a_is_first ? std::pair(e.a, e.b) : std::pair(e.b, e.a);
}

// The hull volume of two tetrahedra with a common facet: their volumes, and what lies between a's visible facets and
// the opposite corner of b.
double DualGraph::union_volume_of_neighbors(int32_t a, int32_t b) const {
    const Tetrahedron& s = mesh_.tetrahedra[static_cast<size_t>(a)];
    const Tetrahedron& t = mesh_.tetrahedra[static_cast<size_t>(b)];
    const auto& neighbors = mesh_.neighbors[static_cast<size_t>(b)];
    const Point& apex =
        point(t[static_cast<size_t>(std::find(neighbors.begin(), neighbors.end(), a) - neighbors.begin())]);
    double added6 = 0;
    for (size_t k = 0; k < 4; ++k) {
        if (mesh_.neighbors[static_cast<size_t>(a)][k] == b) continue;
        const Triangle f = facet(s, k);
        added6 += std::max(0.0, signed_volume6(point(f[0]), point(f[1]), point(f[2]), apex));
    }
    return at(a).volume + at(b).volume + added6 / 6;
}

// A hull volume at which this edge certainly costs more than this concavity.
double DualGraph::early_out_volume(const DualEdge& e, double concavity) const {
    if (e.bound_evaluated) return std::numeric_limits<double>::infinity();
    const double volume = at(e.a).volume + at(e.b).volume;
    // With a margin for rounding and for bound_slack.
    if (concavity == 0) return volume / (1 - convex_tolerance) * (1 + 1e-9);
    return (volume + concavity * (1 + 1e-8)) * (1 + 1e-10);
}

void DualGraph::compute_costs(std::span<const int32_t> edges, double concavity) {
    for (size_t i = 0; i < edges.size(); ++i) {
        if (i + 1 < edges.size()) hulls_.prefetch(corners(larger_hull_first(edge(edges[i + 1])).second));
        DualEdge& e = edge(edges[i]);
        const auto [large, small] = larger_hull_first(e);
        make_hull(large);
        const auto [volume, exact] = hulls_.union_volume(at(large).hull, corners(small), early_out_volume(e, concavity));
        e.hull_volume = exact ? volume : std::max(e.hull_volume, volume);
        e.exact = exact;
        e.bound_evaluated = true;
    }
}

Hull DualGraph::unite(const DualEdge& e) {
    const auto [large, small] = larger_hull_first(e);
    if (at(large).hull) return hulls_.unite(at(large).hull, corners(small));
    std::array<int32_t, 8> both;
    std::copy_n(corners(small).begin(), 4, std::copy_n(corners(large).begin(), 4, both.begin()));
    return hulls_.build(both);
}

Merge DualGraph::contract(int32_t contracted, int32_t number, std::vector<int32_t>& removed, int32_t& merged) {
    const DualEdge& e = edge(contracted);
    // The cluster with more links absorbs the other.
    const bool keeps_a = at(e.a).links.size() >= at(e.b).links.size();
    const int32_t kept_id = keeps_a ? e.a : e.b, absorbed_id = keeps_a ? e.b : e.a;
    Cluster &m = at(kept_id), &g = at(absorbed_id);

    const bool is_ordered = m.low < g.low;
    const Cluster &first = is_ordered ? m : g, &second = is_ordered ? g : m;
    const double volume = first.volume + second.volume;
    const Merge merge = {first.number, second.number, ranked_concavity(e.hull_volume, volume), e.hull_volume};
    for (const Link& link : g.links) prefetch_line(at(link.cluster).links.begin());
    set_hull(kept_id, unite(e));
    m.hull_volume = m.hull.volume();
    m.volume = volume;
    m.size += g.size;
    m.low = std::min(m.low, g.low);
    m.number = number;

    m.links.erase_of(absorbed_id);
    for (size_t i = 0; i < m.links.size(); ++i)
        link_of_[static_cast<size_t>(m.links[i].cluster)] = static_cast<int32_t>(i);
    for (const Link& link : g.links) {
        if (link.cluster == kept_id) continue;
        Cluster& other = at(link.cluster);
        DualEdge& link_edge = edge(link.edge);
        Link* const back = other.links.find(absorbed_id);
        const int32_t duplicate = link_of_[static_cast<size_t>(link.cluster)];
        if (duplicate < 0) {
            back->cluster = kept_id;
            (link_edge.a == absorbed_id ? link_edge.a : link_edge.b) = kept_id;
            m.links.push_back(link, links_);
        } else {
            DualEdge& original = edge(m.links[static_cast<size_t>(duplicate)].edge);
            original.hull_volume = std::max(original.hull_volume, link_edge.hull_volume);
            removed.push_back(link.edge);
            other.links.erase(back);
        }
    }
    g.links.release(links_);
    g = Cluster{};
    g.size = 0;
    for (const Link& link : m.links) link_of_[static_cast<size_t>(link.cluster)] = -1;
    merged = kept_id;
    return merge;
}

}  // namespace partwheel
