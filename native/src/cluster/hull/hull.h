// Convex hulls of clusters: built, united, measured. The inner loop of everything.
//
// see.cpp finds the facets that a point sees, insert.cpp builds hulls by inserting points, measure.cpp finds the volume
// of a union, merge.cpp makes the union; view.h and vectors.h are what these share.
#pragma once

#include "base/geometry.h"
#include "base/memory.h"
#include "cluster/hull/pool.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

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

inline bool fewer_facets(const Hull& a, const Hull& b) { return a.facet_count() < b.facet_count(); }

struct FacetsView;

// Does the hull work on one array of points, with scratch memory that it keeps between calls: one kernel a thread.
// Results are exact in their combinatorics (exact predicates); volumes are rounded.
class HullKernel {
public:
    // The points' coordinates should be at most some 1e80 in size, and their differences, where not 0, at least some 1e-80.
    explicit HullKernel(std::span<const Point> points);

    // One point more: its number. forget() drops all from `count` on again; no hull made of such may be used after that.
    int32_t add(const Point& point) {
        points_.push_back({point});
        return static_cast<int32_t>(points_.size() - 1);
    }
    void forget(size_t count) {
        points_.resize(count);
        surveyed_ = nullptr;  // numbers will mean other points
    }
    size_t point_count() const { return points_.size(); }
    const Point& point(int32_t vertex) const { return at(vertex); }

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

    // Asks memory for the first of these points, ahead of use: more would take longer than they are waited for.
    void prefetch(std::span<const int32_t> points) const {
        for (const int32_t v : points.first(std::min(points.size(), size_t{8}))) prefetch_line(&at(v));
    }

    Box bounds(const Hull& hull) const;
    // Its vertices are the hull's, in the same order.
    TriangleMesh surface(const Hull& hull) const;

private:
    // A point that may be outside.
    struct Candidate {
        double volume6 = 0;  // six times what it alone adds to the hull, to rounding; infinity if not known
        int32_t vertex = 0;
    };

    // With what is noted of it, so that all comes from memory at once.
    struct alignas(32) Vertex {
        Point place;
        uint32_t mark = 0;        // stamp_: it is one of those in question
        int32_t facet_from = -1;  // the new facet whose rim edge starts here
    };

    struct RimEdge {
        int32_t from, to;
        int32_t beyond;  // the facet that stays
    };

    const Point& at(int32_t v) const { return points_[static_cast<size_t>(v)].place; }
    void mark(int32_t v) { points_[static_cast<size_t>(v)].mark = stamp_; }
    bool marked(int32_t v) const { return points_[static_cast<size_t>(v)].mark == stamp_; }
    void mark_corners() {  // of the hull at work, and no other vertex
        ++stamp_;
        for (size_t f = 0; f < count_; ++f)
            for (const int32_t v : facets_[f].corners) mark(v);
    }
    static FacetsView view(const Hull& hull);
    FacetsView view() const;  // of the hull at work
    int exact_side(const FacetsView& h, size_t f, int32_t vertex) const;
    void reserve(size_t facets) {  // for work on a hull of so many, and for one point more
        if (facets_.size() < 3 * facets + 3) [[unlikely]]
            make_room(facets);
    }
    void make_room(size_t facets);

    size_t walk(const FacetsView& h, const Point& p, size_t start);
    size_t find_seen(const FacetsView& h, const Point& p, int32_t vertex, size_t start);
    double flood(const FacetsView& h, size_t f, const Point& p, int32_t vertex);
    double see(const Point& p, int32_t vertex);
    double look(int32_t vertex);

    bool load_simplex(std::span<const int32_t> vertices);
    void make_plane(size_t f);
    void make_facets(std::span<const RimEdge> rim, const Point& p, int32_t vertex);
    void attach(int32_t vertex);
    void insert(int32_t vertex) {
        volume6_ += look(vertex);
        attach(vertex);
    }

    void survey(const Hull& hull, std::span<const int32_t> points);

    void load(const Hull& hull);
    void close_gaps();
    Hull unload(std::span<const int32_t> some, std::span<const int32_t> others);
    Hull allocate(std::span<const int32_t> vertices, size_t facets);

    LargeVector<Vertex> points_;
    Pool pool_;

    // The hull at work: its facets are in the first count_ places, but for the gaps.
    size_t count_ = 0;
    std::vector<double> x_, y_, z_, offset_, size_;
    std::vector<HullFacet> facets_;
    std::vector<uint32_t> gaps_;
    size_t latest_ = 0;  // one of them: the newest, if any has been made
    Point origin_{};
    double reach_ = 0;
    bool centred_ = false;
    double volume6_ = 0;

    // What the last survey found, of these arguments, in the order to insert them. The first inserted_ are in the hull at
    // work, if that is loaded_.
    const Hull::Block* surveyed_ = nullptr;
    std::vector<int32_t> surveyed_points_;
    std::vector<Candidate> candidates_;
    std::vector<int32_t> others_;  // scratch of survey()
    size_t inserted_ = 0;
    bool loaded_ = false;

    // Scratch.
    size_t seen_count_ = 0, rim_count_ = 0;
    std::vector<uint32_t> seen_;        // the facets that the last point flooded from sees
    std::vector<RimEdge> rim_;          // the edges around them
    std::vector<uint32_t> facet_mark_;  // facet_mark_[f] == facet_stamp_: f is one of those in question
    uint32_t facet_stamp_ = 0;
    uint32_t stamp_ = 0;  // of vertices, in the same manner
    std::vector<int32_t> vertices_;
    std::vector<int32_t> unloaded_;
};

// The surface of the hull of points, by a kernel of its own. Its vertices are the extreme ones, in their order.
TriangleMesh hull_of(std::span<const Point> points);

}  // namespace partwheel
