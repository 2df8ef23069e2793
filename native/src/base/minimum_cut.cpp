// Minimum cuts: a maximum flow by Boykov and Kolmogorov's algorithm, and the nodes that the source still reaches.
#include "base/minimum_cut.h"

#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>

#include <numeric>
#include <utility>

namespace partwheel {

namespace {

struct Arc {
    uint32_t from, to;
    int64_t there, back;  // capacities
};

std::vector<Arc> make_arcs(const Cut& cut, uint32_t source, uint32_t sink) {
    const auto count = static_cast<uint32_t>(cut.to_part.size());
    std::vector<Arc> arcs;
    const auto as_node = [](int32_t n) { return static_cast<uint32_t>(n); };
    arcs.reserve(cut.edges.size() + 2 * count);
    for (const auto& [one, other, cost] : cut.edges) arcs.push_back({as_node(one), as_node(other), cost, cost});
    for (uint32_t n = 0; n < count; ++n) {
        if (cut.to_part[n] > 0) arcs.push_back({source, n, cut.to_part[n], 0});
        if (cut.to_rest[n] > 0) arcs.push_back({n, sink, cut.to_rest[n], 0});
    }
    return arcs;
}

}  // namespace

std::vector<uint8_t> minimum_cut(const Cut& cut) {
    // A flow from the fixed nodes of the part (source) to those of the rest (sink); arcs are sorted by their start.
    const auto count = static_cast<uint32_t>(cut.to_part.size()), source = count, sink = count + 1;
    const std::vector<Arc> arcs = make_arcs(cut, source, sink);
    std::vector<uint32_t> place(count + 4, 0);
    for (const Arc& arc : arcs) ++place[arc.from + 2], ++place[arc.to + 2];
    std::partial_sum(place.begin(), place.end(), place.begin());
    std::vector<std::pair<uint32_t, uint32_t>> ends(2 * arcs.size());
    std::vector<int64_t> capacity(ends.size()), residual(ends.size());
    std::vector<uint32_t> opposite(ends.size());
    for (const auto& [from, to, there, back] : arcs) {
        const uint32_t i = place[from + 1]++, j = place[to + 1]++;
        ends[i] = {from, to}, ends[j] = {to, from};
        capacity[i] = there, capacity[j] = back;
        opposite[i] = j, opposite[j] = i;
    }

    using None = boost::no_property;
    using Graph = boost::compressed_sparse_row_graph<boost::directedS, None, None, None, uint32_t, uint32_t>;
    using Edge = boost::graph_traits<Graph>::edge_descriptor;
    const Graph graph(boost::edges_are_sorted, ends.begin(), ends.end(), count + 2);
    std::vector<Edge> reverse(ends.size()), predecessor(count + 2);
    for (size_t i = 0; i < ends.size(); ++i) reverse[i] = Edge(ends[i].second, opposite[i]);
    std::vector<boost::default_color_type> tree(count + 2);
    std::vector<int32_t> distance(count + 2);
    const auto edge_index = get(boost::edge_index, graph);
    const auto vertex_index = get(boost::vertex_index, graph);
    boost::boykov_kolmogorov_max_flow(
        graph, boost::make_iterator_property_map(capacity.begin(), edge_index),
        boost::make_iterator_property_map(residual.begin(), edge_index),
        boost::make_iterator_property_map(reverse.begin(), edge_index),
        boost::make_iterator_property_map(predecessor.begin(), vertex_index),
        boost::make_iterator_property_map(tree.begin(), vertex_index),
        boost::make_iterator_property_map(distance.begin(), vertex_index), vertex_index, source, sink);

    // The nodes that the source still reaches are its tree: the same for every maximum flow.
    std::vector<uint8_t> reached(count);
    for (uint32_t n = 0; n < count; ++n) reached[n] = tree[n] == boost::black_color;
    return reached;
}

}  // namespace partwheel
