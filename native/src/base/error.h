// The exception of all layers: a status of the C API and a message for the user.
#pragma once

#include "partwheel_types.h"

#include <array>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

namespace partwheel {

// The elements of the caller's mesh that an error refers to, see pw_error_info; -1: none.
struct ErrorLocation {
    std::array<int64_t, 2> faces{-1, -1}, vertices{-1, -1};
    int64_t triangle = -1;
};

class Error : public std::runtime_error {
public:
    Error(pw_status status, const std::string& message, const ErrorLocation& location = {})
        : std::runtime_error(message), status_(status), location_(location) {}
    pw_status status() const noexcept { return status_; }
    const ErrorLocation& location() const noexcept { return location_; }

private:
    pw_status status_;
    ErrorLocation location_;
};

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
