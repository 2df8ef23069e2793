// Limits of int32_t indices: each tetrahedron needs several.
#pragma once

#include "base/error.h"

#include <cstddef>
#include <cstdint>
#include <limits>

namespace partwheel {

// n as int32_t. Throws an Error if it is too large.
inline int32_t checked_index(size_t n) {
    if (n > static_cast<size_t>(std::numeric_limits<int32_t>::max()))
        throw Error(PW_ERROR_MEMORY, "The mesh takes more tetrahedra than can be numbered. Decimate it first.");
    return static_cast<int32_t>(n);
}

// For T tetrahedra there are up to 2 T clusters and dual edges, and up to 4 T + 63 facets and queue positions. Throws
// an Error if these exceed int32_t.
inline void check_tetrahedron_count(size_t count) { (void)checked_index(4 * count + 63); }

}  // namespace partwheel
