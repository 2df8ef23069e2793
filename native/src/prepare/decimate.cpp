// Decimation: passes of independent edge collapses, then the assignment of source triangles to the coarse surface.
#include "prepare/decimate.h"

#include "base/morton.h"
#include "base/adjacency.h"
#include "base/parallel.h"
#include "mesh/face_assignment.h"
#include "mesh/nearest.h"

namespace partwheel {

namespace {

// Vertices with more triangles are not collapsed: comparing the rings of both ends takes quadratic time.
constexpr size_t max_valence = 96;

// Weight of the squared length of a collapsed edge, relative to the squared distance from the surface.
constexpr double edge_length_weight = 1e-3;

// Weight of the planes that hold an open border in place, relative to the planes of its triangles.
constexpr double border_weight = 4;

// Least cosine of the angle by which a collapse may turn a triangle's normal.
constexpr double min_normal_cosine = 0.25;

// A pass considers this share of all possible collapses, the cheapest ones. A pass that removes a smaller share of the
// triangles than min_pass_reduction is the last.
constexpr double considered_share = 0.5, min_pass_reduction = 0.01;

// Vertices are clustered if collapses leave more than this times the target.
constexpr size_t max_excess_factor = 4;

constexpr size_t chunk_size = 1024;  // of a parallel loop

constexpr size_t queries_between_polls = 256;

// The weighted sum of squared distances of a point from planes.
struct Quadric {
    std::array<double, 6> square{};  // xx, yy, zz, xy, xz, yz
    Point linear{};
    double constant = 0, weight = 0;

    // Adds the plane through a point.
    void add(const Point& normal, const Point& through, double plane_weight) {
        const auto& [x, y, z] = normal;
        const double d = -dot(normal, through);
        const std::array<double, 6> products = {x * x, y * y, z * z, x * y, x * z, y * z};
        for (size_t k = 0; k < 6; ++k) square[k] += plane_weight * products[k];
        for (size_t k = 0; k < 3; ++k) linear[k] += plane_weight * d * normal[k];
        constant += plane_weight * d * d;
    }
    void add(const Quadric& other) {
        for (size_t k = 0; k < 6; ++k) square[k] += other.square[k];
        linear = linear + other.linear;
        constant += other.constant;
        weight += other.weight;
    }
    double at(const Point& p) const {
        const auto& [x, y, z] = p;
        const auto& [xx, yy, zz, xy, xz, yz] = square;
        return xx * x * x + yy * y * y + zz * z * z + 2 * (xy * x * y + xz * x * z + yz * y * z) +
               2 * dot(linear, p) + constant;
    }
};

// The neighbors of a vertex, each with the number of triangles at the edge to it.
struct Ring {
    struct Spoke {
        int32_t vertex, triangles;
    };
    std::array<Spoke, 2 * max_valence> spokes;
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

class Decimation {
public:
    Decimation(const Surface& source, ThreadPool& threads)
        : vertices_(source.vertices), triangles_(source.triangles), threads_(threads), into_(iota(vertices_.size())),
          quadrics_(vertices_.size()), own_error_(vertices_.size()), best_(vertices_.size()),
          is_stale_(vertices_.size(), true) {
        weld_borders();
        apply_collapses();
        threads_.parallel_for(vertices_.size(), chunk_size, [&](size_t first, size_t last) {
            for (size_t v = first; v < last; ++v) set_quadric(v, initial_quadric(v));
        });
    }

    std::span<const Triangle> triangles() const { return triangles_; }

    // Runs passes until at most `target` triangles are left, or until a pass removes hardly any.
    void collapse(size_t target, Progress& progress) {
        const auto from = static_cast<double>(triangles_.size() - std::min(target, triangles_.size()));
        while (triangles_.size() > target) {
            const size_t before = triangles_.size();
            progress.advance(0.2 + 0.5 * (1 - static_cast<double>(before - target) / from));
            run_pass(before - target, progress);
            if (static_cast<double>(before - triangles_.size()) < min_pass_reduction * static_cast<double>(before)) break;
        }
    }

