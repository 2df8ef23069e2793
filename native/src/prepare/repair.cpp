// The second fill method: the source repaired, its crossing parts united.
#include "prepare/repair.h"

#include "base/predicates.h"
#include "mesh/crossings.h"
#include "mesh/face_assignment.h"
#include "prepare/soup_repair.h"

#include <CGAL/Polygon_mesh_processing/compute_normal.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/intersection.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>

#include <set>

namespace partwheel {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Face = CgalMesh::Face_index;
using Vertex = CgalMesh::Vertex_index;

// If more of a part's faces than this cross others, removing them and filling the holes would invent a surface.
constexpr double max_crossing_share = 0.1;

// Nothing of the source may be farther outside of what is left than near_enough. A large surface may lose twice as much:
// filled from points, which would follow, it is as far from the surface used, and takes two to four times as long. Small
// ones get smaller tetrahedra and better parts from points, in little time.
constexpr size_t large_surface = 2000;       // triangles
constexpr double max_lost = 1.0 / 100;       // relative to the diagonal, of a large one
constexpr double max_deviation = 1.0 / 50;   // of such a one: beyond it, space was filled instead

// The time for both grows faster than the mesh. Above these limits the next fill method is faster.
constexpr size_t max_crossing_faces = 5000;       // of a part
constexpr size_t max_compared_faces = 2000000;  // of all pairs of parts that are compared

// CGAL compares every two faces around a vertex, at each of its steps, and takes degree^3 steps for a vertex's normal.
constexpr size_t max_pairs_around_vertices = 250000, max_pairs_per_face = 32, max_degree_for_normal = 64;

[[noreturn]] void throw_tangled() {
    throw Error(PW_ERROR_SELF_INTERSECTION,
                "The surface passes through itself in ways that can't be repaired. Remesh it, or unite its parts with "
                "a Boolean.");
}

// Removes sheets, which have no inside: their faces go with the nearest solid part. Returns the number of sheets.
size_t drop_sheets(CgalMesh& mesh) {
    auto part = mesh.add_property_map<Face, size_t>("f:part", 0).first;
    std::vector<bool> open(pmp::connected_components(mesh, part), false);
    for (const auto h : mesh.halfedges())
        if (mesh.is_border(h)) open[part[mesh.face(mesh.opposite(h))]] = true;
    std::vector<size_t> sheets;
    for (size_t p = 0; p < open.size(); ++p)
        if (open[p]) sheets.push_back(p);
    if (!sheets.empty()) pmp::remove_connected_components(mesh, sheets, part);
    mesh.remove_property_map(part);
    mesh.collect_garbage();
    return sheets.size();
}

// A direction in which all faces around a vertex are visible, if there is one; of many faces, their mean.
CgalKernel::Vector_3 vertex_normal(const CgalMesh& mesh, Vertex v) {
    if (mesh.degree(v) <= max_degree_for_normal) return pmp::compute_vertex_normal(v, mesh);
    CgalKernel::Vector_3 sum = CGAL::NULL_VECTOR;
    for (const Face f : CGAL::faces_around_target(mesh.halfedge(v), mesh))
        if (f != CgalMesh::null_face()) sum += pmp::compute_face_normal(f, mesh);
    const double length = std::sqrt(sum.squared_length());
    return length > 0 ? sum / length : sum;
}

// Where parts touch at a vertex or an edge, each has its own vertices there, at the same position: moves them apart.
// Returns the number of vertices moved.
size_t separate_touching_vertices(CgalMesh& mesh) {
    std::map<CgalKernel::Point_3, std::vector<Vertex>> places;
    for (const Vertex v : mesh.vertices()) places[mesh.point(v)].push_back(v);
    std::vector<std::pair<Vertex, CgalKernel::Point_3>> moves;
    for (const auto& [place, group] : places) {
        if (group.size() < 2) continue;
        for (const Vertex v : group) {
            double shortest = HUGE_VAL;
            for (const auto h : CGAL::halfedges_around_target(v, mesh))
                shortest = std::min(shortest, pmp::edge_length(h, mesh));
            moves.emplace_back(v, place - inward_shift * shortest * vertex_normal(mesh, v));
        }
    }
    for (const auto& [v, place] : moves) mesh.point(v) = place;
    return moves.size();
}

bool is_tangled(size_t crossing_faces, size_t faces) {
    return crossing_faces > max_crossing_faces ||
           static_cast<double>(crossing_faces) > max_crossing_share * static_cast<double>(faces);
}

// A step of CGAL's that removes no crossings widens the surface that the next one replaces. Of 500 models, none was repaired
// after three such steps.
constexpr size_t max_steps_in_vain = 3;

// Polls for cancellation while CGAL removes crossings, and gives up above the limits.
class CrossingVisitor : public pmp::experimental::Remove_self_intersection_default_visitor<CgalMesh> {
public:
    CrossingVisitor(const CgalMesh& mesh, Progress& progress) : faces_(mesh.number_of_faces()), progress_(&progress) {}
    template <class Faces>
    void status_update(const Faces& crossed) {
        progress_->advance_by(0.1);
        steps_in_vain_ = crossed.size() < crossing_faces_ ? 0 : steps_in_vain_ + 1;
        crossing_faces_ = crossed.size();
        if (steps_in_vain_ == max_steps_in_vain || is_tangled(crossing_faces_, faces_)) throw_tangled();
    }

private:
    size_t faces_, crossing_faces_ = std::numeric_limits<size_t>::max(), steps_in_vain_ = 0;
    Progress* progress_;
};

// The number of faces that have no area or cross others. Stops when that is too many.
size_t count_crossing_faces(const CgalMesh& mesh, Progress& progress) {
    std::vector<Point> vertices(mesh.num_vertices());
    for (const Vertex v : mesh.vertices()) vertices[v] = {mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z()};
    std::vector<Triangle> triangles;
    size_t count = 0;
    for (const Face f : mesh.faces()) {
        Triangle t{};
        size_t k = 0;
        for (const Vertex v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) t[k++] = static_cast<int32_t>(v.idx());
        if (collinear(vertices[idx(t[0])], vertices[idx(t[1])], vertices[idx(t[2])]))
            ++count;
        else
            triangles.push_back(t);
    }
    std::vector<bool> crosses(triangles.size(), false);
    CrossingSearch(vertices, triangles).for_each_crossing(progress, [&](size_t t, size_t u) {
        for (const size_t face : {t, u})
            if (!crosses[face]) crosses[face] = true, ++count;
        return !is_tangled(count, mesh.number_of_faces());
    });
    return count;
}

// Removes a part's crossings with itself: deletes the crossing faces and fills the holes. Returns whether there were
// any.
bool remove_crossings(CgalMesh& mesh, Progress& progress) {
    size_t crossing_faces = count_crossing_faces(mesh, progress);
    if (crossing_faces == 0) return false;
    std::vector<Face> degenerate;
    pmp::degenerate_faces(mesh, std::back_inserter(degenerate));
    if (!degenerate.empty()) {
        pmp::remove_degenerate_faces(mesh);
        crossing_faces = count_crossing_faces(mesh, progress);
    }
    const size_t max_pairs = max_pairs_around_vertices + max_pairs_per_face * mesh.number_of_faces();
    size_t pairs = 0;
    for (const Vertex v : mesh.vertices()) pairs += mesh.degree(v) * (mesh.degree(v) - 1) / 2;
    if (pairs > max_pairs || is_tangled(crossing_faces, mesh.number_of_faces())) throw_tangled();
    pmp::experimental::remove_self_intersections(
        mesh, CGAL::parameters::preserve_genus(false).visitor(CrossingVisitor(mesh, progress)));
    return true;
}

// Pairs of parts whose bounding boxes meet, computed once. A union has a larger box: it counts as a neighbor of all
// parts.
class PartNeighbors {
public:
    explicit PartNeighbors(const std::vector<CGAL::Bbox_3>& boxes) : lower_(boxes.size()) {
        using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, size_t>;
        std::vector<Box> all;
        for (const CGAL::Bbox_3& box : boxes) all.emplace_back(box, all.size());
        size_t pairs = 0;
        CGAL::box_self_intersection_d(all.begin(), all.end(), [&](const Box& a, const Box& b) {
            if (++pairs > max_compared_faces) throw_tangled();  // as comparing their faces would
            lower_[std::max(a.info(), b.info())].push_back(std::min(a.info(), b.info()));
        });
        for (std::vector<size_t>& neighbors : lower_) std::ranges::sort(neighbors);
    }

