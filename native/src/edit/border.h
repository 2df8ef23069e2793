// Border snapping: moves the border of a set of faces to creases nearby, by a minimum cut in a band around it.
#pragma once

#include "base/adjacency.h"
#include "base/minimum_cut.h"
#include "mesh/surface.h"

namespace partwheel {

// The face adjacency graph of a surface with edge costs. Built once, used for any number of parts.
class Creases {
public:
    // face: the neighbor. begin, end: the edge as the face at hand traverses it; the neighbor traverses it in
    // reverse, unless is_inconsistent.
    struct Neighbor {
        int32_t face, begin, end;
        bool is_inconsistent;
    };

    // Throws an Error.
    explicit Creases(const MeshView& mesh, Progress& progress = unobserved_progress());

    // The part of `whole`, which must outlive this, that snap_border() needs for one part: faster than all of a large
    // surface. part: its faces, ascending.
    Creases(const Creases& whole, std::span<const int32_t> part);

    size_t count() const { return center_.size(); }
    double area(size_t face) const { return area_[face]; }
    double outside_area() const { return outside_area_; }  // of the whole surface's faces that are not here
    // For each face its number in the whole surface; empty if this is the whole surface.
    std::span<const int32_t> whole_faces() const { return whole_faces_; }
    std::span<const Neighbor> neighbors(size_t face) const { return neighbors_.row(face); }

    // The same without the edges, for traversals of the whole surface: half the memory traffic.
    std::span<const int32_t> neighbor_faces(size_t face) const { return neighbor_faces_.row(face); }

    // The distance from the center of the face to that of the edge.
    double center_to_edge(size_t face, const Neighbor& edge) const;

    // The cost of a border along the edge.
    double cost(size_t face, const Neighbor& edge) const;

private:
    void compute_face_geometry(const MeshView& mesh);
    void build_adjacency(const MeshView& mesh, Progress& progress);
    void list_neighbor_faces();

    std::vector<Point> own_points_, center_, normal_;
    std::span<const Point> points_;
    std::vector<double> area_;
    double volume_ = 0, outside_area_ = 0;
    bool is_inside_out_ = false;  // closed, with inward orientation
    CsrArray<Neighbor> neighbors_;
    CsrArray<int32_t> neighbor_faces_;  // of neighbors_
    std::vector<int32_t> whole_faces_;
};

// The faces around a part's border that may change sides. Each connected component of the part and of the rest has
// faces outside the band, which are connected without it, so no cut splits a component.
struct BorderBand : Cut {
    std::vector<int32_t> faces;  // the cut's nodes
};

// inside: of each face, not 0 if it is in the part. Throws an Error.
BorderBand build_border_band(const Creases& faces, std::span<const uint8_t> inside);

// As pw_creases_snap. Throws an Error.
void snap_border(const Creases& creases, std::span<const uint8_t> inside, std::span<uint8_t> result);

}  // namespace partwheel
