// Builds the closed, manifold surface around a set of tetrahedra: source triangles, and caps inside the solid.
#include "edit/manifold_surface.h"

#include "base/adjacency.h"
#include "base/checked_index.h"
#include "base/error.h"

#include <algorithm>
#include <set>
#include <utility>

namespace partwheel {

namespace {

struct Facet {
    int32_t tet, corner;  // the facet opposite this corner
};

int32_t corner_of(const Tetrahedron& tet, int32_t vertex) {
    for (int32_t k = 0; k < 4; ++k)
        if (tet[idx(k)] == vertex) return k;
    throw_inconsistent_tetrahedra();
}

// Half-edge 3 f + k leads from corner k of triangle f to the next corner.
class SurfaceBuilder {
public:
    SurfaceBuilder(const TetFacets& facets, std::span<const int32_t> tets, Progress& progress)
        : facets_(facets), progress_(progress), inside_(facets.tetrahedra.size(), 0) {
        for (const int32_t t : tets) inside_[idx(t)] = 1;
        // A facet without neighbor is on the model's surface; one to a tetrahedron outside the set is a cap.
        for (const int32_t t : tets)
            for (int32_t c = 0; c < 4; ++c)
                if (const int32_t n = facets_.neighbors[idx(t)][idx(c)]; n < 0 || !inside_[idx(n)]) surface_.push_back({t, c});
        (void)checked_index(3 * surface_.size());
    }

    TriangleMesh build(std::span<const std::array<int32_t, 2>> split_edges) {
        connect_half_edges();
        progress_.reach(0.8);
        add_vertices();
        add_midpoints(split_edges);
        progress_.reach(0.9);
        for (size_t f = 0; f < surface_.size(); ++f) add_triangles(f);
        return std::move(mesh_);
    }

private:
    // The vertex of the tetrahedra at a corner of triangle f.
    int32_t vertex(size_t f, size_t k) const {
        const Facet& facet = surface_[f];
        return facets_.tetrahedra[idx(facet.tet)][facet_corners[idx(facet.corner)][k % 3]];
    }

    // Finds the half-edge across each half-edge. Corners at a vertex that are connected across edges form an umbrella.
    void connect_half_edges() {
        std::vector<std::array<int32_t, 4>> number(facets_.tetrahedra.size());  // of each facet in the surface
        for (size_t f = 0; f < surface_.size(); ++f)
            number[idx(surface_[f].tet)][idx(surface_[f].corner)] = static_cast<int32_t>(f);
        across_.assign(3 * surface_.size(), -1);
        umbrellas_ = UnionFind(3 * surface_.size());
        for (size_t f = 0; f < surface_.size(); ++f) {
            if (f % 4096 == 0) progress_.reach(0.6 + 0.2 * static_cast<double>(f) / static_cast<double>(surface_.size()));
            for (size_t k = 0; k < 3; ++k) {
                if (across_[3 * f + k] >= 0) continue;  // set from the other side
                const Facet other = next_around(surface_[f], static_cast<int32_t>(facet_corners[idx(surface_[f].corner)][(k + 2) % 3]));
                const size_t g = idx(number[idx(other.tet)][idx(other.corner)]);
                size_t j = 0;
                while (j < 3 && vertex(g, j) != vertex(f, k + 1)) ++j;
                if (j == 3 || vertex(g, j + 1) != vertex(f, k) || across_[3 * g + j] >= 0) throw_inconsistent_tetrahedra();
                across_[3 * f + k] = static_cast<int32_t>(3 * g + j);
                across_[3 * g + j] = static_cast<int32_t>(3 * f + k);
                umbrellas_.unite(3 * f + k, 3 * g + (j + 1) % 3);
                umbrellas_.unite(3 * f + (k + 1) % 3, 3 * g + j);
            }
        }
    }

    // Rotates a facet through the solid around one of its edges (that opposite the corner `edge`) to the facet on the
    // other side.
    Facet next_around(Facet facet, int32_t edge) const {
        int32_t t = facet.tet, fixed = facet.corner, out = edge;
        for (size_t steps = 0; steps <= facets_.tetrahedra.size(); ++steps) {
            const int32_t n = facets_.neighbors[idx(t)][idx(out)];
            if (n < 0 || !inside_[idx(n)]) return {t, out};
            const int32_t leave = corner_of(facets_.tetrahedra[idx(n)], facets_.tetrahedra[idx(t)][idx(fixed)]);
            const auto& back = facets_.neighbors[idx(n)];
            fixed = static_cast<int32_t>(std::find(back.begin(), back.end(), t) - back.begin());
            t = n;
            out = leave;
        }
        throw_inconsistent_tetrahedra();
    }

    // A vertex, or the midpoint of two.
    int32_t add_vertex(int32_t a, int32_t b) {
        Point p = facets_.vertices[idx(a)];
        if (a != b)
            for (size_t i = 0; i < 3; ++i) p[i] = p[i] / 2 + facets_.vertices[idx(b)][i] / 2;
        mesh_.vertices.push_back(p);
        mesh_.source_edges.push_back({a, b});
        return static_cast<int32_t>(mesh_.vertices.size() - 1);
    }

