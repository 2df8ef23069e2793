// Greedy search for convex parts: planes divide pieces, and pieces merge again, while that shrinks the hulls.
#pragma once

#include "convex/pieces.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace partwheel::convex {

// A step of the search, by positions in its list of pieces. divide: piece a keeps what is below the plane, what is
// above is appended. merge: b is added to a and removed. redivide: the plane divides a and b together into a (below)
// and b (above).
struct Step {
    enum { divide, merge, redivide } kind;
    size_t a, b;
    CutPlane plane;
};

// Each choice has the lowest cost, the first one in a tie, so every run gives the same result.
class Search {
public:
    using Predicate = std::function<bool(const ConvexPiece&)>;
    using Tick = std::function<void()>;  // called before each division; it may throw

    Search(PieceFactory& factory, std::vector<std::vector<Tetrahedron>> start, Tick tick)
        : factory_(factory), tick_(std::move(tick)) {
        for (auto& tetrahedra : start) {
            initial_tetrahedra_ += tetrahedra.size();
            pieces_.push_back(make_candidate(factory_.build_piece(std::move(tetrahedra))));
        }
    }

    // Divides the piece with the largest gain, until there are count pieces or none gains.
    void divide_until(size_t count);
    // Divides pieces that are not good until all are, or there are max_count.
    void divide_until_good(const Predicate& is_good, size_t max_count);
    // Merges the cheapest pair until there are count pieces, then on while that costs nothing.
    void merge_until(size_t count);
    // Merges the cheapest pair whose union is good, while there is one.
    void merge_while_good(const Predicate& is_good);
    // Divides each pair of neighbors by the best plane for both together, if that costs less than their present border.
    void refine_borders();
    // Divides one piece and merges two others while that gains.
    void trade_pieces();

    double cost() const;  // the sum of the hulls' volumes
    std::span<const Step> steps() const { return steps_; }

private:
    struct Candidate {
        ConvexPiece piece;
        std::optional<Division> division;
        size_t stamp = 0;  // unique per piece
    };
    struct Pair {
        size_t a = 0, b = 0;
        double cost = HUGE_VAL;  // what merging adds
    };

    bool is_too_fine() const;
    double gain(Candidate& candidate);
    size_t piece_with_largest_gain();
    bool divide(size_t i);
    void merge(size_t a, size_t b);
    std::vector<Pair> sorted_pairs(bool include_distant);
    Candidate make_candidate(ConvexPiece&& piece) { return {std::move(piece), {}, next_stamp_++}; }

    PieceFactory& factory_;
    Tick tick_;
    std::vector<Candidate> pieces_;
    std::vector<Step> steps_;
    size_t next_stamp_ = 0, initial_tetrahedra_ = 0;
    std::vector<std::pair<std::array<size_t, 2>, double>> cost_cache_;  // costs of merging by stamps, sorted
};

}  // namespace partwheel::convex
