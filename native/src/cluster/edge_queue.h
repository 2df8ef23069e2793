// A priority queue of dual edges by cost.
#pragma once

#include "base/memory.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace partwheel {

// Eq. 3 of the paper with a rule for ties: ordered by concavity (ranked_concavity, 0 if convex), then by C2 (Eq. 2
// without its constant denominator: t1^2 + t2^2, exact), then by the lowest tetrahedra of the two clusters, the lower
// one first. Stored as three integers in that order; the first decides most comparisons.
struct MergeCost {
    uint64_t rank = 0, balance = 0, tie = 0;

    MergeCost() = default;
    MergeCost(double concavity, double squares, int32_t low, int32_t high)
        // Nonnegative doubles are ordered like their bits; the unused sign bit holds the class.
        : rank(concavity > 0 ? not_convex | std::bit_cast<uint64_t>(concavity) : std::bit_cast<uint64_t>(squares)),
          balance(std::bit_cast<uint64_t>(squares)),
          tie(uint64_t{static_cast<uint32_t>(low)} << 32 | static_cast<uint32_t>(high)) {}

    double concavity() const { return rank & not_convex ? std::bit_cast<double>(rank & ~not_convex) : 0; }
    bool operator<(const MergeCost& other) const {
        if (rank != other.rank) [[likely]]
            return rank < other.rank;
        return balance != other.balance ? balance < other.balance : tie < other.tie;
    }

private:
    static constexpr uint64_t not_convex = uint64_t{1} << 63;
};

// Edges up to a threshold are in a heap that fits into the cache. The others are deferred, unordered, until the heap
// runs out: the cost of most edges rises several times before they come near the top, if they ever do.
//
// The heap is 4-ary. The position of each edge is known, so its cost can change in place. A binary heap with stale
// items would be 120 lines shorter, and whole builds 30 to 43 % slower (two models of 52,000 and 89,000 triangles,
// PW_MODE_PAPER, one thread; medians of five builds with the same bytes as result, as in base/memory.h and
// hull/pool.h).
class EdgeQueue {
public:
    struct Item : MergeCost {
        int32_t edge = -1;

        Item() = default;
        Item(const MergeCost& cost, int32_t e) : MergeCost(cost), edge(e) {}
    };

    // Reserves memory for this many edges.
    void reserve(size_t items) { deferred_.reserve(items); }

    // An upper bound of all edge indices.
    void set_edge_count(size_t edges) {
        positions_.reserve(edges);
        positions_.resize(edges, absent);
    }

    // Fills an empty queue; call sort() afterward.
    void append(const MergeCost& cost, int32_t edge) {
        ++size_;
        defer({cost, edge});
    }

    void sort() { refill(); }

    bool empty() const { return size_ == 0; }
    size_t size() const { return size_; }
    const Item& top() const { return at(0); }
    bool has(int32_t edge) const { return position(edge) != absent; }
    const MergeCost& cost(int32_t edge) const {  // of an edge in the queue
        const uint32_t place = position(edge);
        return place & in_deferred ? deferred_[place & ~in_deferred] : at(place);
    }

    // Prefetches the position of an edge.
    void prefetch(int32_t edge) const { prefetch_line(&positions_[static_cast<size_t>(edge)]); }

    // The second cheapest edge; null if there is none.
    const Item* runner_up() const {
        const std::span<const Item> next = items(1, children + 1);
        return next.empty() ? nullptr : &*std::min_element(next.begin(), next.end());
    }

    // The items at these positions of the heap: some of those that follow the top.
    std::span<const Item> items(size_t first, size_t last) const {
        return {&at(std::min(first, heap_size())), &at(std::min(last, heap_size()))};
    }

    void update(const MergeCost& cost, int32_t edge) {
        const uint32_t place = position(edge);
        const bool is_deferred = threshold_ < cost;
        if (place & in_deferred) {
            Item& item = deferred_[place & ~in_deferred];
            if (is_deferred) {
                item = {cost, edge};
            } else {
                item.edge = tombstone;
                push({cost, edge});
            }
        } else if (is_deferred) {
            remove_from_heap(place);
            defer({cost, edge});
            refill();
        } else {
            sift(place, {cost, edge});
        }
    }

    void remove(int32_t edge) {
        --size_;
        const uint32_t place = std::exchange(position(edge), absent);
        if (place & in_deferred) {
            deferred_[place & ~in_deferred].edge = tombstone;
        } else {
            remove_from_heap(place);
            refill();
        }
    }

private:
    static constexpr size_t children = 4;

    // Unused entries at the front that align each node's children to cache lines.
    static constexpr size_t padding = children - 1;

    // This bit of a position marks an edge that is deferred.
    static constexpr uint32_t in_deferred = uint32_t{1} << 31;

