// The second fill method: the source mended, its crossing parts united.
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

// With a larger share of a part's faces crossing others, taking them out and filling the holes would invent a surface.
constexpr double largest_crossed_share = 0.1;

// Both of these take time that grows faster than the mesh: beyond so much the next fill method is quicker.
constexpr size_t most_crossed = 5000;          // faces of a part
constexpr size_t most_faces_united = 2000000;  // of parts that are compared, each time they are

[[noreturn]] void throw_tangled() {
    throw Error(PW_ERROR_SELF_INTERSECTION,
                "The surface passes through itself in ways that can't be repaired. Remesh it, or unite its parts with "
                "a Boolean.");
}

// Sheets have no inside: their faces go with whatever solid part is near.
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

// Where parts touch at a vertex or an edge, each has vertices of its own, at the same place: they are set apart.
size_t set_apart(CgalMesh& mesh) {
    std::map<CgalKernel::Point_3, std::vector<Vertex>> places;
    for (const Vertex v : mesh.vertices()) places[mesh.point(v)].push_back(v);
    std::vector<std::pair<Vertex, CgalKernel::Point_3>> moves;
    for (const auto& [place, group] : places) {
        if (group.size() < 2) continue;
        for (const Vertex v : group) {
            double shortest = HUGE_VAL;
            for (const auto h : CGAL::halfedges_around_target(v, mesh))
                shortest = std::min(shortest, pmp::edge_length(h, mesh));
            moves.emplace_back(v, place - nudge * shortest * pmp::compute_vertex_normal(v, mesh));
        }
    }
    for (const auto& [v, place] : moves) mesh.point(v) = place;
    return moves.size();
}

class CrossingWatcher : public pmp::experimental::Remove_self_intersection_default_visitor<CgalMesh> {
public:
    CrossingWatcher(const CgalMesh& mesh, Progress& progress) : faces_(mesh.number_of_faces()), progress_(&progress) {}
    template <class Faces>
    void status_update(const Faces& crossed) {
        progress_->advance(0.2);
        if (crossed.size() > most_crossed ||
            static_cast<double>(crossed.size()) > largest_crossed_share * static_cast<double>(faces_))
            throw_tangled();
    }

private:
    size_t faces_;
    Progress* progress_;
};

// A part's crossings with itself: faces taken out, and the holes filled.
bool uncross(CgalMesh& mesh, Progress& progress) {
    if (!pmp::does_self_intersect(mesh)) return false;
    // So many pairs are of more than most_crossed faces: then they need not all be found.
    constexpr size_t most_pairs = most_crossed * most_crossed / 2;
    size_t pairs = 0;
    pmp::self_intersections<CGAL::Sequential_tag>(mesh, boost::make_function_output_iterator([&](const auto&) { ++pairs; }),
                                                  CGAL::parameters::maximum_number(most_pairs + 1));
    if (pairs > most_pairs) throw_tangled();
    pmp::remove_degenerate_faces(mesh);
    pmp::experimental::remove_self_intersections(
        mesh, CGAL::parameters::preserve_genus(false).visitor(CrossingWatcher(mesh, progress)));
    return true;
}

// Parts whose boxes meet, found once; a part that was united with another has a larger box, and is a neighbor of all.
class PartNeighbors {
public:
    explicit PartNeighbors(const std::vector<CGAL::Bbox_3>& boxes) : lower_(boxes.size()) {
        using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, size_t>;
        std::vector<Box> all;
        for (const CGAL::Bbox_3& box : boxes) all.emplace_back(box, all.size());
        size_t pairs = 0;
        CGAL::box_self_intersection_d(all.begin(), all.end(), [&](const Box& a, const Box& b) {
            if (++pairs > most_faces_united) throw_tangled();  // as comparing their faces would
            lower_[std::max(a.info(), b.info())].push_back(std::min(a.info(), b.info()));
        });
        for (std::vector<size_t>& each : lower_) std::ranges::sort(each);
    }

    void has_grown(size_t part) { grown_.insert(part); }

    // The first from j on, and below i, whose box may meet that of i; or i.
    size_t next(size_t i, size_t j) const {
        if (j >= i || grown_.contains(i)) return std::min(i, j);
        const auto met = std::ranges::lower_bound(lower_[i], j);
        const auto grown = grown_.lower_bound(j);
        return std::min({i, met == lower_[i].end() ? i : *met, grown == grown_.end() ? i : *grown});
    }

private:
    std::vector<std::vector<size_t>> lower_;  // of each part, those before it
    std::set<size_t> grown_;
};

// The union of the parts that cross each other. Parts that don't are left alone, also where one holds another.
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
            if (compared > most_faces_united) throw_tangled();
            if (!pmp::do_intersect(parts[i], parts[j])) continue;
            if (pmp::volume(parts[i]) <= 0 || pmp::volume(parts[j]) <= 0) throw_tangled();
            if (pmp::does_self_intersect(parts[i]) || pmp::does_self_intersect(parts[j])) throw_tangled();
            CgalMesh both;
            if (!pmp::corefine_and_compute_union(parts[i], parts[j], both)) throw_tangled();
            parts[i] = std::move(both);
            parts[j].clear();
            boxes[i] = boxes[i] + boxes[j];
            neighbors.has_grown(i);
            ++united;
            j = static_cast<size_t>(-1);  // the union may cross parts that i did not
        }
    return united;
}

// How far the mesh is from the surface used, of which nothing reaches out by more than near_enough.
std::string how_far(double deviation) {
    if (deviation == 0) return "All of the mesh is on the surface used.";
    if (deviation <= near_enough) return at_most_away(deviation) + ".";
    return at_most_away(near_enough) + ", but up to " + percent(deviation) + " from what of the mesh is now inside.";
}

}  // namespace

Surface repair(const Surface& source, Progress& progress) {
    RepairedSoup mended = repair_soup(source, progress);
    if (mended.solids == 0)
        throw Error(PW_ERROR_OPEN, "The mesh has no part that can be closed. Give it a thickness (Solidify).");
    Account account;
    mended.done.tell(account);
    if (mended.sheets) account.add(drop_sheets(mended.mesh), "loose sheet left out", "loose sheets left out");
    account.add(set_apart(mended.mesh), "touching vertex set apart", "touching vertices set apart");

    std::vector<CgalMesh> parts;
    pmp::split_connected_components(mended.mesh, parts);
    size_t crossed = 0;
    for (CgalMesh& part : parts) crossed += uncross(part, progress);
    account.add(crossed, "part freed of crossings with itself", "parts freed of crossings with themselves");
    account.add(unite(parts, progress), "overlap united", "overlaps united");

    CgalMesh whole;
    for (CgalMesh& part : parts) {
        part.collect_garbage();
        whole += part;
    }
    Surface surface = to_surface(source, whole);
    check_surface(surface, progress);
    if (assign_source_faces_by_distance(source, surface, progress).outside > 0) throw_tangled();  // something was lost
    surface.account = "Repaired: " + account.text() + ". " + how_far(surface.deviation);
    return surface;
}

}  // namespace partwheel
