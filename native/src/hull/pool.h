// A memory pool for short-lived blocks of many sizes. Builds are 7 to 12 % slower with an allocation from the system
// for each block.
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
        const size_t lines = to_lines(bytes);
        if (lines >= size_classes) return allocate_from_system(bytes);
        if (FreeBlock* head = free_[lines]) {
            free_[lines] = head->next;
            return head;
        }
        if (bytes_left_ < lines * line_size) {
            // The first chunk is small: a small model needs no large page.
            bytes_left_ = chunks_.empty() ? large_page / 4 : large_page;
            next_ = chunks_.emplace_back(bytes_left_).data();
        }
        bytes_left_ -= lines * line_size;
        return std::exchange(next_, next_ + lines * line_size);
    }
    void free(void* block, size_t bytes) {
        const size_t lines = to_lines(bytes);
        if (lines >= size_classes)
            system_blocks_.erase(block);
        else
            free_[lines] = new (block) FreeBlock{free_[lines]};
    }

private:
    static constexpr size_t line_size = 64, size_classes = 128;
    struct FreeBlock {
        FreeBlock* next;
    };

    static size_t to_lines(size_t bytes) { return (bytes + line_size - 1) / line_size; }
    void* allocate_from_system(size_t bytes) {
        LargeVector<std::byte> block(bytes);
        void* const memory = block.data();
        system_blocks_.emplace(memory, std::move(block));
        return memory;
    }

    FreeBlock* free_[size_classes] = {};
    std::vector<LargeVector<std::byte>> chunks_;
    std::unordered_map<void*, LargeVector<std::byte>> system_blocks_;
    std::byte* next_ = nullptr;
    size_t bytes_left_ = 0;
};

}  // namespace partwheel