    // Each umbrella gets its own vertex.
    void add_vertices() {
        corner_vertex_.assign(3 * surface_.size(), -1);
        for (size_t i = 0; i < corner_vertex_.size(); ++i) {
            int32_t& umbrella_vertex = corner_vertex_[umbrellas_.find(i)];
            if (umbrella_vertex < 0) umbrella_vertex = add_vertex(vertex(i / 3, i % 3), vertex(i / 3, i % 3));
            corner_vertex_[i] = umbrella_vertex;
        }
    }

    // Tetrahedra may touch along an edge and be connected around both of its ends: then several pairs of triangles share
    // two vertices. The pair with the most source triangles keeps the edge, the others get a vertex at its midpoint. All get
    // one if the caller asks for it.
    void add_midpoints(std::span<const std::array<int32_t, 2>> split_edges) {
        std::set<std::pair<int32_t, int32_t>> split;
        for (const auto& [a, b] : split_edges) split.insert(std::minmax(a, b));
        const auto ends = [&](size_t edge) {
            return std::pair(corner_vertex_[edge], corner_vertex_[edge % 3 == 2 ? edge - 2 : edge + 1]);
        };
        midpoint_.assign(3 * surface_.size(), -1);
        std::vector<size_t> pairs;  // by the lower half-edge
        for_each_edge(mesh_.vertices.size(), corner_vertex_.size(), ends, [&](int32_t, std::span<const Side> sides) {
            if (sides.size() == 2 && split.empty()) return;
            pairs.clear();
            for (const Side& side : sides)
                if (side.number <= across_[idx(side.number)]) pairs.push_back(idx(side.number));
            std::ranges::sort(pairs, {}, [&](size_t edge) { return std::pair(-count_source_triangles(edge), edge); });
            for (const size_t edge : pairs) {
                const int32_t a = vertex(edge / 3, edge % 3), b = vertex(edge / 3, edge % 3 + 1);
                if (edge == pairs.front() && !split.contains(std::minmax(a, b))) continue;
                midpoint_[edge] = midpoint_[idx(across_[edge])] = add_vertex(a, b);
            }
        });
    }

    // Of the two triangles at a half-edge.
    int count_source_triangles(size_t edge) const {
        const auto is_source = [&](size_t e) {
            const Facet& facet = surface_[e / 3];
            return facets_.neighbors[idx(facet.tet)][idx(facet.corner)] < 0 ? 1 : 0;
        };
        return is_source(edge) + is_source(idx(across_[edge]));
    }

    // The triangle itself, or two to four instead if its edges have midpoints.
    void add_triangles(size_t f) {
        const Facet& facet = surface_[f];
        const auto add = [&](int32_t a, int32_t b, int32_t c) {
            mesh_.triangles.push_back({a, b, c});
            mesh_.source_faces.push_back(facets_.faces[idx(facet.tet)][idx(facet.corner)]);
            mesh_.neighbor_tets.push_back(facets_.neighbors[idx(facet.tet)][idx(facet.corner)]);
        };
        // Rotates the corners so that edges without a midpoint come last.
        size_t turn = 0;
        const auto corner = [&](size_t k) { return corner_vertex_[3 * f + (turn + k) % 3]; };
        const auto middle = [&](size_t k) { return midpoint_[3 * f + (turn + k) % 3]; };
        const int splits = (middle(0) >= 0) + (middle(1) >= 0) + (middle(2) >= 0);
        while (splits > 0 && (middle(0) < 0 || (splits == 2 && middle(1) < 0))) ++turn;
        const int32_t a = corner(0), b = corner(1), c = corner(2), ab = middle(0), bc = middle(1), ca = middle(2);
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

    const TetFacets& facets_;
    Progress& progress_;
    std::vector<uint8_t> inside_;  // of each tetrahedron
    std::vector<Facet> surface_;   // triangles
    std::vector<int32_t> across_;  // of each half-edge, the one on the other side
    UnionFind umbrellas_{0};       // of corners
    std::vector<int32_t> corner_vertex_;
    std::vector<int32_t> midpoint_;  // of each half-edge, its vertex; -1: none
    TriangleMesh mesh_;
};

}  // namespace

void throw_inconsistent_tetrahedra() {
    throw Error(PW_ERROR_DATA,
                "This is not a hierarchy that can be used: its tetrahedra don't fit together. Build it again.");
}

TriangleMesh build_surface(const TetFacets& facets, std::span<const int32_t> tets,
                           std::span<const std::array<int32_t, 2>> split_edges, Progress& progress) {
    if (tets.empty())
        throw Error(PW_ERROR_EMPTY, "This part is no solid: it has no face of the surface. Take a larger one.");
    return SurfaceBuilder(facets, tets, progress).build(split_edges);
}

}  // namespace partwheel
