// Any triangles -> an oriented manifold with its holes filled.
#include "prepare/soup_repair.h"

#include "base/predicates.h"

#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace partwheel {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using CgalPoint = CgalKernel::Point_3;
using Corners = std::array<size_t, 3>;
using Face = CgalMesh::Face_index;
using Halfedge = CgalMesh::Halfedge_index;

// Longer rims are filled with a fan. Where Delaunay's triangulation holds no filling, the best of all takes a time that
// grows with the cube of the length: beyond so many of its steps in all, too, a fan.
constexpr size_t longest_triangulated = 300, most_steps = 10000000;

// Counts those steps, and lets a cancellation in.
class FillingWatcher : public pmp::Hole_filling::Default_visitor {
public:
    explicit FillingWatcher(Progress& progress) : progress_(&progress) {}
    void start_cubic_phase(int steps) { steps_ += static_cast<size_t>(steps); }
    void cubic_step() {
        if (++step_ % 4096 == 0) progress_->advance(0);
    }
    bool spent() const { return steps_ > most_steps; }

private:
    Progress* progress_;
    size_t steps_ = 0, step_ = 0;
};

// Points with equal coordinates become one, triangles without area and copies of others go.
void read_soup(const Surface& source, std::vector<CgalPoint>& points, std::vector<Corners>& triangles, SoupRepairCounts& done) {
    std::vector<size_t> number;
    for (size_t v = 0; v < source.vertices.size(); ++v) {
        const Point& p = source.vertices[v];
        if (v == 0 || p != source.vertices[v - 1]) points.emplace_back(p[0], p[1], p[2]);
        number.push_back(points.size() - 1);
    }
    done.merged = number.size() - points.size();
    std::set<Corners> known;
    for (const Triangle& t : source.triangles) {
        const auto at = [&](size_t k) { return source.vertices[static_cast<size_t>(t[k])]; };
        Corners corners, sorted;
        for (size_t k = 0; k < 3; ++k) corners[k] = number[static_cast<size_t>(t[k])];
        sorted = corners;
        std::sort(sorted.begin(), sorted.end());
        if (collinear(at(0), at(1), at(2)) || !known.insert(sorted).second)
            ++done.dropped;
        else
            triangles.push_back(corners);
    }
}

