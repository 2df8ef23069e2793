// The saved form of a hierarchy: the arrays from which all others follow, packed as bytes, and their validation.
#pragma once

#include "base/progress.h"
#include "mesh/surface.h"
#include "partwheel.h"

namespace partwheel {

// A flag in shell_fills: a proxy of the shell was filled.
inline constexpr uint8_t is_proxy = 128;

// The format that pack() writes, and the oldest one that unpack() reads.
inline constexpr uint32_t saved_format = 7, oldest_saved_format = 5;

// Notes consist of these characters.
inline bool is_printable(char c) { return c >= ' ' && c <= '~'; }

// What a hierarchy is made of, besides its merges; all its other arrays follow from these. Tetrahedra are in
// depth-first order, lengths and volumes in the caller's unit.
struct HierarchyData {
    pw_summary summary{};  // without shells, sheets and volume, which follow
    std::string notes;
    FaceCounts face_counts;  // not saved: of a shell that was built, for the notes of its assembly
    std::vector<Point> vertices;
    std::vector<int32_t> source;  // of each vertex
    std::vector<Tetrahedron> tetrahedra;
    std::vector<int32_t> leaf;  // of each face
    std::vector<double> face_area;
    std::vector<int32_t> outer_faces;  // see Hierarchy::outer_faces()
    std::vector<double> scores;        // see ScoredTree; none: this is the paper's tree
    // For each shell, in depth-first order: its pw_fill_method, plus `is_proxy`. The last merges, one fewer, join them.
    std::vector<uint8_t> shell_fills;

    std::vector<Point> working_vertices() const { return Frame::around(vertices).to_working(vertices); }
    // The last merges, those of the merge policy and those that join shells.
    size_t policy_merge_count() const { return scores.empty() ? 0 : (scores.size() - 1) / 2; }
};

// For each tetrahedron, the neighbors across the facets opposite its corners; -1: none. Throws Error(PW_ERROR_DATA) if
// a tetrahedron repeats a corner or if more than two share a facet.
std::vector<std::array<int32_t, 4>> find_neighbors(std::span<const Tetrahedron> tetrahedra);

// Whether a tetrahedron is inside out by more than rounding to the caller's coordinates explains.
bool has_reversed_tetrahedra(const HierarchyData& data);

struct SavedHierarchy : HierarchyData {
    std::vector<int32_t> borders;  // of each merge, the border between two tetrahedra that it removes
    std::vector<double> concavities;

    std::vector<uint8_t> pack(Progress& progress = unobserved_progress()) const;

    // Throws Error(PW_ERROR_DATA) for bytes that pack() does not write. The arrays have matching sizes, no more: see
    // check().
    static SavedHierarchy unpack(std::span<const uint8_t> bytes);

    // Throws Error(PW_ERROR_DATA) unless everything holds that a hierarchy and its queries rely on: a hash can be
    // forged.
    void check() const;
};

}  // namespace partwheel
