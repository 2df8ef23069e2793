// A hierarchy as a spatial index: point location, ray casting, nearest points, intersection of two indexes.
#pragma once

#include "base/predicates.h"
#include "query/tree.h"
#include "mesh/rays.h"
#include "mesh/surface.h"
#include "tree/hierarchy.h"

namespace partwheel {

struct NearestPart {
    int32_t part = -1;
    double distance = 0;
    Point point{};
};

// A part of each index and a common point; -1 if the two are disjoint.
struct IntersectingParts {
    std::array<int32_t, 2> parts{-1, -1};
    Point point{};
};

// Convex bodies: the tetrahedra, or the hulls of the parts of a cut. The surface: their boundary facets, or the hulls'
// facets. Immutable; does not refer to the hierarchy. pw_index_* document the queries.
class PartIndex {
public:
    // bounds: of a cut; empty: the tetrahedra. Throws Error(PW_ERROR_ARGUMENT) for bounds of no cut.
    PartIndex(const Hierarchy& hierarchy, std::span<const int32_t> bounds, Progress& progress = unobserved_progress());

    int32_t locate(const Point& p) const;
    RayHit first_hit(const Point& origin, const Point& direction) const;  // .triangle is a part
    NearestPart nearest(const Point& p) const;
    // matrix: takes the other index to this one; invertible.
    IntersectingParts intersect(const PartIndex& other, const Affine& matrix) const;

private:
    class IntersectionTest;

    // The corners of the hull of a group or merge, by coordinate, padded to pairs. The first coarse_count are spread
    // over the hull: they are usually enough to see that two hulls are not separated.
    struct SupportMap {
        static constexpr size_t coarse_count = 64;
        std::array<std::vector<double>, 3> coordinates;
        Point center{};
        double size = 0;

        explicit SupportMap(std::span<const Point> points);
        Point support_point(const Point& axis, bool use_all) const;
    };

    void set_tetrahedra(const Hierarchy& hierarchy);
    void set_hulls(const Hierarchy& hierarchy, std::span<const int32_t> bounds, Progress& progress);
    void build_trees(const index::TopLevels& top, Progress& progress);

    template <class Visit>
    bool all_sides(int32_t body, const Visit& visit) const;
    template <class Place>
    int32_t locate(const Point& p, const Box& near, bool is_mirrored, const Place& place) const;

    Frame frame_;
    std::vector<Point> vertices_, working_;  // in the caller's coordinates, and in working ones
    std::vector<Tetrahedron> tetrahedra_;    // the bodies; or empty, if they are hulls:
    std::vector<Triangle> sides_;
    std::vector<int32_t> side_begin_;
    index::PartBvh bodies_, surface_;

    // The surface, in the order of surface_.
    std::vector<Triangle> facets_;
    std::vector<std::array<Point, 3>> corners_;  // in working coordinates
    std::vector<int32_t> body_;

    std::vector<SupportMap> support_maps_;          // of each group and merge of surface_, in working coordinates

    struct Component {
        int32_t vertex, body;  // any of each connected component of the bodies
    };
    std::vector<Component> components_;
};

// Whether visit returns true for all facets of a body, oriented outward. Stops at the first false.
template <class Visit>
bool PartIndex::all_sides(int32_t body, const Visit& visit) const {
    if (tetrahedra_.empty())
        return std::all_of(sides_.begin() + side_begin_[idx(body)], sides_.begin() + side_begin_[idx(body + 1)], visit);
    for (size_t k = 0; k < 4; ++k)
        if (!visit(facet(tetrahedra_[idx(body)], k))) return false;
    return true;
}

// near: a box around p in working coordinates. place(v): position of a vertex in p's coordinates. is_mirrored: place()
// reverses orientation.
template <class Place>
int32_t PartIndex::locate(const Point& p, const Box& near, bool is_mirrored, const Place& place) const {
    int32_t lowest = -1;
    if (!near.overlaps(bodies_.root.box)) return lowest;
    constexpr double overlapping = 0;
    const auto distance = [&](const index::Node& node, size_t side) {
        bool in = true;
        for (size_t k = 0; k < 3; ++k) in &= node.low[k][side] <= near.high[k] && near.low[k] <= node.high[k][side];
        return in ? overlapping : HUGE_VAL;
    };
    bodies_.nearest_first(distance, overlapping, [&](size_t i) {
        const int32_t body = bodies_.order[i];
        if (lowest >= 0 && lowest < body) return;
        bool has_sides = false;  // a flat hull has none
        const bool inside = all_sides(body, [&](const Triangle& t) {
            has_sides = true;
            const int side = orientation(place(t[0]), place(t[1]), place(t[2]), p);
            return is_mirrored ? side >= 0 : side <= 0;
        });
        if (has_sides && inside) lowest = body;
    });
    return lowest;
}

}  // namespace partwheel