CgalMesh oriented(std::vector<CgalPoint> points, std::vector<Corners> triangles, SoupRepairCounts& done) {
    const auto normal = [&](const Corners& t) {
        return CGAL::cross_product(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
    };
    std::vector<CgalKernel::Vector_3> before;
    for (const Corners& t : triangles) before.push_back(normal(t));
    const size_t given = points.size();
    pmp::orient_polygon_soup(points, triangles);
    done.split = points.size() - given;

    CgalMesh mesh;
    pmp::polygon_soup_to_polygon_mesh(points, triangles, mesh);
    // Each part looks where most of its area looked.
    auto part = mesh.add_property_map<Face, size_t>("f:part", 0).first;
    const size_t parts = pmp::connected_components(mesh, part);
    std::vector<double> balance(parts, 0);
    std::vector<bool> agrees;
    for (const Face f : mesh.faces()) {  // face f is triangle f
        const CgalKernel::Vector_3 n = normal(triangles[f]);
        agrees.push_back(n * before[f] > 0);
        balance[part[f]] += agrees.back() ? std::sqrt(n.squared_length()) : -std::sqrt(n.squared_length());
    }
    std::vector<Face> turn;
    for (const Face f : mesh.faces()) {
        const bool reverse = balance[part[f]] < 0;
        if (reverse) turn.push_back(f);
        done.turned += agrees[f] == reverse;
    }
    pmp::reverse_face_orientations(turn, mesh);
    mesh.remove_property_map(part);
    return mesh;
}

double volume_of(const CgalMesh& mesh, const std::vector<Face>& faces) {
    double volume = 0;
    for (const Face f : faces) {
        const auto h = mesh.halfedge(f);
        volume += CGAL::volume(CgalPoint(CGAL::ORIGIN), mesh.point(mesh.source(h)), mesh.point(mesh.target(h)),
                               mesh.point(mesh.target(mesh.next(h))));
    }
    return volume;
}

// The faces that close a hole, or none if that fails.
std::vector<Face> fill(CgalMesh& mesh, Halfedge rim, FillingWatcher& watcher) {
    std::vector<Face> patch;
    const size_t length = CGAL::halfedges_around_face(rim, mesh).size();
    if (length <= longest_triangulated) {
        pmp::triangulate_hole(
            mesh, rim, std::back_inserter(patch),
            CGAL::parameters::visitor(std::ref(watcher)).do_not_use_cubic_algorithm(watcher.spent()));
        if (!patch.empty()) return patch;
    }
    CgalKernel::Vector_3 sum(0, 0, 0);
    for (const Halfedge h : CGAL::halfedges_around_face(rim, mesh))
        sum = sum + (mesh.point(mesh.target(h)) - CGAL::ORIGIN);
    CGAL::Euler::fill_hole(rim, mesh);
    const Halfedge center = CGAL::Euler::add_center_vertex(rim, mesh);
    mesh.point(mesh.target(center)) = CGAL::ORIGIN + sum / static_cast<double>(length);
    for (const Halfedge h : CGAL::halfedges_around_target(center, mesh)) patch.push_back(mesh.face(h));
    return patch;
}

// Fills the holes of all parts but sheets.
void fill_holes(RepairedSoup& mended, Progress& progress) {
    CgalMesh& mesh = mended.mesh;
    auto part = mesh.add_property_map<Face, size_t>("f:part", 0).first;
    const size_t parts = pmp::connected_components(mesh, part);
    std::vector<std::vector<Face>> own(parts), patch(parts);
    for (const Face f : mesh.faces()) own[part[f]].push_back(f);
    std::vector<Halfedge> rims;
    pmp::extract_boundary_cycles(mesh, std::back_inserter(rims));
    std::vector<size_t> holes(parts, 0);
    FillingWatcher watcher(progress);
    for (size_t i = 0; i < rims.size(); ++i) {
        progress.advance(0.1 + 0.1 * static_cast<double>(i) / static_cast<double>(rims.size()));
        const size_t p = part[mesh.face(mesh.opposite(rims[i]))];
        const std::vector<Face> faces = fill(mesh, rims[i], watcher);
        patch[p].insert(patch[p].end(), faces.begin(), faces.end());
        ++holes[p];
    }
    double open = 0, closed = 0;
    for (size_t p = 0; p < parts; ++p) {
        const double area = pmp::area(own[p], mesh), added = pmp::area(patch[p], mesh);
        const double volume = std::fabs(volume_of(mesh, own[p]) + volume_of(mesh, patch[p]));
        const double whole = area + added;
        const bool sheet = added > sheet_area * area && volume < sheet_volume * whole * std::sqrt(whole);
        ++(sheet ? mended.sheets : mended.solids);
        (sheet ? open : closed) += area;
        if (!sheet) mended.done.holes += holes[p];
        if (sheet)
            for (const Face f : patch[p]) CGAL::Euler::remove_face(mesh.halfedge(f), mesh);
    }
    if (open > 0) mended.sheet_share = open / (open + closed);
    mesh.remove_property_map(part);
}

}  // namespace

void Account::add(size_t count, const char* one, const char* many) {
    if (count) text_ += (text_.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : many);
}

void SoupRepairCounts::tell(Account& account) const {
    account.add(merged, "vertex merged with another", "vertices merged with others");
    account.add(dropped, "triangle without area or doubled left out", "triangles without area or doubled left out");
    account.add(split, "vertex split", "vertices split");
    account.add(turned, "triangle turned round", "triangles turned round");
    account.add(stitched, "pair of edges stitched", "pairs of edges stitched");
    account.add(holes, "hole filled", "holes filled");
}

RepairedSoup repair_soup(const Surface& source, Progress& progress) {
    RepairedSoup mended;
    std::vector<CgalPoint> points;
    std::vector<Corners> triangles;
    read_soup(source, points, triangles, mended.done);
    mended.mesh = oriented(std::move(points), std::move(triangles), mended.done);
    progress.advance(0.05);
    mended.done.stitched = pmp::stitch_borders(mended.mesh);
    pmp::duplicate_non_manifold_vertices(mended.mesh);
    progress.advance(0.1);
    fill_holes(mended, progress);
    mended.mesh.collect_garbage();
    return mended;
}

Surface to_surface(const Surface& source, const CgalMesh& mesh) {
    std::map<Point, int32_t> source_of;
    for (size_t v = source.vertices.size(); v-- > 0;) source_of[source.vertices[v]] = source.source_vertex[v];
    std::vector<Point> vertices;
    std::vector<int32_t> source_vertex, number(mesh.number_of_vertices(), -1);
    for (const auto v : mesh.vertices()) {
        if (mesh.is_isolated(v)) continue;
        const Point p = {mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z()};
        const auto known = source_of.find(p);
        source_vertex.push_back(known == source_of.end() ? -1 : known->second);
        number[v] = static_cast<int32_t>(vertices.size());
        vertices.push_back(p);
    }
    std::vector<Triangle> triangles;
    for (const Face f : mesh.faces()) {
        Triangle& t = triangles.emplace_back();
        size_t k = 0;
        for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) t[k++] = number[v];
    }
    return canonical(source.frame, vertices, source_vertex, triangles);
}

}  // namespace partwheel
