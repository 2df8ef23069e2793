// SIMD vectors of two doubles or four integers, which every 64-bit processor has.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

namespace partwheel {

using Double2 = double __attribute__((vector_size(16)));
using Int64x2 = int64_t __attribute__((vector_size(16)));
using Int4 = int32_t __attribute__((vector_size(16)));

template <class Vector, class Number>
inline Vector vector_at(const Number* numbers) {
    Vector v;
    std::memcpy(&v, numbers, sizeof v);
    return v;
}

// Bit k is set if element k is negative.
inline unsigned sign_mask(Double2 x) {
#if defined(__SSE2__)
    return static_cast<unsigned>(__builtin_ia32_movmskpd(x));
#else
    const auto bits = std::bit_cast<std::array<uint64_t, 2>>(x);
    return static_cast<unsigned>(bits[0] >> 63 | bits[1] >> 63 << 1);
#endif
}

constexpr size_t round_up_to_4(size_t n) { return (n + 3) / 4 * 4; }

// numbers: padded in memory to a multiple of 4.
inline bool contains(std::span<const int32_t> numbers, int32_t v) {
    Int4 equal = {0, 0, 0, 0};
    for (size_t i = 0; i < numbers.size(); i += 4) equal |= vector_at<Int4>(&numbers[i]) == v;
    const auto halves = std::bit_cast<std::array<int64_t, 2>>(equal);
    return (halves[0] | halves[1]) != 0;
}

inline Double2 magnitude(Double2 x) {
    return std::bit_cast<Double2>(std::bit_cast<Int64x2>(x) & std::numeric_limits<int64_t>::max());
}

// max(0, x) per element.
inline Double2 positive(Double2 x) { return std::bit_cast<Double2>(std::bit_cast<Int64x2>(x) & (x > 0)); }

}  // namespace partwheel
