// A large surface made coarser: passes of collapses that have nothing to do with each other, and whose faces go where.
#include "prepare/decimate.h"

#include "base/morton.h"
#include "base/adjacency.h"
#include "base/parallel.h"
#include "mesh/face_assignment.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace partwheel {

namespace {

// Collapses of vertices with more triangles are left out: comparing all around both ends takes the square.
constexpr size_t most_triangles = 96;

// How much the way that a vertex goes counts, beside the square of its distance from the surface: little.
constexpr double evenness = 1e-3;

// What keeps an open border in its place, relative to the triangles there.
constexpr double border_weight = 4;

// A triangle's normal turns by no more than this cosine says.
constexpr double least_turned = 0.25;

// Of the collapses that are possible in a pass this share is looked at, the cheapest; a pass that takes away less than
// this share of the triangles is the last.
constexpr double looked_at = 0.5, least_progress = 0.01;

// A copy of more triangles than this for each that was wanted would take too long.
constexpr size_t too_many = 4;

constexpr size_t piece = 1024;  // of a parallel loop

// How far a point is from planes: a sum of squares, each times a weight.
struct Quadric {
    std::array<double, 6> square{};  // xx, yy, zz, xy, xz, yz
    Point linear{};
    double constant = 0, weight = 0;

    // The plane through a point.
    void add(const Point& normal, const Point& through, double with) {
        const auto& [x, y, z] = normal;
        const double d = -dot(normal, through);
        const std::array<double, 6> products = {x * x, y * y, z * z, x * y, x * z, y * z};
        for (size_t k = 0; k < 6; ++k) square[k] += with * products[k];
        for (size_t k = 0; k < 3; ++k) linear[k] += with * d * normal[k];
        constant += with * d * d;
    }
    void add(const Quadric& other) {
        for (size_t k = 0; k < 6; ++k) square[k] += other.square[k];
        linear = linear + other.linear;
        constant += other.constant;
        weight += other.weight;
    }
    double of(const Point& p) const {
        const auto& [x, y, z] = p;
        const auto& [xx, yy, zz, xy, xz, yz] = square;
        return xx * x * x + yy * y * y + zz * z * z + 2 * (xy * x * y + xz * x * z + yz * y * z) +
               2 * dot(linear, p) + constant;
    }
};

// The vertices around one, each with the number of triangles at the edge to it.
struct Ring {
    struct Spoke {
        int32_t vertex, triangles;
    };
    std::array<Spoke, 2 * most_triangles> spokes;
    size_t count = 0;

    void add(int32_t vertex) {
        for (size_t i = 0; i < count; ++i)
            if (spokes[i].vertex == vertex) {
                ++spokes[i].triangles;
                return;
            }
        spokes[count++] = {vertex, 1};
    }
    std::span<const Spoke> all() const { return std::span(spokes).first(count); }
};

class Collapses {
public:
    Collapses(const Surface& source, ThreadPool& threads)
        : vertices_(source.vertices), triangles_(source.triangles), threads_(threads), into_(vertices_.size()),
          quadrics_(vertices_.size()), own_(vertices_.size()), choices_(vertices_.size()),
          stale_(vertices_.size(), true) {
        std::iota(into_.begin(), into_.end(), 0);
        join_borders();
        sort_out();
        threads_.parallel_for(vertices_.size(), piece, [&](size_t first, size_t last) {
            for (size_t v = first; v < last; ++v) set(v, measured(v));
        });
    }

    std::span<const Triangle> triangles() const { return triangles_; }
    // The vertex that each has become.
    std::span<const int32_t> into() const { return into_; }

    // Until there are so many triangles, or it comes to no end.
    void collapse(size_t target, Progress& progress) {
        const auto from = static_cast<double>(triangles_.size() - std::min(target, triangles_.size()));
        while (triangles_.size() > target) {
            const size_t before = triangles_.size();
            progress.advance(0.2 + 0.5 * (1 - static_cast<double>(before - target) / from));
            pass(before - target, progress);
            if (static_cast<double>(before - triangles_.size()) < least_progress * static_cast<double>(before)) break;
        }
    }

