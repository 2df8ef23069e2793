// Extraction of closed, manifold surfaces around sets of tetrahedra.
#include "edit/solid.h"

#include "base/error.h"
#include "base/adjacency.h"
#include "base/checked_index.h"
#include "edit/border.h"
#include "tree/adjacency.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace partwheel {

namespace {

[[noreturn]] void refuse() {
    throw Error(PW_ERROR_DATA,
                "This is not a hierarchy that can be used: its tetrahedra don't fit together. Build it again.");
}

int32_t corner_of(const Tetrahedron& tet, int32_t vertex) {
    for (int32_t k = 0; k < 4; ++k)
        if (tet[idx(k)] == vertex) return k;
    refuse();
}

}  // namespace

SolidBuilder::SolidBuilder(std::span<const Tetrahedron> tetrahedra, std::span<const int32_t> outer_faces,
               std::span<const int32_t> leaf, std::span<const uint8_t> exact, Progress& progress)
    : neighbors_(find_neighbors(tetrahedra)), faces_(tetrahedra.size(), {-1, -1, -1, -1}), owner_(tetrahedra.size()) {
    progress.reach(0.3);
    auto next = outer_faces.begin();
    for (size_t t = 0; t < tetrahedra.size(); ++t) {
        int32_t face_at_tet = -1;  // -2: several
        for (size_t c = 0; c < 4; ++c) {
            if (neighbors_[t][c] >= 0) continue;
            if (next == outer_faces.end()) refuse();
            const int32_t face = faces_[t][c] = *next++;
            face_at_tet = face_at_tet == -1 || face_at_tet == face ? face : -2;
        }
        owner_[t] = exact[t] && face_at_tet >= 0 ? leaf[idx(face_at_tet)] : static_cast<int32_t>(t);
        if (owner_[t] != static_cast<int32_t>(t)) reassigned_.emplace_back(owner_[t], static_cast<int32_t>(t));
    }
    if (next != outer_faces.end()) refuse();
    std::sort(reassigned_.begin(), reassigned_.end());
}

std::vector<int32_t> SolidBuilder::tets_of_slice(size_t first, size_t last) const {
    std::vector<int32_t> tets;
    if (first > last) {
        for (size_t t = 0; t < owner_.size(); ++t)
            if (idx(owner_[t]) < last || idx(owner_[t]) >= first) tets.push_back(static_cast<int32_t>(t));
        return tets;
    }
    for (size_t t = first; t < last; ++t)
        if (idx(owner_[t]) >= first && idx(owner_[t]) < last) tets.push_back(static_cast<int32_t>(t));
    const auto from =
        std::lower_bound(reassigned_.begin(), reassigned_.end(), std::pair(static_cast<int32_t>(first), -1));
    for (auto m = from; m != reassigned_.end() && idx(m->first) < last; ++m)
        if (idx(m->second) < first || idx(m->second) >= last) tets.push_back(m->second);
    return tets;
}

std::vector<int32_t> SolidBuilder::components(std::span<const uint8_t> in) const {
    UnionFind sets(in.size());
    for (size_t t = 0; t < in.size(); ++t)
        for (int32_t n : neighbors_[t])
            if (n >= 0 && in[idx(n)] == in[t]) sets.unite(t, idx(n));
    std::vector<int32_t> component;
    for (size_t t = 0; t < in.size(); ++t) component.push_back(static_cast<int32_t>(sets.find(t)));
    return component;
}

void SolidBuilder::restore_components(std::span<const uint8_t> before, std::vector<uint8_t>& in) const {
    const std::vector<int32_t> old = components(before);
    for (const bool side : {true, false}) {  // one side's components may separate the other's
        const std::vector<int32_t> current = components(in);
        // The component with the most tetrahedra of an old one is its successor.
        std::map<std::pair<int32_t, int32_t>, size_t> common;
        for (size_t t = 0; t < in.size(); ++t)
            if (in[t] == before[t]) ++common[{old[t], current[t]}];
        std::map<int32_t, std::pair<size_t, int32_t>> successor;  // (common tetrahedra, component)
        for (const auto& [pair, count] : common)
            if (count > successor[pair.first].first) successor[pair.first] = {count, pair.second};
        std::set<int32_t> successors;
        for (const auto& [component, best] : successor) successors.insert(best.second);
        for (size_t t = 0; t < in.size(); ++t)
            if ((in[t] != 0) == side && !successors.contains(current[t])) in[t] = !in[t];
    }
}

