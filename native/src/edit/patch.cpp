// Costs of cuts, patches, shortest paths, and cuts to disks.
#include "edit/patch.h"

#include "base/elementary.h"

namespace partwheel {

namespace {

// A cut along an edge of length L costs L / (1 + crease_discount s), with s = 1 at a right angle, times concave_factor
// in a concave crease.
constexpr double crease_discount = 4, concave_factor = 2;
constexpr double cost_digits = 1e9;  // costs in units of about the mean length are rounded to 1 / cost_digits
constexpr double min_relative_length = 1e-6;  // of an edge, in mean lengths: paths of no cost would be cyclic
constexpr double max_cotangent = 50;          // cotangents of degenerate triangles are clamped to this
constexpr size_t max_tried_loops = 4;  // as the first cut of a closed surface, those with the shortest paths
constexpr double infinite = std::numeric_limits<double>::infinity(), tiny = 1e-300;

SeamMesh::Face make_face(const std::array<Point, 3>& corners, int32_t polygon) {
    SeamMesh::Face face{corners, polygon, area(corners[0], corners[1], corners[2]), {}};
    for (size_t k = 0; k < 3; ++k) {
        const Point to_next = corners[(k + 1) % 3] - corners[k], to_previous = corners[(k + 2) % 3] - corners[k];
        face.angle[k] = angle_of(length(cross(to_next, to_previous)), dot(to_next, to_previous));
    }
    return face;
}

// Half the cotangent of the corner opposite a side.
double side_weight(const SeamMesh& mesh, int32_t side) {
    const auto& corners = mesh.faces[idx(side / 3)].corners;
    const Point &from = corners[idx(side % 3)], &to = corners[idx((side + 1) % 3)], &opposite = corners[idx((side + 2) % 3)];
    const Point a = from - opposite, b = to - opposite;
    return std::clamp(dot(a, b) / std::max(length(cross(a, b)), tiny), -max_cotangent, max_cotangent) / 2;
}

double length_of(const SeamMesh::Face& face, size_t from, size_t to) { return length(face.corners[to] - face.corners[from]); }

double edge_length(const SeamMesh& mesh, const SeamMesh::Edge& edge) {
    return length_of(mesh.faces[idx(edge.triangle(0))], idx(edge.corners[0][0] % 3), idx(edge.corners[1][0] % 3));
}

double crease_divisor(const SeamMesh& mesh, const SeamMesh::Edge& edge) {
    const auto normal = [](const SeamMesh::Face& face) {
        const Point n = cross(face.corners[1] - face.corners[0], face.corners[2] - face.corners[0]);
        return (1 / std::max(2 * face.area, tiny)) * n;
    };
    const SeamMesh::Face &one = mesh.faces[idx(edge.triangle(0))], &other = mesh.faces[idx(edge.triangle(1))];
    const double sharpness = std::sqrt(std::max(1 - dot(normal(one), normal(other)), 0.0));  // 1 at a right angle
    const Point center = (1.0 / 3) * (other.corners[0] + other.corners[1] + other.corners[2]);
    const bool is_concave = dot(normal(one), center - one.corners[idx(edge.corners[0][0] % 3)]) > 0;
    return 1 + crease_discount * sharpness * (is_concave ? concave_factor : 1);
}

}  // namespace

SeamMesh::SeamMesh(const MeshView& mesh) {
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const int32_t polygon = mesh.faces.empty() ? static_cast<int32_t>(t) : mesh.faces[t];
        faces.push_back(make_face({mesh.vertices[idx(a)], mesh.vertices[idx(b)], mesh.vertices[idx(c)]}, polygon));
    }
    double total_length = 0;
    for_each_edge(mesh.vertices.size(), mesh.triangles, [&](int32_t, std::span<const Side> sides) {
        if (sides.size() > 2)
            for (const Side& side : sides) non_manifold_sides.push_back(side.number);
        if (sides.size() != 2) return;
        Edge edge{static_cast<int32_t>(edges.size()), {}, false, 0, 0};
        for (size_t t = 0; t < 2; ++t) {
            edge.corners[sides[t].is_ascending ? 0 : 1][t] = sides[t].number;
            edge.corners[sides[t].is_ascending ? 1 : 0][t] = next_corner(sides[t].number);
        }
        edge.is_diagonal = faces[idx(edge.triangle(0))].polygon == faces[idx(edge.triangle(1))].polygon;
        edge.weight = side_weight(*this, edge.side(0)) + side_weight(*this, edge.side(1));
        total_length += edge_length(*this, edge);
        edges.push_back(edge);
    });
    const double mean = total_length / static_cast<double>(std::max<size_t>(edges.size(), 1));
    const double unit = std::ldexp(1.0, std::ilogb(std::max(mean, tiny)));
    for (Edge& edge : edges) {
        const double cost = std::max(edge_length(*this, edge) / unit, min_relative_length) / crease_divisor(*this, edge);
        edge.cost = std::nearbyint(cost * cost_digits) / cost_digits * unit;
    }
    index_sides();
}