    void mark_united(size_t part) { united_.insert(part); }

    // The first part in [j, i) whose box may meet the box of part i; i if there is none.
    size_t next(size_t i, size_t j) const {
        if (j >= i || united_.contains(i)) return std::min(i, j);
        const auto neighbor = std::ranges::lower_bound(lower_[i], j);
        const auto united = united_.lower_bound(j);
        return std::min({i, neighbor == lower_[i].end() ? i : *neighbor, united == united_.end() ? i : *united});
    }

private:
    std::vector<std::vector<size_t>> lower_;  // neighbors of each part that come before it
    std::set<size_t> united_;
};

// Unites parts that cross each other; leaves the others alone, even if one contains another. Returns the number of
// unions.
size_t unite(std::vector<CgalMesh>& parts, Progress& progress) {
    size_t united = 0, compared = 0;
    std::vector<CGAL::Bbox_3> boxes;
    for (const CgalMesh& part : parts) boxes.push_back(pmp::bbox(part));
    PartNeighbors neighbors(boxes);
    for (size_t i = 0; i < parts.size(); ++i)
        for (size_t j = neighbors.next(i, 0); j < i; j = neighbors.next(i, j + 1)) {
            progress.advance_by(0.5 / static_cast<double>(parts.size()));
            if (parts[j].is_empty() || !CGAL::do_overlap(boxes[i], boxes[j])) continue;
            compared += parts[i].number_of_faces() + parts[j].number_of_faces();
            if (compared > max_compared_faces) throw_tangled();
            if (!pmp::do_intersect(parts[i], parts[j])) continue;
            if (pmp::volume(parts[i]) <= 0 || pmp::volume(parts[j]) <= 0) throw_tangled();
            for (const size_t part : {i, j})
                if (count_crossing_faces(parts[part], progress) > 0) throw_tangled();
            CgalMesh both;
            if (!pmp::corefine_and_compute_union(parts[i], parts[j], both)) throw_tangled();
            parts[i] = std::move(both);
            parts[j].clear();
            boxes[i] = boxes[i] + boxes[j];
            neighbors.mark_united(i);
            ++united;
            j = static_cast<size_t>(-1);  // the union may cross parts that i did not
        }
    return united;
}

// A sentence on how far the mesh is from the surface used, and how far outside of it.
std::string describe_deviation(double deviation, double outside) {
    if (deviation == 0) return "All of the mesh is on the surface used.";
    outside = std::max(outside, near_enough);
    if (deviation <= outside) return at_most_away(deviation) + ".";
    return at_most_away(outside) + ", but up to " + percent(deviation) + " from what of the mesh is now inside.";
}

}  // namespace