    // The vertices in each cell of a grid become one, that which fits best: in the coarsest grid that leaves so many
    // triangles. Cells are pieces of the curve, along which the vertices are sorted.
    void unite_cells(size_t target) {
        const std::vector<uint64_t> places = morton_codes(vertices_);
        const auto left = [&](int level) {
            size_t count = 0;
            const auto cell = [&](int32_t v) { return places[idx(v)] >> 3 * (morton_bits - level); };
            for (const auto& [a, b, c] : triangles_)
                if (cell(a) != cell(b) && cell(b) != cell(c) && cell(c) != cell(a)) ++count;
            return count;
        };
        int level = 1;
        while (level < morton_bits && left(level) < target) ++level;
        const auto cell = [&](size_t v) { return places[v] >> 3 * (morton_bits - level); };
        for (size_t first = 0, last = 0; first < vertices_.size(); first = last) {
            Quadric all;
            while (last < vertices_.size() && cell(last) == cell(first)) {
                if (idx(into_[last]) == last) all.add(quadrics_[last]);
                ++last;
            }
            size_t best = last;
            double least = HUGE_VAL;
            for (size_t v = first; v < last; ++v)
                if (idx(into_[v]) == v && !by_vertex_.with(v).empty() && all.of(vertices_[v]) < least) {
                    best = v;
                    least = all.of(vertices_[v]);
                }
            if (best == last) continue;
            for (size_t v = first; v < last; ++v)
                if (idx(into_[v]) == v) into_[v] = static_cast<int32_t>(best);
            set(best, all);
        }
        sort_out();
        std::fill(stale_.begin(), stale_.end(), true);
    }

private:
    const Point& point(int32_t v) const { return vertices_[idx(v)]; }
    Point normal(const Triangle& t) const { return cross(point(t[1]) - point(t[0]), point(t[2]) - point(t[0])); }

    void set(size_t v, const Quadric& quadric) {
        quadrics_[v] = quadric;
        own_[v] = quadric.of(vertices_[v]);
    }

    // What is open and meets at the same places is joined: seams that no one sees.
    void join_borders() {
        if (std::adjacent_find(vertices_.begin(), vertices_.end()) == vertices_.end()) return;
        std::vector<bool> open(vertices_.size(), false);
        for_each_edge(vertices_.size(), triangles_, [&](int32_t low, std::span<const Side> sides) {
            if (sides.size() == 1) open[idx(low)] = open[idx(sides[0].high)] = true;
        });
        for (size_t v = 0, first = 0; v < vertices_.size(); ++v) {
            if (!open[v]) continue;
            if (vertices_[first] != vertices_[v] || !open[first]) first = v;
            into_[v] = static_cast<int32_t>(first);
        }
    }

    // Vertices that were collapsed leave the triangles, and triangles those that they have.
    void sort_out() {
        for (int32_t& v : into_) v = into_[idx(v)];
        const auto gone = std::remove_if(triangles_.begin(), triangles_.end(), [&](Triangle& t) {
            for (int32_t& v : t) v = into_[idx(v)];
            return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
        });
        triangles_.erase(gone, triangles_.end());
        by_vertex_ = CsrArray<int32_t>(vertices_.size(), [&](const auto& put) {
            for (size_t t = 0; t < triangles_.size(); ++t)
                for (const int32_t v : triangles_[t]) put(idx(v), static_cast<int32_t>(t));
        });
    }

    Quadric measured(size_t v) const {
        Quadric q;
        if (by_vertex_.with(v).size() > most_triangles) return q;
        const Ring around = ring(v);
        for (const int32_t t : by_vertex_.with(v)) {
            const Triangle& tri = triangles_[idx(t)];
            const Point n = normal(tri);
            const double twice = length(n);
            if (!(twice > 0)) continue;
            q.add(1 / twice * n, point(tri[0]), twice / 2);
            q.weight += twice / 2;
            for (size_t k = 0; k < 3; ++k) {
                const int32_t a = tri[k], b = tri[(k + 1) % 3];
                if (idx(a) != v && idx(b) != v) continue;
                for (const Ring::Spoke& spoke : around.all()) {
                    if (spoke.vertex != (idx(a) == v ? b : a) || spoke.triangles != 1) continue;
                    const Point across = cross(point(b) - point(a), n);
                    const double size = length(across);
                    if (size > 0) q.add(1 / size * across, point(a), border_weight * twice / 2);
                }
            }
        }
        return q;
    }

    Ring ring(size_t v) const {
        Ring around;
        for (const int32_t t : by_vertex_.with(v))
            for (const int32_t w : triangles_[idx(t)])
                if (idx(w) != v) around.add(w);
        return around;
    }

    static constexpr int32_t none = -1;
    struct Choice {
        double cost;
        int32_t into, shared;  // triangles at the edge
    };

