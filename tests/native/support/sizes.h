// How much the tests do: everything, or under a sanitizer less of the same.
#pragma once

#include <cstdlib>
#include <string_view>

namespace partwheel::test {

// True if the environment asks for less (PARTWHEEL_TEST_LIGHT=1): smaller sizes, and fewer models that take the same code.
inline bool light() {
    const char* value = std::getenv("PARTWHEEL_TEST_LIGHT");
    return value != nullptr && std::string_view(value) != "" && std::string_view(value) != "0";
}

template <typename T>
T sized(T full, T small) {
    return light() ? small : full;
}

}  // namespace partwheel::test
