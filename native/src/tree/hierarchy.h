// The finished, immutable hierarchy: flat arrays, queries, saving and loading.
#pragma once

#include "partwheel.h"
#include "tree/dendrogram.h"
#include "parts/merge/merge_policy.h"
#include "tree/saved.h"

namespace partwheel {

constexpr size_t max_parts = 4096;  // of a cut, and convex ones: as the C API promises

struct ShellHierarchy;

// See pw_arrays and pw_hierarchy_*; api.cpp checks the arguments.
class Hierarchy {
public:
    // scored_tree: the tree and scores of merge_parts(), or the paper's tree without scores. caller_vertices: in the
    // caller's coordinates.
    Hierarchy(const Surface& surface, const TetMesh& mesh, const ScoredTree& scored_tree,
              std::span<const Point> caller_vertices);

    // data: valid, see SavedHierarchy::check(). merges: their hull volumes are not used.
    Hierarchy(HierarchyData data, std::vector<Merge> merges);

    // The hierarchy of an assembly: its shells' hierarchies as subtrees, joined two at a time (see ShellJoins; shells.size() -
    // 1 joins). original: of each source face the one that it goes with, or itself; none: each is its own.
    static Hierarchy assemble(std::vector<ShellHierarchy> shells, std::span<const std::array<int32_t, 2>> joins,
                              size_t face_count, std::span<const int32_t> original, Progress& progress);

    // Throws Error(PW_ERROR_DATA) for anything that save() didn't make.
    static Hierarchy load(std::span<const uint8_t> bytes, Progress& progress = unobserved_progress());
    std::vector<uint8_t> save(Progress& progress = unobserved_progress()) const;

    pw_arrays arrays() const;
    const HierarchyData& data() const { return data_; }
    const pw_summary& summary() const { return data_.summary; }
    const std::string& notes() const { return data_.notes; }
    void add_note(const std::string& note) {
        if (!note.empty()) data_.notes += (data_.notes.empty() ? "" : " ") + note;
    }
    // Whether all shells are sheets, filled as thin solids.
    bool is_sheet() const { return data_.summary.sheets == data_.summary.shells; }
    // For each tetrahedron: whether the surface used of its shell is the caller's own.
    std::vector<uint8_t> exact_tetrahedra() const;
    size_t face_count() const { return data_.leaf.size(); }
    size_t node_count() const { return parent_.size(); }
    size_t tetrahedron_count() const { return data_.tetrahedra.size(); }
    std::span<const Merge> merges() const { return merges_; }
    std::span<const Point> vertices() const { return data_.vertices; }
    std::span<const Tetrahedron> tetrahedra() const { return data_.tetrahedra; }  // in depth-first order
    std::span<const int32_t> leaves() const { return data_.leaf; }                // of each source face
    // The source face, or -1, of each facet that has nothing on its other side, by tetrahedron and then corner.
    std::span<const int32_t> outer_faces() const { return data_.outer_faces; }

    std::vector<double> cluster_scores() const;  // 0 below the initial parts; also in the paper's tree
    size_t shell_of(size_t tet) const;
    double area() const { return area_.back(); }
    std::vector<int32_t> path(size_t face) const;
    WheelStops wheel(size_t face, double view = 0) const;  // its stops are nodes
    std::span<const int32_t> faces(size_t node) const;
    // A hierarchy in which these source faces are a node with score 1: see pw_hierarchy_with_part.
    Hierarchy with_part(std::span<const int32_t> faces, Progress& progress = unobserved_progress()) const;
    std::vector<int32_t> cut_height(double height) const;   // bounds, as the C API documents
    std::vector<int32_t> cut_parts(size_t parts) const;     // likewise
    std::vector<int32_t> cut_least_concavity(size_t parts, Progress& progress = unobserved_progress()) const;  // likewise
    std::vector<int32_t> cut_automatic() const;             // likewise
    // The end of a cluster's slice of the tetrahedra; the bounds of a cut of the binary tree into clusters.
    int32_t end_of(int32_t cluster) const;
    std::vector<int32_t> bounds_of(std::span<const int32_t> clusters) const;
    TriangleMesh hull(size_t tet_first, size_t tet_last, Progress& progress = unobserved_progress()) const;

private:
    void derive();
    void measure_clusters();
    std::vector<int32_t> keep_nodes();
    void link_nodes(std::vector<int32_t>& node);
    void order_faces();
    std::array<std::vector<double>*, 5> measures() { return {&volume_, &area_, &height_, &score_, &extent_}; }
    std::vector<uint8_t> kept_merges() const;  // the merges that are nodes

    HierarchyData data_;
    std::vector<Merge> merges_;

    // Set by derive().
    Frame frame_;
    std::vector<int32_t> merge_pairs_;
    std::vector<int32_t> merge_last_;  // the end of each merge's slice of the tetrahedra
    std::vector<int32_t> shell_nodes_;  // in depth-first order
    std::vector<int32_t> order_, parent_, first_, last_, tet_first_, tet_last_;
    std::vector<uint8_t> cost_class_;
    std::vector<double> cost_, height_, volume_, area_, score_;
    std::vector<double> extent_;  // of each node: the diagonal of its bounding box
};

struct ShellHierarchy {
    Hierarchy hierarchy;
    std::vector<int32_t> faces, vertices;  // the caller's number of each of its own
    size_t duplicates = 0;   // faces that go with its own because they are copies of them
    size_t inner_faces = 0;  // faces of an inner wall, which go with those of the outer one
    size_t welded = 0;       // vertices that were merged with others

    bool is_changed() const { return duplicates + inner_faces + welded > 0; }
};

}  // namespace partwheel
