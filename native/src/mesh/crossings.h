// Pairs of triangles that intersect anywhere but in shared corners and edges.
#pragma once

#include "base/geometry.h"
#include "base/progress.h"

namespace partwheel {

// A tree of bounds over triangles in the order of a space-filling curve. The bounds of all triangles around a vertex or
// an edge overlap, so fans of many triangles are also compared by their directions from there: n triangles take about n
// log n steps, not n^2.
class CrossingSearch {
public:
    // Both arrays must outlive the search.
    CrossingSearch(std::span<const Point> vertices, std::span<const Triangle> triangles);

    // Calls visit(t, u) for each pair that intersects, until visit returns false. Vertices are shared by index, not by
    // position. Throws Error(PW_ERROR_SELF_INTERSECTION) after max_steps() steps.
    using Visit = std::function<bool(size_t, size_t)>;
    void for_each_crossing(Progress& progress, const Visit& visit);

    // Pairs of nodes that were compared.
    size_t steps() const { return steps_; }
    size_t max_steps() const;

private:
    // What the triangles of a fan share: a vertex, or an edge, its lower vertex first.
    using Center = std::array<int32_t, 2>;
    static constexpr Center no_center{-1, -1};

    struct Node {
        Bounds<9> bounds;  // along the axes and the diagonals between each two of them
        Center center = no_center;
        // Contains the directions from the center to all points of the triangles; from an edge, at right angles to it.
        Box directions;
    };
    struct Place {
        size_t level, index;
    };

    std::vector<Center> find_centers() const;
    Node leaf(const Triangle& triangle, const Center& center) const;
    // Both call visit(t, u) for triangles that may intersect. They return whether to go on.
    bool compare_within(Place place, Progress& progress, const Visit& visit);
    bool compare(Place a, Place b, Progress& progress, const Visit& visit);

    std::span<const Point> vertices_;
    std::span<const Triangle> triangles_;
    std::vector<size_t> order_;              // of the triangles along the curve
    std::vector<std::vector<Node>> levels_;  // the first of triangles, each other of pairs of the previous one
    size_t steps_ = 0;
};

}  // namespace partwheel
