// A memory pool for short-lived blocks of many sizes. With malloc, allocation would take longer than the work on the blocks.
#pragma once

#include "base/memory.h"

#include <cstddef>
#include <new>
#include <unordered_map>
#include <utility>
#include <vector>

namespace partwheel {

// Free lists by size in cache lines; larger blocks come from the system. The destructor frees everything.
class Pool {
public:
    Pool() = default;
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;

    void* allocate(size_t bytes) {
        const size_t lines = lines_of(bytes);
        if (lines >= classes) return allocate_alone(bytes);
        if (Free* head = free_[lines]) {
            free_[lines] = head->next;
            return head;
        }
        if (left_ < lines * line) {
            // The first chunk is small: a small model needs no large page.
            left_ = chunks_.empty() ? large_page / 4 : large_page;
            next_ = chunks_.emplace_back(left_).data();
        }
        left_ -= lines * line;
        return std::exchange(next_, next_ + lines * line);
    }
    void free(void* block, size_t bytes) {
        const size_t lines = lines_of(bytes);
        if (lines >= classes)
            alone_.erase(block);
        else
            free_[lines] = new (block) Free{free_[lines]};
    }

private:
    static constexpr size_t line = 64, classes = 128;
    struct Free {
        Free* next;
    };

    static size_t lines_of(size_t bytes) { return (bytes + line - 1) / line; }
    void* allocate_alone(size_t bytes) {
        LargeVector<std::byte> block(bytes);
        void* const memory = block.data();
        alone_.emplace(memory, std::move(block));
        return memory;
    }

    Free* free_[classes] = {};
    std::vector<LargeVector<std::byte>> chunks_;
    std::unordered_map<void*, LargeVector<std::byte>> alone_;
    std::byte* next_ = nullptr;
    size_t left_ = 0;
};

}  // namespace partwheel
