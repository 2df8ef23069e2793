// Dual edges, cheapest first: the keys and the queue.
#pragma once

#include "cluster.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace partwheel {

// A cost as three integers in its order. Most comparisons are settled by the first: concavity, or C2 among convex
// unions.
struct Price {
    uint64_t rank = 0, balance = 0, tie = 0;

    Price() = default;
    explicit Price(const Cost& cost)
        // Doubles that are not negative are ordered as their bits; the free sign bit tells the class.
        : rank(cost.concavity > 0 ? not_convex | std::bit_cast<uint64_t>(cost.concavity)
                                  : std::bit_cast<uint64_t>(cost.balance)),
          balance(std::bit_cast<uint64_t>(cost.balance)),
          tie(uint64_t{static_cast<uint32_t>(cost.low)} << 32 | static_cast<uint32_t>(cost.high)) {}

    double concavity() const { return rank & not_convex ? std::bit_cast<double>(rank & ~not_convex) : 0; }
    bool operator<(const Price& other) const {
        if (rank != other.rank) [[likely]]
            return rank < other.rank;
        return balance != other.balance ? balance < other.balance : tie < other.tie;
    }

private:
    static constexpr uint64_t not_convex = uint64_t{1} << 63;
};

// Where each edge is in the queue that it is in. Queues may share one, for an edge is in one of them at most.
class EdgePlaces {
public:
    static constexpr uint32_t absent = 0xffffffff;

    void resize(size_t edges) { places_.resize(edges, absent); }
    void reserve(size_t edges) { places_.reserve(edges); }
    uint32_t& operator[](int32_t edge) { return places_[static_cast<size_t>(edge)]; }
    bool queued(int32_t edge) const { return places_[static_cast<size_t>(edge)] != absent; }
    void prefetch(int32_t edge) const { __builtin_prefetch(&places_[static_cast<size_t>(edge)]); }

private:
    std::vector<uint32_t> places_;
};

// A heap with four children a node that knows where each edge is, so that keys change in place.
template <class Key>
class EdgeQueue {
public:
    struct Item : Key {
        int32_t edge = -1;

        Item() = default;
        Item(const Key& key, int32_t e) : Key(key), edge(e) {}
    };

    explicit EdgeQueue(EdgePlaces& places) : place_(places) {}

    void reserve(size_t edges) { heap_.reserve(edges); }

    // Without restoring the order, see sort().
    void append(const Key& key, int32_t edge) {
        heap_.emplace_back();
        put(heap_.size() - 1, {key, edge});
    }

    void sort() {
        for (size_t i = heap_.size() / children + 1; i-- > 0;)
            if (i < heap_.size()) sink(i, Item(heap_[i]));
    }

    void insert(const Key& key, int32_t edge) {
        heap_.emplace_back();
        settle(heap_.size() - 1, {key, edge});
    }

    bool empty() const { return heap_.empty(); }
    size_t size() const { return heap_.size(); }
    const Item& top() const { return heap_[0]; }
    const Key& key(int32_t edge) const { return heap_[place_[edge]]; }

    // The top one and some that come soon after it.
    std::span<const Item> top_items() const { return {heap_.data(), std::min(children + 1, heap_.size())}; }

    // What comes after the top one; null if there is nothing.
    const Item* runner_up() const {
        const std::span<const Item> items = top_items();
        return items.size() < 2 ? nullptr : &*std::min_element(items.begin() + 1, items.end());
    }

    // Some of those that come after the top one: the items at these places of the heap.
    std::span<const Item> items(size_t first, size_t last) const {
        return {heap_.data() + std::min(first, heap_.size()), heap_.data() + std::min(last, heap_.size())};
    }

    void update(const Key& key, int32_t edge) { settle(place_[edge], {key, edge}); }

    void remove(int32_t edge) {
        const size_t i = std::exchange(place_[edge], EdgePlaces::absent);
        const Item last = heap_.back();
        heap_.pop_back();
        if (i < heap_.size()) settle(i, last);
    }

private:
    static constexpr size_t children = 4;

    void put(size_t i, const Item& item) {
        heap_[i] = item;
        place_[item.edge] = static_cast<uint32_t>(i);
    }

    // Puts the item where it belongs, above or below the gap at i.
    void settle(size_t i, const Item& item) {
        while (i > 0 && item < heap_[(i - 1) / children]) {
            put(i, heap_[(i - 1) / children]);
            i = (i - 1) / children;
        }
        sink(i, item);
    }

    void sink(size_t i, const Item& item) {
        for (;;) {
            const size_t first = children * i + 1, end = std::min(first + children, heap_.size());
            if (first >= end) break;
            size_t least = first;
            for (size_t c = first + 1; c < end; ++c) least = heap_[c] < heap_[least] ? c : least;
            if (!(heap_[least] < item)) break;
            put(i, heap_[least]);
            i = least;
        }
        put(i, item);
    }

    std::vector<Item> heap_;
    EdgePlaces& place_;
};

}  // namespace partwheel