    // Whether u may become v, as far as what is joined with what is concerned.
    bool keeps_topology(size_t u, const Ring& around, const Choice& choice, bool plain) const {
        const auto v = idx(choice.into);
        const size_t here = by_vertex_.with(u).size(), there = by_vertex_.with(v).size();
        const auto shared = idx(choice.shared);
        if (there > most_triangles || here + there - 2 * shared > most_triangles) return false;
        if (here == shared && there == shared) return false;  // nothing would be left
        if (!plain) return true;
        if (here == 3 && there == 3) return false;  // a tetrahedron
        size_t common = 0;
        const Ring other = ring(v);
        for (const Ring::Spoke& s : other.all())
            for (const Ring::Spoke& mine : around.all()) common += s.vertex == mine.vertex;
        return common == shared;
    }

    // Whether no triangle turns over, or loses its area.
    bool keeps_shape(size_t u, int32_t v) const {
        for (const int32_t t : by_vertex_.with(u)) {
            Triangle tri = triangles_[idx(t)];
            const Point before = normal(tri);
            bool goes = false;
            for (int32_t& w : tri) {
                goes = goes || w == v;
                if (idx(w) == u) w = v;
            }
            if (goes) continue;
            const Point after = normal(tri);
            const double both = length(before) * length(after);
            if (dot(before, after) < least_turned * both || !(length(after) > 0)) return false;
        }
        return true;
    }

    // The cheapest collapse of u that may be done.
    Choice choice(size_t u) const {
        const size_t triangles = by_vertex_.with(u).size();
        if (triangles == 0 || triangles > most_triangles) return {0, none, 0};
        const Ring around = ring(u);
        size_t open = 0, crowded = 0;
        for (const Ring::Spoke& spoke : around.all()) {
            open += spoke.triangles == 1;
            crowded += spoke.triangles > 2;
        }
        const bool plain = crowded == 0 && (open == 0 || open == 2);
        std::array<Choice, 2 * most_triangles> costs;
        size_t count = 0;
        for (const Ring::Spoke& spoke : around.all()) {
            if (plain && open > 0 && spoke.triangles != 1) continue;
            const Point& there = point(spoke.vertex);
            const Point way = there - vertices_[u];
            costs[count++] = {quadrics_[u].of(there) + own_[idx(spoke.vertex)] +
                                  evenness * quadrics_[u].weight * dot(way, way),
                              spoke.vertex, spoke.triangles};
        }
        const auto cheaper = [](const Choice& a, const Choice& b) {
            return a.cost != b.cost ? a.cost < b.cost : a.into < b.into;
        };
        for (auto left = std::span(costs).first(count); !left.empty(); left = left.subspan(1)) {
            std::swap(left[0], *std::min_element(left.begin(), left.end(), cheaper));
            if (keeps_topology(u, around, left[0], plain) && keeps_shape(u, left[0].into)) return left[0];
        }
        return {0, none, 0};
    }

    // The cheapest collapses, none beside another, that take away at most so many triangles.
    void pass(size_t excess, Progress& progress) {
        threads_.parallel_for(vertices_.size(), piece, [&](size_t first, size_t last) {
            progress.advance(0);
            for (size_t v = first; v < last; ++v)
                if (stale_[v]) choices_[v] = choice(v);
        });
        std::vector<std::pair<double, int32_t>> order;
        for (size_t v = 0; v < choices_.size(); ++v)
            if (choices_[v].into >= 0) order.emplace_back(choices_[v].cost, static_cast<int32_t>(v));
        const double cheap = std::ceil(looked_at * static_cast<double>(order.size()));
        const auto middle = order.begin() + static_cast<std::ptrdiff_t>(cheap);
        if (middle != order.end()) std::nth_element(order.begin(), middle, order.end());
        std::sort(order.begin(), middle);
        std::vector<char> changed(vertices_.size(), false);
        size_t removed = 0;
        for (auto next = order.begin(); next != middle && removed < excess; ++next) {
            const auto u = idx(next->second), v = idx(choices_[u].into);
            if (changed[u] || changed[v]) continue;
            for (const int32_t t : by_vertex_.with(u)) {
                bool goes = false;
                for (const int32_t w : triangles_[idx(t)]) {
                    changed[idx(w)] = true;
                    goes = goes || idx(w) == v;
                }
                removed += goes;
            }
            into_[u] = static_cast<int32_t>(v);
            quadrics_[v].add(quadrics_[u]);
            set(v, quadrics_[v]);
        }
        sort_out();
        // A choice depends on what is around the vertex and around those that it has edges to.
        stale_ = changed;
        for (const auto& [a, b, c] : triangles_)
            if (changed[idx(a)] || changed[idx(b)] || changed[idx(c)])
                stale_[idx(a)] = stale_[idx(b)] = stale_[idx(c)] = true;
    }

