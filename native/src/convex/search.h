// Greedy search for convex parts: planes divide pieces, and pieces merge again, while that shrinks the hulls.
#pragma once

#include "convex/concave_edges.h"
#include "convex/pieces.h"

#include <set>

namespace partwheel::convex {

// A step of the search, by positions in its list of pieces. divide: piece a keeps what is below the plane, what is
// above is appended. merge: b is added to a and removed. redivide: the plane divides a and b together into a (below)
// and b (above).
struct Step {
    enum { divide, merge, redivide } kind;
    size_t a, b;
    Plane plane;
};

// Each choice has the lowest cost, the first one in a tie, so every run gives the same result.
class Search {
public:
    using Predicate = std::function<bool(const ConvexPiece&)>;
    using Tick = std::function<void()>;  // called before each division; it may throw
    using Farthest = std::function<Point(const ConvexPiece&)>;  // the point of a hull that is farthest from the solid

    // is_good: whether a hull keeps to the error; good hulls stay good, and need no division. None: there is no error.
    Search(PieceFactory& factory, std::vector<std::vector<Tetrahedron>> start, Tick tick, Farthest farthest,
           Predicate is_good = {})
        : factory_(factory), tick_(std::move(tick)), farthest_(std::move(farthest)), is_good_(std::move(is_good)) {
        for (auto& tetrahedra : start) {
            initial_tetrahedra_ += tetrahedra.size();
            pieces_.push_back(make_candidate(factory_.build_piece(std::move(tetrahedra))));
        }
    }

    // Divides pieces by the walls that resolve the most concave edges, until all are convex or good, or there are
    // max_count. Before any other step, on one piece.
    void divide_at_walls(const ConcaveEdges& concave, size_t max_count);
    // Divides the piece with the largest gain, until there are count pieces or none gains, with one plane or with two.
    void divide_until(size_t count);
    // Divides pieces that are not good until all are, or there are max_count.
    void divide_until_good(size_t max_count);
    // Divides a piece by the best plane or, if none gains, by the first of the best two. Returns false if it is flat.
    bool divide_further(size_t i);
    // Merges the cheapest pair until there are count pieces, then on while that costs nothing.
    void merge_until(size_t count);
    // Merges the cheapest pair whose union is good, while there are one and more than count pieces.
    void merge_while_good(size_t count);
    // Divides each pair of neighbors by the best plane for both together, if that costs less than their present border
    // and both stay good.
    void refine_borders();
    // Divides one piece and merges two others while that gains and the union is good.
    void trade_pieces();

    double cost() const;  // the sum of the hulls' volumes
    size_t count_bad() const;
    std::span<const Step> steps() const { return steps_; }

private:
    struct Candidate {
        ConvexPiece piece;
        std::optional<Division> division;
        bool is_pair_evaluated = false;
        size_t stamp = 0;  // unique per piece
    };
    struct Pair {
        size_t a = 0, b = 0;
        double cost = HUGE_VAL;  // what merging adds
    };

    bool is_union_good(const Pair& pair);
    bool is_too_fine() const;
    bool is_good(const ConvexPiece& piece) const { return !is_good_ || is_good_(piece); }
    bool is_good_enough(const ConvexPiece& piece) const { return is_good_ && is_good_(piece); }
    bool divide_with_pair(double threshold);
    std::optional<Division> find_best_wall(const ConvexPiece& piece, std::span<const ConcaveEdge> edges,
                                           std::span<const Plane> walls, double threshold);
    double gain(Candidate& candidate);
    size_t piece_with_largest_gain();
    bool divide(size_t i);
    void merge(size_t a, size_t b);
    std::vector<Pair> sorted_pairs(bool include_distant);
    Candidate make_candidate(ConvexPiece&& piece) { return {std::move(piece), {}, false, next_stamp_++}; }

    PieceFactory& factory_;
    Tick tick_;
    Farthest farthest_;
    Predicate is_good_;
    std::vector<Candidate> pieces_;
    std::vector<Step> steps_;
    size_t next_stamp_ = 0, initial_tetrahedra_ = 0;
    std::vector<std::pair<std::array<size_t, 2>, double>> cost_cache_;  // costs of merging by stamps, sorted
    std::set<std::array<size_t, 2>> bad_unions_;  // by stamps
};

}  // namespace partwheel::convex
