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

#include <set>

namespace partwheel {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using CgalPoint = CgalKernel::Point_3;
using Corners = std::array<size_t, 3>;
using Face = CgalMesh::Face_index;
using Halfedge = CgalMesh::Halfedge_index;

// Holes with more edges are filled with a fan. If the Delaunay triangulation contains no filling, CGAL searches all of
// them in O(edges^3) steps; once max_cubic_steps are used up, too, holes are filled with fans.
constexpr size_t max_hole_edges = 300, max_cubic_steps = 10000000;

// Counts these steps and polls for cancellation.
class HoleFillingVisitor : public pmp::Hole_filling::Default_visitor {
public:
    explicit HoleFillingVisitor(Progress& progress) : progress_(&progress) {}
    void start_cubic_phase(int steps) { steps_ += static_cast<size_t>(steps); }
    void cubic_step() {
        if (++polls_ % 4096 == 0) progress_->advance_by(0.001);
    }
    bool is_over_budget() const { return steps_ > max_cubic_steps; }

private:
    Progress* progress_;
    size_t steps_ = 0, polls_ = 0;
};

// Merges points with equal coordinates; drops triangles without area and duplicates.
void read_soup(const Surface& source, std::vector<CgalPoint>& points, std::vector<Corners>& triangles, NoteList& notes) {
    std::vector<size_t> number;
    for (size_t v = 0; v < source.vertices.size(); ++v) {
        const Point& p = source.vertices[v];
        if (v == 0 || p != source.vertices[v - 1]) points.emplace_back(p[0], p[1], p[2]);
        number.push_back(points.size() - 1);
    }
    notes.add(number.size() - points.size(), "vertex merged with another", "vertices merged with others");
    std::set<Corners> known;
    for (const Triangle& t : source.triangles) {
        const auto at = [&](size_t k) { return source.vertices[static_cast<size_t>(t[k])]; };
        Corners corners, sorted;
        for (size_t k = 0; k < 3; ++k) corners[k] = number[static_cast<size_t>(t[k])];
        sorted = corners;
        std::sort(sorted.begin(), sorted.end());
        if (!collinear(at(0), at(1), at(2)) && known.insert(sorted).second) triangles.push_back(corners);
    }
    notes.add(source.triangles.size() - triangles.size(), "triangle without area or doubled left out",
              "triangles without area or doubled left out");
}

// Orients each component as most of its area was oriented.
CgalMesh orient(std::vector<CgalPoint> points, std::vector<Corners> triangles, NoteList& notes) {
    const auto normal = [&](const Corners& t) {
        return CGAL::cross_product(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
    };
    std::vector<CgalKernel::Vector_3> before;
    for (const Corners& t : triangles) before.push_back(normal(t));
    const size_t point_count = points.size();
    pmp::orient_polygon_soup(points, triangles);
    // Where more than two faces or several fans met.
    notes.add(points.size() - point_count, "vertex split", "vertices split");

    CgalMesh mesh;
    pmp::polygon_soup_to_polygon_mesh(points, triangles, mesh);
    auto part = mesh.add_property_map<Face, size_t>("f:part", 0).first;
    const size_t parts = pmp::connected_components(mesh, part);
    std::vector<double> balance(parts, 0);
    std::vector<bool> agrees;
    for (const Face f : mesh.faces()) {  // face f is triangle f
        const CgalKernel::Vector_3 n = normal(triangles[f]);
        agrees.push_back(n * before[f] > 0);
        balance[part[f]] += agrees.back() ? std::sqrt(n.squared_length()) : -std::sqrt(n.squared_length());
    }
    std::vector<Face> reversed;
    size_t turned = 0;
    for (const Face f : mesh.faces()) {
        const bool must_reverse = balance[part[f]] < 0;
        if (must_reverse) reversed.push_back(f);
        turned += agrees[f] == must_reverse;
    }
    notes.add(turned, "triangle turned round", "triangles turned round");
    pmp::reverse_face_orientations(reversed, mesh);
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

// Fills the hole with this border. Returns the new faces.
std::vector<Face> fill_hole(CgalMesh& mesh, Halfedge rim, HoleFillingVisitor& visitor) {
    std::vector<Face> patch;
    const size_t length = CGAL::halfedges_around_face(rim, mesh).size();
    if (length <= max_hole_edges) {
        pmp::triangulate_hole(
            mesh, rim, std::back_inserter(patch),
            CGAL::parameters::visitor(std::ref(visitor)).do_not_use_cubic_algorithm(visitor.is_over_budget()));
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

// Fills the holes of all components that are not sheets.
void fill_holes(RepairedSoup& soup, Progress& progress) {
    CgalMesh& mesh = soup.mesh;
    auto part = mesh.add_property_map<Face, size_t>("f:part", 0).first;
    const size_t parts = pmp::connected_components(mesh, part);
    std::vector<std::vector<Face>> own(parts), patch(parts);
    for (const Face f : mesh.faces()) own[part[f]].push_back(f);
    std::vector<Halfedge> rims;
    pmp::extract_boundary_cycles(mesh, std::back_inserter(rims));
    std::vector<size_t> holes(parts, 0);
    HoleFillingVisitor visitor(progress);
    for (size_t i = 0; i < rims.size(); ++i) {
        progress.advance(0.1 + 0.1 * static_cast<double>(i) / static_cast<double>(rims.size()));
        const size_t p = part[mesh.face(mesh.opposite(rims[i]))];
        const std::vector<Face> faces = fill_hole(mesh, rims[i], visitor);
        patch[p].insert(patch[p].end(), faces.begin(), faces.end());
        ++holes[p];
    }
    double open = 0, closed = 0;
    size_t filled = 0;
    for (size_t p = 0; p < parts; ++p) {
        const double area = pmp::area(own[p], mesh), added = pmp::area(patch[p], mesh);
        const double volume = std::fabs(volume_of(mesh, own[p]) + volume_of(mesh, patch[p]));
        const double whole = area + added;
        const bool is_flat = volume < max_sheet_volume * whole * std::sqrt(whole);
        const bool sheet = added > (is_flat ? min_sheet_added_area : max_added_area) * area;
        ++(sheet ? soup.sheets : soup.solids);
        (sheet ? open : closed) += area;
        if (!sheet) filled += holes[p];
        if (sheet)
            for (const Face f : patch[p]) CGAL::Euler::remove_face(mesh.halfedge(f), mesh);
    }
    soup.notes.add(filled, "hole filled", "holes filled");
    if (open > 0) soup.sheet_share = open / (open + closed);
    mesh.remove_property_map(part);
}

}  // namespace

void NoteList::add(size_t count, const char* one, const char* many) {
    if (count) text_ += (text_.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : many);
}

RepairedSoup repair_soup(const Surface& source, Progress& progress) {
    RepairedSoup soup;
    std::vector<CgalPoint> points;
    std::vector<Corners> triangles;
    read_soup(source, points, triangles, soup.notes);
    soup.mesh = orient(std::move(points), std::move(triangles), soup.notes);
    progress.advance(0.05);
    soup.notes.add(pmp::stitch_borders(soup.mesh), "pair of edges stitched", "pairs of edges stitched");
    pmp::duplicate_non_manifold_vertices(soup.mesh);
    progress.advance(0.1);
    fill_holes(soup, progress);
    soup.mesh.collect_garbage();
    return soup;
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
