// Asking memory for what will be read soon.
#pragma once

namespace partwheel {

// The cache line at an address, which is not read: any will do.
inline void prefetch_line(const void* address) {
    __builtin_prefetch(address);
    // Without this GCC takes a function that only prefetches to do nothing, and drops the calls of it.
    asm volatile("");
}

}  // namespace partwheel
