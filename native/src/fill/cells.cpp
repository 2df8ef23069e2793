// A closed surface with interior walls.
#include "fill/cells.h"

#include "base/adjacency.h"
#include "base/predicates.h"
#include "mesh/face_assignment.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace partwheel {

namespace {

// Whether no edge has only one triangle and some edge has more than two.
bool may_have_walls(const Surface& surface) {
    bool open = false, non_manifold = false;
    for_each_edge(surface.vertices.size(), surface.triangles, [&](int32_t, std::span<const Side> sides) {
        open = open || sides.size() == 1;
        non_manifold = non_manifold || sides.size() > 2;
    });
    return non_manifold && !open;
}

bool is_degenerate(const Surface& surface) {
    return std::ranges::any_of(surface.triangles, [&](const Triangle& t) {
        return collinear(surface.vertices[idx(t[0])], surface.vertices[idx(t[1])], surface.vertices[idx(t[2])]);
    });
}

// The regions into which the surface divides the tetrahedra, and which of them are solid.
class Regions {
public:
    Regions(const Surface& surface, TetMesh&& mesh, Progress& progress)
        : mesh_(std::move(mesh)), walls_(find_walls(surface, mesh_, progress)), regions_(mesh_.tetrahedra.size()),
          state_(mesh_.tetrahedra.size(), unknown) {
        std::vector<bool> lost(surface.triangles.size(), true);
        for_facets([&](size_t t, size_t k) {
            if (walls_[t][k].triangle >= 0) lost[idx(walls_[t][k].triangle)] = false;
            if (walls_[t][k].triangle < 0 && mesh_.neighbors[t][k] >= 0) regions_.unite(t, idx(mesh_.neighbors[t][k]));
        });
        if (std::ranges::find(lost, true) != lost.end()) throw_lost();
        classify(surface);
    }

    const TetMesh& mesh() const { return mesh_; }
    const Wall& wall(size_t tet, size_t corner) const { return walls_[tet][corner]; }
    bool is_solid(int32_t tet) { return tet >= 0 && state_[regions_.find(idx(tet))] == solid; }

    size_t cavities() const { return static_cast<size_t>(std::ranges::count(state_, cavity)); }

    // Calls visit(tetrahedron, corner) for each facet opposite a corner.
    template <class Visit>
    void for_facets(const Visit& visit) const {
        for (size_t t = 0; t < mesh_.tetrahedra.size(); ++t)
            for (size_t k = 0; k < 4; ++k) visit(t, k);
    }

private:
    enum State : uint8_t { unknown, solid, cavity };

    // Regions at the outside are solid, whatever their orientation. From there inward: a region next to a cavity is
    // solid; any other region is a cavity if all triangles around it face it, which agrees with the winding number.
    void classify(const Surface& surface) {
        std::vector<size_t> front;
        double outwards = 0;  // signed area of outer triangles, positive if they face outward
        const auto add = [&](size_t region, State state) {
            if (state_[region] != unknown) return;
            state_[region] = state;
            front.push_back(region);
        };
        for_facets([&](size_t t, size_t k) {
            if (mesh_.neighbors[t][k] >= 0) return;
            if (walls_[t][k].triangle < 0) throw_lost();
            const double area = surface.samples[idx(walls_[t][k].triangle)].area;
            outwards += walls_[t][k].behind ? area : -area;
            add(regions_.find(t), solid);
        });
        std::vector<bool> faces_away(state_.size(), false), beside_cavity(state_.size(), false);
        for_facets([&](size_t t, size_t k) {
            if (walls_[t][k].triangle >= 0 && walls_[t][k].behind == (outwards > 0)) faces_away[regions_.find(t)] = true;
        });
        const CsrArray<int32_t> tets(state_.size(), [&](const auto& put) {
            for (size_t t = 0; t < state_.size(); ++t) put(regions_.find(t), static_cast<int32_t>(t));
        });
        while (!front.empty()) {
            std::vector<size_t> next;
            for (const size_t region : std::exchange(front, {}))
                for (const int32_t t : tets.row(region))
                    for (const int32_t n : mesh_.neighbors[idx(t)]) {
                        const size_t other = n < 0 ? region : regions_.find(idx(n));
                        if (state_[other] != unknown) continue;
                        next.push_back(other);
                        if (state_[region] == cavity) beside_cavity[other] = true;
                    }
            for (const size_t region : next) add(region, beside_cavity[region] || faces_away[region] ? solid : cavity);
        }
    }

