// Dual edges, cheapest first: the keys and the queue.
#pragma once

#include "cluster.h"
#include "large_pages.h"
#include "prefetch.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>

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
    void prefetch(int32_t edge) const { prefetch_line(&places_[static_cast<size_t>(edge)]); }

private:
    LargeVector<uint32_t> places_;
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

    void reserve(size_t edges) { heap_.reserve(before + edges); }

    // Without restoring the order, see sort().
    void append(const Key& key, int32_t edge) {
        heap_.emplace_back();
        put(size() - 1, {key, edge});
    }

    void sort() {
        for (size_t i = size() / children + 1; i-- > 0;)
            if (i < size()) sink(i, Item(at(i)));
    }

    void insert(const Key& key, int32_t edge) {
        heap_.emplace_back();
        settle(size() - 1, {key, edge});
    }

    bool empty() const { return size() == 0; }
    size_t size() const { return heap_.size() - before; }
    const Item& top() const { return at(0); }
    const Key& key(int32_t edge) const { return at(place_[edge]); }

    // The top one and some that come soon after it.
    std::span<const Item> top_items() const { return items(0, children + 1); }

    // What comes after the top one; null if there is nothing.
    const Item* runner_up() const {
        const std::span<const Item> items = top_items();
        return items.size() < 2 ? nullptr : &*std::min_element(items.begin() + 1, items.end());
    }

    // Some of those that come after the top one: the items at these places of the heap.
    std::span<const Item> items(size_t first, size_t last) const {
        return {&at(std::min(first, size())), &at(std::min(last, size()))};
    }

    void update(const Key& key, int32_t edge) { settle(place_[edge], {key, edge}); }

    void remove(int32_t edge) {
        const size_t i = std::exchange(place_[edge], EdgePlaces::absent);
        const Item last = heap_.back();
        heap_.pop_back();
        if (i < size()) settle(i, last);
    }

private:
    static constexpr size_t children = 4;

    // Unused places, with which the children of each are as near in memory as can be: in whole cache lines.
    static constexpr size_t before = children - 1;

    Item& at(size_t i) { return *(heap_.data() + before + i); }
    const Item& at(size_t i) const { return *(heap_.data() + before + i); }

    void put(size_t i, const Item& item) {
        at(i) = item;
        place_[item.edge] = static_cast<uint32_t>(i);
    }

    // Puts the item where it belongs, above or below the gap at i.
    void settle(size_t i, const Item& item) {
        while (i > 0 && item < at((i - 1) / children)) {
            put(i, at((i - 1) / children));
            i = (i - 1) / children;
        }
        sink(i, item);
    }

    void sink(size_t i, const Item& item) {
        for (;;) {
            const size_t first = children * i + 1, end = std::min(first + children, size());
            if (first >= end) break;
            size_t least = first;
            for (size_t c = first + 1; c < end; ++c) least = at(c) < at(least) ? c : least;
            if (!(at(least) < item)) break;
            put(i, at(least));
            i = least;
        }
        put(i, item);
    }

    LargeVector<Item> heap_{before};
    EdgePlaces& place_;
};

}  // namespace partwheel
