// Surface edges, and the features of parts and their borders.
#include "parts/merge/parts.h"

#include "base/adjacency.h"
#include "parts/boundary.h"

namespace partwheel {

namespace {

constexpr double concave_bend = 0.02;
constexpr double sharp_bend = 0.2;
constexpr double half_curvature = 4;  // the mean curvature, on a model of unit area, that is mapped to 1/2
constexpr int smoothing_passes = 4, wide_passes = 24;

// The boundary of a mesh, measured relative to its longest extent.
class Boundary {
public:
    explicit Boundary(const TetMesh& mesh)
        : mesh_(mesh), facets_(mesh), length_unit_(Frame::around(mesh.vertices).longest),
          curvature_(mesh.vertices.size(), 0), vertex_area_(mesh.vertices.size(), 0) {
        measure_facets();
        collect_edges();
    }

    std::vector<SurfaceEdge> edges(const Regions* regions) {
        const std::vector<double> narrow = smooth(smoothing_passes), wide = smooth(wide_passes - smoothing_passes);
        std::vector<SurfaceEdge> result;
        for (const Edge& e : edges_) {
            const auto to_unit_range = [&](const std::vector<double>& curvatures) {
                const double h = (curvatures[idx(e.low)] + curvatures[idx(e.high)]) / 2;
                return h / (half_curvature + std::abs(h));
            };
            const auto length_if = [&](bool condition) { return condition ? e.length : 0; };
            result.push_back({e.left, e.right,
                              {.length = e.length,
                               .crease = e.length * e.bend,
                               .sharpness = e.length * std::abs(e.bend),
                               .concave = length_if(e.bend < -concave_bend),
                               .ridge = length_if(e.bend > sharp_bend),
                               .valley = length_if(e.bend < -sharp_bend),
                               .curvature = e.length * to_unit_range(narrow),
                               .wide_curvature = e.length * to_unit_range(wide),
                               .marked = regions ? e.length * double{regions->strength(e.left, e.right)} : 0}});
        }
        return result;
    }

private:
    struct Edge {
        int32_t low, high;
        int32_t left, right;  // the tetrahedra of its facets
        double length, bend;  // see merge_policy.h
    };

    const Point& point(int32_t v) const { return mesh_.vertices[idx(v)]; }

    void measure_facets() {
        const double area_unit = length_unit_ * length_unit_;
        for (const Triangle& f : facets_.triangles) {
            const auto [a, b, c] = corner_points(mesh_.vertices, f);
            Point n = cross(b - a, c - a);
            const double twice = length(n), size = twice / 2 / area_unit;
            if (twice > 0)
                for (double& x : n) x /= twice;
            normals_.push_back(n);
            total_area_ += size;
            for (const int32_t v : f) vertex_area_[idx(v)] += size / 3;
        }
    }

    void collect_edges() {
        for_each_edge(mesh_.vertices.size(), facets_.triangles, [&](int32_t low, std::span<const Side> sides) {
            for (size_t i = 0; i + 1 < sides.size(); i += 2) {
                const int32_t high = sides[i].high, s = sides[i].number / 3, t = sides[i + 1].number / 3;
                const Point &m = normals_[idx(s)], &n = normals_[idx(t)];
                const Point along = point(high) - point(low);
                const double turn = dot(cross(m, n), along) * (sides[i].is_ascending ? 1 : -1);
                const double bend = length(n - m) / 2 * (turn < 0 ? -1 : 1);
                edges_.push_back({low, high, facets_.tetrahedra[idx(s)], facets_.tetrahedra[idx(t)],
                                  length(along) / length_unit_, bend});
            }
        });
        for (const Edge& e : edges_)
            for (const int32_t v : {e.low, e.high}) curvature_[idx(v)] += e.length * e.bend / 2;
    }

    // Mean curvature of each vertex, smoothed further over the surface: finds creases that are spread over many small
    // edges. Only the quotient of the two sums matters, so both may grow with each pass.
    std::vector<double> smooth(int extra_passes) {
        for (int pass = 0; pass < extra_passes; ++pass) {
            std::vector<double> c = curvature_, r = vertex_area_;
            for (const Edge& e : edges_) {
                const auto i = idx(e.low), j = idx(e.high);
                c[i] += curvature_[j];
                c[j] += curvature_[i];
                r[i] += vertex_area_[j];
                r[j] += vertex_area_[i];
            }
            curvature_.swap(c);
            vertex_area_.swap(r);
        }
        const double unit = std::sqrt(total_area_);
        std::vector<double> h(curvature_.size(), 0);
        for (size_t i = 0; i < h.size(); ++i)
            if (vertex_area_[i] > 0) h[i] = curvature_[i] / vertex_area_[i] * unit;
        return h;
    }

