// Dual edges, cheapest first: their prices and the queue.
#pragma once

#include "base/memory.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace partwheel {

// Eq. 3 of the paper with its ties settled: ordered by concavity (ranked_concavity, 0 if convex), then by C2 (Eq. 2
// without its constant denominator: t1^2 + t2^2, exact), then by the lowest tetrahedra of the two clusters, the lower
// one first. It is three integers in that order. Most comparisons are settled by the first: concavity, or C2 among
// convex unions.
struct Price {
    uint64_t rank = 0, balance = 0, tie = 0;

    Price() = default;
    Price(double concavity, double squares, int32_t low, int32_t high)
        // Doubles that are not negative are ordered as their bits; the free sign bit tells the class.
        : rank(concavity > 0 ? not_convex | std::bit_cast<uint64_t>(concavity) : std::bit_cast<uint64_t>(squares)),
          balance(std::bit_cast<uint64_t>(squares)),
          tie(uint64_t{static_cast<uint32_t>(low)} << 32 | static_cast<uint32_t>(high)) {}

    double concavity() const { return rank & not_convex ? std::bit_cast<double>(rank & ~not_convex) : 0; }
    bool operator<(const Price& other) const {
        if (rank != other.rank) [[likely]]
            return rank < other.rank;
        return balance != other.balance ? balance < other.balance : tie < other.tie;
    }

private:
    static constexpr uint64_t not_convex = uint64_t{1} << 63;
};

// Those up to some key are in a heap, small enough to stay in a cache; the later ones lie in no order until that runs
// out. Most edges become dearer several times before they come near the top, if they ever do.
//
// The heap has four children a node. Each edge's place is known, so that prices change in place.
class EdgeQueue {
public:
    struct Item : Price {
        int32_t edge = -1;

        Item() = default;
        Item(const Price& price, int32_t e) : Price(price), edge(e) {}
    };

    // Makes room for so many to be appended.
    void reserve(size_t items) { later_.reserve(items); }

    // All edges that are ever appended have lower numbers than this.
    void number_edges(size_t edges) {
        places_.reserve(edges);
        places_.resize(edges, absent);
    }

    // Fills an empty queue; sort() then brings it in order.
    void append(const Price& price, int32_t edge) {
        ++size_;
        put_later({price, edge});
    }

    void sort() { refill(); }

    bool empty() const { return size_ == 0; }
    size_t size() const { return size_; }
    const Item& top() const { return at(0); }
    bool has(int32_t edge) const { return place(edge) != absent; }
    const Price& price(int32_t edge) const {  // of one that it has
        const uint32_t at = place(edge);
        return at & later ? later_[at & ~later] : this->at(at);
    }

    // Asks memory for where an edge is in it, ahead of use.
    void prefetch(int32_t edge) const { prefetch_line(&places_[static_cast<size_t>(edge)]); }

    // What comes after the top one; null if there is nothing.
    const Item* runner_up() const {
        const std::span<const Item> next = items(1, children + 1);
        return next.empty() ? nullptr : &*std::min_element(next.begin(), next.end());
    }

    // Some of those that come after the top one: the items at these places of the heap.
    std::span<const Item> items(size_t first, size_t last) const {
        return {&at(std::min(first, soon())), &at(std::min(last, soon()))};
    }

    void update(const Price& price, int32_t edge) {
        const uint32_t at = place(edge);
        const bool is_later = horizon_ < price;
        if (at & later) {
            Item& item = later_[at & ~later];
            if (is_later) {
                item = {price, edge};
            } else {
                item.edge = gone;
                put_soon({price, edge});
            }
        } else if (is_later) {
            take_out(at);
            put_later({price, edge});
            refill();
        } else {
            settle(at, {price, edge});
        }
    }

    void remove(int32_t edge) {
        --size_;
        const uint32_t at = std::exchange(place(edge), absent);
        if (at & later) {
            later_[at & ~later].edge = gone;
        } else {
            take_out(at);
            refill();
        }
    }

private:
    static constexpr size_t children = 4;

    // Unused places, with which the children of each are as near in memory as can be: in whole cache lines.
    static constexpr size_t before = children - 1;

