// Tetrahedra -> the closed, manifold surface around them: the source's own triangles, and caps where the rest was.
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

Facets::Facets(std::span<const Tetrahedron> tetrahedra, std::span<const int32_t> outer_faces,
               std::span<const int32_t> leaf, bool whole_faces, Progress& progress)
    : neighbors_(neighbors_of(tetrahedra)), faces_(tetrahedra.size(), {-1, -1, -1, -1}), home_(tetrahedra.size()) {
    progress.reach(0.3);
    auto next = outer_faces.begin();
    for (size_t t = 0; t < tetrahedra.size(); ++t) {
        int32_t only = -1;  // the face at it; -2: several
        for (size_t c = 0; c < 4; ++c) {
            if (neighbors_[t][c] >= 0) continue;
            if (next == outer_faces.end()) refuse();
            const int32_t face = faces_[t][c] = *next++;
            only = only == -1 || only == face ? face : -2;
        }
        home_[t] = whole_faces && only >= 0 ? leaf[idx(only)] : static_cast<int32_t>(t);
        if (home_[t] != static_cast<int32_t>(t)) moved_.emplace_back(home_[t], static_cast<int32_t>(t));
    }
    if (next != outer_faces.end()) refuse();
    std::sort(moved_.begin(), moved_.end());
}

std::vector<int32_t> Facets::at_home(size_t first, size_t last) const {
    std::vector<int32_t> tets;
    if (first > last) {
        for (size_t t = 0; t < home_.size(); ++t)
            if (idx(home_[t]) < last || idx(home_[t]) >= first) tets.push_back(static_cast<int32_t>(t));
        return tets;
    }
    for (size_t t = first; t < last; ++t)
        if (idx(home_[t]) >= first && idx(home_[t]) < last) tets.push_back(static_cast<int32_t>(t));
    const auto from = std::lower_bound(moved_.begin(), moved_.end(), std::pair(static_cast<int32_t>(first), -1));
    for (auto m = from; m != moved_.end() && idx(m->first) < last; ++m)
        if (idx(m->second) < first || idx(m->second) >= last) tets.push_back(m->second);
    return tets;
}

std::vector<int32_t> Facets::pieces(std::span<const uint8_t> in) const {
    UnionFind joined(in.size());
    for (size_t t = 0; t < in.size(); ++t)
        for (int32_t n : neighbors_[t])
            if (n >= 0 && in[idx(n)] == in[t]) joined.join(t, idx(n));
    std::vector<int32_t> piece;
    for (size_t t = 0; t < in.size(); ++t) piece.push_back(static_cast<int32_t>(joined.find(t)));
    return piece;
}

void Facets::drop_splinters(std::span<const uint8_t> before, std::vector<uint8_t>& in) const {
    const std::vector<int32_t> old = pieces(before);
    for (const bool side : {true, false}) {  // the one's splinters may have been what set apart the other's
        const std::vector<int32_t> now = pieces(in);
        // What has most tetrahedra in common with a piece that there was goes on as that piece.
        std::map<std::pair<int32_t, int32_t>, size_t> common;
        for (size_t t = 0; t < in.size(); ++t)
            if (in[t] == before[t]) ++common[{old[t], now[t]}];
        std::map<int32_t, std::pair<size_t, int32_t>> most;
        for (const auto& [pair, count] : common)
            if (count > most[pair.first].first) most[pair.first] = {count, pair.second};
        std::set<int32_t> kept;
        for (const auto& [piece, best] : most) kept.insert(best.second);
        for (size_t t = 0; t < in.size(); ++t)
            if ((in[t] != 0) == side && !kept.contains(now[t])) in[t] = !in[t];
    }
}

