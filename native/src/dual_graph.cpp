// Clusters and edges: priced by hulls from hulls, contracted.
#include "dual_graph.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <system_error>

namespace partwheel {

namespace {

// So many edges are priced between two looks at whether all is cancelled.
constexpr size_t edges_a_step = 16384;

// A second thread is asked for help from so many tests of a point against a facet on: some microseconds.
constexpr size_t worth_sharing = 1500;

// The same for a hull that is made, not only measured.
constexpr size_t worth_sharing_union = 400;

}  // namespace

Workers::Workers(std::span<const Point> points, int count) : first(points) {
    if (count < 2) return;
    try {
        threads.emplace();
        second.emplace(points);
    } catch (const std::system_error&) {
        // One does as well.
    }
}

DualGraph::DualGraph(const TetMesh& mesh)
    : mesh_(mesh), first_links_(LinkPool::least * mesh.tetrahedra.size()), clusters_(mesh.tetrahedra.size()),
      link_of_(mesh.tetrahedra.size(), -1) {
    const auto count = static_cast<int32_t>(mesh.tetrahedra.size());
    for (int32_t t = 0; t < count; ++t) {
        const Tetrahedron& tet = mesh.tetrahedra[static_cast<size_t>(t)];
        Cluster& c = at(t);
        c.volume = c.hull_volume = six_volumes(point(tet[0]), point(tet[1]), point(tet[2]), point(tet[3])) / 6;
        c.low = c.number = t;
        c.links = Links(&first_links_[LinkPool::least * static_cast<size_t>(t)]);
    }
    edges_.reserve(2 * mesh.tetrahedra.size());
    LinkPool none;  // no tetrahedron has more links than it has room for
    for (int32_t t = 0; t < count; ++t)
        for (const int32_t other : mesh.neighbours[static_cast<size_t>(t)])
            if (other > t) add_edge(t, other, none);
}

void DualGraph::price_all(Progress& progress, PairOfThreads* threads) {
    for (size_t first = 0; first < edges_.size(); first += edges_a_step) {
        const size_t last = std::min(first + edges_a_step, edges_.size());
        in_halves(threads, first, last, [this](size_t i) {
            edges_[i].hull_volume = union_of_neighbours(edges_[i].a, edges_[i].b);
            edges_[i].exact = true;
        });
        progress.advance(0.1 * static_cast<double>(last) / static_cast<double>(edges_.size()));
    }
}

int32_t DualGraph::add_edge(int32_t a, int32_t b, LinkPool& pool) {
    const auto edge = static_cast<int32_t>(edges_.size());
    edges_.push_back({.a = a, .b = b});
    at(a).links.push_back({b, edge}, pool);
    at(b).links.push_back({a, edge}, pool);
    return edge;
}

std::span<const int32_t> DualGraph::corners(int32_t c) const {
    if (at(c).hull) return at(c).hull.vertices();
    return mesh_.tetrahedra[static_cast<size_t>(at(c).low)];
}

// The edge's clusters, the one whose hull has more facets first, or the lower one.
std::pair<int32_t, int32_t> DualGraph::by_size(const DualEdge& e) const {
    const uint32_t a = at(e.a).facets, b = at(e.b).facets;
    const bool ordered = a != b ? a > b : at(e.a).low < at(e.b).low;
    return ordered ? std::pair(e.a, e.b) : std::pair(e.b, e.a);
}

// The volume of the union of two tetrahedra with a common facet: theirs, and what the far corner of b sees of a.
double DualGraph::union_of_neighbours(int32_t a, int32_t b) const {
    const Tetrahedron& s = mesh_.tetrahedra[static_cast<size_t>(a)];
    const Tetrahedron& t = mesh_.tetrahedra[static_cast<size_t>(b)];
    const auto& beyond = mesh_.neighbours[static_cast<size_t>(b)];
    const Point& far = point(t[static_cast<size_t>(std::find(beyond.begin(), beyond.end(), a) - beyond.begin())]);
    double seen = 0;
    for (size_t k = 0; k < 4; ++k) {
        if (mesh_.neighbours[static_cast<size_t>(a)][k] == b) continue;
        const Triangle f = facet(s, k);
        seen += std::max(0.0, six_volumes(point(f[0]), point(f[1]), point(f[2]), far));
    }
    return at(a).volume + at(b).volume + seen / 6;
}

// A volume of this edge's union with which it costs more than this concavity.
double DualGraph::enough(const DualEdge& e, double concavity) const {
    if (e.tried) return std::numeric_limits<double>::infinity();
    const double volume = at(e.a).volume + at(e.b).volume;
    // Rather more than that, for the roundings and the slack.
    if (concavity == 0) return volume / (1 - convex_tolerance) * (1 + 1e-9);
    return (volume + concavity * (1 + 1e-8)) * (1 + 1e-10);
}

DualGraph::Pricing DualGraph::pricing(int32_t edge_number, double concavity, Worker& worker) {
    const DualEdge& e = edge(edge_number);
    const auto [large, small] = by_size(e);
    if (!at(large).hull) set_hull(large, worker.hulls.build(corners(large)));
    return {&at(large).hull, corners(small), enough(e, concavity), {}};
}

void DualGraph::priced(int32_t edge_number, const Pricing& pricing) {
    DualEdge& e = edge(edge_number);
    const auto [volume, exact] = pricing.measure;
    e.hull_volume = exact ? volume : std::max(e.hull_volume, volume);
    e.exact = exact;
    e.tried = true;
}

void DualGraph::find_prices(std::span<const int32_t> edges, double concavity, Worker& worker) {
    for (size_t i = 0; i < edges.size(); ++i) {
        if (i + 1 < edges.size()) worker.hulls.prefetch(corners(by_size(edge(edges[i + 1])).second));
        find_price(edges[i], concavity, worker);
    }
}

void DualGraph::find_prices(std::span<const int32_t> edges, double concavity, Workers& workers) {
    if (edges.size() < 2 || !workers.two()) return find_prices(edges, concavity, workers.first);
    pricings_.clear();
    size_t tests = 0;
    for (const int32_t e : edges) {
        pricings_.push_back(pricing(e, concavity, workers.first));
        tests += pricings_.back().tests();
    }
    if (tests < worth_sharing) return find_prices(edges, concavity, workers.first);
    workers.threads->share(edges.size(), [&](size_t i, size_t thread) {
        pricings_[i].work(thread == 0 ? workers.first : *workers.second);
    });
    for (size_t i = 0; i < edges.size(); ++i) priced(edges[i], pricings_[i]);
}

bool DualGraph::worth_uniting_ahead(int32_t contracted, const Workers& workers) const {
    if (!workers.two()) return false;
    const auto [large, small] = by_size(edge(contracted));
    return at(large).facets * corners(small).size() >= worth_sharing_union;
}

void DualGraph::unite_and_find_prices(int32_t contracted, std::span<const int32_t> edges, double concavity,
                                      Workers& workers) {
    pricings_.clear();
    for (const int32_t e : edges) pricings_.push_back(pricing(e, concavity, workers.first));
    workers.threads->share(1 + edges.size(), [&](size_t i, size_t thread) {
        Worker& worker = thread == 0 ? workers.first : *workers.second;
        if (i == 0)
            united_ = unite(edge(contracted), worker.hulls);
        else
            pricings_[i - 1].work(worker);
    });
    for (size_t i = 0; i < edges.size(); ++i) priced(edges[i], pricings_[i]);
}

Hull DualGraph::unite(const DualEdge& e, HullKernel& kernel) const {
    const auto [large, small] = by_size(e);
    if (at(large).hull) return kernel.unite(at(large).hull, corners(small));
    std::array<int32_t, 8> both;
    std::copy_n(corners(small).begin(), 4, std::copy_n(corners(large).begin(), 4, both.begin()));
    return kernel.build(both);
}

Merge DualGraph::contract(int32_t contracted, int32_t number, Worker& worker, std::vector<int32_t>& removed,
                          int32_t& merged, Contraction* undo) {
    const DualEdge& e = edge(contracted);
    // The cluster with more links stays and takes in the other.
    const bool stay_a = at(e.a).links.size() >= at(e.b).links.size();
    const int32_t stay = stay_a ? e.a : e.b, go = stay_a ? e.b : e.a;
    Cluster &m = at(stay), &g = at(go);

    const bool ordered = m.low < g.low;
    const Cluster &first = ordered ? m : g, &second = ordered ? g : m;
    const double volume = first.volume + second.volume;
    const Merge merge = {first.number, second.number, ranked_concavity(e.hull_volume, volume), e.hull_volume};
    for (const Link& link : g.links) prefetch_line(at(link.cluster).links.begin());
    Hull united = united_ ? std::move(united_) : unite(e, worker.hulls);
    if (undo) {
        undo->stay = stay;
        undo->go = go;
        undo->hull_volumes.clear();
        undo->hull_volumes.reserve(std::bit_ceil(m.links.size() + g.links.size()));
        for (const Cluster* c : {&m, &g})
            for (const Link& link : c->links) {
                const DualEdge& was = edge(link.edge);
                undo->hull_volumes.push_back(was.exact ? was.hull_volume : -was.hull_volume);
            }
        Cluster& was = undo->stayed;
        was.hull = std::move(m.hull);
        was.hull_volume = m.hull_volume;
        was.facets = m.facets;
        was.volume = m.volume;
        was.size = m.size;
        was.low = m.low;
        was.number = m.number;
        was.links.copy(m.links, worker.links);
    }
    set_hull(stay, std::move(united));
    m.hull_volume = m.hull.volume();
    m.volume = volume;
    m.size += g.size;
    m.low = std::min(m.low, g.low);
    m.number = number;

    m.links.erase_of(go);
    for (size_t i = 0; i < m.links.size(); ++i)
        link_of_[static_cast<size_t>(m.links[i].cluster)] = static_cast<int32_t>(i);
    for (const Link& link : g.links) {
        if (link.cluster == stay) continue;
        Cluster& other = at(link.cluster);
        DualEdge& moved = edge(link.edge);
        Link* const back = other.links.find(go);
        const int32_t twin = link_of_[static_cast<size_t>(link.cluster)];
        if (twin < 0) {
            back->cluster = stay;
            (moved.a == go ? moved.a : moved.b) = stay;
            m.links.push_back(link, worker.links);
        } else {
            DualEdge& kept = edge(m.links[static_cast<size_t>(twin)].edge);
            kept.hull_volume = std::max(kept.hull_volume, moved.hull_volume);
            removed.push_back(link.edge);
            other.links.erase(back);
        }
    }
    if (undo)
        undo->gone = std::move(g);
    else
        g.links.release(worker.links);
    g = Cluster{};
    g.size = 0;
    for (const Link& link : m.links) link_of_[static_cast<size_t>(link.cluster)] = -1;
    merged = stay;
    return merge;
}

void DualGraph::undo(Contraction& contraction, Worker& worker) {
    const int32_t stay = contraction.stay, go = contraction.go;
    for (const Link& link : at(stay).links) at(link.cluster).links.erase_of(stay);
    at(stay).links.release(worker.links);
    at(stay) = std::move(contraction.stayed);
    at(go) = std::move(contraction.gone);
    auto volume = contraction.hull_volumes.begin();
    for (const int32_t c : {stay, go})
        for (const Link& link : at(c).links) {
            edge(link.edge) = {.a = c,
                               .b = link.cluster,
                               .hull_volume = std::fabs(*volume),
                               .exact = !std::signbit(*volume),
                               .tried = false,
                               .home = edge(link.edge).home};
            ++volume;
            if (link.cluster != stay && link.cluster != go) at(link.cluster).links.push_back({c, link.edge}, worker.links);
        }
}

void DualGraph::forget(Contraction& contraction, Worker& worker) {
    for (Cluster* c : {&contraction.stayed, &contraction.gone}) {
        worker.hulls.release(c->hull);
        c->links.release(worker.links);
    }
}

}  // namespace partwheel
