// Convex hulls of clusters: built, united, measured. The inner loop of everything.
#pragma once

#include "base/geometry.h"
#include "base/prefetch.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>

namespace partwheel {

struct HullFacet {
    Triangle corners;     // outward; facets may be coplanar
    Triangle neighbours;  // the facet across the edge from corner k to corner k + 1
};

// The convex hull of some vertices of one mesh: exactly its extreme points, and its triangulated boundary. A flat set
// (all points in one plane) has no facets and volume 0; its vertices are all its points. Made by a HullKernel, which it
// must not outlive; never changes.
class Hull {
public:
    explicit operator bool() const { return block_ != nullptr; }
    std::span<const int32_t> vertices() const;  // in rising order
    std::span<const HullFacet> facets() const;
    size_t facet_count() const { return block_ ? block_->facet_count : 0; }
    // Its first part, ahead of use; it may be shorter.
    void prefetch() const {
        const auto begin = reinterpret_cast<uintptr_t>(block_.get());
        for (uintptr_t i = 0; i < 512; i += 64) prefetch_line(reinterpret_cast<const void*>(begin + i));
    }
    double volume() const { return block_ ? block_->volume : 0; }

private:
    friend class HullKernel;
    class Pool;

    // The head of one block of memory: after it come the vertices, filled up to whole fours; the planes, five numbers a
    // facet, each an array; and the facets.
    struct alignas(64) Block {
        uint32_t vertex_count, facet_count;
        double volume;
        Point origin;  // a point inside, near which the numbers of the planes are small
        double reach;  // of the vertices, from there
        bool centred;  // the origin is surely inside
        Pool* pool;

        static size_t bytes(size_t vertices, size_t facets);
        int32_t* vertices();
        double* planes();
        HullFacet* facets();
    };
    struct Release {
        void operator()(Block* block) const;
    };
    std::unique_ptr<Block, Release> block_;
};

// Does the hull work on one array of points, with scratch memory that it keeps between calls: one kernel a thread.
// Results are exact in their combinatorics (exact predicates); volumes are rounded.
class HullKernel {
public:
    // The points' coordinates should be at most some 1e80 in size, and their differences, where not 0, at least some 1e-80.
    explicit HullKernel(std::span<const Point> points);
    ~HullKernel();
    HullKernel(const HullKernel&) = delete;
    HullKernel& operator=(const HullKernel&) = delete;

    // conv of these vertices; repetitions are allowed.
    Hull build(std::span<const int32_t> vertices);

    // conv(hull u points), points being numbers of vertices. For hulls: conv(A u B) = conv(A u vertices of conv(B)).
    Hull unite(const Hull& hull, std::span<const int32_t> points);

    struct Measure {
        double volume;
        bool exact;  // else it is a lower bound
    };

    // The volume of conv(hull u points), without building it where it can be had for less; or, once it is seen to be
    // more than enough, a lower bound above enough. What had to be built is kept for a unite() of the same arguments
    // that follows.
    Measure united_volume(const Hull& hull, std::span<const int32_t> points,
                          double enough = std::numeric_limits<double>::infinity());

    // Asks memory for the first of these points, ahead of use.
    void prefetch(std::span<const int32_t> points) const;

    // The lower and upper corner of the hull's bounding box.
    std::pair<Point, Point> bounds(const Hull& hull) const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace partwheel
