// Tetrahedra from points: the tetrahedralization, which tetrahedra are inside, and the boundary of these.
#include "fill/points.h"

#include "base/adjacency.h"
#include "base/corners.h"
#include "base/error.h"
#include "base/parallel.h"
#include "fill/sheet.h"
#include "fill/winding_surface.h"
#include "fill/winding.h"
#include "mesh/face_assignment.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <queue>

namespace partwheel {

namespace {

// The number of points is that of the source's vertices, but at most this, if vertices are spread evenly; regions where
// they are denser get more. Three times as many points don't give better parts.
constexpr size_t max_points = 15000;

// Least distance of points, relative to the diagonal. Meshes of less area are nearly lines, and the Delaunay
// tetrahedralization of points on lines has a quadratic number of tetrahedra.
constexpr double least_spacing = 1.0 / 1000;

// If sheets have more than min_sheet_share of the area, the mesh may be a soup of triangles or patches that wind around
// something together, without repair. That is so if they enclose a volume of more than min_soup_volume times their area
// to the power of 3/2, and the mean of 1 - winding number inside is at most max_uncertainty.
constexpr double min_sheet_share = 0.1, min_soup_volume = 0.003, max_uncertainty = 0.33;

// The winding number classifies a tetrahedron if its volume is more than this times the sum of its facets' areas to the
// power of 3/2; this quotient is 0.10 for a regular one. Flatter ones mostly lie along the surface, on neither side of
// it, and get the label of a neighbor.
constexpr double flat = 0.04;

// Cost of a facet between inside and outside, times its area to the power of 3/2, relative to a volume on the wrong
// side.
constexpr double smoothness = 0.05;
constexpr int smoothing_passes = 6;

// A component that is connected to a larger one only by an edge or a corner is dropped if its volume is less than this
// share.
constexpr double max_loose_share = 0.05;

constexpr size_t points_between_polls = 512, tets_per_chunk = 1024, tets_between_polls = 65536;

// Limits of the mean number of nodes that a winding number visits, for soups and for repaired meshes. Real surfaces
// take up to 3,000. Triangles that all pass through each other take all nodes, and the time for all tetrahedra would be
// quadratic. tetrahedra_sampled: the mean is estimated from about as many.
constexpr size_t max_visits_of_soup = 4096, max_visits = 65536, tetrahedra_sampled = 64;

size_t mean_visits(const TetMesh& mesh, const WindingNumber& winding) {
    const size_t count = mesh.tetrahedra.size(), stride = count / tetrahedra_sampled + 1;
    size_t sum = 0, asked = 0;
    for (size_t t = 0; t < count; t += stride, ++asked) {
        sum += winding.visits(centroid(mesh.vertices, mesh.tetrahedra[t]));
    }
    return sum / std::max<size_t>(asked, 1);
}

// The Delaunay tetrahedralization of distinct points, in canonical order.
TetMesh delaunay_tetrahedra(const std::vector<Point>& points, Progress& progress) {
    using Cells = CGAL::Triangulation_data_structure_3<CGAL::Triangulation_vertex_base_with_info_3<int32_t, CgalKernel>,
                                                       CGAL::Triangulation_cell_base_with_info_3<int32_t, CgalKernel>>;
    using Delaunay = CGAL::Delaunay_triangulation_3<CgalKernel, Cells>;
    std::vector<std::pair<CgalKernel::Point_3, int32_t>> order;
    for (const Point& p : points) order.emplace_back(CgalKernel::Point_3(p[0], p[1], p[2]), checked_index(order.size()));
    using Places = CGAL::First_of_pair_property_map<std::pair<CgalKernel::Point_3, int32_t>>;
    CGAL::spatial_sort(order.begin(), order.end(), CGAL::Spatial_sort_traits_adapter_3<CgalKernel, Places>());
    Delaunay delaunay;
    Delaunay::Vertex_handle near;
    for (size_t i = 0; i < order.size(); ++i) {
        if (i % points_between_polls == 0) progress.advance(0.4 * static_cast<double>(i) / static_cast<double>(order.size()));
        const bool has_hint = near != Delaunay::Vertex_handle();
        near = delaunay.insert(order[i].first, has_hint ? near->cell() : Delaunay::Cell_handle());
        near->info() = order[i].second;
    }
    std::vector<std::array<Corner, 4>> corners;
    if (delaunay.dimension() == 3) {
        check_tetrahedron_count(delaunay.number_of_finite_cells());
        int32_t count = 0;
        for (const auto cell : delaunay.all_cell_handles()) cell->info() = delaunay.is_infinite(cell) ? -1 : count++;
        for (const auto cell : delaunay.finite_cell_handles()) {
            std::array<Corner, 4>& c = corners.emplace_back();
            for (int k = 0; k < 4; ++k)
                c[static_cast<size_t>(k)] = {cell->vertex(k)->info(), cell->neighbor(k)->info()};
        }
    }
    return canonical(points, std::move(corners), progress);
}

// Tetrahedra, and which of them are inside.
class InsideLabels {
public:
    InsideLabels(TetMesh&& mesh, const WindingNumber& winding, size_t threads, Progress& progress)
        : mesh_(std::move(mesh)), side_(mesh_.tetrahedra.size(), unknown), volume_(side_.size()),
          winding_number_(side_.size(), 0.5), weights_(side_.size()) {
        classify(winding, threads, progress);
        propagate(progress);
        for (int pass = 0; pass < smoothing_passes && smooth(); ++pass) progress.advance(0.7);
        drop_loose();
        progress.advance(0.7);
    }

