// Shells inside shells, and cavities.
#pragma once

#include "mesh/shells.h"

namespace partwheel {

struct ShellNesting {
    std::vector<int32_t> enclosing;   // of each closed shell, the smallest closed shell that winds around it; -1: none, or open
    std::vector<int32_t> cavity_of;   // the same if the shell is a cavity of that shell, that is, oriented the other way; else -1
};

// Tests two vertices of each shell against at most `max_candidates` shells, the smallest bounding boxes first: O(n log
// n).
ShellNesting find_nesting(const MeshView& mesh, const Shells& shells);

// The shells joined with their cavities.
Shells join_cavities(const MeshView& mesh, const Shells& shells, const ShellNesting& nesting);

}  // namespace partwheel