    const TetMesh& mesh_;
    const BoundaryFacets facets_;
    double length_unit_, total_area_ = 0;
    std::vector<double> curvature_, vertex_area_;  // of each vertex
    std::vector<Point> normals_;
    std::vector<Edge> edges_;
};

// Where two parts touch: a facet between them, or an edge of the surface.
struct Contact {
    int32_t a, b;  // parts
    bool is_pair;
    Border border;
};

// Adds volumes and areas to the parts, and the facets between them to the contacts. Returns the vertices of each part.
std::vector<std::vector<int32_t>> measure_tetrahedra(const TetMesh& mesh, std::span<const int32_t> label,
                                                     const Regions* regions, Parts& parts, std::vector<Contact>& contacts) {
    const double length_unit = Frame::around(mesh.vertices).longest, area_unit = length_unit * length_unit;
    std::vector<std::vector<int32_t>> corners(parts.nodes.size());
    std::vector<int32_t> last_part(mesh.vertices.size(), -1);  // the last part that each vertex was added to
    for (size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        const Tetrahedron& tet = mesh.tetrahedra[t];
        const int32_t p = label[t];
        std::vector<int32_t>& part_corners = corners[idx(p)];
        if (part_corners.empty()) {
            parts[p].lowest_tet = static_cast<int32_t>(t);
            if (regions) parts[p].group = regions->group(parts[p].lowest_tet);
        }
        for (const int32_t v : tet)
            if (std::exchange(last_part[idx(v)], p) != p) part_corners.push_back(v);
        parts[p].volume += signed_volume6(mesh.vertices, tet) / 6 / parts.volume_unit;
        for (size_t k = 0; k < 4; ++k) {
            const int32_t neighbor = mesh.neighbors[t][k];
            const int32_t q = neighbor < 0 ? -1 : label[idx(neighbor)];
            if (neighbor >= 0 && q <= p) continue;
            const double size = area(mesh.vertices, facet(tet, k)) / area_unit;
            if (neighbor < 0) {
                parts[p].area += size;
                continue;
            }
            const float strength = regions ? regions->strength(static_cast<int32_t>(t), neighbor) : 0;
            contacts.push_back({p, q, true, {.interface = size, .marked_interface = size * double{strength}}});
        }
    }
    return corners;
}

// The pairs of parts that share a facet, or an edge that no hard mark divides.
void add_pairs(std::vector<Contact> contacts, Parts& parts) {
    std::stable_sort(contacts.begin(), contacts.end(), [](const Contact& x, const Contact& y) {
        return std::pair(x.a, x.b) < std::pair(y.a, y.b);
    });
    for (size_t i = 0; i < contacts.size();) {
        Pair pair{contacts[i].a, contacts[i].b, {}};
        bool is_pair = false;
        for (; i < contacts.size() && contacts[i].a == pair.a && contacts[i].b == pair.b; ++i) {
            pair.border += contacts[i].border;
            is_pair |= contacts[i].is_pair;
        }
        if (!is_pair) continue;  // an edge only
        for (const int32_t p : {pair.a, pair.b}) {
            parts[p].border += pair.border;
            parts[p].pairs.push_back(static_cast<int32_t>(parts.pairs.size()));
        }
        parts.pairs.push_back(pair);
    }
}

}  // namespace

std::vector<SurfaceEdge> compute_surface_edges(const TetMesh& mesh, const Regions* regions) {
    return Boundary(mesh).edges(regions);
}

Parts build_parts(const TetMesh& mesh, std::span<const SurfaceEdge> edges, std::span<const int32_t> label, size_t count,
                  double hull_volume, std::vector<Hull> hulls, const Regions* regions, HullKernel& kernel,
                  Progress& progress) {
    const double length_unit = Frame::around(mesh.vertices).longest;
    Parts parts;
    parts.nodes.resize(count);
    parts.initial_count = count;
    parts.volume_unit = length_unit * length_unit * length_unit;
    std::vector<Contact> contacts;
    const std::vector<std::vector<int32_t>> corners = measure_tetrahedra(mesh, label, regions, parts, contacts);
    progress.advance(0.1);
    for (size_t p = 0; p < count; ++p) {
        Part& part = parts.nodes[p];
        part.volume = std::max(0.0, part.volume);
        part.hull = hulls.empty() ? kernel.build(corners[p]) : std::move(hulls[p]);
        part.hull_volume = part.hull.volume() / parts.volume_unit;
        part.update_logs();
        parts.model.volume += part.volume;
        parts.model.area += part.area;
        if (p % 16 == 0) progress.advance(0.1);
    }
    parts.model.update_logs();
    parts.model.hull_volume = hull_volume / parts.volume_unit;

    for (const auto& [tet_a, tet_b, border] : edges) {
        const auto [p, q] = std::minmax(label[idx(tet_a)], label[idx(tet_b)]);
        // What no hard mark divides may merge although it touches in an edge only.
        const bool is_pair = regions && regions->group(tet_a) == regions->group(tet_b);
        if (p != q) contacts.push_back({p, q, is_pair, border});
    }
    add_pairs(std::move(contacts), parts);
    return parts;
}

}  // namespace partwheel