    const TetMesh& mesh() const { return mesh_; }

    bool is_inside(int32_t tet) const { return tet >= 0 && side_[idx(tet)] == in; }

    double volume() const {
        double sum = 0;
        for (size_t t = 0; t < side_.size(); ++t) sum += side_[t] == in ? volume_[t] : 0;
        return sum;
    }

    // The mean of 1 - winding number over the inside, at least 0.
    double uncertainty() const {
        double sum = 0;
        for (size_t t = 0; t < side_.size(); ++t)
            if (side_[t] == in) sum += volume_[t] * std::max(0.0, 1 - winding_number_[t]);
        return sum / volume();
    }

private:
    enum Side : uint8_t { out, in, unknown };

    double weight(size_t tet, size_t facet) const { return weights_[tet][facet]; }

    void classify(const WindingNumber& winding, size_t threads, Progress& progress) {
        ThreadPool pool(threads, side_.size() / tets_per_chunk + 1);
        const auto chunk = [&](size_t first, size_t last) {
            for (size_t t = first; t < last; ++t) {
                const auto point = [&](int32_t v) -> const Point& { return mesh_.vertices[idx(v)]; };
                const Tetrahedron& tet = mesh_.tetrahedra[t];
                const Point &a = point(tet[0]), &b = point(tet[1]), &c = point(tet[2]), &d = point(tet[3]);
                volume_[t] = std::max(0.0, signed_volume6(a, b, c, d) / 6);
                double sum = 0;
                for (size_t k = 0; k < 4; ++k) {
                    const Triangle f = facet(tet, k);
                    const double size = area(point(f[0]), point(f[1]), point(f[2]));
                    sum += weights_[t][k] = size * std::sqrt(size);
                }
                if (volume_[t] <= flat * sum) continue;
                winding_number_[t] = winding.at(0.25 * (a + b + c + d));
                side_[t] = winding_number_[t] > 0.5 ? in : out;
            }
        };
        for (size_t first = 0; first < side_.size(); first += tets_between_polls) {
            const size_t count = std::min(tets_between_polls, side_.size() - first);
            pool.parallel_for(count, tets_per_chunk,
                              [&](size_t begin, size_t end) { chunk(first + begin, first + end); });
            progress.advance(0.4 + 0.3 * static_cast<double>(first) / static_cast<double>(side_.size()));
        }
    }

