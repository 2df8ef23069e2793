// The search for convex parts: pieces divided by planes and joined again while that makes their hulls smaller.
#pragma once

#include "convex/pieces.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace partwheel::convex {

// What the search did, by places in its list of pieces: piece a is divided, and what is above goes to the end; b is joined
// with a, and those after b move up; or a and b together are divided anew.
struct Step {
    enum { divide, join, move } what;
    size_t a, b;
    CutPlane plane;
};

// Every choice is the least cost, the first of several: the same on every run.
class Search {
public:
    using Good = std::function<bool(const Piece&)>;
    using Tick = std::function<void()>;  // called before each division; it may throw

    Search(Pieces& made, std::vector<std::vector<Tetrahedron>> start, Tick tick) : made_(made), tick_(std::move(tick)) {
        for (auto& tetrahedra : start) {
            tetrahedra_at_first_ += tetrahedra.size();
            pieces_.push_back(entry(made_.piece(std::move(tetrahedra))));
        }
    }

    // Divides the piece that gains most by it, until there are so many or none gains.
    void divide_until(size_t count);
    // Divides those that are not good until all are, or there are so many.
    void divide_until_good(const Good& good, size_t most);
    // Joins the two that cost least, until there are so many, and on while that costs nothing.
    void join_until(size_t count);
    // Joins the two that cost least while what is joined is good.
    void join_while_good(const Good& good);
    // Two neighbours together are divided by the plane that is best for them, where that is better than what divides them
    // now.
    void move_borders();
    // Divides one piece and joins two others while that gains.
    void exchange();

    double cost() const;  // all hulls' volume
    std::span<const Step> steps() const { return steps_; }

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

    bool crowded() const;
    double gain(Entry& entry);
    size_t most_gaining();
    bool divide(size_t i);
    void join(size_t a, size_t b);
    std::vector<Pair> pairs(bool all);
    Entry entry(Piece&& piece) { return {std::move(piece), {}, next_stamp_++}; }

    Pieces& made_;
    Tick tick_;
    std::vector<Entry> pieces_;
    std::vector<Step> steps_;
    size_t next_stamp_ = 0, tetrahedra_at_first_ = 0;
    std::vector<std::pair<std::array<size_t, 2>, double>> known_;  // costs of joining, by stamps; sorted
};

}  // namespace partwheel::convex