    std::span<const Point> vertices_;
    std::vector<Triangle> triangles_;
    ThreadPool& threads_;
    std::vector<int32_t> into_;
    std::vector<Quadric> quadrics_;
    std::vector<double> own_;  // what each vertex's own is of it
    std::vector<Choice> choices_;
    std::vector<char> stale_;     // whose choice is to be made anew
    CsrArray<int32_t> by_vertex_;  // triangles
};

// The square of the distance of a point from a triangle: Ericson, Real-Time Collision Detection (2005), 5.1.5.
double squared_distance(const Point& p, const Point& a, const Point& b, const Point& c) {
    const auto from = [&](const Point& q) {
        const Point way = p - q;
        return dot(way, way);
    };
    const auto share = [](double part, double whole) { return whole > 0 ? part / whole : 0; };  // 0: corners at one place
    const Point ab = b - a, ac = c - a, ap = p - a;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return from(a);
    const Point bp = p - b;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return from(b);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return from(a + share(d1, d1 - d3) * ab);
    const Point cp = p - c;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return from(c);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return from(a + share(d2, d2 - d6) * ac);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) return from(b + share(d4 - d3, (d4 - d3) + (d5 - d6)) * (c - b));
    const double sum = va + vb + vc;
    return from(a + share(vb, sum) * ab + share(vc, sum) * ac);
}

// Steps on the coarse surface from triangle to triangle, to where a point is on it.
class Walk {
public:
    explicit Walk(const Surface& surface)
        : surface_(surface), by_vertex_(surface.vertices.size(), [&](const auto& put) {
              for (size_t t = 0; t < surface.triangles.size(); ++t)
                  for (const int32_t v : surface.triangles[t]) put(idx(v), static_cast<int32_t>(t));
          }) {}

    // The nearest triangle, as far as steps to nearer ones lead to it: from those around a vertex, if any are looked at.
    Near from_vertex(const Point& p, int32_t v) const {
        Near near;
        look_around(p, v, near);
        return near.triangle < 0 ? near : onwards(p, near, v);
    }
    // The same from the nearest of some.
    int32_t from_triangles(const Point& p, const std::array<int32_t, 3>& triangles) const {
        Near near;
        for (const int32_t t : triangles) look_at(p, t, near);
        return onwards(p, near, -1).triangle;
    }

private:
    void look_at(const Point& p, int32_t t, Near& near) const {
        const Triangle& tri = surface_.triangles[idx(t)];
        const auto corner = [&](size_t k) -> const Point& { return surface_.vertices[idx(tri[k])]; };
        const double squared = squared_distance(p, corner(0), corner(1), corner(2));
        if (squared < near.squared || (squared == near.squared && t < near.triangle)) near = {t, squared};
    }
    void look_around(const Point& p, int32_t v, Near& near) const {
        const std::span<const int32_t> around = by_vertex_.with(idx(v));
        if (around.size() > most_triangles) return;
        for (const int32_t t : around) look_at(p, t, near);
    }
    // around: a vertex around which all were looked at before, or -1.
    Near onwards(const Point& p, Near near, int32_t around) const {
        for (Triangle seen = {around, around, around};;) {
            const int32_t from = near.triangle;
            const Triangle& here = surface_.triangles[idx(from)];
            for (const int32_t v : here)
                if (std::find(seen.begin(), seen.end(), v) == seen.end()) look_around(p, v, near);
            if (near.triangle == from) return near;
            seen = here;
        }
    }

    const Surface& surface_;
    CsrArray<int32_t> by_vertex_;
};

// The triangle of the coarse surface that each of the source's pieces goes with. coarse_vertex: of each of the source's.
// Returns the square of the largest distance of a vertex.
double find_pieces(const Surface& source, const Surface& coarse, std::span<const int32_t> coarse_vertex,
                   std::vector<Piece>& pieces, ThreadPool& threads, Progress& progress) {
    const Walk walk(coarse);
    std::vector<Near> places(source.vertices.size());
    threads.parallel_for(places.size(), piece, [&](size_t first, size_t last) {
        progress.advance(0);
        for (size_t v = first; v < last; ++v)
            if (coarse_vertex[v] >= 0) places[v] = walk.from_vertex(source.vertices[v], coarse_vertex[v]);
    });
    // Where no steps lead near, all triangles are asked.
    const double far = diagonal(source) * near_enough;
    std::optional<NearestTriangle> nearest;
    for (size_t v = 0, asked = 0; v < places.size(); ++v) {
        if (places[v].squared <= far * far) continue;
        if (asked++ % piece == 0) progress.advance(0);
        if (!nearest) nearest.emplace(coarse.vertices, coarse.triangles);
        places[v] = (*nearest)(source.vertices[v]);
    }
    double farthest = 0;
    for (const Near& near : places) farthest = std::max(farthest, near.squared);
    threads.parallel_for(pieces.size(), piece, [&](size_t first, size_t last) {
        progress.advance(0);
        for (size_t t = first; t < last; ++t) {
            const Triangle& tri = source.triangles[t];
            const auto of = [&](size_t k) { return places[idx(tri[k])].triangle; };
            if (of(0) == of(1) && of(1) == of(2)) {
                pieces[t].triangle = of(0);
                continue;
            }
            const auto corner = [&](size_t k) { return source.vertices[idx(tri[k])]; };
            pieces[t].triangle =
                walk.from_triangles(1.0 / 3 * (corner(0) + corner(1) + corner(2)), {of(0), of(1), of(2)});
        }
    });
    return farthest;
}

}  // namespace

