// The links of a cluster in the dual graph: a small array in memory from a pool, for the system's would take longer than
// the work that is done with it.
#pragma once

#include "base/large_pages.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace partwheel {

struct Link {
    int32_t cluster;  // the neighbour
    int32_t edge;
};

// Blocks of 4, 8, 16... links. No list must outlive the pool.
class LinkPool {
public:
    static constexpr uint32_t least = 4;

    LinkPool() = default;
    LinkPool(const LinkPool&) = delete;
    LinkPool& operator=(const LinkPool&) = delete;

    Link* allocate(uint32_t capacity) {
        Link*& head = free_[level(capacity)];
        if (head) {
            Link* const block = head;
            std::memcpy(&head, block, sizeof head);
            return block;
        }
        if (left_ < capacity) {
            left_ = std::max<size_t>(capacity, chunk);
            chunks_.emplace_back(left_);
            next_ = chunks_.back().data();
        }
        left_ -= capacity;
        return std::exchange(next_, next_ + capacity);
    }
    void free(Link* block, uint32_t capacity) {
        Link*& head = free_[level(capacity)];
        std::memcpy(static_cast<void*>(block), &head, sizeof head);
        head = block;
    }

private:
    static constexpr size_t chunk = 1 << 14;
    static_assert(sizeof(Link*) <= least * sizeof(Link));

    static size_t level(uint32_t capacity) { return static_cast<size_t>(std::countr_zero(capacity / least)); }

    std::array<Link*, 32> free_{};
    std::vector<LargeVector<Link>> chunks_;
    Link* next_ = nullptr;
    size_t left_ = 0;
};

// Like a vector, but that who makes it larger says from which pool, and that it doesn't free its memory itself: release()
// does, or the pools do in the end.
class Links {
public:
    Links() = default;
    // An empty one in a block of its own from elsewhere, of the least capacity.
    explicit Links(Link* block) : links_(block), capacity_(LinkPool::least) {}
    Links(Links&& other) noexcept { swap(other); }
    Links& operator=(Links&& other) noexcept {
        Links(std::move(other)).swap(*this);
        return *this;
    }

    Link* begin() { return links_; }
    Link* end() { return links_ + size_; }
    const Link* begin() const { return links_; }
    const Link* end() const { return links_ + size_; }
    size_t size() const { return size_; }
    Link& operator[](size_t i) { return links_[i]; }

    void push_back(const Link& link, LinkPool& pool) {
        if (size_ == capacity_) [[unlikely]]
            grow(size_ + 1, pool);
        links_[size_++] = link;
    }
    void erase(Link* link) {
        std::copy(link + 1, end(), link);
        --size_;
    }
    void erase_of(int32_t cluster) {
        Link* const last = std::remove_if(begin(), end(), [&](const Link& l) { return l.cluster == cluster; });
        size_ = static_cast<uint32_t>(last - links_);
    }
    Link* find(int32_t cluster) {  // end() if there is none
        return std::find_if(begin(), end(), [&](const Link& l) { return l.cluster == cluster; });
    }
    void release(LinkPool& pool) {
        if (links_) pool.free(links_, capacity_);
        links_ = nullptr;
        size_ = capacity_ = 0;
    }

private:
    void swap(Links& other) noexcept {
        std::swap(links_, other.links_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
    }
    void grow(uint32_t least, LinkPool& pool) {
        const uint32_t capacity = std::max(LinkPool::least, std::bit_ceil(least));
        Link* const links = pool.allocate(capacity);
        std::copy(begin(), end(), links);
        if (links_) pool.free(links_, capacity_);
        links_ = links;
        capacity_ = capacity;
    }

    Link* links_ = nullptr;
    uint32_t size_ = 0, capacity_ = 0;
};

}  // namespace partwheel
