// Patches: what marked edges and creases divide the surface into.
//
// Geometry says little about a shirt on a body that is one surface, but its material does. A caller marks edges of the
// mesh: borders of materials, seams, strong changes of color. Faces that are connected without crossing a mark form a
// patch.
#pragma once

#include "mesh/shells.h"

namespace partwheel {

// Marked edges of one kind.
struct EdgeMarks {
    std::string name;                               // for the notes, such as "material borders"
    std::span<const std::array<int32_t, 2>> edges;  // vertices of the caller's mesh
    std::span<const float> strengths;               // of the edges, 0 to 1; none: all are 1
    bool is_chosen = false;                         // by somebody for this model: never ignored
};

// Weaker marks divide nothing.
inline constexpr float min_mark_strength = 0.5F;
// A mark of this strength was drawn on purpose: no part crosses it.
inline constexpr float hard_mark_strength = 1;

struct Patches {
    // For each source face; -1: its connected component has a single patch. Empty: there are no patches.
    std::vector<int32_t> of_face;
    std::vector<int32_t> group;  // of each patch: those that are connected without crossing a hard mark
    std::vector<bool> has_hints;  // of each patch: whether marks of the caller divide its connected component
    std::string notes;           // sentences for pw_hierarchy_notes()

    struct Border {
        int32_t a, b;  // a < b
        double length;
        float strength;
    };
    std::vector<Border> borders;  // between adjacent patches, ascending

    // The strength of the marks between two patches, -1 included: 1 if they are in different groups, else less, the
    // mean over their common edges; 0 within a patch.
    float strength(int32_t a, int32_t b) const;
};

// Ignores the kinds of marks that divide the surface into small pieces all over, which a machine made: islands of an
// atlas, every edge of triangulated CAD, random face sets; unless somebody chose them. Patches that are too small to
// see join a neighbor, but not across a hard mark. Creases of hard surfaces (creases.h) count as marks of medium
// strength, without a note.
Patches find_patches(const MeshView& mesh, const Shells& shells, std::span<const EdgeMarks> marks);

}  // namespace partwheel