    // This bit of a place says that it is not one in the heap.
    static constexpr uint32_t later = uint32_t{1} << 31;

    // In place of the place of an edge that is not in the queue.
    static constexpr uint32_t absent = 0xffffffff;

    // In place of an edge that is not there any more.
    static constexpr int32_t gone = -1;

    // The heap holds at least so many, if there are as many: what comes soon is to be found there.
    static constexpr size_t least_soon = 32;

    // From this place on items are in no near cache: a level is asked for while the one above is looked at.
    static constexpr size_t far = 2048, items_a_line = std::max<size_t>(64 / sizeof(Item), 1);

    // When it runs out it gets one in so many of the later ones, the first as far as a sample tells.
    static constexpr size_t share = 8, sample = 16 * share;

    uint32_t& place(int32_t edge) { return places_[static_cast<size_t>(edge)]; }
    uint32_t place(int32_t edge) const { return places_[static_cast<size_t>(edge)]; }

    size_t soon() const { return heap_.size() - before; }
    Item& at(size_t i) { return *(heap_.data() + before + i); }
    const Item& at(size_t i) const { return *(heap_.data() + before + i); }

    void put(size_t i, const Item& item) {
        at(i) = item;
        place(item.edge) = static_cast<uint32_t>(i);
    }

    void put_soon(const Item& item) {
        heap_.emplace_back();
        settle(soon() - 1, item);
    }

    void put_later(const Item& item) {
        place(item.edge) = static_cast<uint32_t>(later_.size()) | later;
        later_.push_back(item);
    }

    void take_out(size_t i) {
        const Item last = heap_.back();
        heap_.pop_back();
        if (i < soon()) settle(i, last);
    }

    // Keeps the heap from running out, and the gaps among the later ones from becoming too many.
    void refill() {
        while ((soon() < least_soon && soon() < size_) || later_.size() > 2 * size_ + least_soon) [[unlikely]]
            fetch();
    }

    // Moves the horizon, and the items up to it to the heap. Gaps among the later ones are filled from their end.
    void fetch() {
        if (soon() == size_) return later_.clear();
        horizon_ = next_horizon();
        for (size_t i = 0; i < later_.size();) {
            const Item item = later_[i];
            if (item.edge != gone && horizon_ < item) {
                ++i;
                continue;
            }
            if (item.edge != gone) {
                heap_.emplace_back();
                put(soon() - 1, item);
            }
            const Item last = later_.back();
            later_.pop_back();
            if (i == later_.size()) break;
            later_[i] = last;
            if (last.edge != gone) place(last.edge) = static_cast<uint32_t>(i) | later;
        }
        for (size_t i = soon() / children + 1; i-- > 0;)
            if (i < soon()) sink(i, Item(at(i)));
    }

    // Among the later ones; if they are few it is the last, so that all are fetched.
    Price next_horizon() const {
        const bool few = size_ - soon() <= 4 * least_soon;
        std::vector<Price> prices;
        for (size_t stride = few ? 1 : later_.size() / sample + 1; prices.empty(); stride = 1)  // a sample may miss all
            for (size_t i = 0; i < later_.size(); i += stride)
                if (later_[i].edge != gone) prices.push_back(later_[i]);
        const auto next = prices.begin() + static_cast<std::ptrdiff_t>(few ? prices.size() - 1 : prices.size() / share);
        std::nth_element(prices.begin(), next, prices.end());
        return *next;
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
            const size_t first = children * i + 1, end = std::min(first + children, soon());
            if (first >= end) break;
            if (const size_t next = children * first + 1; next >= far && next < soon())
                for (size_t c = next; c < next + children * children; c += items_a_line)
                    prefetch_line(heap_.data() + before + c);
            size_t least = first;
            for (size_t c = first + 1; c < end; ++c) least = at(c) < at(least) ? c : least;
            if (!(at(least) < item)) break;
            put(i, at(least));
            i = least;
        }
        put(i, item);
    }

    LargeVector<Item> heap_{before};
    LargeVector<Item> later_;
    size_t size_ = 0;
    Price horizon_;  // the heap has what doesn't come after it
    LargeVector<uint32_t> places_;  // of each edge
};

}  // namespace partwheel
