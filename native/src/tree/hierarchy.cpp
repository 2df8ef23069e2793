// The finished hierarchy: flat arrays and queries.
#include "tree/hierarchy.h"

#include "base/adjacency.h"
#include "base/corners.h"
#include "base/sorted.h"
#include "hull/hull.h"
#include "tree/face_leaves.h"

namespace partwheel {

Hierarchy::Hierarchy(const Surface& surface, const TetMesh& mesh, const ScoredTree& scored_tree,
                     std::span<const Point> caller_vertices) {
    data_.scores = scored_tree.scores;
    const BinaryTree& tree = scored_tree.tree;
    const Frame& frame = surface.frame;
    data_.source = surface.source_vertex;
    data_.source.resize(mesh.vertices.size(), -1);
    for (size_t v = 0; v < data_.source.size(); ++v)
        data_.vertices.push_back(data_.source[v] < 0 ? frame.to_caller(mesh.vertices[v]) : caller_vertices[idx(data_.source[v])]);

    const size_t leaves = mesh.tetrahedra.size();
    merges_ = tree.merges;
    const std::vector<int32_t> order = sort_leaves(merges_);
    std::vector<int32_t> leaf_of_tet(leaves);
    for (size_t i = 0; i < leaves; ++i) {
        leaf_of_tet[idx(order[i])] = static_cast<int32_t>(i);
        data_.tetrahedra.push_back(mesh.tetrahedra[idx(order[i])]);
    }
    for (Merge& m : merges_) m.concavity = frame.volume_to_caller(m.concavity);
    if (!merges_.empty()) data_.summary.hull_volume = frame.volume_to_caller(tree.merges.back().hull_volume);

    assign_faces(surface, mesh, leaf_of_tet, data_.leaf, data_.face_area);
    for (double& a : data_.face_area) a = frame.area_to_caller(a);
    data_.outer_faces = faces_of_outer_facets(surface, mesh, leaf_of_tet);

    data_.summary.components = tree.components;
    data_.summary.cavities = mesh.cavities;
    data_.summary.added_vertices = mesh.vertices.size() - surface.vertices.size();
    data_.summary.fill_method = surface.fill_method;
    data_.summary.proxy_triangles = surface.proxy_triangles;
    data_.summary.deviation = surface.deviation;
    data_.notes = surface.notes;
    data_.face_counts = surface.face_counts;
    const uint8_t method = static_cast<uint8_t>(surface.fill_method);
    data_.shell_fills = {surface.proxy_triangles > 0 ? static_cast<uint8_t>(method | is_proxy) : method};
    derive();
}

Hierarchy::Hierarchy(HierarchyData data, std::vector<Merge> merges) : data_(std::move(data)), merges_(std::move(merges)) {
    derive();
}

// Computes all other arrays.
void Hierarchy::derive() {
    frame_ = Frame::around(data_.vertices);
    measure_clusters();
    std::vector<int32_t> node = keep_nodes();
    link_nodes(node);
    order_faces();
    data_.summary.shells = data_.shell_fills.size();
    const auto is_thin = [](uint8_t fill) { return (fill & ~is_proxy) == PW_FILL_SHEET; };
    data_.summary.sheets = static_cast<size_t>(std::ranges::count_if(data_.shell_fills, is_thin));
}

// Fills the arrays by node for all clusters of the unpruned tree, bottom up. Leaves are in depth-first order, so a
// slice is given by its ends.
void Hierarchy::measure_clusters() {
    const size_t leaves = data_.tetrahedra.size(), clusters = leaves + merges_.size();
    const size_t top = clusters - data_.policy_merge_count();
    for (std::vector<double>* values : measures()) values->resize(clusters);
    for (std::vector<int32_t>* ends : {&tet_first_, &tet_last_}) ends->resize(clusters);
    score_ = cluster_scores();
    const std::vector<Point> points = data_.working_vertices();
    std::vector<Box> boxes(clusters);
    for (size_t l = 0; l < leaves; ++l) {
        // Rounding may make a sliver's volume negative.
        volume_[l] = frame_.volume_to_caller(std::max(0.0, signed_volume6(points, data_.tetrahedra[l]) / 6));
        tet_first_[l] = static_cast<int32_t>(l);
        tet_last_[l] = static_cast<int32_t>(l + 1);
        boxes[l] = Box::around(corner_points(points, data_.tetrahedra[l]));
    }
    for (size_t f = 0; f < data_.leaf.size(); ++f) area_[idx(data_.leaf[f])] += data_.face_area[f];
    merge_pairs_.reserve(2 * merges_.size());
    for (size_t c = leaves; c < clusters; ++c) {
        Merge& merge = merges_[c - leaves];
        const auto left = idx(merge.left), right = idx(merge.right);
        merge_pairs_.push_back(merge.left);
        merge_pairs_.push_back(merge.right);
        tet_first_[c] = tet_first_[left];
        tet_last_[c] = tet_last_[right];
        volume_[c] = volume_[left] + volume_[right];
        area_[c] = area_[left] + area_[right];
        for (const size_t child : {left, right}) boxes[c].add(boxes[child]);
        merge.hull_volume = volume_[c] + merge.concavity;
        // Joining may make a cluster less concave; a node is never lower than the nodes that it is made of.
        const bool is_intermediate = c >= top && score_[c] == 0;
        height_[c] = is_intermediate ? 0 : merge.concavity;
        if (c >= top) height_[c] = std::max({height_[c], height_[left], height_[right]});
    }
    for (size_t c = 0; c < clusters; ++c) extent_[c] = frame_.scale * boxes[c].diagonal();
    merge_last_.assign(tet_last_.begin() + static_cast<std::ptrdiff_t>(leaves), tet_last_.end());
    data_.summary.volume = volume_.back();
    if (merges_.empty())
        data_.summary.hull_volume = data_.summary.volume;
    else
        merges_.back().hull_volume = data_.summary.hull_volume;
}

// Nodes are all leaves, and the merges that survive pruning: arrays by cluster become arrays by node in place. Returns
// the node of each cluster, or -1.
std::vector<int32_t> Hierarchy::keep_nodes() {
    const size_t leaves = data_.tetrahedra.size(), clusters = leaves + merges_.size();
    const std::vector<uint8_t> kept = kept_merges();
    const std::vector<NodeCost> costs = node_costs(merges_);
    const size_t nodes = leaves + static_cast<size_t>(std::count(kept.begin(), kept.end(), 1));
    std::vector<int32_t> node = iota(leaves);
    node.resize(clusters, -1);
    cost_class_.resize(nodes);
    cost_.resize(nodes);
    for (size_t c = leaves, n = leaves; c < clusters; ++c) {
        if (!kept[c - leaves]) continue;
        node[c] = static_cast<int32_t>(n);
        cost_class_[n] = costs[c - leaves].concave;
        cost_[n] = costs[c - leaves].value;
        tet_first_[n] = tet_first_[c];
        tet_last_[n] = tet_last_[c];
        for (std::vector<double>* values : measures()) (*values)[n] = (*values)[c];
        ++n;
    }
    for (std::vector<double>* values : measures()) values->resize(nodes);
    for (std::vector<int32_t>* ends : {&tet_first_, &tet_last_}) ends->resize(nodes);
    for (const int32_t c : cut_undoing_last(merges_, data_.shell_fills.size())) shell_nodes_.push_back(node[idx(c)]);
    return node;
}

// node: of each cluster, or -1; changed.
void Hierarchy::link_nodes(std::vector<int32_t>& node) {
    const size_t leaves = data_.tetrahedra.size();
    parent_.assign(volume_.size(), -1);
    for (size_t m = merges_.size(); m-- > 0;) {
        // node[] of a pruned merge becomes the node that its children hang from.
        for (const int32_t child : {merges_[m].left, merges_[m].right}) {
            int32_t& below = node[idx(child)];
            if (below < 0)
                below = node[leaves + m];
            else
                parent_[idx(below)] = node[leaves + m];
        }
    }
}

// Sorts the faces by leaf.
void Hierarchy::order_faces() {
    const CsrArray<int32_t> faces(data_.tetrahedra.size(), [&](const auto& put) {
        for (size_t f = 0; f < data_.leaf.size(); ++f) put(idx(data_.leaf[f]), static_cast<int32_t>(f));
    });
    order_.assign(faces.items().begin(), faces.items().end());
    std::vector<int32_t> face_begin = {0};
    for (size_t l = 0; l < data_.tetrahedra.size(); ++l)
        face_begin.push_back(face_begin.back() + static_cast<int32_t>(faces.row(l).size()));
    first_.reserve(tet_first_.size());
    last_.reserve(tet_last_.size());
    for (const int32_t t : tet_first_) first_.push_back(face_begin[idx(t)]);
    for (const int32_t t : tet_last_) last_.push_back(face_begin[idx(t)]);
}

std::vector<double> Hierarchy::cluster_scores() const {
    std::vector<double> scores(data_.tetrahedra.size() + merges_.size(), 0);
    if (data_.scores.empty()) return scores;
    // The initial parts are the clusters that the merges of the policy start from.
    auto next = data_.scores.begin();
    for (const int32_t c : cut_undoing_last(merges_, data_.policy_merge_count() + 1)) scores[idx(c)] = *next++;
    std::copy(next, data_.scores.end(), scores.end() - (data_.scores.end() - next));
    return scores;
}

std::vector<uint8_t> Hierarchy::kept_merges() const {
    if (data_.scores.empty()) return prune(merges_);
    return prune_scored(merges_, std::span(data_.scores).last(data_.policy_merge_count()));
}

pw_arrays Hierarchy::arrays() const {
    pw_arrays a{};
    a.face_count = data_.leaf.size();
    a.node_count = parent_.size();
    a.tetrahedron_count = data_.tetrahedra.size();
    a.vertex_count = data_.vertices.size();
    a.order = order_.data();
    a.leaf = data_.leaf.data();
    a.parent = parent_.data();
    a.first = first_.data();
    a.last = last_.data();
    a.tet_first = tet_first_.data();
    a.tet_last = tet_last_.data();
    a.cost_class = cost_class_.data();
    a.cost = cost_.data();
    a.height = height_.data();
    a.volume = volume_.data();
    a.area = area_.data();
    a.vertices = data_.vertices.data()->data();
    a.source = data_.source.data();
    a.tetrahedra = data_.tetrahedra.data()->data();
    a.merges = merge_pairs_.data();
    a.score = score_.data();
    return a;
}

std::vector<int32_t> Hierarchy::path(size_t face) const {
    std::vector<int32_t> nodes;
    for (int32_t n = data_.leaf[face]; n >= 0; n = parent_[idx(n)]) nodes.push_back(n);
    return nodes;
}

WheelStops Hierarchy::wheel(size_t face, double view) const {
    const std::vector<int32_t> nodes = path(face);
    if (data_.scores.empty()) return {nodes, 0};  // the paper's: all of the path, from the tetrahedron clicked
    std::vector<double> areas, scores, extents;
    for (int32_t n : nodes) {
        areas.push_back(area_[idx(n)]);
        scores.push_back(score_[idx(n)]);
        extents.push_back(extent_[idx(n)]);
    }
    const int32_t shell = shell_nodes_[shell_of(idx(data_.leaf[face]))];
    const auto place = static_cast<size_t>(std::ranges::find(nodes, shell) - nodes.begin());
    WheelStops wheel = assembly_wheel_stops(areas, scores, place);
    if (view > 0 && std::isfinite(view))
        wheel.start = start_in_view(wheel.stops, scores, extents, largest_click(wheel.stops, areas, scores, place), view);
    for (int32_t& stop : wheel.stops) stop = nodes[idx(stop)];
    return wheel;
}

size_t Hierarchy::shell_of(size_t tet) const {
    const auto ends = [&](int32_t node) { return idx(tet_last_[idx(node)]); };
    return static_cast<size_t>(std::ranges::upper_bound(shell_nodes_, tet, {}, ends) - shell_nodes_.begin());
}

std::vector<uint8_t> Hierarchy::exact_tetrahedra() const {
    std::vector<uint8_t> exact;
    for (size_t s = 0; s < data_.shell_fills.size(); ++s)
        exact.resize(idx(tet_last_[idx(shell_nodes_[s])]), data_.shell_fills[s] == PW_FILL_EXACT);
    return exact;
}

std::span<const int32_t> Hierarchy::faces(size_t node) const {
    return std::span(order_).subspan(idx(first_[node]),
                                     static_cast<size_t>(last_[node] - first_[node]));
}

std::vector<int32_t> Hierarchy::cut_height(double height) const {
    std::vector<int32_t> bounds = {0};
    while (idx(bounds.back()) < data_.tetrahedra.size()) {
        size_t n = idx(bounds.back());
        while (parent_[n] >= 0 && height_[idx(parent_[n])] <= height) n = idx(parent_[n]);
        bounds.push_back(tet_last_[n]);
    }
    return bounds;
}

std::vector<int32_t> Hierarchy::cut_parts(size_t parts) const {
    return bounds_of(cut_undoing_last(merges_, parts));
}

std::vector<int32_t> Hierarchy::cut_least_concavity(size_t parts, Progress& progress) const {
    return bounds_of(partwheel::cut_least_concavity(merges_, parts, progress));
}

std::vector<int32_t> Hierarchy::cut_automatic() const {
    constexpr double paper_height = 0.03;  // of the hull's volume
    if (data_.scores.empty()) return cut_height(paper_height * data_.summary.hull_volume);
    // Areas and scores by cluster; pruned clusters have no score.
    const size_t leaves = data_.tetrahedra.size(), clusters = leaves + merges_.size();
    const std::vector<uint8_t> kept = kept_merges();
    std::vector<double> areas(clusters, 0), scores(clusters, 0);
    for (size_t c = 0, n = 0; c < clusters; ++c) {
        if (c >= leaves && !kept[c - leaves]) {
            areas[c] = areas[idx(merges_[c - leaves].left)] + areas[idx(merges_[c - leaves].right)];
            continue;
        }
        areas[c] = area_[n];
        scores[c] = score_[n++];
    }
    return bounds_of(best_scoring_cut(merges_, data_.policy_merge_count(), areas, scores));
}

std::vector<int32_t> Hierarchy::bounds_of(std::span<const int32_t> clusters) const {
    std::vector<int32_t> bounds = {0};
    for (const int32_t c : clusters) bounds.push_back(end_of(c));
    return bounds;
}

int32_t Hierarchy::end_of(int32_t cluster) const {
    const size_t leaves = data_.tetrahedra.size(), c = idx(cluster);
    return c < leaves ? cluster + 1 : merge_last_[c - leaves];
}

TriangleMesh Hierarchy::hull(size_t tet_first, size_t tet_last, Progress& progress) const {
    const std::vector<int32_t> used = corner_vertices(tetrahedra().subspan(tet_first, tet_last - tet_first));
    const std::vector<Point> points = frame_.to_working(points_at(data_.vertices, used));
    progress.reach(0);
    HullKernel kernel(points, progress);
    const Hull hull = kernel.build(iota(points.size()));
    TriangleMesh mesh = kernel.surface(hull);
    for (size_t i = 0; i < mesh.vertices.size(); ++i) mesh.vertices[i] = data_.vertices[idx(used[idx(hull.vertices()[i])])];
    return mesh;
}

}  // namespace partwheel