SeamMesh::SeamMesh(const SeamMesh& whole, std::span<const int32_t> selected) {
    std::vector<int32_t> number(whole.faces.size(), -1), kept;
    for (const int32_t t : selected) number[idx(t)] = static_cast<int32_t>(faces.size()), faces.push_back(whole.faces[idx(t)]);
    for (const int32_t t : selected)
        for (const int32_t side : {3 * t, 3 * t + 1, 3 * t + 2}) {
            const int32_t e = whole.side_edge[idx(side)];
            const SeamMesh::Edge* edge = e < 0 ? nullptr : &whole.edges[idx(e)];
            if (edge && edge->side(0) == side && number[idx(edge->triangle(1))] >= 0) kept.push_back(e);
        }
    std::ranges::sort(kept);
    for (const int32_t e : kept) {
        edges.push_back(whole.edges[idx(e)]);
        for (auto& end : edges.back().corners)
            for (int32_t& corner : end) corner = 3 * number[idx(corner / 3)] + corner % 3;
    }
    index_sides();
}

void SeamMesh::index_sides() {
    side_edge.assign(3 * faces.size(), -1);
    for (size_t e = 0; e < edges.size(); ++e)
        for (size_t t = 0; t < 2; ++t) side_edge[idx(edges[e].side(t))] = static_cast<int32_t>(e);
}

std::vector<uint8_t> SeamMesh::borders(std::span<const int32_t> labels) const {
    std::vector<uint8_t> result;
    for (const Edge& edge : edges) result.push_back(labels[idx(edge.triangle(0))] != labels[idx(edge.triangle(1))] ? 1 : 0);
    return result;
}

std::vector<std::vector<int32_t>> SeamMesh::components(std::span<const uint8_t> is_cut) const {
    UnionFind sets(faces.size());
    for (size_t e = 0; e < edges.size(); ++e)
        if (!is_cut[e]) sets.unite(idx(edges[e].triangle(0)), idx(edges[e].triangle(1)));
    std::vector<std::vector<int32_t>> result;
    std::vector<size_t> number(faces.size());
    for (size_t t = 0; t < faces.size(); ++t) {
        const size_t root = sets.find(t);
        if (root == t) number[t] = result.size(), result.emplace_back();
        result[number[root]].push_back(static_cast<int32_t>(t));
    }
    return result;
}

double SeamMesh::area() const {
    return std::accumulate(faces.begin(), faces.end(), 0.0, [](double sum, const Face& face) { return sum + face.area; });
}

int32_t ShortestPaths::farthest_vertex() const {
    size_t farthest = 0;
    const auto reached = [&](size_t v) { return distance[v] < infinite ? distance[v] : -1; };
    for (size_t v = 1; v < distance.size(); ++v)
        if (reached(v) > reached(farthest)) farthest = v;
    return static_cast<int32_t>(farthest);
}

