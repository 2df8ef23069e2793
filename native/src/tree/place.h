// The hierarchy of a shell that is a copy of another one.
#pragma once

#include "prepare/congruent.h"
#include "tree/hierarchy.h"

namespace partwheel {

// The original's hierarchy where the copy is. from, to: the shells. Nothing if a tetrahedron is so flat that the
// rounding of the copy's vertices turns it inside out.
std::optional<Hierarchy> place_copy(const Hierarchy& original, const Congruence& congruence, const SubMesh& from,
                                    const SubMesh& to);

}  // namespace partwheel
