// The search for convex parts: pieces divided by planes and joined again while that makes their hulls smaller.
#pragma once

#include "part/convex/pieces.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace partwheel::convex {

// Every choice is the least cost, the first of several: the same on every run.
class Search {
public:
    // Whether a piece is as good as it must be; none: all are.
    using Good = std::function<bool(const Piece&)>;

    Search(Pieces& made, std::vector<Piece> start) : made_(made) {
        for (Piece& piece : start) pieces_.push_back({std::move(piece), {}, next_stamp_++});
    }

    // Divides the piece that gains most by it, until there are so many or none gains.
    void divide_until(size_t count);
    // Divides those that are not good until all are, or there are so many.
    void divide_until_good(const Good& good, size_t most);
    // Joins the two that cost least, until there are so many; with `good`, while the joined are.
    void join_until(size_t count, const Good& good = {});
    // Two neighbours together are divided by the plane that is best for them, where that is better than what divides them
    // now; with `good`, where both stay good.
    void move_borders(const Good& good = {});
    // Divides one piece and joins two others while that gains.
    void exchange();

    double cost() const;
    std::vector<Piece> take();

private:
    struct Entry {
        Piece piece;
        std::optional<Division> division;
        size_t stamp = 0;  // of this very piece
    };
    struct Pair {
        size_t a = 0, b = 0;
        double cost = HUGE_VAL;  // what joining adds
    };

    double gain(Entry& entry);
    bool divide(size_t i);
    void join(size_t a, size_t b);
    std::vector<Pair> pairs(bool all);
    Entry entry(Piece&& piece) { return {std::move(piece), {}, next_stamp_++}; }

    Pieces& made_;
    std::vector<Entry> pieces_;
    size_t next_stamp_ = 0;
    std::vector<std::pair<std::array<size_t, 2>, double>> known_;  // costs of joining, by stamps; sorted
};

}  // namespace partwheel::convex