Patch::Patch(const SeamMesh& of, std::span<const uint8_t> is_cut) : mesh(of), vertex(3 * of.faces.size()) {
    UnionFind sets(vertex.size());
    std::vector<uint8_t> is_outer(vertex.size(), 1);
    for (size_t e = 0; e < mesh.edges.size(); ++e) {
        if (is_cut[e]) continue;
        const SeamMesh::Edge& edge = mesh.edges[e];
        uncut.push_back(static_cast<int32_t>(e));
        for (const auto& [one, other] : edge.corners) sets.unite(idx(one), idx(other));
        for (size_t t = 0; t < 2; ++t) is_outer[idx(edge.side(t))] = 0;
    }
    for (size_t c = 0; c < vertex.size(); ++c) {
        const size_t root = sets.find(c);
        vertex[c] = root == c ? static_cast<int32_t>(vertex_count++) : vertex[root];
    }
    for (const int32_t e : uncut) {
        const auto& corners = mesh.edges[idx(e)].corners;
        uncut_ends.push_back({vertex[idx(corners[0][0])], vertex[idx(corners[1][0])]});
    }
    is_boundary.assign(vertex_count, 0);
    for (size_t side = 0; side < is_outer.size(); ++side) {
        if (!is_outer[side]) continue;
        boundary_sides.push_back(static_cast<int32_t>(side));
        for (const int32_t corner : {boundary_sides.back(), next_corner(boundary_sides.back())})
            is_boundary[idx(vertex[idx(corner)])] = 1;
    }
}

ptrdiff_t Patch::euler_characteristic() const {
    return std::ssize(mesh.faces) + static_cast<ptrdiff_t>(vertex_count) - std::ssize(uncut) - std::ssize(boundary_sides);
}

std::vector<Patch::BoundaryStep> Patch::boundary_loop() const {
    struct Neighbor {
        int32_t side = -1, vertex = -1;
    };
    std::vector<std::array<Neighbor, 2>> neighbors(vertex_count);  // a vertex is at two sides, if at any
    for (const int32_t side : boundary_sides) {
        const int32_t begin = vertex[idx(side)], end = vertex[idx(next_corner(side))];
        for (const auto& [from, to] : {std::pair(begin, end), std::pair(end, begin)})
            neighbors[idx(from)][neighbors[idx(from)][0].side < 0 ? 0 : 1] = {side, to};
    }
    std::vector<BoundaryStep> loop;
    if (boundary_sides.empty()) return loop;
    const int32_t first = vertex[idx(boundary_sides[0])];
    int32_t at = first, side = -1;
    do {
        const auto& [one, other] = neighbors[idx(at)];
        const Neighbor& next = one.side != side ? one : other;
        side = next.side;
        loop.push_back({at, length_of(mesh.faces[idx(side / 3)], idx(side % 3), idx(next_corner(side) % 3))});
        at = next.vertex;
    } while (at != first && loop.size() < boundary_sides.size());
    return loop;
}

std::vector<int32_t> Patch::boundary_vertices() const {
    std::vector<int32_t> result;
    for (size_t v = 0; v < vertex_count; ++v)
        if (is_boundary[v]) result.push_back(static_cast<int32_t>(v));
    return result;
}

ShortestPaths Patch::shortest_paths(std::span<const int32_t> start) const {
    struct Link {
        int32_t to;
        double cost;
    };
    const auto for_each_link = [&](const auto& visit) {
        for (size_t k = 0; k < uncut.size(); ++k) {
            const SeamMesh::Edge& edge = mesh.edges[idx(uncut[k])];
            const auto& [a, b] = uncut_ends[k];
            if (!edge.is_diagonal) visit(a, b, edge.cost, k), visit(b, a, edge.cost, k);
        }
    };
    const CsrArray<Link> links(vertex_count, [&](const auto& put) {
        for_each_link([&](int32_t from, int32_t to, double cost, size_t) { put(idx(from), Link{to, cost}); });
    });
    ShortestPaths paths{std::vector<double>(vertex_count, infinite), std::vector<int32_t>(vertex_count, -1),
                        std::vector<int32_t>(vertex_count, -1)};
    std::vector<double>& distance = paths.distance;
    for (const int32_t v : start) distance[idx(v)] = 0;
    find_shortest_paths(distance, start, [&](int32_t from, double path_length, const auto& relax) {
        for (const auto& [to, cost] : links.row(idx(from))) relax(to, path_length + cost);
        return true;
    });
    for_each_link([&](int32_t from, int32_t to, double cost, size_t k) {
        if (paths.via[idx(to)] < 0 && distance[idx(to)] < infinite && distance[idx(from)] + cost == distance[idx(to)])
            paths.via[idx(to)] = static_cast<int32_t>(k), paths.previous[idx(to)] = from;
    });
    return paths;
}

