// Memory for arrays that are read and written all over: in large pages, where the system has them, since looking up so
// many small ones costs more than the memory itself; and asked for before it is read.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace partwheel {

inline constexpr size_t large_page = size_t{2} << 20;

// Memory aligned to large pages, to be freed by free_large(). Throws std::bad_alloc.
inline void* allocate_large(size_t bytes) {
    void* memory = ::operator new(bytes, std::align_val_t{large_page});
#if defined(MADV_HUGEPAGE)
    // A hint: without it the pages are small ones. What is beyond the last whole large page may be others' memory.
    (void)madvise(memory, bytes / large_page * large_page, MADV_HUGEPAGE);
#endif
    return memory;
}

inline void free_large(void* memory) { ::operator delete(memory, std::align_val_t{large_page}); }

// For std::vector: what would fill several large pages is in such, the rest begins with a cache line.
template <class T>
struct LargePages {
    using value_type = T;

    LargePages() = default;
    template <class U>
    LargePages(const LargePages<U>&) {}

    T* allocate(size_t n) {
        if (n >= least) return static_cast<T*>(allocate_large(n * sizeof(T)));
        return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t{cache_line}));
    }
    void deallocate(T* memory, size_t n) {
        if (n >= least)
            free_large(memory);
        else
            ::operator delete(memory, std::align_val_t{cache_line});
    }
    // Without arguments as by default: numbers are whatever lies in that memory, not 0.
    template <class U>
    void construct(U* item) {
        ::new (static_cast<void*>(item)) U;
    }
    bool operator==(const LargePages&) const = default;

private:
    static constexpr size_t least = large_page / sizeof(T), cache_line = 64;
    static_assert(alignof(T) <= cache_line);
};

template <class T>
using LargeVector = std::vector<T, LargePages<T>>;

// Asks for the cache line at an address, which is not read: any will do.
inline void prefetch_line(const void* address) {
    __builtin_prefetch(address);
    // Without this GCC takes a function that only prefetches to do nothing, and drops the calls of it.
    asm volatile("");
}

}  // namespace partwheel