std::vector<int32_t> SolidBuilder::tets_of_faces(std::span<const Tetrahedron> tetrahedra, std::span<const Point> vertices,
                                        size_t first, size_t last, std::span<const uint8_t> inside,
                                        Progress& progress) const {
    const bool is_complement = first > last;
    if (is_complement) std::swap(first, last);
    std::vector<uint8_t> in(tetrahedra.size(), 0);
    for (int32_t t : tets_of_slice(first, last)) in[idx(t)] = 1;
    const std::vector<uint8_t> before = in;
    const auto area = [&](size_t t, size_t corner) {
        const Triangle f = facet(tetrahedra[t], corner);
        return partwheel::area(vertices[idx(f[0])], vertices[idx(f[1])], vertices[idx(f[2])]);
    };

    std::vector<uint8_t> is_inner(tetrahedra.size(), 1);  // without surface
    Box changed;  // around the tetrahedra that change sides
    for (size_t t = 0; t < tetrahedra.size(); ++t) {
        double balance = 0;  // surface area of the part's faces minus that of the rest
        for (size_t c = 0; c < 4; ++c) {
            if (neighbors_[t][c] >= 0) continue;
            is_inner[t] = 0;
            const int32_t face = faces_[t][c];
            if (face >= 0) balance += inside[idx(face)] ? area(t, c) : -area(t, c);
        }
        const uint8_t majority = balance > 0 ? 1 : balance < 0 ? 0 : in[t];
        if (majority == in[t]) continue;
        in[t] = majority;
        for (int32_t v : tetrahedra[t]) changed.add(vertices[idx(v)]);
    }
    progress.reach(0.5);
    const Point &low = changed.low, &high = changed.high;
    if (const double size = changed.diagonal(); low[0] <= high[0] && size > 0) {
        struct Edge {  // of the surface
            std::pair<int32_t, int32_t> ends;
            int in_part, total;  // number of faces
        };
        std::vector<Edge> edges;
        const auto ends = [&](size_t t, size_t corner, size_t k) -> std::pair<int32_t, int32_t> {
            const Triangle f = facet(tetrahedra[t], corner);
            return std::minmax(f[k], f[(k + 1) % 3]);
        };
        BorderBand band;
        std::vector<int32_t> number(tetrahedra.size(), -1);
        for (size_t t = 0; t < tetrahedra.size(); ++t) {
            const auto near = [&](int32_t v) {
                for (size_t i = 0; i < 3; ++i)
                    if (vertices[idx(v)][i] < low[i] - size || vertices[idx(v)][i] > high[i] + size) return false;
                return true;
            };
            if (std::ranges::none_of(tetrahedra[t], near)) continue;
            if (is_inner[t]) {
                number[t] = static_cast<int32_t>(band.faces.size());
                band.faces.push_back(static_cast<int32_t>(t));
                continue;
            }
            for (size_t c = 0; c < 4; ++c)
                for (size_t k = 0; neighbors_[t][c] < 0 && k < 3; ++k) edges.push_back({ends(t, c, k), in[t], 1});
        }
        std::ranges::sort(edges, {}, &Edge::ends);
        size_t count = 0;
        for (const Edge& edge : edges) {
            if (count > 0 && edges[count - 1].ends == edge.ends)
                edges[count - 1].in_part += edge.in_part, ++edges[count - 1].total;
            else
                edges[count++] = edge;
        }
        edges.resize(count);
        // Extra cost of a cap through a surface edge between two faces of the same side.
        const auto edge_cost = [&](size_t t, size_t corner) {
            double sum = 0;
            for (size_t k = 0; k < 3; ++k) {
                const auto found = std::ranges::lower_bound(edges, ends(t, corner, k), {}, &Edge::ends);
                if (found == edges.end() || found->ends != ends(t, corner, k)) continue;
                if (found->total < 2 || (found->in_part > 0 && found->in_part < found->total)) continue;
                const Point along = vertices[idx(found->ends.first)] - vertices[idx(found->ends.second)];
                sum += length(along);
            }
            return sum / size;
        };
        band.to_part.assign(band.faces.size(), 0);
        band.to_rest.assign(band.faces.size(), 0);
        for (size_t n = 0; n < band.faces.size(); ++n) {
            const size_t t = idx(band.faces[n]);
            for (size_t c = 0; c < 4; ++c) {
                const size_t other = idx(neighbors_[t][c]);
                if (number[other] >= 0 && other < t) continue;
                const int64_t cost = quantize_cost(area(t, c) / size / size + edge_cost(t, c));
                if (number[other] >= 0)
                    band.edges.push_back({static_cast<int32_t>(n), number[other], cost});
                else
                    (in[other] ? band.to_part : band.to_rest)[n] += cost;
            }
        }
        progress.reach(0.55);
        const std::vector<uint8_t> side = minimum_cut(band);
        progress.reach(0.6);
        for (size_t n = 0; n < band.faces.size(); ++n) in[idx(band.faces[n])] = side[n];
        restore_components(before, in);

        // If tetrahedra are large compared to the change, the old set may fit the faces better.
        const auto wrong_area = [&](std::span<const uint8_t> sides) {
            double sum = 0;
            for (size_t t = 0; t < tetrahedra.size(); ++t)
                for (size_t c = 0; !is_inner[t] && c < 4; ++c)
                    if (neighbors_[t][c] < 0 && faces_[t][c] >= 0 && !inside[idx(faces_[t][c])] != !sides[t])
                        sum += area(t, c);
            return sum;
        };
        const auto both_are_nonempty = [&] {
            return std::ranges::find(in, 0) != in.end() && std::ranges::find(in, 1) != in.end();
        };
        if (!both_are_nonempty() || wrong_area(in) >= wrong_area(before)) in = before;
    }

    std::vector<int32_t> tets;
    for (size_t t = 0; t < tetrahedra.size(); ++t)
        if ((in[t] != 0) != is_complement) tets.push_back(static_cast<int32_t>(t));
    return tets;
}

