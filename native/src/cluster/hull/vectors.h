// Numbers two and four at a time: one vector register of every 64-bit machine.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

namespace partwheel {

using Two = double __attribute__((vector_size(16)));
using TwoBits = int64_t __attribute__((vector_size(16)));
using Four = int32_t __attribute__((vector_size(16)));

template <class Vector, class Number>
inline Vector vector_at(const Number* numbers) {
    Vector v;
    std::memcpy(&v, numbers, sizeof v);
    return v;
}

// Bit k is set if number k is negative.
inline unsigned signs(Two x) {
#if defined(__SSE2__)
    return static_cast<unsigned>(__builtin_ia32_movmskpd(x));
#else
    const auto bits = std::bit_cast<std::array<uint64_t, 2>>(x);
    return static_cast<unsigned>(bits[0] >> 63 | bits[1] >> 63 << 1);
#endif
}

constexpr size_t whole_fours(size_t n) { return (n + 3) / 4 * 4; }

// Among numbers that have been filled up to whole fours.
inline bool contains(std::span<const int32_t> numbers, int32_t v) {
    Four equal = {0, 0, 0, 0};
    for (size_t i = 0; i < numbers.size(); i += 4) equal |= vector_at<Four>(&numbers[i]) == v;
    const auto halves = std::bit_cast<std::array<int64_t, 2>>(equal);
    return (halves[0] | halves[1]) != 0;
}

inline Two magnitude(Two x) {
    return std::bit_cast<Two>(std::bit_cast<TwoBits>(x) & std::numeric_limits<int64_t>::max());
}

// The larger of 0 and each number.
inline Two positive(Two x) { return std::bit_cast<Two>(std::bit_cast<TwoBits>(x) & (x > 0)); }

}  // namespace partwheel