    // Each unknown tetrahedron gets the label of the labeled neighbor across its largest facet, the largest facet
    // first. So the facets between inside and outside are small.
    void propagate(Progress& progress) {
        struct Facet {
            double weight;
            int32_t tet;
            Side side;
            bool operator<(const Facet& other) const {
                return std::tie(weight, tet, side) < std::tie(other.weight, other.tet, other.side);
            }
        };
        std::priority_queue<Facet> front;
        const auto push_neighbors = [&](size_t t) {
            for (size_t k = 0; k < 4; ++k) {
                const int32_t next = mesh_.neighbors[t][k];
                if (next >= 0 && side_[idx(next)] == unknown) front.push({weight(t, k), next, side_[t]});
            }
        };
        for (size_t t = 0; t < side_.size(); ++t) {
            if (side_[t] != unknown) push_neighbors(t);
            for (size_t k = 0; k < 4 && side_[t] == unknown; ++k)
                if (mesh_.neighbors[t][k] < 0) front.push({weight(t, k), static_cast<int32_t>(t), out});
        }
        for (size_t step = 0; !front.empty(); ++step) {
            if (step % tets_between_polls == 0) progress.advance(0.7);
            const Facet f = front.top();
            front.pop();
            if (side_[idx(f.tet)] != unknown) continue;
            side_[idx(f.tet)] = f.side;
            push_neighbors(idx(f.tet));
        }
    }

    // Tetrahedra change sides, one after the other, where that lowers the cost (volume on the wrong side plus area of
    // the boundary). Returns whether any did.
    bool smooth() {
        bool changed = false;
        for (size_t t = 0; t < side_.size(); ++t) {
            double gain = 0;
            for (size_t k = 0; k < 4; ++k)
                gain += is_inside(mesh_.neighbors[t][k]) == (side_[t] == in) ? -weight(t, k) : weight(t, k);
            const double confidence = 2 * std::clamp(winding_number_[t], 0.0, 1.0) - 1;  // that it is inside; below 0: outside
            if (smoothness * gain <= volume_[t] * (side_[t] == in ? confidence : -confidence)) continue;
            side_[t] = side_[t] == in ? out : in;
            changed = true;
        }
        return changed;
    }

    void drop_loose() {
        UnionFind components(side_.size());
        std::vector<double> size(side_.size(), 0), largest(mesh_.vertices.size(), 0);  // of the components at each vertex
        for (size_t t = 0; t < side_.size(); ++t)
            for (const int32_t next : mesh_.neighbors[t])
                if (side_[t] == in && is_inside(next)) components.unite(t, idx(next));
        for (size_t t = 0; t < side_.size(); ++t) size[components.find(t)] += volume_[t];
        std::vector<bool> loose(side_.size(), false);
        for (const bool second_pass : {false, true})
            for (size_t t = 0; t < side_.size(); ++t)
                for (size_t k = 0; side_[t] == in && k < 4; ++k) {
                    double& largest_here = largest[idx(mesh_.tetrahedra[t][k])];
                    const size_t component = components.find(t);
                    if (!second_pass)
                        largest_here = std::max(largest_here, size[component]);
                    else if (size[component] < max_loose_share * largest_here)
                        loose[component] = true;
                }
        for (size_t t = 0; t < side_.size(); ++t)
            if (side_[t] == in && loose[components.find(t)]) side_[t] = out;
    }