    TetMesh mesh_;
    std::vector<std::array<Wall, 4>> walls_;
    UnionFind regions_;
    std::vector<State> state_;  // of each region, at its lowest tetrahedron
};

// The solid regions, separated along the walls.
Solid separate_at_walls(const Surface& source, Regions& regions, Progress& progress) {
    const TetMesh& all = regions.mesh();
    const auto corner_of = [&](size_t tet, int32_t vertex) {
        return idx(static_cast<int32_t>(std::ranges::find(all.tetrahedra[tet], vertex) - all.tetrahedra[tet].begin()));
    };
    // Corners of tetrahedra at a vertex share a copy of it if steps across facets without wall connect them.
    UnionFind fans(4 * all.tetrahedra.size());
    regions.for_facets([&](size_t t, size_t k) {
        const int32_t n = all.neighbors[t][k];
        if (n < 0 || regions.wall(t, k).triangle >= 0) return;
        for (size_t c = 0; c < 4; ++c)
            if (c != k) fans.unite(4 * t + c, 4 * idx(n) + corner_of(idx(n), all.tetrahedra[t][c]));
    });
    const auto is_connected = [&](size_t t, size_t k) {  // with a solid tetrahedron on the other side of this facet
        const int32_t n = all.neighbors[t][k];
        if (!regions.is_solid(n)) return false;
        for (size_t c = 0; c < 4; ++c)
            if (c != k && fans.find(4 * t + c) != fans.find(4 * idx(n) + corner_of(idx(n), all.tetrahedra[t][c])))
                return false;
        return true;
    };

    std::vector<int32_t> number(4 * all.tetrahedra.size(), -1), given, source_vertex, behind, triangle_of;
    std::vector<int32_t> tet_number(all.tetrahedra.size(), -1);
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;
    const auto vertex_of_corner = [&](size_t t, size_t c) {
        int32_t& n = number[fans.find(4 * t + c)];
        if (n < 0) {
            const size_t v = idx(all.tetrahedra[t][c]);
            n = static_cast<int32_t>(vertices.size());
            vertices.push_back(all.vertices[v]);
            given.push_back(n);
            source_vertex.push_back(v < source.vertices.size() ? source.source_vertex[v] : -1);
        }
        return n;
    };
    int32_t count = 0;
    regions.for_facets([&](size_t t, size_t k) {
        if (!regions.is_solid(static_cast<int32_t>(t))) return;
        if (k == 0) tet_number[t] = count++;
        const Wall wall = regions.wall(t, k);
        if (wall.triangle < 0 || (!wall.behind && is_connected(t, k))) return;
        Triangle f = facet(all.tetrahedra[t], k);
        for (int32_t& v : f) v = vertex_of_corner(t, corner_of(t, v));
        triangles.push_back(f);
        behind.push_back(tet_number[t]);
        triangle_of.push_back(wall.behind || !regions.is_solid(all.neighbors[t][k]) ? wall.triangle : -1);
    });
    Solid solid;
    solid.surface = canonical(source.frame, vertices, given, triangles);

    // Vertices as the surface has them, then those that are inside alone.
    std::vector<int32_t> place(vertices.size());
    for (size_t v = 0; v < vertices.size(); ++v) place[idx(solid.surface.source_vertex[v])] = static_cast<int32_t>(v);
    for (int32_t& n : number)
        if (n >= 0) n = place[idx(n)];
    for (int32_t& v : solid.surface.source_vertex) v = source_vertex[idx(v)];
    vertices = solid.surface.vertices;
    std::vector<std::array<Corner, 4>> corners;
    for (size_t t = 0; t < all.tetrahedra.size(); ++t) {
        if (tet_number[t] < 0) continue;
        std::array<Corner, 4>& c = corners.emplace_back();
        for (size_t k = 0; k < 4; ++k)
            c[k] = {vertex_of_corner(t, k), is_connected(t, k) ? tet_number[idx(all.neighbors[t][k])] : -1};
    }
    std::vector<int32_t> tet_place;
    solid.mesh = canonical(std::move(vertices), std::move(corners), progress, &tet_place);
    std::vector<FaceSample> samples;
    for (const FaceSample& sample : solid.surface.samples) {
        solid.mesh.tet_of_triangle.push_back(tet_place[idx(behind[idx(sample.face)])]);
        const int32_t triangle = triangle_of[idx(sample.face)];
        if (triangle < 0) continue;
        const FaceSample& own = source.samples[idx(triangle)];
        samples.push_back({own.face, sample.triangle, own.area});
    }
    solid.surface.samples = std::move(samples);
    solid.surface.face_count = source.face_count;
    solid.mesh.cavities = regions.cavities();
    return solid;
}

// The number of source faces with solid on both sides.
size_t count_walls(const Surface& source, Regions& regions) {
    std::set<int32_t> faces;
    regions.for_facets([&](size_t t, size_t k) {
        const int32_t triangle = regions.wall(t, k).triangle;
        if (triangle >= 0 && regions.is_solid(static_cast<int32_t>(t)) && regions.is_solid(regions.mesh().neighbors[t][k]))
            faces.insert(source.samples[idx(triangle)].face);
    });
    return faces.size();
}

}  // namespace

std::optional<Solid> fill_cells(const Surface& source, double quality, Progress& progress) {
    if (!may_have_walls(source) || is_degenerate(source) || crosses_itself(source, progress)) return {};
    progress.enter(PW_STAGE_TETRAHEDRA);
    std::optional<Regions> regions;
    try {
        (void)tetrahedralize(source, quality, progress,
                             [&](TetMesh& all) { regions.emplace(source, std::move(all), progress); });
    } catch (const Error& error) {
        if (error.status() != PW_ERROR_TETRAHEDRA) throw;
        return {};
    }
    const size_t walls = count_walls(source, *regions);
    if (walls == 0) return {};
    Solid solid = separate_at_walls(source, *regions, progress);
    if (solid.surface.samples.size() != source.triangles.size()) return {};  // some triangles have no solid behind them
    solid.surface.fill_method = PW_FILL_REPAIRED;
    solid.surface_from_tetrahedra = true;
    solid.surface.notes = "Repaired: " + counted_faces(walls, "is a wall", "are walls") +
                            " inside the solid, which was cut apart there.";
    return solid;
}

}  // namespace partwheel