Surface repair(const Surface& source, Progress& progress) {
    RepairedSoup soup = repair_soup(source, progress);
    if (soup.solids == 0)
        throw Error(PW_ERROR_OPEN, "The mesh has no part that can be closed. Give it a thickness (Solidify).");
    NoteList& notes = soup.notes;
    if (soup.sheets) notes.add(drop_sheets(soup.mesh), "loose sheet left out", "loose sheets left out");
    notes.add(separate_touching_vertices(soup.mesh), "touching vertex set apart", "touching vertices set apart");

    std::vector<CgalMesh> parts;
    pmp::split_connected_components(soup.mesh, parts);
    size_t crossed = 0;
    for (CgalMesh& part : parts) crossed += remove_crossings(part, progress);
    notes.add(crossed, "part freed of crossings with itself", "parts freed of crossings with themselves");
    notes.add(unite(parts, progress), "overlap united", "overlaps united");

    CgalMesh whole;
    for (CgalMesh& part : parts) {
        part.collect_garbage();
        whole += part;
    }
    Surface surface = to_surface(source, whole);
    check_surface(surface, progress);
    const double outside = assign_source_faces_by_distance(source, surface, progress).outside;
    const bool may_lose_more = source.triangles.size() >= large_surface && surface.deviation <= max_deviation;
    if (outside > (may_lose_more ? max_lost : 0)) throw_tangled();  // within near_enough, it is 0
    surface.notes = "Repaired: " + notes.text() + ". " + describe_deviation(surface.deviation, outside);
    return surface;
}

}  // namespace partwheel
