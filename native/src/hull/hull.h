// Exact convex hulls of clusters: construction, unions, volumes. Clustering spends most of its time here.
//
// visible.cpp finds the facets visible from a point, insert.cpp builds hulls by inserting points, measure.cpp
// computes the volume of a union's hull, merge.cpp builds that hull; all of them use view.h and vectors.h.
#pragma once

#include "base/geometry.h"
#include "base/memory.h"
#include "base/progress.h"
#include "hull/pool.h"

#include <memory>

namespace partwheel {

struct HullFacet {
    Triangle corners;     // counter-clockwise seen from outside; facets may be coplanar
    Triangle neighbors;  // [k]: the facet across the edge from corner k to corner k + 1
};

// The convex hull of some vertices of one mesh: exactly its extreme points, and its triangulated boundary. A coplanar
// set has no facets and volume 0; its vertices are all its points. Immutable. The HullKernel that made it must
// outlive it.
class Hull {
public:
    explicit operator bool() const { return block_ != nullptr; }
    std::span<const int32_t> vertices() const;  // ascending
    std::span<const HullFacet> facets() const;
    size_t facet_count() const { return block_ ? block_->facet_count : 0; }
    // Prefetches the first 512 bytes.
    void prefetch() const {
        const auto begin = reinterpret_cast<uintptr_t>(block_.get());
        for (uintptr_t i = 0; i < 512; i += 64) prefetch_line(reinterpret_cast<const void*>(begin + i));
    }
    double volume() const { return block_ ? block_->volume : 0; }

private:
    friend class HullKernel;

    // The header of one memory block. After it: the vertices, padded to a multiple of 4; the planes, five arrays with
    // one double per facet; and the facets.
    struct alignas(64) Block {
        uint32_t vertex_count, facet_count;
        double volume;
        Point origin;           // planes are relative to it, which keeps their coefficients small
        double radius;          // of the vertices around the origin, in the maximum norm
        bool origin_is_inside;  // certainly, in spite of rounding
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

inline bool has_fewer_facets(const Hull& a, const Hull& b) { return a.facet_count() < b.facet_count(); }

struct FacetsView;

// Hull computations on one array of points. It keeps scratch memory between calls, so use one kernel per thread.
// The combinatorics are exact (exact predicates); volumes are rounded.
class HullKernel {
public:
    // Coordinates should be at most about 1e80 in magnitude, and nonzero differences at least about 1e-80. All calls
    // check the progress for cancellation; after Error(PW_ERROR_CANCELED) the kernel can only be destroyed.
    explicit HullKernel(std::span<const Point> points, Progress& progress = unobserved_progress());

    // Appends a point and returns its index. forget() drops all points from `count` on; hulls that use them become
    // invalid.
    int32_t add(const Point& point) {
        points_.push_back({point});
        return static_cast<int32_t>(points_.size() - 1);
    }
    // Appends those points of another kernel that have no index here yet.
    void copy_points(const HullKernel& from) {
        for (size_t i = points_.size(); i < from.points_.size(); ++i) points_.push_back({from.points_[i].place});
    }
    void forget(size_t count) {
        points_.resize(count);
        candidates_hull_ = nullptr;  // indices will refer to other points
    }
    size_t point_count() const { return points_.size(); }
    size_t facet_visits() const { return facet_visits_; }  // by all calls so far
    const Point& point(int32_t vertex) const { return at(vertex); }

    // conv(vertices); duplicates are allowed.
    Hull build(std::span<const int32_t> vertices);

    // conv(hull u points), with points as vertex indices. For hulls: conv(A u B) = conv(A u vertices of conv(B)).
    Hull unite(const Hull& hull, std::span<const int32_t> points);
    Hull unite(const Hull& a, const Hull& b) {
        const auto [small, large] = std::minmax(a, b, has_fewer_facets);
        return unite(large, small.vertices());
    }

    struct VolumeBound {
        double volume;
        bool exact;  // otherwise volume is a lower bound
    };

    // The volume of conv(hull u points), usually without building that hull. Once the volume is known to exceed
    // early_out_volume, returns a lower bound above it. The state is kept for a following unite() of the same
    // arguments.
    VolumeBound union_volume(const Hull& hull, std::span<const int32_t> points,
                          double early_out_volume = std::numeric_limits<double>::infinity());

    // Prefetches the first of these points; prefetching more costs more than it gains.
    void prefetch(std::span<const int32_t> points) const {
        for (const int32_t v : points.first(std::min(points.size(), size_t{8}))) prefetch_line(&at(v));
    }

    Box bounds(const Hull& hull) const;
    // A mesh with the hull's vertices, in the same order.
    TriangleMesh surface(const Hull& hull) const;

private:
    // A point that may lie outside the hull.
    struct Candidate {
        double volume6 = 0;  // six times the volume that this point alone adds to the hull; infinity if unknown
        int32_t vertex = 0;
    };

