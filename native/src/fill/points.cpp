// Tetrahedra from points: the tetrahedralization, which tetrahedra are inside, and the surface of these.
#include "fill/points.h"

#include "base/adjacency.h"
#include "base/checked_index.h"
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

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <queue>
#include <string>
#include <tuple>
#include <utility>

namespace partwheel {

namespace {

// As many points as the source has vertices, within these bounds, were they spread evenly: the vertices are among them,
// and where they are denser more come together. Three times as many select no better.
constexpr size_t usual_points = 15000;

// Points are no closer together than this share of the diagonal. What has so little area that they would be is all but
// lines, and of points on lines nearly every two pairs make a tetrahedron.
constexpr double least_spacing = 1.0 / 1000;

// Where sheets have more than this share of the area, the mesh may be a soup of triangles, or of patches, that wind
// around something together as they are. So it is if they enclose more volume than this times their area to the power of
// 3/2, and wind around it so nearly once.
constexpr double much_open = 0.1, least_volume = 0.003, sure_enough = 0.33;

// A tetrahedron is asked whether it is inside if its volume is more than this times the sum of its facets' areas to the
// power of 3/2, which is 0.10 for a regular one: flatter ones mostly lie along the surface, on neither side of it, and
// go with their neighbours.
constexpr double flat = 0.04;

// What a facet between inside and outside costs, its area to the power of 3/2, beside a volume on the wrong side.
constexpr double smoothness = 0.05;
constexpr int smoothing_passes = 6;

// A piece that hangs on by an edge or a corner is left out if it is less than this share of what it hangs on.
constexpr double loose_share = 0.05;

constexpr size_t points_a_look = 512, tetrahedra_a_piece = 1024, tetrahedra_a_look = 65536;

// What a winding number costs: nodes visited on average. Real surfaces take up to some 3000. Triangles that all pass through
// each other take all nodes, and asking for all tetrahedra would take a time that grows with the square of their number.
// So a soup is not tried beyond the first, and nothing beyond the second.
constexpr size_t most_visits_of_soup = 4096, most_visits = 65536, tetrahedra_sampled = 64;

size_t mean_visits(const TetMesh& mesh, const WindingNumber& winding) {
    const size_t count = mesh.tetrahedra.size(), stride = count / tetrahedra_sampled + 1;
    size_t sum = 0, asked = 0;
    for (size_t t = 0; t < count; t += stride, ++asked) {
        Point middle{};
        for (const int32_t v : mesh.tetrahedra[t]) middle = middle + 0.25 * mesh.vertices[idx(v)];
        sum += winding.visits(middle);
    }
    return sum / std::max<size_t>(asked, 1);
}

// The Delaunay tetrahedralization of points that are all different, in canonical order.
TetMesh tetrahedralized(const std::vector<Point>& points, Progress& progress) {
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
        if (i % points_a_look == 0) progress.advance(0.4 * static_cast<double>(i) / static_cast<double>(order.size()));
        const bool begun = near != Delaunay::Vertex_handle();
        near = delaunay.insert(order[i].first, begun ? near->cell() : Delaunay::Cell_handle());
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
class Sides {
public:
    Sides(TetMesh&& mesh, const WindingNumber& winding, size_t threads, Progress& progress);

    const TetMesh& mesh() const { return mesh_; }

    bool inside(int32_t tet) const { return tet >= 0 && side_[idx(tet)] == in; }
    double volume() const;  // inside
    double unsure() const;  // how far the winding numbers inside are from 1, on average over the volume

private:
    enum Side : uint8_t { out, in, open };

    double weight(size_t tet, size_t facet) const { return weights_[tet][facet]; }
    void ask(const WindingNumber& winding, size_t threads, Progress& progress);
    void grow(Progress& progress);
    bool smooth();
    void drop_loose();

    TetMesh mesh_;
    std::vector<Side> side_;
    std::vector<double> volume_, around_;             // around_: the winding number, where it was asked
    std::vector<std::array<double, 4>> weights_;  // of the facet opposite each corner: its area to the power of 3/2
};

Sides::Sides(TetMesh&& mesh, const WindingNumber& winding, size_t threads, Progress& progress)
    : mesh_(std::move(mesh)), side_(mesh_.tetrahedra.size(), open), volume_(side_.size()), around_(side_.size(), 0.5),
      weights_(side_.size()) {
    ask(winding, threads, progress);
    grow(progress);
    for (int pass = 0; pass < smoothing_passes && smooth(); ++pass) progress.advance(0.7);
    drop_loose();
    progress.advance(0.7);
}

void Sides::ask(const WindingNumber& winding, size_t threads, Progress& progress) {
    ThreadPool pool(threads, side_.size() / tetrahedra_a_piece + 1);
    const auto piece = [&](size_t first, size_t last) {
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
            around_[t] = winding.at(0.25 * (a + b + c + d));
            side_[t] = around_[t] > 0.5 ? in : out;
        }
    };
    for (size_t first = 0; first < side_.size(); first += tetrahedra_a_look) {
        const size_t count = std::min(tetrahedra_a_look, side_.size() - first);
        pool.parallel_for(count, tetrahedra_a_piece,
                          [&](size_t begin, size_t end) { piece(first + begin, first + end); });
        progress.advance(0.4 + 0.3 * static_cast<double>(first) / static_cast<double>(side_.size()));
    }
}

// Each open tetrahedron goes with the neighbour on the other side of its largest facet that has a side, the largest
// first: so small facets are what is left between inside and outside.
void Sides::grow(Progress& progress) {
    struct Facet {
        double weight;
        int32_t tet;
        Side side;
        bool operator<(const Facet& other) const {
            return std::tie(weight, tet, side) < std::tie(other.weight, other.tet, other.side);
        }
    };
    std::priority_queue<Facet> front;
    const auto pass_on = [&](size_t t) {
        for (size_t k = 0; k < 4; ++k) {
            const int32_t next = mesh_.neighbors[t][k];
            if (next >= 0 && side_[idx(next)] == open) front.push({weight(t, k), next, side_[t]});
        }
    };
    for (size_t t = 0; t < side_.size(); ++t) {
        if (side_[t] != open) pass_on(t);
        for (size_t k = 0; k < 4 && side_[t] == open; ++k)
            if (mesh_.neighbors[t][k] < 0) front.push({weight(t, k), static_cast<int32_t>(t), out});
    }
    for (size_t step = 0; !front.empty(); ++step) {
        if (step % tetrahedra_a_look == 0) progress.advance(0.7);
        const Facet f = front.top();
        front.pop();
        if (side_[idx(f.tet)] != open) continue;
        side_[idx(f.tet)] = f.side;
        pass_on(idx(f.tet));
    }
}

// Tetrahedra change sides, one after the other, where that makes the boundary smaller by more than it costs. Whether
// any did.
bool Sides::smooth() {
    bool changed = false;
    for (size_t t = 0; t < side_.size(); ++t) {
        double gain = 0;
        for (size_t k = 0; k < 4; ++k)
            gain += inside(mesh_.neighbors[t][k]) == (side_[t] == in) ? -weight(t, k) : weight(t, k);
        const double surely = 2 * std::clamp(around_[t], 0.0, 1.0) - 1;  // inside
        if (smoothness * gain <= volume_[t] * (side_[t] == in ? surely : -surely)) continue;
        side_[t] = side_[t] == in ? out : in;
        changed = true;
    }
    return changed;
}

void Sides::drop_loose() {
    UnionFind pieces(side_.size());
    std::vector<double> size(side_.size(), 0), largest(mesh_.vertices.size(), 0);  // of the pieces at each vertex
    for (size_t t = 0; t < side_.size(); ++t)
        for (const int32_t next : mesh_.neighbors[t])
            if (side_[t] == in && inside(next)) pieces.join(t, idx(next));
    for (size_t t = 0; t < side_.size(); ++t) size[pieces.find(t)] += volume_[t];
    std::vector<bool> loose(side_.size(), false);
    for (const bool second_pass : {false, true})
        for (size_t t = 0; t < side_.size(); ++t)
            for (size_t k = 0; side_[t] == in && k < 4; ++k) {
                double& there = largest[idx(mesh_.tetrahedra[t][k])];
                const size_t piece = pieces.find(t);
                if (!second_pass)
                    there = std::max(there, size[piece]);
                else if (size[piece] < loose_share * there)
                    loose[piece] = true;
            }
    for (size_t t = 0; t < side_.size(); ++t)
        if (side_[t] == in && loose[pieces.find(t)]) side_[t] = out;
}

double Sides::volume() const {
    double sum = 0;
    for (size_t t = 0; t < side_.size(); ++t) sum += side_[t] == in ? volume_[t] : 0;
    return sum;
}

double Sides::unsure() const {
    double sum = 0;
    for (size_t t = 0; t < side_.size(); ++t)
        if (side_[t] == in) sum += volume_[t] * std::max(0.0, 1 - around_[t]);
    return sum / volume();
}

// What is inside, and its surface.
Solid kept(const Surface& source, const Sides& sides, Progress& progress) {
    const TetMesh& all = sides.mesh();
    std::vector<int32_t> number(all.vertices.size(), -1), given, behind, name(all.tetrahedra.size(), -1);
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;
    const auto named = [&](int32_t v) {
        int32_t& n = number[idx(v)];
        if (n < 0) {
            n = static_cast<int32_t>(vertices.size());
            vertices.push_back(all.vertices[idx(v)]);
            given.push_back(v);
        }
        return n;
    };
    int32_t count = 0;
    for (size_t t = 0; t < all.tetrahedra.size(); ++t) {
        if (!sides.inside(static_cast<int32_t>(t))) continue;
        name[t] = count++;
        for (size_t k = 0; k < 4; ++k) {
            if (sides.inside(all.neighbors[t][k])) continue;
            Triangle f = facet(all.tetrahedra[t], k);
            for (int32_t& v : f) v = named(v);
            triangles.push_back(f);
            behind.push_back(name[t]);
        }
    }
    Solid solid;
    solid.surface = canonical(source.frame, vertices, given, triangles);

    // Vertices as the surface has them, then those that are inside alone.
    vertices = solid.surface.vertices;
    for (size_t v = 0; v < vertices.size(); ++v) number[idx(solid.surface.source_vertex[v])] = static_cast<int32_t>(v);
    std::vector<std::array<Corner, 4>> corners;
    for (size_t t = 0; t < all.tetrahedra.size(); ++t) {
        if (name[t] < 0) continue;
        std::array<Corner, 4>& c = corners.emplace_back();
        for (size_t k = 0; k < 4; ++k) {
            const int32_t next = all.neighbors[t][k];
            c[k] = {named(all.tetrahedra[t][k]), next < 0 ? -1 : name[idx(next)]};
        }
    }
    std::vector<int32_t> place;
    solid.mesh = canonical(std::move(vertices), std::move(corners), progress, &place);
    for (const Piece& piece : solid.surface.pieces)
        solid.mesh.tet_of_triangle.push_back(place[idx(behind[idx(piece.face)])]);

    std::map<Point, int32_t> source_of;
    for (size_t v = source.vertices.size(); v-- > 0;) source_of[source.vertices[v]] = source.source_vertex[v];
    for (size_t v = 0; v < solid.surface.vertices.size(); ++v) {
        const auto known = source_of.find(solid.surface.vertices[v]);
        solid.surface.source_vertex[v] = known == source_of.end() ? -1 : known->second;
    }
    return solid;
}

// Regions outside that no way leads out of.
size_t cavities(const Sides& sides) {
    const TetMesh& all = sides.mesh();
    UnionFind regions(all.tetrahedra.size() + 1);  // the last is all beyond
    for (size_t t = 0; t < all.tetrahedra.size(); ++t)
        for (const int32_t next : all.neighbors[t])
            if (!sides.inside(static_cast<int32_t>(t)) && !sides.inside(next))
                regions.join(t, next < 0 ? all.tetrahedra.size() : idx(next));
    size_t count = 0;
    for (size_t t = 0; t < all.tetrahedra.size(); ++t)
        count += !sides.inside(static_cast<int32_t>(t)) && regions.find(t) == t;
    return count - (regions.find(all.tetrahedra.size()) < all.tetrahedra.size());
}

}  // namespace

Solid from_points(const Surface& source, size_t least_points, size_t threads, Progress& progress) {
    const RepairedSoup mended = repair_soup(source, progress);
    // None if that would take more visits than these.
    const auto filled = [&](const WindingSurface& shell, size_t visits) -> std::optional<Sides> {
        if (shell.area() == 0)
            throw Error(PW_ERROR_NOT_SOLID, "The mesh has no area at all: only edges and points.");
        const size_t wanted = std::clamp(source.vertices.size(), least_points, usual_points);
        progress.enter(PW_STAGE_TETRAHEDRA);
        TetMesh mesh = tetrahedralized(shell.points(wanted, least_spacing * diagonal(source)), progress);
        const WindingNumber winding(shell.vertices, shell.triangles);
        if (mean_visits(mesh, winding) > visits) return std::nullopt;
        return Sides(std::move(mesh), winding, threads, progress);
    };
    Account account;
    std::optional<Sides> found;
    if (mended.sheet_share > much_open) {
        const WindingSurface soup{source.vertices, source.triangles};
        const double least = least_volume * soup.area() * std::sqrt(soup.area());
        found = filled(soup, most_visits_of_soup);
        if (found && (found->volume() < least || found->unsure() > sure_enough)) found.reset();
    }
    if (!found) {
        if (mended.solids == 0) throw_sheet();
        found = filled(make_winding_surface(mended, sheet_thickness * diagonal(source)), most_visits);
        if (!found)
            throw Error(PW_ERROR_SELF_INTERSECTION,
                        "So many triangles pass through each other that the inside can't be found. Remesh the model, or "
                        "unite its parts with a Boolean.");
        mended.done.tell(account);
    }
    const Sides& sides = *found;
    if (sides.volume() == 0)
        throw Error(PW_ERROR_NO_VOLUME, "The surface encloses no volume. Give it some thickness.");
    Solid solid = kept(source, sides, progress);
    solid.mesh.cavities = cavities(sides);
    assign_source_faces_by_distance(source, solid.surface, progress);

    solid.surface.fill_method = PW_FILL_POINTS;
    solid.surface_from_tetrahedra = true;
    solid.surface.account = std::string("Filled from points on the mesh") +
                            (account.text().empty() ? "" : ", after this: " + account.text()) +
                            ". " + at_most_away(solid.surface.deviation) + ".";
    return solid;
}

}  // namespace partwheel