    // Merges the vertices in each cell of a grid into the one with the least error, in the coarsest grid that leaves at
    // least `target` triangles. Vertices are sorted along Morton's curve, so a cell is a slice of them.
    void cluster_vertices(size_t target) {
        const std::vector<uint64_t> places = morton_codes(vertices_);
        const auto remaining = [&](int level) {
            size_t count = 0;
            const auto cell = [&](int32_t v) { return places[idx(v)] >> 3 * (morton_bits - level); };
            for (const auto& [a, b, c] : triangles_)
                if (cell(a) != cell(b) && cell(b) != cell(c) && cell(c) != cell(a)) ++count;
            return count;
        };
        int level = 1;
        while (level < morton_bits && remaining(level) < target) ++level;
        const auto cell = [&](size_t v) { return places[v] >> 3 * (morton_bits - level); };
        for (size_t first = 0, last = 0; first < vertices_.size(); first = last) {
            Quadric sum;
            while (last < vertices_.size() && cell(last) == cell(first)) {
                if (idx(into_[last]) == last) sum.add(quadrics_[last]);
                ++last;
            }
            size_t best = last;
            double least = HUGE_VAL;
            for (size_t v = first; v < last; ++v)
                if (idx(into_[v]) == v && !by_vertex_.row(v).empty() && sum.at(vertices_[v]) < least) {
                    best = v;
                    least = sum.at(vertices_[v]);
                }
            if (best == last) continue;
            for (size_t v = first; v < last; ++v)
                if (idx(into_[v]) == v) into_[v] = static_cast<int32_t>(best);
            set_quadric(best, sum);
        }
        apply_collapses();
        std::fill(is_stale_.begin(), is_stale_.end(), true);
    }

private:
    const Point& point(int32_t v) const { return vertices_[idx(v)]; }
    Point normal(const Triangle& t) const { return cross(point(t[1]) - point(t[0]), point(t[2]) - point(t[0])); }

    void set_quadric(size_t v, const Quadric& quadric) {
        quadrics_[v] = quadric;
        own_error_[v] = quadric.at(vertices_[v]);
    }