void Patch::cut_path(const ShortestPaths& paths, int32_t to, std::span<uint8_t> is_cut) const {
    for (; paths.via[idx(to)] >= 0; to = paths.previous[idx(to)]) is_cut[idx(uncut[idx(paths.via[idx(to)])])] = 1;
}

std::vector<uint8_t> cut_to_disk(const SeamMesh& mesh, std::vector<uint8_t> is_cut) {
    const Patch patch(mesh, is_cut);
    const ptrdiff_t euler_characteristic = patch.euler_characteristic();
    if (euler_characteristic == 1) return is_cut;
    std::vector<int32_t> start = patch.boundary_vertices();
    const bool is_closed = start.empty();
    if (is_closed) start = {patch.shortest_paths(std::array{0}).farthest_vertex()};
    const ShortestPaths paths = patch.shortest_paths(start);
    if (euler_characteristic == 2) {
        patch.cut_path(paths, paths.farthest_vertex(), is_cut);
        return is_cut;
    }
    // The tree: all shortest paths. The cotree: a maximum spanning tree of the triangles across the other edges, by the
    // cost of the loop through each edge. The loops through the remaining edges cut the surface to a disk.
    std::vector<uint8_t> in_tree(patch.uncut.size(), 0);
    for (const int32_t via : paths.via)
        if (via >= 0) in_tree[idx(via)] = 1;
    std::vector<std::pair<double, size_t>> loops;  // (-cost, index into uncut)
    for (size_t k = 0; k < patch.uncut.size(); ++k) {
        if (in_tree[k]) continue;
        const auto& [a, b] = patch.uncut_ends[k];
        const SeamMesh::Edge& edge = mesh.edges[idx(patch.uncut[k])];
        loops.emplace_back(edge.is_diagonal ? -infinite : -(paths.distance[idx(a)] + paths.distance[idx(b)] + edge.cost), k);
    }
    std::ranges::sort(loops);
    UnionFind cotree(mesh.faces.size());
    std::erase_if(loops, [&](const auto& loop) {
        const SeamMesh::Edge& edge = mesh.edges[idx(patch.uncut[loop.second])];
        const size_t one = cotree.find(idx(edge.triangle(0))), other = cotree.find(idx(edge.triangle(1)));
        cotree.unite(one, other);
        return one != other;
    });
    const auto cut_loop = [&](size_t k, std::vector<uint8_t>& cuts) {
        cuts[idx(patch.uncut[k])] = 1;
        for (const int32_t v : patch.uncut_ends[k]) patch.cut_path(paths, v, cuts);
    };
    if (!is_closed) {
        for (const auto& [cost, k] : loops) cut_loop(k, is_cut);
        return is_cut;
    }
    // All loops pass through the start, which is arbitrary: cut one loop, then continue from that.
    std::vector<uint8_t> best;
    double best_cost = infinite;
    for (size_t i = loops.size() - std::min(loops.size(), max_tried_loops); i < loops.size(); ++i) {
        std::vector<uint8_t> cuts = is_cut;
        cut_loop(loops[i].second, cuts);
        cuts = cut_to_disk(mesh, std::move(cuts));
        double cost = 0;
        for (size_t e = 0; e < cuts.size(); ++e) cost += cuts[e] ? mesh.edges[e].cost : 0;
        if (cost < best_cost) best_cost = cost, best = std::move(cuts);
    }
    return best.empty() ? is_cut : best;
}

}  // namespace partwheel
