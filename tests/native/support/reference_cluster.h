// Listing 1 of the paper by brute force, written from the paper and from the cost rule that cluster.h states.
#pragma once

#include "cluster/cluster.h"

#include <map>
#include <optional>
#include <set>
#include <string>

namespace partwheel::test {

// Eq. 3 as cluster.h documents it, with what the rounding of volumes may do to the first term.
struct ReferenceCost {
    double rank = 0;  // the rounded concavity, 0 if convex
    double rank_low = 0, rank_high = 0;  // the least and the greatest it may be within the tolerance
    double balance = 0;
    int32_t low = 0, high = 0;
    long double volume = 0, hull_volume = 0;
    double tolerance = 0;  // of the concavity

    bool operator<(const ReferenceCost& other) const;  // the order of merges
};

// True if a comes before b however their volumes were rounded within the tolerance: 1e-12 of the hull's volume and
// 1e-14 of its bounding box's.
bool surely_before(const ReferenceCost& a, const ReferenceCost& b);

// The clusters and the candidate edges at one moment of Listing 1. Every hull is built by CGAL from all the vertices
// of the cluster, the cost of every edge of a new cluster is recomputed.
class ReferenceClustering {
public:
    explicit ReferenceClustering(const TetMesh& mesh);

    struct Candidate {
        int32_t left = 0, right = 0;  // clusters by their numbers, as in Merge
        ReferenceCost cost;
    };

    // The next merge; none at the end. Without dual edges, all pairs of clusters are candidates; of more than 64 clusters,
    // each and the 16 nearest to it.
    std::optional<Candidate> cheapest();
    const ReferenceCost* cost(int32_t left, int32_t right) const;  // null if the two are no candidate
    // True if no candidate surely comes before this one.
    bool is_a_cheapest(const ReferenceCost& cost) const;
    void merge(int32_t left, int32_t right);

    size_t components() const { return components_; }
    size_t hulls_built() const { return hulls_built_; }

private:
    struct Cluster {
        std::vector<int32_t> vertices;  // sorted
        double tetrahedra = 1;
        int32_t lowest = 0;
        long double volume = 0;
        std::set<int32_t> neighbors;
    };
    using Edge = std::pair<int32_t, int32_t>;

    void connect_components();
    double squared_box_distance(const std::vector<int32_t>& a, const std::vector<int32_t>& b) const;
    void add_edge(int32_t a, int32_t b);
    void remove_edge(int32_t a, int32_t b);
    Edge edge(int32_t a, int32_t b) const;
    ReferenceCost measure(const Cluster& a, const Cluster& b);

    const std::vector<Point>& points_;
    std::map<int32_t, Cluster> clusters_;
    std::map<Edge, ReferenceCost> costs_;
    struct Before {
        bool operator()(const std::pair<ReferenceCost, Edge>& a, const std::pair<ReferenceCost, Edge>& b) const {
            return a.first < b.first;
        }
    };
    std::set<std::pair<ReferenceCost, Edge>, Before> queue_;
    int32_t next_ = 0;
    size_t components_ = 0;
    size_t hulls_built_ = 0;
};

// The result of comparing the library's tree with the reference.
struct Comparison {
    size_t merges = 0;
    size_t parted = 0;    // merges that weren't the reference's first choice, but a cheapest within the tolerance
    std::string failure;  // the first merge that was wrong, else empty
};

Comparison compare_with_reference(const TetMesh& mesh, const BinaryTree& tree);

}  // namespace partwheel::test