// Rotates a boundary facet through the solid around one of its edges (that opposite the corner `edge`) to the
// boundary facet on the other side.
SolidBuilder::Facet SolidBuilder::next_around(std::span<const Tetrahedron> tetrahedra, std::span<const uint8_t> inside,
                                              Facet facet, int32_t edge) const {
    int32_t t = facet.tet, fixed = facet.corner, out = edge;
    for (size_t steps = 0; steps <= tetrahedra.size(); ++steps) {
        const int32_t n = neighbors_[idx(t)][idx(out)];
        if (n < 0 || !inside[idx(n)]) return {t, out};
        const int32_t leave = corner_of(tetrahedra[idx(n)], tetrahedra[idx(t)][idx(fixed)]);
        const auto& back = neighbors_[idx(n)];
        fixed = static_cast<int32_t>(std::find(back.begin(), back.end(), t) - back.begin());
        t = n;
        out = leave;
    }
    refuse();
}

TriangleMesh SolidBuilder::build(std::span<const Tetrahedron> tetrahedra, std::span<const Point> vertices,
                           std::span<const int32_t> tets, std::span<const std::array<int32_t, 2>> split_edges,
                           Progress& progress) const {
    std::vector<uint8_t> inside(tetrahedra.size(), 0);
    if (tets.empty())
        throw Error(PW_ERROR_EMPTY, "This part is no solid: it has no face of the surface. Take a larger one.");
    for (int32_t t : tets) inside[idx(t)] = 1;

    std::vector<Facet> surface;
    std::vector<std::array<int32_t, 4>> number(tetrahedra.size());  // of each facet in surface
    for (int32_t t : tets)
        for (int32_t c = 0; c < 4; ++c) {
            const int32_t n = neighbors_[idx(t)][idx(c)];
            if (n >= 0 && inside[idx(n)]) continue;
            number[idx(t)][idx(c)] = static_cast<int32_t>(surface.size());
            surface.push_back({t, c});
        }

    // The half-edge across each half-edge k of a triangle, from corner k to the next. Corners at a vertex that are
    // connected across edges form an umbrella; each umbrella gets its own vertex.
    const auto vertex = [&](size_t f, size_t k) {
        const Facet& facet = surface[f];
        return tetrahedra[idx(facet.tet)][facet_corners[idx(facet.corner)][k % 3]];
    };
    constexpr int32_t unknown = -1;
    (void)checked_index(3 * surface.size());
    std::vector<std::array<int32_t, 3>> across(surface.size(), {unknown, unknown, unknown});  // 3 * triangle + edge
    UnionFind umbrellas(3 * surface.size());
    for (size_t f = 0; f < surface.size(); ++f) {
        if (f % 4096 == 0) progress.reach(0.6 + 0.2 * static_cast<double>(f) / static_cast<double>(surface.size()));
        for (size_t k = 0; k < 3; ++k) {
            if (across[f][k] != unknown) continue;  // set from the other side
            const Facet& facet = surface[f];
            const size_t edge = facet_corners[idx(facet.corner)][(k + 2) % 3];
            const Facet other = next_around(tetrahedra, inside, facet, static_cast<int32_t>(edge));
            const size_t g = idx(number[idx(other.tet)][idx(other.corner)]);
            size_t j = 0;
            while (j < 3 && vertex(g, j) != vertex(f, k + 1)) ++j;
            if (j == 3 || vertex(g, j + 1) != vertex(f, k) || across[g][j] != unknown) refuse();
            across[f][k] = static_cast<int32_t>(3 * g + j);
            across[g][j] = static_cast<int32_t>(3 * f + k);
            umbrellas.unite(3 * f + k, 3 * g + (j + 1) % 3);
            umbrellas.unite(3 * f + (k + 1) % 3, 3 * g + j);
        }
    }

    progress.reach(0.8);
    TriangleMesh mesh;
    const auto add_vertex = [&](int32_t a, int32_t b) {
        Point p = vertices[idx(a)];
        if (a != b)
            for (size_t i = 0; i < 3; ++i) p[i] = p[i] / 2 + vertices[idx(b)][i] / 2;
        mesh.vertices.push_back(p);
        mesh.source_edges.push_back({a, b});
        return static_cast<int32_t>(mesh.vertices.size() - 1);
    };
    std::vector<int32_t> corner_vertex(3 * surface.size(), -1);
    for (size_t i = 0; i < corner_vertex.size(); ++i) {
        int32_t& umbrella_vertex = corner_vertex[umbrellas.find(i)];
        if (umbrella_vertex < 0) umbrella_vertex = add_vertex(vertex(i / 3, i % 3), vertex(i / 3, i % 3));
        corner_vertex[i] = umbrella_vertex;
    }

    // Tetrahedra may touch along an edge and be connected around both of its ends: then several pairs of triangles
    // share two vertices. The pair with the most source triangles keeps the edge, the others get a vertex at its
    // midpoint. All get one if the caller asks for it.
    std::set<std::pair<int32_t, int32_t>> split;
    for (const auto& [a, b] : split_edges) split.insert(std::minmax(a, b));
    const auto opposite = [&](size_t edge) { return idx(across[edge / 3][edge % 3]); };
    const auto source_triangles = [&](size_t edge) {  // among the two at the edge
        const auto is_source = [&](size_t e) {
            const Facet& facet = surface[e / 3];
            return neighbors_[idx(facet.tet)][idx(facet.corner)] < 0 ? 1 : 0;
        };
        return is_source(edge) + is_source(opposite(edge));
    };
    const auto ends = [&](size_t edge) {
        return std::pair(corner_vertex[edge], corner_vertex[edge % 3 == 2 ? edge - 2 : edge + 1]);
    };
    std::vector<std::array<int32_t, 3>> midpoint(surface.size(), {-1, -1, -1});
    std::vector<size_t> pairs;  // by the lower half-edge
    for_each_edge(mesh.vertices.size(), corner_vertex.size(), ends, [&](int32_t, std::span<const Side> sides) {
        if (sides.size() == 2 && split.empty()) return;
        pairs.clear();
        for (const Side& side : sides)
            if (idx(side.number) <= opposite(idx(side.number))) pairs.push_back(idx(side.number));
        std::ranges::sort(pairs, {}, [&](size_t edge) { return std::pair(-source_triangles(edge), edge); });
        for (const size_t edge : pairs) {
            const size_t back = opposite(edge);
            const int32_t a = vertex(edge / 3, edge % 3), b = vertex(edge / 3, edge % 3 + 1);
            if (edge == pairs.front() && !split.contains(std::minmax(a, b))) continue;
            midpoint[edge / 3][edge % 3] = midpoint[back / 3][back % 3] = add_vertex(a, b);
        }
    });

    progress.reach(0.9);
    for (size_t f = 0; f < surface.size(); ++f) {
        const Facet& facet = surface[f];
        const auto add = [&](int32_t a, int32_t b, int32_t c) {
            mesh.triangles.push_back({a, b, c});
            mesh.source_faces.push_back(faces_[idx(facet.tet)][idx(facet.corner)]);
            mesh.neighbor_tets.push_back(neighbors_[idx(facet.tet)][idx(facet.corner)]);
        };
        // Rotates the corners so that edges without a midpoint come last.
        size_t turn = 0;
        const auto has_midpoint = [&](size_t k) { return midpoint[f][k % 3] >= 0; };
        const int splits = has_midpoint(0) + has_midpoint(1) + has_midpoint(2);
        while (splits > 0 && (!has_midpoint(turn) || (splits == 2 && !has_midpoint(turn + 1)))) ++turn;
        const int32_t a = corner_vertex[3 * f + turn % 3], b = corner_vertex[3 * f + (turn + 1) % 3],
                      c = corner_vertex[3 * f + (turn + 2) % 3];
        const int32_t ab = midpoint[f][turn % 3], bc = midpoint[f][(turn + 1) % 3], ca = midpoint[f][(turn + 2) % 3];
        if (splits == 0) {
            add(a, b, c);
        } else if (splits == 1) {
            add(a, ab, c);
            add(ab, b, c);
        } else {
            add(ab, b, bc);
            if (splits == 2 && vertex(f, turn) < vertex(f, turn + 2)) {  // the same diagonal from both sides
                add(a, ab, bc);
                add(a, bc, c);
            } else if (splits == 2) {
                add(a, ab, c);
                add(ab, bc, c);
            } else {
                add(a, ab, ca);
                add(bc, c, ca);
                add(ab, bc, ca);
            }
        }
    }
    return mesh;
}