Decimated decimate(Surface source, size_t target, size_t threads, Progress& progress) {
    ThreadPool all(threads, source.triangles.size() / piece);
    Collapses collapses(source, all);
    collapses.collapse(target, progress);
    if (collapses.triangles().size() > too_many * target) {
        collapses.unite_cells(target);
        collapses.collapse(target, progress);
    }
    if (collapses.triangles().empty())
        throw Error(PW_ERROR_NOT_SOLID, "The mesh has no area at all: only edges and points.");

    Decimated coarse;
    std::vector<int32_t> number(source.vertices.size(), -1), source_vertex, used;
    for (const Triangle& t : collapses.triangles())
        for (const int32_t v : t) number[idx(v)] = 0;
    std::vector<Point> points;
    for (size_t v = 0; v < number.size(); ++v)
        if (number[v] == 0) {
            number[v] = static_cast<int32_t>(points.size());
            points.push_back(source.vertices[v]);
            source_vertex.push_back(source.source_vertex[v]);
            used.push_back(static_cast<int32_t>(v));
        }
    std::vector<Triangle> triangles(collapses.triangles().begin(), collapses.triangles().end());
    for (Triangle& t : triangles)
        for (int32_t& v : t) v = number[idx(v)];
    std::vector<int32_t> own(points.size());
    std::iota(own.begin(), own.end(), 0);
    coarse.surface = canonical(source.frame, points, own, triangles);
    std::vector<int32_t> place(points.size());
    for (size_t v = 0; v < place.size(); ++v) {
        int32_t& from = coarse.surface.source_vertex[v];
        place[idx(from)] = static_cast<int32_t>(v);
        from = source_vertex[idx(from)];
    }
    for (size_t t = 0; t < coarse.surface.pieces.size(); ++t) coarse.surface.pieces[t].face = static_cast<int32_t>(t);
    std::vector<int32_t> coarse_vertex(source.vertices.size());
    for (size_t v = 0; v < coarse_vertex.size(); ++v) {
        const int32_t kept = number[idx(collapses.into()[v])];
        coarse_vertex[v] = kept < 0 ? -1 : place[idx(kept)];
    }
    coarse.pieces = std::move(source.pieces);
    const double squared = find_pieces(source, coarse.surface, coarse_vertex, coarse.pieces, all, progress);
    coarse.face_count = source.face_count;
    coarse.diagonal = diagonal(source);
    coarse.deviation = std::sqrt(squared) / coarse.diagonal;
    return coarse;
}

void restore_source_faces(Decimated&& coarse, Surface& surface) {
    // Of each of the copy's triangles the one that is behind most of it.
    std::vector<Piece> most(coarse.surface.triangles.size(), Piece{0, 0, -1});
    for (const Piece& p : surface.pieces)
        if (p.area > most[idx(p.face)].area) most[idx(p.face)] = p;
    const auto original = [&](int32_t t) { return surface.original.empty() ? t : surface.original[idx(t)]; };
    for (Piece& p : coarse.pieces) p.triangle = most[idx(original(p.triangle))].triangle;
    surface.original.clear();
    surface.pieces = std::move(coarse.pieces);
    surface.face_count = coarse.face_count;
    surface.deviation = coarse.deviation + surface.deviation * diagonal(coarse.surface) / coarse.diagonal;
    surface.proxy_triangles = coarse.surface.triangles.size();
    surface.account = "Parts found on a copy with " + with_commas(coarse.surface.triangles.size()) + " of " +
                      with_commas(surface.pieces.size()) + " triangles, at most " + percent(coarse.deviation) +
                      " of the model's size away." + (surface.account.empty() ? "" : " " + surface.account);
}

}  // namespace partwheel
