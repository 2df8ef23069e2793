// The exception of all layers: a status of the C API and a message for the user.
#pragma once

#include "partwheel_types.h"

#include <array>
#include <cstdint>
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

}  // namespace partwheel
