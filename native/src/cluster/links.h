// The links of a cluster in the dual graph: a small array in memory of a pool.
#pragma once

#include "hull/pool.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace partwheel {

struct Link {
    int32_t cluster;  // the neighbor
    int32_t edge;
};

// Like a vector, except that the caller passes the pool, and that release() or the pool's destructor frees the
// memory. The pool must outlive all lists.
class Links {
public:
    // The capacity of memory that the caller may provide.
    static constexpr uint32_t inline_capacity = 4;

    Links() = default;
    // Empty, in memory for `inline_capacity` links that the caller owns.
    explicit Links(Link* position) : links_(position), capacity_(inline_capacity) {}
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

    void push_back(const Link& link, Pool& pool) {
        if (size_ == capacity_) [[unlikely]]
            grow(pool);
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
    Link* find(int32_t cluster) {  // end() if not found
        return std::find_if(begin(), end(), [&](const Link& l) { return l.cluster == cluster; });
    }
    void release(Pool& pool) {
        if (capacity_ > inline_capacity) pool.free(links_, capacity_ * sizeof(Link));
        links_ = nullptr;
        size_ = capacity_ = 0;
    }

private:
    void swap(Links& other) noexcept {
        std::swap(links_, other.links_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
    }
    void grow(Pool& pool) {
        const uint32_t capacity = std::max(2 * inline_capacity, 2 * capacity_);
        auto* const links = static_cast<Link*>(pool.allocate(capacity * sizeof(Link)));
        std::copy(begin(), end(), links);
        if (capacity_ > inline_capacity) pool.free(links_, capacity_ * sizeof(Link));
        links_ = links;
        capacity_ = capacity;
    }

    Link* links_ = nullptr;
    uint32_t size_ = 0, capacity_ = 0;
};

}  // namespace partwheel
