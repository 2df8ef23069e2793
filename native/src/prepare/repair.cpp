// The second fill method: the source repaired, its crossing parts united.
#include "prepare/repair.h"

#include "mesh/face_assignment.h"
#include "prepare/soup_repair.h"

#include <CGAL/Polygon_mesh_processing/compute_normal.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/intersection.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>

#include <boost/iterator/function_output_iterator.hpp>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace partwheel {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Face = CgalMesh::Face_index;
using Vertex = CgalMesh::Vertex_index;

// If more of a part's faces than this cross others, removing them and filling the holes would invent a surface.
constexpr double max_crossing_share = 0.1;

// The time for both grows faster than the mesh. Above these limits the next fill method is faster.
constexpr size_t max_crossing_faces = 5000;       // of a part
constexpr size_t max_compared_faces = 2000000;  // of all pairs of parts that are compared

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
            moves.emplace_back(v, place - inward_shift * shortest * pmp::compute_vertex_normal(v, mesh));
        }
    }
    for (const auto& [v, place] : moves) mesh.point(v) = place;
    return moves.size();
}

// Polls for cancellation while CGAL removes crossings, and gives up above the limits.
class CrossingVisitor : public pmp::experimental::Remove_self_intersection_default_visitor<CgalMesh> {
public:
    CrossingVisitor(const CgalMesh& mesh, Progress& progress) : faces_(mesh.number_of_faces()), progress_(&progress) {}
    template <class Faces>
    void status_update(const Faces& crossed) {
        progress_->advance(0.2);
        if (crossed.size() > max_crossing_faces ||
            static_cast<double>(crossed.size()) > max_crossing_share * static_cast<double>(faces_))
            throw_tangled();
    }

private:
    size_t faces_;
    Progress* progress_;
};

// Removes a part's crossings with itself: deletes the crossing faces and fills the holes. Returns whether there were
// any.
bool remove_crossings(CgalMesh& mesh, Progress& progress) {
    if (!pmp::does_self_intersect(mesh)) return false;
    // So many pairs are of more than max_crossing_faces faces: then they need not all be found.
    constexpr size_t max_pairs = max_crossing_faces * max_crossing_faces / 2;
    size_t pairs = 0;
    pmp::self_intersections<CGAL::Sequential_tag>(mesh, boost::make_function_output_iterator([&](const auto&) { ++pairs; }),
                                                  CGAL::parameters::maximum_number(max_pairs + 1));
    if (pairs > max_pairs) throw_tangled();
    pmp::remove_degenerate_faces(mesh);
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
            progress.advance(0.2 + 0.4 * static_cast<double>(i) / static_cast<double>(parts.size()));
            if (parts[j].is_empty() || !CGAL::do_overlap(boxes[i], boxes[j])) continue;
            compared += parts[i].number_of_faces() + parts[j].number_of_faces();
            if (compared > max_compared_faces) throw_tangled();
            if (!pmp::do_intersect(parts[i], parts[j])) continue;
            if (pmp::volume(parts[i]) <= 0 || pmp::volume(parts[j]) <= 0) throw_tangled();
            if (pmp::does_self_intersect(parts[i]) || pmp::does_self_intersect(parts[j])) throw_tangled();
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

// A sentence on how far the mesh is from the surface used. Nothing of the mesh is farther than near_enough outside of
// it.
std::string describe_deviation(double deviation) {
    if (deviation == 0) return "All of the mesh is on the surface used.";
    if (deviation <= near_enough) return at_most_away(deviation) + ".";
    return at_most_away(near_enough) + ", but up to " + percent(deviation) + " from what of the mesh is now inside.";
}

}  // namespace

Surface repair(const Surface& source, Progress& progress) {
    RepairedSoup soup = repair_soup(source, progress);
    if (soup.solids == 0)
        throw Error(PW_ERROR_OPEN, "The mesh has no part that can be closed. Give it a thickness (Solidify).");
    NoteList notes;
    soup.counts.add_to(notes);
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
    if (assign_source_faces_by_distance(source, surface, progress).outside > 0) throw_tangled();  // something was lost
    surface.notes = "Repaired: " + notes.text() + ". " + describe_deviation(surface.deviation);
    return surface;
}

}  // namespace partwheel