    // Welds vertices of open edges at the same position: invisible seams.
    void weld_borders() {
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

    // Applies the collapses: renumbers corners, removes degenerate triangles, rebuilds by_vertex_.
    void apply_collapses() {
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

    Quadric initial_quadric(size_t v) const {
        Quadric q;
        if (by_vertex_.row(v).size() > max_valence) return q;
        const Ring around = ring(v);
        for (const int32_t t : by_vertex_.row(v)) {
            const Triangle& tri = triangles_[idx(t)];
            const Point n = normal(tri);
            const double double_area = length(n);
            if (!(double_area > 0)) continue;
            q.add(1 / double_area * n, point(tri[0]), double_area / 2);
            q.weight += double_area / 2;
            for (size_t k = 0; k < 3; ++k) {
                const int32_t a = tri[k], b = tri[(k + 1) % 3];
                if (idx(a) != v && idx(b) != v) continue;
                for (const Ring::Spoke& spoke : around.all()) {
                    if (spoke.vertex != (idx(a) == v ? b : a) || spoke.triangles != 1) continue;
                    const Point across = cross(point(b) - point(a), n);
                    const double size = length(across);
                    if (size > 0) q.add(1 / size * across, point(a), border_weight * double_area / 2);
                }
            }
        }
        return q;
    }

    Ring ring(size_t v) const {
        Ring around;
        for (const int32_t t : by_vertex_.row(v))
            for (const int32_t w : triangles_[idx(t)])
                if (idx(w) != v) around.add(w);
        return around;
    }

    static constexpr int32_t none = -1;
    struct Collapse {
        double cost;
        int32_t into, shared;  // shared: the number of triangles at the edge
    };

    // Whether collapsing u keeps the topology. is_manifold: so is the surface at u.
    bool keeps_topology(size_t u, const Ring& ring_of_u, const Collapse& collapse, bool is_manifold) const {
        const auto v = idx(collapse.into);
        const size_t at_u = by_vertex_.row(u).size(), at_v = by_vertex_.row(v).size();
        const auto shared = idx(collapse.shared);
        if (at_v > max_valence || at_u + at_v - 2 * shared > max_valence) return false;
        if (at_u == shared && at_v == shared) return false;  // nothing would be left
        if (!is_manifold) return true;
        if (at_u == 3 && at_v == 3) return false;  // a tetrahedron
        size_t common = 0;
        const Ring ring_of_v = ring(v);
        for (const Ring::Spoke& s : ring_of_v.all())
            for (const Ring::Spoke& t : ring_of_u.all()) common += s.vertex == t.vertex;
        return common == shared;
    }

    // Whether no triangle turns over or loses its area when u is collapsed into v.
    bool keeps_shape(size_t u, int32_t v) const {
        for (const int32_t t : by_vertex_.row(u)) {
            Triangle tri = triangles_[idx(t)];
            const Point before = normal(tri);
            bool is_removed = false;
            for (int32_t& w : tri) {
                is_removed = is_removed || w == v;
                if (idx(w) == u) w = v;
            }
            if (is_removed) continue;
            const Point after = normal(tri);
            const double lengths = length(before) * length(after);
            if (dot(before, after) < min_normal_cosine * lengths || !(length(after) > 0)) return false;
        }
        return true;
    }

    // The cheapest allowed collapse of u; into: none if there is none.
    Collapse find_best_collapse(size_t u) const {
        const size_t triangles = by_vertex_.row(u).size();
        if (triangles == 0 || triangles > max_valence) return {0, none, 0};
        const Ring around = ring(u);
        size_t open = 0, non_manifold = 0;
        for (const Ring::Spoke& spoke : around.all()) {
            open += spoke.triangles == 1;
            non_manifold += spoke.triangles > 2;
        }
        const bool is_manifold = non_manifold == 0 && (open == 0 || open == 2);
        std::array<Collapse, 2 * max_valence> candidates;
        size_t count = 0;
        for (const Ring::Spoke& spoke : around.all()) {
            if (is_manifold && open > 0 && spoke.triangles != 1) continue;
            const Point& target = point(spoke.vertex);
            const Point edge = target - vertices_[u];
            candidates[count++] = {quadrics_[u].at(target) + own_error_[idx(spoke.vertex)] +
                                       edge_length_weight * quadrics_[u].weight * dot(edge, edge),
                                   spoke.vertex, spoke.triangles};
        }
        const auto is_cheaper = [](const Collapse& a, const Collapse& b) {
            return a.cost != b.cost ? a.cost < b.cost : a.into < b.into;
        };
        for (auto rest = std::span(candidates).first(count); !rest.empty(); rest = rest.subspan(1)) {
            std::swap(rest[0], *std::min_element(rest.begin(), rest.end(), is_cheaper));
            if (keeps_topology(u, around, rest[0], is_manifold) && keeps_shape(u, rest[0].into)) return rest[0];
        }
        return {0, none, 0};
    }

    // Performs the cheapest collapses, no two next to each other, until they have removed `excess` triangles.
    void run_pass(size_t excess, Progress& progress) {
        threads_.parallel_for(vertices_.size(), chunk_size, [&](size_t first, size_t last) {
            progress.advance(0);
            for (size_t v = first; v < last; ++v)
                if (is_stale_[v]) best_[v] = find_best_collapse(v);
        });
        std::vector<std::pair<double, int32_t>> order;
        for (size_t v = 0; v < best_.size(); ++v)
            if (best_[v].into >= 0) order.emplace_back(best_[v].cost, static_cast<int32_t>(v));
        const double considered = std::ceil(considered_share * static_cast<double>(order.size()));
        const auto middle = order.begin() + static_cast<std::ptrdiff_t>(considered);
        if (middle != order.end()) std::nth_element(order.begin(), middle, order.end());
        std::sort(order.begin(), middle);
        std::vector<char> changed(vertices_.size(), false);
        size_t removed = 0;
        for (auto next = order.begin(); next != middle && removed < excess; ++next) {
            const auto u = idx(next->second), v = idx(best_[u].into);
            if (changed[u] || changed[v]) continue;
            for (const int32_t t : by_vertex_.row(u)) {
                bool is_removed = false;
                for (const int32_t w : triangles_[idx(t)]) {
                    changed[idx(w)] = true;
                    is_removed = is_removed || idx(w) == v;
                }
                removed += is_removed;
            }
            into_[u] = static_cast<int32_t>(v);
            quadrics_[v].add(quadrics_[u]);
            set_quadric(v, quadrics_[v]);
        }
        apply_collapses();
        // The best collapse of a vertex depends on its ring and on those of its neighbors.
        is_stale_ = changed;
        for (const auto& [a, b, c] : triangles_)
            if (changed[idx(a)] || changed[idx(b)] || changed[idx(c)])
                is_stale_[idx(a)] = is_stale_[idx(b)] = is_stale_[idx(c)] = true;
    }

    std::span<const Point> vertices_;
    std::vector<Triangle> triangles_;
    ThreadPool& threads_;
    std::vector<int32_t> into_;
    std::vector<Quadric> quadrics_;
    std::vector<double> own_error_;  // of each vertex: its quadric at itself
    std::vector<Collapse> best_;     // of each vertex
    std::vector<char> is_stale_;     // whether best_ must be computed again
    CsrArray<int32_t> by_vertex_;    // triangles
};

// The surface of triangles between vertices of the source.
Surface subsurface(const Surface& source, std::span<const Triangle> subset) {
    std::vector<int32_t> used = in_order_of_use(source.vertices.size(), subset);
    std::ranges::sort(used);
    Surface surface = canonical(source.frame, source.vertices, source.source_vertex, {subset.begin(), subset.end()}, used);
    for (size_t t = 0; t < surface.samples.size(); ++t) surface.samples[t].face = static_cast<int32_t>(t);
    return surface;
}

// Sets the triangle of each of the source's samples to the nearest of the coarse surface. Returns the largest distance
// of a source vertex.
double assign_triangles(const Surface& source, const Surface& coarse, std::vector<FaceSample>& samples,
                        Progress& progress) {
    NearestTriangle nearest(coarse.vertices, coarse.triangles);
    const size_t count = source.vertices.size() + samples.size();
    size_t queries = 0;
    const auto find = [&](const Point& p) {
        if (queries++ % queries_between_polls == 0)
            progress.advance(0.7 + 0.3 * static_cast<double>(queries) / static_cast<double>(count));
        return nearest(p);
    };
    double farthest = 0;
    std::vector<int32_t> places;  // the triangle that is nearest to each source vertex
    for (const Point& p : source.vertices) {
        const Near near = find(p);
        places.push_back(near.triangle);
        farthest = std::max(farthest, near.squared);
    }
    for (size_t t = 0; t < samples.size(); ++t) {
        const auto& [a, b, c] = source.triangles[t];
        const bool same = places[idx(a)] == places[idx(b)] && places[idx(b)] == places[idx(c)];
        const auto corner = [&](int32_t v) { return source.vertices[idx(v)]; };
        samples[t].triangle = same ? places[idx(a)] : find(1.0 / 3 * (corner(a) + corner(b) + corner(c))).triangle;
    }
    return std::sqrt(farthest);
}

}  // namespace

Decimated decimate(Surface source, size_t target, size_t threads, Progress& progress) {
    ThreadPool pool(threads, source.triangles.size() / chunk_size);
    Decimation decimation(source, pool);
    decimation.collapse(target, progress);
    if (decimation.triangles().size() > max_excess_factor * target) {
        decimation.cluster_vertices(target);
        decimation.collapse(target, progress);
    }
    if (decimation.triangles().empty())
        throw Error(PW_ERROR_NOT_SOLID, "The faces of the mesh have no area. Choose another mesh.");

    Decimated coarse;
    coarse.surface = subsurface(source, decimation.triangles());
    coarse.samples = std::move(source.samples);
    coarse.face_count = source.face_count;
    coarse.diagonal = diagonal(source);
    coarse.deviation = assign_triangles(source, coarse.surface, coarse.samples, progress) / coarse.diagonal;
    return coarse;
}

void restore_source_faces(Decimated&& coarse, Surface& surface) {
    // For each triangle of the coarse surface, the triangle of `surface` with the largest part of its area.
    std::vector<FaceSample> largest(coarse.surface.triangles.size(), FaceSample{0, 0, -1});
    for (const FaceSample& p : surface.samples)
        if (p.area > largest[idx(p.face)].area) largest[idx(p.face)] = p;
    const auto original = [&](int32_t t) { return surface.original.empty() ? t : surface.original[idx(t)]; };
    for (FaceSample& p : coarse.samples) p.triangle = largest[idx(original(p.triangle))].triangle;
    surface.original.clear();
    surface.samples = std::move(coarse.samples);
    surface.face_count = coarse.face_count;
    surface.deviation = coarse.deviation + surface.deviation * diagonal(coarse.surface) / coarse.diagonal;
    surface.proxy_triangles = coarse.surface.triangles.size();
    surface.notes = "Parts found on a copy with " + with_commas(coarse.surface.triangles.size()) + " of " +
                      with_commas(surface.samples.size()) + " triangles, at most " + percent(coarse.deviation) +
                      " of the model's size away." + (surface.notes.empty() ? "" : " " + surface.notes);
}

}  // namespace partwheel
