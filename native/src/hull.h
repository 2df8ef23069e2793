// Convex hulls of clusters: built, united, measured. The inner loop of everything.
#pragma once

#include "geometry.h"

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace partwheel {

// The convex hull of some vertices of one mesh: exactly its extreme points, and its triangulated boundary. A flat set
// (all points in one plane) has no facets and volume 0; its `vertices` are all its points.
struct Hull {
    std::vector<int32_t> vertices;
    std::vector<Triangle> facets;      // outward; coplanar facets are possible
    std::vector<Triangle> neighbours;  // the facet across each facet's edge from corner k to corner k + 1
    std::vector<double> planes;        // five numbers a facet, each a block of facets.size(): see hull.cpp
    double volume = 0;
};

// Does the hull work on one array of points, with scratch memory that it keeps between calls: one kernel a thread.
// Results are exact in their combinatorics (exact predicates); volumes are rounded.
class HullKernel {
public:
    // points must outlive the kernel; their coordinates should be at most some 1e80 in size, and their differences,
    // where not 0, at least some 1e-80.
    explicit HullKernel(std::span<const Point> points);
    ~HullKernel();
    HullKernel(const HullKernel&) = delete;
    HullKernel& operator=(const HullKernel&) = delete;

    // conv of these vertices; repetitions are allowed.
    Hull build(std::span<const int32_t> vertices);

    // conv(a u b). The hulls' vertices suffice: conv(A u B) = conv(conv(A) u conv(B)).
    Hull unite(const Hull& a, const Hull& b);

    // The volume of conv(a u b), without building it where it can be had for less. What had to be built is kept for a
    // unite() of the same two objects that follows: they must not change in between.
    double united_volume(const Hull& a, const Hull& b);

    // The lower and upper corner of the hull's bounding box.
    std::pair<Point, Point> bounds(const Hull& hull) const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace partwheel