    // The position of an edge that is not in the queue.
    static constexpr uint32_t absent = 0xffffffff;

    // Replaces a removed edge.
    static constexpr int32_t tombstone = -1;

    // The heap holds at least this many edges, if there are as many.
    static constexpr size_t min_heap_size = 32;

    // From this position on, a level is prefetched while the one above is compared.
    static constexpr size_t first_prefetched = 2048, items_per_line = std::max<size_t>(64 / sizeof(Item), 1);

    // A refill moves about one in `share` of the deferred edges, the cheapest according to a sample.
    static constexpr size_t share = 8, sample = 16 * share;

    uint32_t& position(int32_t edge) { return positions_[static_cast<size_t>(edge)]; }
    uint32_t position(int32_t edge) const { return positions_[static_cast<size_t>(edge)]; }

    size_t heap_size() const { return heap_.size() - padding; }
    Item& at(size_t i) { return *(heap_.data() + padding + i); }
    const Item& at(size_t i) const { return *(heap_.data() + padding + i); }

    void put(size_t i, const Item& item) {
        at(i) = item;
        position(item.edge) = static_cast<uint32_t>(i);
    }

    void push(const Item& item) {
        heap_.emplace_back();
        sift(heap_size() - 1, item);
    }

    void defer(const Item& item) {
        position(item.edge) = static_cast<uint32_t>(deferred_.size()) | in_deferred;
        deferred_.push_back(item);
    }

    void remove_from_heap(size_t i) {
        const Item last = heap_.back();
        heap_.pop_back();
        if (i < heap_size()) sift(i, last);
    }

    // Keeps the heap filled, and the removed entries among the deferred edges few.
    void refill() {
        while ((heap_size() < min_heap_size && heap_size() < size_) || deferred_.size() > 2 * size_ + min_heap_size) [[unlikely]]
            refill_heap();
    }

    // Raises the threshold and moves the items up to it to the heap.
    void refill_heap() {
        if (heap_size() == size_) return deferred_.clear();
        threshold_ = next_threshold();
        for (size_t i = 0; i < deferred_.size();) {
            const Item item = deferred_[i];
            if (item.edge != tombstone && threshold_ < item) {
                ++i;
                continue;
            }
            if (item.edge != tombstone) {
                heap_.emplace_back();
                put(heap_size() - 1, item);
            }
            const Item last = deferred_.back();
            deferred_.pop_back();
            if (i == deferred_.size()) break;
            deferred_[i] = last;
            if (last.edge != tombstone) position(last.edge) = static_cast<uint32_t>(i) | in_deferred;
        }
        for (size_t i = heap_size() / children + 1; i-- > 0;)
            if (i < heap_size()) sift_down(i, Item(at(i)));
    }

    // The largest cost among the deferred edges if they are few, so that all move; otherwise a quantile of a sample.
    MergeCost next_threshold() const {
        const bool few = size_ - heap_size() <= 4 * min_heap_size;
        std::vector<MergeCost> costs;
        // A sample may hit removed entries only.
        for (size_t stride = few ? 1 : deferred_.size() / sample + 1; costs.empty(); stride = 1)
            for (size_t i = 0; i < deferred_.size(); i += stride)
                if (deferred_[i].edge != tombstone) costs.push_back(deferred_[i]);
        const auto next = costs.begin() + static_cast<std::ptrdiff_t>(few ? costs.size() - 1 : costs.size() / share);
        std::nth_element(costs.begin(), next, costs.end());
        return *next;
    }

    // Moves the item up or down from position i to where it belongs.
    void sift(size_t i, const Item& item) {
        while (i > 0 && item < at((i - 1) / children)) {
            put(i, at((i - 1) / children));
            i = (i - 1) / children;
        }
        sift_down(i, item);
    }

    void sift_down(size_t i, const Item& item) {
        for (;;) {
            const size_t first = children * i + 1, end = std::min(first + children, heap_size());
            if (first >= end) break;
            if (const size_t next = children * first + 1; next >= first_prefetched && next < heap_size())
                for (size_t c = next; c < next + children * children; c += items_per_line)
                    prefetch_line(heap_.data() + padding + c);
            size_t least = first;
            for (size_t c = first + 1; c < end; ++c) least = at(c) < at(least) ? c : least;
            if (!(at(least) < item)) break;
            put(i, at(least));
            i = least;
        }
        put(i, item);
    }

    LargeVector<Item> heap_{padding};
    LargeVector<Item> deferred_;
    size_t size_ = 0;
    MergeCost threshold_;  // no item of the heap costs more
    LargeVector<uint32_t> positions_;  // per edge
};

}  // namespace partwheel
