// A tet mesh cut in two where it is thin.
#pragma once

#include "tetrahedra.h"

#include <cstdint>
#include <vector>

namespace partwheel {

// The half that each tetrahedron is in, 0 or 1: of planes in some directions, near the middle, the one that cuts the
// fewest dual edges is between them.
std::vector<uint8_t> halves(const TetMesh& mesh);

}  // namespace partwheel
