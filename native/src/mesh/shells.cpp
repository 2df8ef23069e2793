// The shells of a mesh.
#include "mesh/shells.h"

namespace partwheel {

namespace {

// The lowest vertex with the same coordinates, of each vertex.
std::vector<int32_t> find_places(std::span<const Point> vertices) {
    std::vector<int32_t> order = iota(vertices.size()), place(vertices.size());
    std::ranges::sort(order, [&](int32_t a, int32_t b) {
        const Point &p = vertices[idx(a)], &q = vertices[idx(b)];
        return p != q ? p < q : a < b;
    });
    for (size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && vertices[idx(order[i])] == vertices[idx(order[i - 1])];
        place[idx(order[i])] = same ? place[idx(order[i - 1])] : order[i];
    }
    return place;
}

// Welds the vertices of border edges (those of one triangle) whose ends have the same coordinates.
std::vector<int32_t> weld_borders(const MeshView& mesh) {
    std::vector<std::array<int32_t, 2>> borders;
    for_each_edge(mesh.vertices.size(), mesh.triangles, [&](int32_t low, std::span<const Side> sides) {
        if (sides.size() == 1 && low != sides[0].high) borders.push_back({low, sides[0].high});
    });
    UnionFind welded(mesh.vertices.size());
    if (!borders.empty()) {
        const std::vector<int32_t> place = find_places(mesh.vertices);
        const auto ends = [&](size_t i) { return std::pair(place[idx(borders[i][0])], place[idx(borders[i][1])]); };
        for_each_edge(mesh.vertices.size(), borders.size(), ends, [&](int32_t low, std::span<const Side> sides) {
            if (low == sides[0].high) return;
            const auto end = [&](const Side& side, bool first) {
                return idx(borders[idx(side.number)][side.is_ascending == first ? 0 : 1]);
            };
            for (const Side& side : sides.subspan(1))
                for (const bool first : {true, false}) welded.unite(end(sides[0], first), end(side, first));
        });
    }
    std::vector<int32_t> vertex(mesh.vertices.size());
    for (size_t v = 0; v < vertex.size(); ++v) vertex[v] = static_cast<int32_t>(welded.find(v));
    return vertex;
}

// Numbers the shells given by representatives, in the order of their lowest vertices, then of their highest ones.
Shells numbered(const MeshView& mesh, UnionFind& sets, std::vector<int32_t> vertex) {
    struct Key {
        Point lowest{HUGE_VAL, HUGE_VAL, HUGE_VAL};
        Point highest{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
        size_t triangles = 0;
        int32_t set = 0;
    };
    std::vector<int32_t> number(mesh.vertices.size(), -1);
    std::vector<Key> keys;
    for (const Triangle& t : mesh.triangles) {
        int32_t& n = number[sets.find(idx(t[0]))];
        if (n < 0) {
            n = static_cast<int32_t>(keys.size());
            keys.push_back({.set = n});
        }
        Key& key = keys[idx(n)];
        for (const int32_t v : t) {
            key.lowest = std::min(key.lowest, mesh.vertices[idx(v)]);
            key.highest = std::max(key.highest, mesh.vertices[idx(v)]);
        }
        ++key.triangles;
    }
    std::ranges::sort(keys, {}, [](const Key& k) { return std::tie(k.lowest, k.highest, k.triangles, k.set); });
    std::vector<int32_t> place(keys.size());
    for (size_t i = 0; i < keys.size(); ++i) place[idx(keys[i].set)] = static_cast<int32_t>(i);
    Shells shells;
    shells.vertex = std::move(vertex);
    shells.count = keys.size();
    for (const Triangle& t : mesh.triangles) shells.of_triangle.push_back(place[idx(number[sets.find(idx(t[0]))])]);
    for (size_t v = 0; v < shells.vertex.size(); ++v) shells.is_welded |= shells.vertex[v] != static_cast<int32_t>(v);
    return shells;
}

}  // namespace

Shells find_shells(const MeshView& mesh) {
    std::vector<int32_t> vertex = weld_borders(mesh);
    UnionFind sets(mesh.vertices.size());
    for (size_t v = 0; v < vertex.size(); ++v) sets.unite(v, idx(vertex[v]));
    std::vector<int32_t> of_face(mesh.face_count, -1);  // a vertex of each
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        int32_t& known = of_face[mesh.faces.empty() ? t : idx(mesh.faces[t])];
        if (known < 0) known = mesh.triangles[t][0];
        for (const int32_t v : mesh.triangles[t]) sets.unite(idx(known), idx(v));
    }
    return numbered(mesh, sets, std::move(vertex));
}

Shells join_shells(const MeshView& mesh, const Shells& shells, std::span<const int32_t> joined) {
    std::vector<int32_t> first(shells.count, -1);  // a vertex of each
    UnionFind sets(mesh.vertices.size());
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        int32_t& known = first[idx(shells.of_triangle[t])];
        if (known < 0) known = mesh.triangles[t][0];
        for (const int32_t v : mesh.triangles[t]) sets.unite(idx(known), idx(v));
    }
    for (size_t s = 0; s < shells.count; ++s)
        if (joined[s] >= 0) sets.unite(idx(first[s]), idx(first[idx(joined[s])]));
    return numbered(mesh, sets, shells.vertex);
}

}  // namespace partwheel