const SolidBuilder& Solids::builder(Progress& progress) const {
    const std::lock_guard lock(mutex_);
    if (!builder_)
        builder_ = std::make_unique<SolidBuilder>(hierarchy_.tetrahedra(), hierarchy_.outer_faces(), hierarchy_.leaves(),
                                           hierarchy_.exact_tetrahedra(), progress);
    progress.reach(0.4);
    return *builder_;
}

TriangleMesh Solids::solid(size_t tet_first, size_t tet_last, std::span<const std::array<int32_t, 2>> split_edges,
                           Progress& progress) const {
    const SolidBuilder& solids = builder(progress);
    return solids.build(hierarchy_.tetrahedra(), hierarchy_.vertices(), solids.tets_of_slice(tet_first, tet_last),
                        split_edges, progress);
}

TriangleMesh Solids::solid(std::span<const std::array<int32_t, 2>> slices,
                           std::span<const std::array<int32_t, 2>> split_edges, Progress& progress) const {
    const SolidBuilder& solids = builder(progress);
    std::vector<int32_t> tets;
    for (const auto& [first, last] : slices) {
        // Each tetrahedron has one owner, so none is added twice.
        const std::vector<int32_t> slice_tets = solids.tets_of_slice(idx(first), idx(last));
        tets.insert(tets.end(), slice_tets.begin(), slice_tets.end());
    }
    return solids.build(hierarchy_.tetrahedra(), hierarchy_.vertices(), tets, split_edges, progress);
}

TriangleMesh Solids::solid_of_faces(size_t tet_first, size_t tet_last, std::span<const uint8_t> inside,
                                    Progress& progress) const {
    const auto tetrahedra = hierarchy_.tetrahedra();
    const auto vertices = hierarchy_.vertices();
    const SolidBuilder& solids = builder(progress);
    const std::vector<int32_t> tets = solids.tets_of_faces(tetrahedra, vertices, tet_first, tet_last, inside, progress);
    return solids.build(tetrahedra, vertices, tets, {}, progress);
}

}  // namespace partwheel
