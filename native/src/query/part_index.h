// A hierarchy as an index: which part holds a point, which a ray meets first, which is nearest, where two touch.
#pragma once

#include "base/predicates.h"
#include "query/tree.h"
#include "query/rays.h"
#include "mesh/surface.h"
#include "tree/hierarchy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace partwheel {

struct NearestPart {
    int32_t part = -1;
    double distance = 0;
    Point point{};
};

// Of the first one's parts and the second's, and a point that they share; -1 if they don't touch.
struct IntersectingParts {
    std::array<int32_t, 2> parts{-1, -1};
    Point point{};
};

// Bodies with a surface: the tetrahedra and their outer facets, or the hulls of a cut's parts. Never changes, and keeps
// nothing of the hierarchy. pw_index_* document the questions.
class PartIndex {
public:
    // bounds: of a cut; none: the tetrahedra. Throws Error(PW_ERROR_ARGUMENT) for bounds that no cut has.
    PartIndex(const Hierarchy& hierarchy, std::span<const int32_t> bounds, Progress& progress = unwatched());

    int32_t locate(const Point& p) const;
    RayHit first(const Point& origin, const Point& direction) const;  // the hit's triangle is a part
    NearestPart nearest(const Point& p) const;
    // With the other one moved by the matrix, which has an inverse.
    IntersectingParts touching(const PartIndex& other, const Affine& matrix) const;

private:
    class Pair;
    struct Sent;
    struct Sought;

    // The corners of a group's or a join's hull, coordinate after coordinate, in whole pairs; first a few from all over it, which
    // mostly tell that it is not apart from another.
    struct SupportMap {
        static constexpr size_t few = 64;
        std::array<std::vector<double>, 3> along;
        Point middle{};
        double size = 0;

        explicit SupportMap(std::span<const Point> points);
        Point farthest(const Point& axis, bool all) const;
    };

    void take_tetrahedra(const Hierarchy& hierarchy);
    void take_hulls(const Hierarchy& hierarchy, std::span<const int32_t> bounds, Progress& progress);
    void plant(const index::Top& top, Progress& progress);

    template <class Visit>
    bool sides_of(int32_t body, const Visit& visit) const;
    template <class Place>
    int32_t locate(const Point& p, const Box& near, bool turned, const Place& place) const;

    Frame frame_;
    std::vector<Point> vertices_, working_;  // the caller's, and in the frame
    std::vector<Tetrahedron> tetrahedra_;    // the bodies; or none, and their sides, body after body:
    std::vector<Triangle> sides_;
    std::vector<int32_t> side_begin_;
    index::Tree bodies_, surface_;

    // The surface, in the order of its tree.
    std::vector<Triangle> facets_;
    std::vector<std::array<Point, 3>> corners_;  // working
    std::vector<int32_t> body_;

    std::vector<SupportMap> clouds_;          // of each group and join of the surface; working

    struct Piece {
        int32_t vertex, body;  // one of each
    };
    std::vector<Piece> pieces_;  // of the bodies, that hang together
};

// Calls visit for each side, outwards, until one says no; whether none did.
template <class Visit>
bool PartIndex::sides_of(int32_t body, const Visit& visit) const {
    if (tetrahedra_.empty())
        return std::all_of(sides_.begin() + side_begin_[idx(body)], sides_.begin() + side_begin_[idx(body + 1)], visit);
    for (size_t k = 0; k < 4; ++k)
        if (!visit(facet(tetrahedra_[idx(body)], k))) return false;
    return true;
}

// near: what p is in, in the frame. place: of a vertex, where p is given. turned: places are mirrored.
template <class Place>
int32_t PartIndex::locate(const Point& p, const Box& near, bool turned, const Place& place) const {
    int32_t lowest = -1;
    const auto look = [&](const auto& self, int32_t child, int32_t count) -> void {
        if (count > 0) {
            for (auto i = idx(child); i < idx(child + count); ++i) {
                const int32_t body = bodies_.order[i];
                if (lowest >= 0 && lowest < body) continue;
                bool has_sides = false;  // the hull of what lies in a plane has none
                const bool inside = sides_of(body, [&](const Triangle& t) {
                    has_sides = true;
                    const int side = orientation(place(t[0]), place(t[1]), place(t[2]), p);
                    return turned ? side >= 0 : side <= 0;
                });
                if (has_sides && inside) lowest = body;
            }
            return;
        }
        const index::Node& node = bodies_.nodes[idx(child)];
        for (size_t side = 0; side < 2; ++side) {
            bool in = true;
            for (size_t k = 0; k < 3; ++k) in &= node.low[k][side] <= near.high[k] && near.low[k] <= node.high[k][side];
            if (in) self(self, node.child[side], node.count[side]);
        }
    };
    const Box& all = bodies_.root.box;
    for (size_t k = 0; k < 3; ++k)
        if (near.low[k] > all.high[k] || near.high[k] < all.low[k]) return -1;
    look(look, bodies_.root.child, bodies_.root.count);
    return lowest;
}

}  // namespace partwheel