std::vector<int32_t> Facets::with_faces(std::span<const Tetrahedron> tetrahedra, std::span<const Point> vertices,
                                        size_t first, size_t last, std::span<const uint8_t> inside,
                                        Progress& progress) const {
    const bool rest = first > last;
    if (rest) std::swap(first, last);
    std::vector<uint8_t> in(tetrahedra.size(), 0);
    for (int32_t t : at_home(first, last)) in[idx(t)] = 1;
    const std::vector<uint8_t> before = in;
    const auto area = [&](size_t t, size_t corner) {
        const Triangle f = facet(tetrahedra[t], corner);
        return partwheel::area(vertices[idx(f[0])], vertices[idx(f[1])], vertices[idx(f[2])]);
    };

    std::vector<uint8_t> within(tetrahedra.size(), 1);
    Box changed;  // around those that change sides
    for (size_t t = 0; t < tetrahedra.size(); ++t) {
        double more = 0;  // on the surface: area of the part's faces, less that of others
        for (size_t c = 0; c < 4; ++c) {
            if (neighbors_[t][c] >= 0) continue;
            within[t] = 0;
            const int32_t face = faces_[t][c];
            if (face >= 0) more += inside[idx(face)] ? area(t, c) : -area(t, c);
        }
        const uint8_t wanted = more > 0 ? 1 : more < 0 ? 0 : in[t];
        if (wanted == in[t]) continue;
        in[t] = wanted;
        for (int32_t v : tetrahedra[t]) changed.add(vertices[idx(v)]);
    }
    progress.reach(0.5);
    const Point &low = changed.low, &high = changed.high;
    if (const double size = changed.diagonal(); low[0] <= high[0] && size > 0) {
        // Edges of the surface, by the faces of which they are: of the part's, and of all.
        struct Edge {
            std::pair<int32_t, int32_t> ends;
            int in, all;
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
            if (within[t]) {
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
                edges[count - 1].in += edge.in, ++edges[count - 1].all;
            else
                edges[count++] = edge;
        }
        edges.resize(count);
        // The facets about an edge between two faces of one side join these: to go through there costs so much more.
        const auto joins = [&](size_t t, size_t corner) {
            double sum = 0;
            for (size_t k = 0; k < 3; ++k) {
                const auto found = std::ranges::lower_bound(edges, ends(t, corner, k), {}, &Edge::ends);
                if (found == edges.end() || found->ends != ends(t, corner, k)) continue;
                if (found->all < 2 || (found->in > 0 && found->in < found->all)) continue;
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
                const int64_t cost = quantize_cost(area(t, c) / size / size + joins(t, c));
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
        drop_splinters(before, in);

        // Where tetrahedra are large beside what moved, the part's own may fit the faces better.
        const auto wrong = [&](std::span<const uint8_t> sides) {
            double sum = 0;
            for (size_t t = 0; t < tetrahedra.size(); ++t)
                for (size_t c = 0; !within[t] && c < 4; ++c)
                    if (neighbors_[t][c] < 0 && faces_[t][c] >= 0 && !inside[idx(faces_[t][c])] != !sides[t])
                        sum += area(t, c);
            return sum;
        };
        const auto both = [&] { return std::ranges::find(in, 0) != in.end() && std::ranges::find(in, 1) != in.end(); };
        if (!both() || wrong(in) >= wrong(before)) in = before;
    }

    std::vector<int32_t> tets;
    for (size_t t = 0; t < tetrahedra.size(); ++t)
        if ((in[t] != 0) != rest) tets.push_back(static_cast<int32_t>(t));
    return tets;
}

// Goes from a facet of the surface through the solid, around the edge that lies opposite another corner of its
// tetrahedron in the facet, to the facet of the surface at the other end.
Facets::Facet Facets::next_around(std::span<const Tetrahedron> tetrahedra, std::span<const uint8_t> inside, Facet facet,
                                  int32_t edge) const {
    int32_t t = facet.tet, kept = facet.corner, out = edge;
    for (size_t steps = 0; steps <= tetrahedra.size(); ++steps) {
        const int32_t n = neighbors_[idx(t)][idx(out)];
        if (n < 0 || !inside[idx(n)]) return {t, out};
        const int32_t leave = corner_of(tetrahedra[idx(n)], tetrahedra[idx(t)][idx(kept)]);
        const auto& back = neighbors_[idx(n)];
        kept = static_cast<int32_t>(std::find(back.begin(), back.end(), t) - back.begin());
        t = n;
        out = leave;
    }
    refuse();
}

TriangleMesh Facets::solid(std::span<const Tetrahedron> tetrahedra, std::span<const Point> vertices,
                           std::span<const int32_t> tets, std::span<const std::array<int32_t, 2>> middles,
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

    // Which triangle is across each edge; edge k of a triangle goes from its corner k to the next. Corners at a vertex
    // that are joined by steps across edges are an umbrella, and each umbrella gets a vertex of its own.
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
            if (across[f][k] != unknown) continue;  // seen from the other side
            const Facet& facet = surface[f];
            const size_t edge = facet_corners[idx(facet.corner)][(k + 2) % 3];
            const Facet other = next_around(tetrahedra, inside, facet, static_cast<int32_t>(edge));
            const size_t g = idx(number[idx(other.tet)][idx(other.corner)]);
            size_t j = 0;
            while (j < 3 && vertex(g, j) != vertex(f, k + 1)) ++j;
            if (j == 3 || vertex(g, j + 1) != vertex(f, k) || across[g][j] != unknown) refuse();
            across[f][k] = static_cast<int32_t>(3 * g + j);
            across[g][j] = static_cast<int32_t>(3 * f + k);
            umbrellas.join(3 * f + k, 3 * g + (j + 1) % 3);
            umbrellas.join(3 * f + (k + 1) % 3, 3 * g + j);
        }
    }

    progress.reach(0.8);
    TriangleMesh mesh;
    const auto add_vertex = [&](int32_t a, int32_t b) {
        Point p = vertices[idx(a)];
        if (a != b)
            for (size_t i = 0; i < 3; ++i) p[i] = p[i] / 2 + vertices[idx(b)][i] / 2;
        mesh.vertices.push_back(p);
        mesh.ends.push_back({a, b});
        return static_cast<int32_t>(mesh.vertices.size() - 1);
    };
    std::vector<int32_t> of_corner(3 * surface.size(), -1);
    for (size_t i = 0; i < of_corner.size(); ++i) {
        int32_t& of_umbrella = of_corner[umbrellas.find(i)];
        if (of_umbrella < 0) of_umbrella = add_vertex(vertex(i / 3, i % 3), vertex(i / 3, i % 3));
        of_corner[i] = of_umbrella;
    }

    // Tetrahedra may touch along an edge and yet be joined about both of its ends: then several pairs of triangles
    // share two vertices. The first pair, the one with most of the source's own triangles, keeps the edge; each other
    // pair gets a vertex in its middle. Where the caller wants one, every pair gets it.
    std::set<std::pair<int32_t, int32_t>> wanted;
    for (const auto& [a, b] : middles) wanted.insert(std::minmax(a, b));
    const auto back_of = [&](size_t edge) { return idx(across[edge / 3][edge % 3]); };
    const auto own = [&](size_t edge) {  // of the two triangles at it, how many are the source's
        const auto outer = [&](size_t e) {
            const Facet& facet = surface[e / 3];
            return neighbors_[idx(facet.tet)][idx(facet.corner)] < 0 ? 1 : 0;
        };
        return outer(edge) + outer(back_of(edge));
    };
    const auto ends = [&](size_t edge) {
        return std::pair(of_corner[edge], of_corner[edge % 3 == 2 ? edge - 2 : edge + 1]);
    };
    std::vector<std::array<int32_t, 3>> middle(surface.size(), {-1, -1, -1});
    std::vector<size_t> pairs;  // each by its lower edge
    for_each_edge(mesh.vertices.size(), of_corner.size(), ends, [&](int32_t, std::span<const Side> sides) {
        if (sides.size() == 2 && wanted.empty()) return;
        pairs.clear();
        for (const Side& side : sides)
            if (idx(side.number) <= back_of(idx(side.number))) pairs.push_back(idx(side.number));
        std::ranges::sort(pairs, {}, [&](size_t edge) { return std::pair(-own(edge), edge); });
        for (const size_t edge : pairs) {
            const size_t back = back_of(edge);
            const int32_t a = vertex(edge / 3, edge % 3), b = vertex(edge / 3, edge % 3 + 1);
            if (edge == pairs.front() && !wanted.contains(std::minmax(a, b))) continue;
            middle[edge / 3][edge % 3] = middle[back / 3][back % 3] = add_vertex(a, b);
        }
    });

    progress.reach(0.9);
    for (size_t f = 0; f < surface.size(); ++f) {
        const Facet& facet = surface[f];
        const auto add = [&](int32_t a, int32_t b, int32_t c) {
            mesh.triangles.push_back({a, b, c});
            mesh.faces.push_back(faces_[idx(facet.tet)][idx(facet.corner)]);
            mesh.beyond.push_back(neighbors_[idx(facet.tet)][idx(facet.corner)]);
        };
        // Turned so that edges without a middle come last.
        size_t turn = 0;
        const auto split = [&](size_t k) { return middle[f][k % 3] >= 0; };
        const int splits = split(0) + split(1) + split(2);
        while (splits > 0 && (!split(turn) || (splits == 2 && !split(turn + 1)))) ++turn;
        const int32_t a = of_corner[3 * f + turn % 3], b = of_corner[3 * f + (turn + 1) % 3],
                      c = of_corner[3 * f + (turn + 2) % 3];
        const int32_t ab = middle[f][turn % 3], bc = middle[f][(turn + 1) % 3], ca = middle[f][(turn + 2) % 3];
        if (splits == 0) {
            add(a, b, c);
        } else if (splits == 1) {
            add(a, ab, c);
            add(ab, b, c);
        } else {
            add(ab, b, bc);
            if (splits == 2 && vertex(f, turn) < vertex(f, turn + 2)) {  // the same seen from both sides
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

const Facets& Solids::facets(Progress& progress) const {
    const std::lock_guard lock(mutex_);
    if (!facets_)
        facets_ = std::make_unique<Facets>(hierarchy_.tetrahedra(), hierarchy_.outer_faces(), hierarchy_.leaves(),
                                           hierarchy_.is_exact(), progress);
    progress.reach(0.4);
    return *facets_;
}

TriangleMesh Solids::solid(size_t tet_first, size_t tet_last, std::span<const std::array<int32_t, 2>> middles,
                           Progress& progress) const {
    const Facets& all = facets(progress);
    return all.solid(hierarchy_.tetrahedra(), hierarchy_.vertices(), all.at_home(tet_first, tet_last), middles, progress);
}

TriangleMesh Solids::solid(std::span<const std::array<int32_t, 2>> slices,
                           std::span<const std::array<int32_t, 2>> middles, Progress& progress) const {
    const Facets& all = facets(progress);
    std::vector<int32_t> tets;
    for (const auto& [first, last] : slices) {
        // Homes outside the slice may be in another one: each tetrahedron has one home, so none comes twice.
        const std::vector<int32_t> more = all.at_home(idx(first), idx(last));
        tets.insert(tets.end(), more.begin(), more.end());
    }
    return all.solid(hierarchy_.tetrahedra(), hierarchy_.vertices(), tets, middles, progress);
}

TriangleMesh Solids::solid_of_faces(size_t tet_first, size_t tet_last, std::span<const uint8_t> inside,
                                    Progress& progress) const {
    const auto tetrahedra = hierarchy_.tetrahedra();
    const auto vertices = hierarchy_.vertices();
    const Facets& all = facets(progress);
    const std::vector<int32_t> tets = all.with_faces(tetrahedra, vertices, tet_first, tet_last, inside, progress);
    return all.solid(tetrahedra, vertices, tets, {}, progress);
}

}  // namespace partwheel
