// The expected status of a surface, computed independently.
#pragma once

#include "support/shapes.h"

namespace partwheel::test {

// The status of the first check that fails, in their documented order: PW_OK if the surface is closed, manifold,
// oriented and free of self-intersection. Checks of the arrays themselves aren't made.
pw_status expected_status(const TriMesh& mesh);

}  // namespace partwheel::test
