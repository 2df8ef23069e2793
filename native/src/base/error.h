// How a room says that it can't go on: a status of the C API and a sentence for the user.
#pragma once

#include "partwheel_types.h"

#include <stdexcept>
#include <string>

namespace partwheel {

class Error : public std::runtime_error {
public:
    Error(pw_status status, const std::string& sentence) : std::runtime_error(sentence), status_(status) {}
    pw_status status() const noexcept { return status_; }

private:
    pw_status status_;
};

}  // namespace partwheel
