// How much can be numbered: what we count has numbers that are int32_t, and there are several for each tetrahedron.
#pragma once

#include "base/error.h"

#include <cstddef>
#include <cstdint>
#include <limits>

namespace partwheel {

// n as such a number. Throws an Error if it is too large for one.
inline int32_t checked_index(size_t n) {
    if (n > static_cast<size_t>(std::numeric_limits<int32_t>::max()))
        throw Error(PW_ERROR_MEMORY, "The mesh takes more tetrahedra than can be numbered. Decimate it first.");
    return static_cast<int32_t>(n);
}

// Before anything is numbered of so many tetrahedra. Clusters are up to two for each, dual edges, too; their sides, and
// the places in the queue of edges, gaps included, up to four and some dozens. Throws an Error if that is too many.
inline void check_tetrahedron_count(size_t count) { (void)checked_index(4 * count + 63); }

}  // namespace partwheel