    TetMesh mesh_;
    std::vector<Side> side_;
    std::vector<double> volume_, winding_number_;  // winding_number_: 0.5 where it was not computed
    std::vector<std::array<double, 4>> weights_;  // of the facet opposite each corner: its area to the power of 3/2
};

// The tetrahedra inside, and their boundary.
Solid extract_inside(const Surface& source, const InsideLabels& labels, Progress& progress) {
    const TetMesh& all = labels.mesh();
    std::vector<int32_t> tet_number(all.tetrahedra.size(), -1);
    int32_t count = 0;
    for (size_t t = 0; t < all.tetrahedra.size(); ++t)
        if (labels.is_inside(static_cast<int32_t>(t))) tet_number[t] = count++;
    Filling filling{all.vertices, {}, {}, {}};
    for (size_t t = 0; t < all.tetrahedra.size(); ++t) {
        if (tet_number[t] < 0) continue;
        std::array<Corner, 4>& corners = filling.corners.emplace_back();
        for (size_t k = 0; k < 4; ++k) {
            const int32_t next = all.neighbors[t][k];
            corners[k] = {all.tetrahedra[t][k], next < 0 ? -1 : tet_number[idx(next)]};
            if (corners[k].beyond >= 0) continue;
            filling.triangles.push_back(facet(all.tetrahedra[t], k));
            filling.behind.push_back(tet_number[t]);
        }
    }
    const std::vector<int32_t> on_surface = in_order_of_use(all.vertices.size(), filling.triangles);
    Solid solid = canonical(source.frame, std::move(filling), on_surface, progress);

    std::map<Point, int32_t> source_of;
    for (size_t v = source.vertices.size(); v-- > 0;) source_of[source.vertices[v]] = source.source_vertex[v];
    for (size_t v = 0; v < solid.surface.vertices.size(); ++v) {
        const auto known = source_of.find(solid.surface.vertices[v]);
        solid.surface.source_vertex[v] = known == source_of.end() ? -1 : known->second;
    }
    return solid;
}

// The number of regions outside that are not connected to the space around the model.
size_t count_cavities(const InsideLabels& labels) {
    const TetMesh& all = labels.mesh();
    UnionFind regions(all.tetrahedra.size() + 1);  // the last one stands for the space around the model
    for (size_t t = 0; t < all.tetrahedra.size(); ++t)
        for (const int32_t next : all.neighbors[t])
            if (!labels.is_inside(static_cast<int32_t>(t)) && !labels.is_inside(next))
                regions.unite(t, next < 0 ? all.tetrahedra.size() : idx(next));
    size_t count = 0;
    for (size_t t = 0; t < all.tetrahedra.size(); ++t)
        count += !labels.is_inside(static_cast<int32_t>(t)) && regions.find(t) == t;
    return count - (regions.find(all.tetrahedra.size()) < all.tetrahedra.size());
}

}  // namespace

Solid from_points(const Surface& source, size_t least_points, size_t threads, Progress& progress) {
    const RepairedSoup repaired = repair_soup(source, progress);
    // Nothing if a winding number visits more nodes than this.
    const auto label = [&](const WindingSurface& shell, size_t visits) -> std::optional<InsideLabels> {
        if (shell.area() == 0)
            throw Error(PW_ERROR_NOT_SOLID, "The faces of the mesh have no area. Choose another mesh.");
        const size_t wanted = std::clamp(source.vertices.size(), least_points, max_points);
        progress.enter(PW_STAGE_TETRAHEDRA);
        TetMesh mesh = delaunay_tetrahedra(shell.points(wanted, least_spacing * diagonal(source)), progress);
        const WindingNumber winding(shell.vertices, shell.triangles);
        if (mean_visits(mesh, winding) > visits) return std::nullopt;
        return InsideLabels(std::move(mesh), winding, threads, progress);
    };
    std::string repairs;
    std::optional<InsideLabels> labels;
    if (repaired.sheet_share > min_sheet_share) {
        const WindingSurface soup{source.vertices, source.triangles};
        const double least = min_soup_volume * soup.area() * std::sqrt(soup.area());
        labels = label(soup, max_visits_of_soup);
        if (labels && (labels->volume() < least || labels->uncertainty() > max_uncertainty)) labels.reset();
    }
    if (!labels) {
        if (repaired.solids == 0) throw_sheet();
        labels = label(make_winding_surface(repaired, sheet_thickness * diagonal(source)), max_visits);
        if (!labels)
            throw Error(PW_ERROR_SELF_INTERSECTION,
                        "So many triangles pass through each other that the inside can't be found. Remesh the model, or "
                        "unite its parts with a Boolean.");
        repairs = repaired.notes.text();
    }
    if (labels->volume() == 0)
        throw Error(PW_ERROR_NO_VOLUME, "The surface encloses no volume. Give it some thickness.");
    Solid solid = extract_inside(source, *labels, progress);
    solid.mesh.cavities = count_cavities(*labels);
    assign_source_faces_by_distance(source, solid.surface, progress);

    solid.surface.fill_method = PW_FILL_POINTS;
    solid.surface.notes = "Filled from points on the mesh" + (repairs.empty() ? "" : ", after this: " + repairs) + ". " +
                          at_most_away(solid.surface.deviation) + ".";
    return solid;
}

}  // namespace partwheel