    // A point and its scratch data, on one cache line.
    struct alignas(32) Vertex {
        Point place;
        uint32_t mark = 0;        // equals stamp_ if the vertex is marked
        int32_t facet_from = -1;  // the new facet whose horizon edge starts here
    };

    struct HorizonEdge {
        int32_t from, to;
        int32_t beyond;  // the facet on the far side, which stays
    };

    const Point& at(int32_t v) const { return points_[static_cast<size_t>(v)].place; }
    void mark(int32_t v) { points_[static_cast<size_t>(v)].mark = stamp_; }
    bool is_marked(int32_t v) const { return points_[static_cast<size_t>(v)].mark == stamp_; }
    void mark_corners() {  // marks the vertices of the loaded hull and no others
        ++stamp_;
        for (size_t f = 0; f < count_; ++f)
            for (const int32_t v : facets_[f].corners) mark(v);
    }
    static FacetsView view(const Hull& hull);
    FacetsView view() const;  // the loaded hull
    int exact_side(const FacetsView& h, size_t f, int32_t vertex) const;
    void reserve(size_t facets) {  // scratch for a hull with this many facets and one insertion
        if (facets_.size() < 3 * facets + 3) [[unlikely]]
            grow_scratch(facets);
    }
    void grow_scratch(size_t facets);

    int side_of_edge(const FacetsView& h, int32_t from, int32_t to, int32_t vertex) const;
    size_t walk_to_visible_facet(const FacetsView& h, const Point& p, size_t& f);
    size_t walk_along_ray(const FacetsView& h, int32_t vertex, size_t start);
    size_t find_visible_facet(const FacetsView& h, const Point& p, int32_t vertex, size_t start);
    bool grow_visible_region(const FacetsView& h, size_t f, const Point& p, int32_t vertex, int least_side, size_t max_coplanar,
                             double& volume);
    double find_visible_region(const FacetsView& h, size_t f, const Point& p, int32_t vertex);
    bool add_coplanar_facets(const FacetsView& h, const Point& p, int32_t vertex);
    double find_visible_in_bitset(const Point& p, int32_t vertex);
    double find_visible(int32_t vertex);

    bool load_simplex(std::span<const int32_t> vertices);
    void compute_planes(size_t f, size_t g);
    void move_origin_inside();
    static void spread_out(std::span<int32_t> vertices);
    void replace_visible_facets(int32_t vertex);
    void count_visits(size_t facets) {
        facet_visits_ += facets;
        if (facet_visits_ < next_poll_) [[likely]]
            return;
        next_poll_ = facet_visits_ + visits_between_polls;
        progress_.reach(0);
    }
    void insert(int32_t vertex) {
        volume6_ += find_visible(vertex);
        replace_visible_facets(vertex);
    }

    void collect_candidates(const Hull& hull, std::span<const int32_t> points);

    void load(const Hull& hull);
    void compact_facets();
    Hull unload(std::span<const int32_t> first, std::vector<int32_t>& second);
    Hull allocate(std::span<const int32_t> vertices, size_t facets);

    static constexpr size_t visits_between_polls = 1 << 18;  // some ms

    LargeVector<Vertex> points_;
    Pool pool_;
    Progress& progress_;
    size_t facet_visits_ = 0, next_poll_ = visits_between_polls;

    // The loaded hull, which insertion modifies: its facets are the first count_ entries, except for free_facets_.
    size_t count_ = 0;
    std::vector<double> x_, y_, z_, offset_, size_;
    std::vector<HullFacet> facets_;
    std::vector<uint32_t> free_facets_;
    size_t newest_facet_ = 0;  // where the next search starts
    size_t innermost_facet_ = 0;  // near the last point, if that was inside; may be free or of another hull
    Point origin_{};
    double radius_ = 0;
    bool origin_is_inside_ = false;
    double volume6_ = 0;

    // The result of the last collect_candidates() and its arguments, in insertion order. If loaded_, the first
    // inserted_count_ are already part of the loaded hull.
    const Hull::Block* candidates_hull_ = nullptr;
    std::vector<int32_t> candidates_points_;
    std::vector<Candidate> candidates_;
    std::vector<int32_t> untested_;  // scratch of collect_candidates()
    size_t inserted_count_ = 0;
    bool loaded_ = false;

    // Scratch.
    size_t visible_count_ = 0, horizon_count_ = 0;
    std::vector<uint32_t> visible_;      // the facets visible from the last point
    std::vector<HorizonEdge> horizon_;   // the edges around them
    std::vector<uint32_t> facet_mark_;   // equals facet_stamp_ if the facet is marked
    uint32_t facet_stamp_ = 0;
    uint32_t stamp_ = 0;  // for vertices
    std::vector<int32_t> vertices_;
    std::vector<int32_t> unloaded_;
};

// The convex hull of points as a mesh. Its vertices are the extreme points, in their order.
TriangleMesh convex_hull(std::span<const Point> points, Progress& progress = unobserved_progress());

}  // namespace partwheel
