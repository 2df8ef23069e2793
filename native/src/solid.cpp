// Tetrahedra -> the closed, manifold surface around them: the source's own triangles, and caps where the rest was.
#include "solid.h"

#include "error.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>

namespace partwheel {

namespace {

// The corners of the facet opposite each corner, counter-clockwise seen from outside the tetrahedron.
constexpr std::array<std::array<int32_t, 3>, 4> opposite = {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

size_t at(int32_t i) { return static_cast<size_t>(i); }

[[noreturn]] void refuse() {
    throw Error(PW_ERROR_DATA,
                "This is not a hierarchy that can be used: its tetrahedra don't fit together. Build it again.");
}

int32_t corner_of(const Tetrahedron& tet, int32_t vertex) {
    for (int32_t k = 0; k < 4; ++k)
        if (tet[at(k)] == vertex) return k;
    refuse();
}

std::vector<std::array<int32_t, 4>> neighbours_of(std::span<const Tetrahedron> tetrahedra) {
    struct Side {
        int32_t middle, high, tet, corner;
    };
    // By the lowest vertex of the facet: then there are few to compare.
    int32_t vertices = 0;
    for (const Tetrahedron& t : tetrahedra) vertices = std::max({vertices, t[0] + 1, t[1] + 1, t[2] + 1, t[3] + 1});
    std::vector<size_t> begin(at(vertices) + 2, 0);
    const auto sorted = [&](size_t tet, size_t corner) {
        Triangle v;
        for (size_t k = 0; k < 3; ++k) v[k] = tetrahedra[tet][at(opposite[corner][k])];
        std::sort(v.begin(), v.end());
        return v;
    };
    for (size_t t = 0; t < tetrahedra.size(); ++t)
        for (size_t c = 0; c < 4; ++c) {
            const Triangle v = sorted(t, c);
            if (v[0] == v[1] || v[1] == v[2]) refuse();
            ++begin[at(v[0]) + 2];
        }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<Side> sides(4 * tetrahedra.size());
    for (size_t t = 0; t < tetrahedra.size(); ++t)
        for (size_t c = 0; c < 4; ++c) {
            const Triangle v = sorted(t, c);
            sides[begin[at(v[0]) + 1]++] = {v[1], v[2], static_cast<int32_t>(t), static_cast<int32_t>(c)};
        }

    std::vector<std::array<int32_t, 4>> neighbours(tetrahedra.size(), {-1, -1, -1, -1});
    const auto same = [](const Side& a, const Side& b) { return a.middle == b.middle && a.high == b.high; };
    for (size_t v = 0; v < at(vertices); ++v) {
        const auto first = sides.begin() + static_cast<std::ptrdiff_t>(begin[v]);
        const auto last = sides.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]);
        std::sort(first, last, [](const Side& a, const Side& b) {
            return std::tie(a.middle, a.high, a.tet) < std::tie(b.middle, b.high, b.tet);
        });
        for (auto s = first; s != last; ++s) {
            if (s + 1 == last || !same(s[0], s[1])) continue;
            if (s[0].tet == s[1].tet || (s + 2 != last && same(s[1], s[2]))) refuse();
            neighbours[at(s[0].tet)][at(s[0].corner)] = s[1].tet;
            neighbours[at(s[1].tet)][at(s[1].corner)] = s[0].tet;
            ++s;
        }
    }
    return neighbours;
}

// The corners that are joined with each other, as one number each: union-find.
class Joined {
public:
    explicit Joined(size_t size) : up_(size) { std::iota(up_.begin(), up_.end(), size_t{0}); }
    size_t find(size_t i) {
        while (up_[i] != i) i = up_[i] = up_[up_[i]];
        return i;
    }
    void join(size_t a, size_t b) {
        a = find(a), b = find(b);
        up_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<size_t> up_;
};

}  // namespace

Facets::Facets(std::span<const Tetrahedron> tetrahedra, std::span<const int32_t> outer_faces,
               std::span<const int32_t> leaf, bool whole_faces)
    : neighbours_(neighbours_of(tetrahedra)), faces_(tetrahedra.size(), {-1, -1, -1, -1}), home_(tetrahedra.size()) {
    auto next = outer_faces.begin();
    for (size_t t = 0; t < tetrahedra.size(); ++t) {
        int32_t only = -1;  // the face at it; -2: several
        for (size_t c = 0; c < 4; ++c) {
            if (neighbours_[t][c] >= 0) continue;
            if (next == outer_faces.end()) refuse();
            const int32_t face = faces_[t][c] = *next++;
            only = only == -1 || only == face ? face : -2;
        }
        home_[t] = whole_faces && only >= 0 ? leaf[at(only)] : static_cast<int32_t>(t);
        if (home_[t] != static_cast<int32_t>(t)) moved_.emplace_back(home_[t], static_cast<int32_t>(t));
    }
    if (next != outer_faces.end()) refuse();
    std::sort(moved_.begin(), moved_.end());
}

std::vector<int32_t> Facets::at_home(size_t first, size_t last) const {
    std::vector<int32_t> tets;
    if (first > last) {
        for (size_t t = 0; t < home_.size(); ++t)
            if (at(home_[t]) < last || at(home_[t]) >= first) tets.push_back(static_cast<int32_t>(t));
        return tets;
    }
    for (size_t t = first; t < last; ++t)
        if (at(home_[t]) >= first && at(home_[t]) < last) tets.push_back(static_cast<int32_t>(t));
    const auto from = std::lower_bound(moved_.begin(), moved_.end(), std::pair(static_cast<int32_t>(first), -1));
    for (auto m = from; m != moved_.end() && at(m->first) < last; ++m)
        if (at(m->second) < first || at(m->second) >= last) tets.push_back(m->second);
    return tets;
}

// Goes from a facet of the surface through the solid, around the edge that lies opposite another corner of its
// tetrahedron in the facet, to the facet of the surface at the other end.
Facets::Facet Facets::next_around(std::span<const Tetrahedron> tetrahedra, const std::vector<bool>& inside, Facet facet,
                                  int32_t edge) const {
    int32_t t = facet.tet, kept = facet.corner, out = edge;
    for (size_t steps = 0; steps <= tetrahedra.size(); ++steps) {
        const int32_t n = neighbours_[at(t)][at(out)];
        if (n < 0 || !inside[at(n)]) return {t, out};
        const int32_t leave = corner_of(tetrahedra[at(n)], tetrahedra[at(t)][at(kept)]);
        const auto& back = neighbours_[at(n)];
        kept = static_cast<int32_t>(std::find(back.begin(), back.end(), t) - back.begin());
        t = n;
        out = leave;
    }
    refuse();
}

TriangleMesh Facets::solid(std::span<const Tetrahedron> tetrahedra, std::span<const Point> vertices, size_t first,
                           size_t last, std::span<const std::array<int32_t, 2>> middles) const {
    std::vector<bool> inside(tetrahedra.size(), false);
    const std::vector<int32_t> tets = at_home(first, last);
    if (tets.empty())
        throw Error(PW_ERROR_EMPTY, "This part is no solid: it has no face of the surface. Take a larger one.");
    for (int32_t t : tets) inside[at(t)] = true;

    std::vector<Facet> surface;
    std::vector<std::array<int32_t, 4>> number(tetrahedra.size());  // of each facet in surface
    for (int32_t t : tets)
        for (int32_t c = 0; c < 4; ++c) {
            const int32_t n = neighbours_[at(t)][at(c)];
            if (n >= 0 && inside[at(n)]) continue;
            number[at(t)][at(c)] = static_cast<int32_t>(surface.size());
            surface.push_back({t, c});
        }

    // Which triangle is across each edge; edge k of a triangle goes from its corner k to the next. Corners at a vertex
    // that are joined by steps across edges are an umbrella, and each umbrella gets a vertex of its own.
    const auto vertex = [&](size_t f, size_t k) {
        const Facet& facet = surface[f];
        return tetrahedra[at(facet.tet)][at(opposite[at(facet.corner)][k % 3])];
    };
    std::vector<std::array<size_t, 3>> across(surface.size());  // 3 * triangle + edge
    Joined umbrellas(3 * surface.size());
    for (size_t f = 0; f < surface.size(); ++f)
        for (size_t k = 0; k < 3; ++k) {
            const Facet& facet = surface[f];
            const Facet other = next_around(tetrahedra, inside, facet, opposite[at(facet.corner)][(k + 2) % 3]);
            const size_t g = at(number[at(other.tet)][at(other.corner)]);
            size_t j = 0;
            while (j < 3 && vertex(g, j) != vertex(f, k + 1)) ++j;
            if (j == 3 || vertex(g, j + 1) != vertex(f, k)) refuse();
            across[f][k] = 3 * g + j;
            umbrellas.join(3 * f + k, 3 * g + (j + 1) % 3);
            umbrellas.join(3 * f + (k + 1) % 3, 3 * g + j);
        }

    TriangleMesh mesh;
    const auto add_vertex = [&](int32_t a, int32_t b) {
        Point p = vertices[at(a)];
        if (a != b)
            for (size_t i = 0; i < 3; ++i) p[i] = p[i] / 2 + vertices[at(b)][i] / 2;
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
    struct Pair {
        int32_t low, high;
        int own;  // triangles that are the source's
        size_t edge;
    };
    std::vector<Pair> pairs;
    for (size_t f = 0; f < surface.size(); ++f)
        for (size_t k = 0; k < 3; ++k) {
            const size_t edge = 3 * f + k, back = across[f][k];
            if (edge > back) continue;
            const auto [low, high] = std::minmax(of_corner[edge], of_corner[3 * f + (k + 1) % 3]);
            const auto own = [&](size_t e) {
                const Facet& facet = surface[e / 3];
                return neighbours_[at(facet.tet)][at(facet.corner)] < 0 ? 1 : 0;
            };
            pairs.push_back({low, high, own(edge) + own(back), edge});
        }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
        return std::tuple(a.low, a.high, -a.own, a.edge) < std::tuple(b.low, b.high, -b.own, b.edge);
    });
    std::vector<std::array<int32_t, 3>> middle(surface.size(), {-1, -1, -1});
    for (size_t i = 0; i < pairs.size(); ++i) {
        const size_t edge = pairs[i].edge, back = across[edge / 3][edge % 3];
        const bool again = i > 0 && pairs[i].low == pairs[i - 1].low && pairs[i].high == pairs[i - 1].high;
        if (!again && (wanted.empty() || !wanted.contains(std::minmax(vertex(edge / 3, edge % 3),
                                                                      vertex(edge / 3, edge % 3 + 1)))))
            continue;
        const int32_t m = add_vertex(vertex(edge / 3, edge % 3), vertex(edge / 3, edge % 3 + 1));
        middle[edge / 3][edge % 3] = middle[back / 3][back % 3] = m;
    }

    for (size_t f = 0; f < surface.size(); ++f) {
        const Facet& facet = surface[f];
        const auto add = [&](int32_t a, int32_t b, int32_t c) {
            mesh.triangles.push_back({a, b, c});
            mesh.faces.push_back(faces_[at(facet.tet)][at(facet.corner)]);
            mesh.beyond.push_back(neighbours_[at(facet.tet)][at(facet.corner)]);
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

}  // namespace partwheel
