// Builds the closed, manifold surface around a set of tetrahedra: source triangles, and caps inside the solid.
#include "edit/manifold_surface.h"

#include "base/adjacency.h"
#include "base/error.h"

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

    TriangleMesh build() {
        connect_half_edges();
        progress_.reach(0.8);
        while (!add_vertices()) {}
        progress_.reach(0.9);
        for (size_t f = 0; f < surface_.size(); ++f) add_triangle(f);
        return std::move(mesh_);
    }

private:
    // The vertex of the tetrahedra at a corner of triangle f.
    int32_t vertex(size_t f, size_t k) const {
        const Facet& facet = surface_[f];
        return facets_.tetrahedra[idx(facet.tet)][facet_corners[idx(facet.corner)][k % 3]];
    }

    // Finds the half-edge across each half-edge, through the solid.
    void connect_half_edges() {
        std::vector<std::array<int32_t, 4>> number(facets_.tetrahedra.size());  // of each facet in the surface
        for (size_t f = 0; f < surface_.size(); ++f)
            number[idx(surface_[f].tet)][idx(surface_[f].corner)] = static_cast<int32_t>(f);
        across_.assign(3 * surface_.size(), -1);
        for (size_t f = 0; f < surface_.size(); ++f) {
            if (f % 4096 == 0) progress_.reach(0.6 + 0.2 * static_cast<double>(f) / static_cast<double>(surface_.size()));
            for (size_t k = 0; k < 3; ++k) {
                if (across_[3 * f + k] >= 0) continue;  // set from the other side
                const size_t opposite = facet_corners[idx(surface_[f].corner)][(k + 2) % 3];
                const Facet other = next_around(surface_[f], static_cast<int32_t>(opposite));
                const size_t g = idx(number[idx(other.tet)][idx(other.corner)]);
                size_t j = 0;
                while (j < 3 && vertex(g, j) != vertex(f, k + 1)) ++j;
                if (j == 3 || vertex(g, j + 1) != vertex(f, k) || across_[3 * g + j] >= 0) throw_inconsistent_tetrahedra();
                across_[3 * f + k] = static_cast<int32_t>(3 * g + j);
                across_[3 * g + j] = static_cast<int32_t>(3 * f + k);
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

    // Corner i is where half-edge i begins. Corners at a vertex that are connected across edges form an umbrella.
    size_t next_in_umbrella(size_t corner) const { return next_corner(idx(across_[corner])); }

    bool are_in_one_umbrella(size_t corner, size_t other) const {
        for (size_t i = next_in_umbrella(corner); i != corner; i = next_in_umbrella(i))
            if (i == other) return true;
        return false;
    }

    // Each umbrella gets its own vertex. Tetrahedra may touch along an edge and be connected around both of its ends:
    // then several pairs of triangles share two vertices. Two such pairs exchange partners, which divides the umbrella
    // at either end into two; so each pair has vertices of its own. Returns false if any did.
    bool add_vertices() {
        mesh_.vertices.clear();
        mesh_.source_vertices.clear();
        corner_vertex_.assign(across_.size(), -1);
        for (size_t first = 0; first < corner_vertex_.size(); ++first) {
            if (corner_vertex_[first] >= 0) continue;
            const int32_t source = vertex(first / 3, first % 3);
            for (size_t i = first; corner_vertex_[i] < 0; i = next_in_umbrella(i))
                corner_vertex_[i] = static_cast<int32_t>(mesh_.vertices.size());
            mesh_.vertices.push_back(facets_.vertices[idx(source)]);
            mesh_.source_vertices.push_back(source);
        }
        bool is_done = true;
        std::vector<size_t> pairs;  // by the half-edge that leads to the higher vertex
        const auto ends = [&](size_t edge) { return std::pair(corner_vertex_[edge], corner_vertex_[next_corner(edge)]); };
        for_each_edge(mesh_.vertices.size(), across_.size(), ends, [&](int32_t low, std::span<const Side> sides) {
            if (sides.size() == 2) return;
            is_done = false;
            pairs.clear();
            for (const Side& side : sides)
                if (corner_vertex_[idx(side.number)] == low) pairs.push_back(idx(side.number));
            for (size_t i = 0; i < pairs.size(); ++i)
                for (size_t j = i + 1; j < pairs.size(); ++j) exchange_partners(pairs[i], pairs[j]);
        });
        return is_done;
    }

    // If two half-edges, and so their partners, have both vertices in common.
    void exchange_partners(size_t a, size_t b) {
        if (!are_in_one_umbrella(a, b) || !are_in_one_umbrella(next_corner(a), next_corner(b))) return;
        std::swap(across_[a], across_[b]);
        across_[idx(across_[a])] = static_cast<int32_t>(a);
        across_[idx(across_[b])] = static_cast<int32_t>(b);
    }

    void add_triangle(size_t f) {
        const Facet& facet = surface_[f];
        mesh_.triangles.push_back({corner_vertex_[3 * f], corner_vertex_[3 * f + 1], corner_vertex_[3 * f + 2]});
        mesh_.source_faces.push_back(facets_.faces[idx(facet.tet)][idx(facet.corner)]);
        mesh_.neighbor_tets.push_back(facets_.neighbors[idx(facet.tet)][idx(facet.corner)]);
    }

    const TetFacets& facets_;
    Progress& progress_;
    std::vector<uint8_t> inside_;  // of each tetrahedron
    std::vector<Facet> surface_;   // triangles
    std::vector<int32_t> across_;  // of each half-edge, the one on the other side
    std::vector<int32_t> corner_vertex_;
    TriangleMesh mesh_;
};

}  // namespace

void throw_inconsistent_tetrahedra() {
    throw Error(PW_ERROR_DATA, "This hierarchy can't be used: its tetrahedra don't fit together. Build it again.");
}

TriangleMesh build_surface(const TetFacets& facets, std::span<const int32_t> tets, Progress& progress) {
    if (tets.empty())
        throw Error(PW_ERROR_EMPTY, "This part is not a solid: it has no face of the surface. Choose a larger one.");
    return SurfaceBuilder(facets, tets, progress).build();
}

}  // namespace partwheel
