// Convex parts of a hierarchy's solid.
//
// What planes divide the solid is searched for on a coarse copy, and done again on the solid itself: so the search takes
// much the same time for all models, and the hulls are exact.
#include "convex/convex_parts.h"

#include "convex/distance.h"
#include "convex/simplify.h"
#include "convex/search.h"
#include "convex/coarse_tets.h"
#include "mesh/surface.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <utility>

namespace partwheel {

namespace {

using namespace convex;
using Tetrahedra = std::vector<Tetrahedron>;

constexpr size_t coarse_points = 2000, coarse_points_per_hull = 30;
constexpr double more_than_wanted = 1.5;      // so many times as many pieces are made, and joined again
constexpr size_t more_parts = 2;              // so many times as many of the hierarchy's parts are joined
constexpr double slack_of_error = 0.01;
constexpr double usual_ticks_per_hull = 6, usual_ticks_for_error = 200;  // only the look of a progress bar depends on it

// What a search works on: points, and tetrahedra between them.
struct Copy {
    std::vector<Point> points;
    std::vector<Tetrahedra> pieces;
};

// Of some pieces, coarse, with about so many points.
Copy coarse_copy(std::span<const Tetrahedra> pieces, const HullKernel& kernel, size_t wanted) {
    std::vector<int32_t> used;
    for (const Tetrahedra& piece : pieces)
        for (const Tetrahedron& t : piece) used.insert(used.end(), t.begin(), t.end());
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    Copy copy;
    for (const int32_t v : used) copy.points.push_back(kernel.point(v));
    const std::vector<int32_t> representative = representatives(copy.points, wanted);
    for (Tetrahedra piece : pieces) {
        for (Tetrahedron& t : piece)
            for (int32_t& v : t) v = static_cast<int32_t>(std::ranges::lower_bound(used, v) - used.begin());
        copy.pieces.push_back(coarse(piece, representative));
    }
    return copy;
}

// A search on a coarse copy of some pieces.
struct Attempt {
    std::vector<Tetrahedra> pieces;
    Copy copy;
    Pieces made;
    Search search;

    Attempt(std::vector<Tetrahedra>&& start, const HullKernel& kernel, size_t points, Search::Tick tick)
        : pieces(std::move(start)), copy(coarse_copy(pieces, kernel, points)), made(copy.points),
          search(made, copy.pieces, std::move(tick)) {}
};

class Maker {
public:
    Maker(const Hierarchy& hierarchy, const ConvexOptions& options, Progress& progress)
        : hierarchy_(hierarchy), options_(options), progress_(progress), caller_(hierarchy.vertices()), frame_(Frame::around(caller_)),
          points_(working(caller_, frame_)), solid_(hierarchy.tetrahedra()), kernel_(points_),
          error_(options.error / frame_.scale) {
        if (options.error > 0) distances_.emplace(points_, solid_);
    }

    std::vector<ConvexPart> make() {
        std::vector<Tetrahedra> pieces = options_.hulls > 0 ? by_count() : by_error();
        std::vector<ConvexPart> parts;
        for (const Tetrahedra& piece : pieces) add_part(piece, parts);
        std::ranges::stable_sort(parts, std::greater{}, [](const ConvexPart& part) { return enclosed(part.hull); });
        return parts;
    }

private:
    static std::vector<Point> working(std::span<const Point> caller, const Frame& frame) {
        std::vector<Point> points;
        points.reserve(caller.size());
        for (const Point& p : caller) points.push_back(frame.to_working(p));
        return points;
    }

    static double enclosed(const TriangleMesh& mesh) {
        double six = 0;
        for (const auto& [a, b, c] : mesh.triangles)
            six += signed_volume6(mesh.vertices[0], mesh.vertices[idx(a)], mesh.vertices[idx(b)], mesh.vertices[idx(c)]);
        return six / 6;
    }

    // Takes its share of what of the progress is left, where usually so many are taken.
    void tick(double usual) {
        done_ += (1 - done_) / usual;
        progress_.reach(done_);
    }

    // Slices of the hierarchy's tetrahedra.
    std::vector<Tetrahedra> of_cut(size_t parts) const {
        std::vector<Tetrahedra> pieces;
        const auto bounds = hierarchy_.cut_least_concavity(std::min({parts, max_parts, solid_.size()}));
        for (size_t k = 0; k + 1 < bounds.size(); ++k)
            pieces.emplace_back(solid_.begin() + bounds[k], solid_.begin() + bounds[k + 1]);
        return pieces;
    }

    // From the whole or from the hierarchy's parts, whichever begins better.
    std::vector<Tetrahedra> by_count() {
        const size_t points = std::max(coarse_points, coarse_points_per_hull * options_.hulls);
        const auto more = static_cast<size_t>(std::ceil(more_than_wanted * static_cast<double>(options_.hulls)));
        const double usual = usual_ticks_per_hull * static_cast<double>(options_.hulls);
        std::unique_ptr<Attempt> best;
        for (const size_t start : {size_t{1}, more_parts * options_.hulls}) {
            auto attempt = std::make_unique<Attempt>(of_cut(start), kernel_, points, [&] { tick(usual); });
            if (options_.hulls > 1) attempt->search.divide_until(more);
            attempt->search.join_until(options_.hulls);
            if (!best || attempt->search.cost() < best->search.cost()) best = std::move(attempt);
        }
        best->search.move_borders();
        best->search.exchange();
        best->search.join_until(options_.hulls);
        replay(best->search.steps(), best->pieces);
        return std::move(best->pieces);
    }

    std::vector<Tetrahedra> by_error() {
        Attempt attempt(of_cut(1), kernel_, coarse_points, [&] { tick(usual_ticks_for_error); });
        const auto good = [&](const convex::Piece& piece) { return keeps_error(attempt.made.kernel().surface(piece.hull)); };
        attempt.search.divide_until_good(good, max_parts);
        attempt.search.join_while_good(good);
        replay(attempt.search.steps(), attempt.pieces);
        keep_error(attempt.pieces);
        return std::move(attempt.pieces);
    }

    // Where the coarse hulls kept the error and the exact ones don't, these are divided on.
    void keep_error(std::vector<Tetrahedra>& pieces) {
        for (size_t i = 0; i < pieces.size() && pieces.size() < max_parts;) {
            tick(usual_ticks_for_error);
            if (keeps_error(kernel_.surface(of_piece(pieces[i])))) {
                ++i;
                continue;
            }
            const Copy copy = coarse_copy({&pieces[i], 1}, kernel_, coarse_points);
            Pieces made(copy.points);
            const Division best = made.best_division(made.piece(copy.pieces[0]));
            Sliced sides;
            if (best.cost < HUGE_VAL) sides = sliced(pieces[i], best.plane);
            if (sides.below.empty() || sides.above.empty()) {
                ++i;
                continue;
            }
            pieces[i] = std::move(sides.below);
            pieces.push_back(std::move(sides.above));
        }
    }

    // What the search did with coarse pieces, with these.
    void replay(std::span<const Step> steps, std::vector<Tetrahedra>& pieces) {
        for (const Step& step : steps) {
            progress_.reach(done_);
            Tetrahedra& a = pieces[step.a];
            if (step.what != Step::divide) a.insert(a.end(), pieces[step.b].begin(), pieces[step.b].end());
            if (step.what == Step::join) {
                pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(step.b));
                continue;
            }
            Sliced sides = sliced(a, step.plane);
            a = std::move(sides.below);
            if (step.what == Step::divide)
                pieces.push_back(std::move(sides.above));
            else
                pieces[step.b] = std::move(sides.above);
        }
    }

    Sliced sliced(const Tetrahedra& piece, const CutPlane& plane) {
        Sliced sides = slice(piece, plane, kernel_);
        edges_.insert(edges_.end(), sides.edges.begin(), sides.edges.end());
        return sides;
    }

    // Vertices that a plane made on an edge are left out where a piece, joined again, has both its ends.
    Hull of_piece(const Tetrahedra& piece) {
        const std::vector<int32_t> vertices = Outline(piece).vertices;
        std::vector<int32_t> needed;
        std::ranges::copy_if(vertices, std::back_inserter(needed), [&](int32_t v) {
            return idx(v) < caller_.size() || !std::ranges::all_of(edges_[idx(v) - caller_.size()], [&](int32_t end) {
                       return std::ranges::binary_search(vertices, end);
                   });
        });
        return kernel_.build(needed);
    }

    TriangleMesh limited(const TriangleMesh& hull) const {
        return options_.max_vertices > 0 ? simplify_outer_hull(hull, options_.max_vertices) : hull;
    }

    bool keeps_error(const TriangleMesh& hull) const {
        return distances_->farthest(limited(hull), slack_of_error * error_, error_) <= error_;
    }

    void add_part(const Tetrahedra& piece, std::vector<ConvexPart>& parts) {
        progress_.reach(done_);
        const Hull hull = of_piece(piece);
        if (hull.facet_count() == 0) return;  // nothing but splinters in a plane
        const TriangleMesh exact = kernel_.surface(hull);
        ConvexPart part{limited(exact), 0, 0};
        part.error = options_.hulls > 0
                         ? -1
                         : frame_.scale * distances_->farthest(part.hull, slack_of_error * error_, error_);
        const bool as_it_was = part.hull.vertices.size() == exact.vertices.size();
        std::vector<Point> corners = part.hull.vertices;
        for (size_t i = 0; i < corners.size(); ++i) {
            const size_t v = as_it_was ? idx(hull.vertices()[i]) : caller_.size();
            corners[i] = v < caller_.size() ? caller_[v] : frame_.to_caller(corners[i]);
        }
        part.hull = convex_hull(corners);  // once more: what rounding does to corners in a plane may have dented it
        for (const auto& [a, b, c, d] : piece)
            part.volume += std::fabs(signed_volume6(kernel_.point(a), kernel_.point(b), kernel_.point(c), kernel_.point(d)));
        part.volume = frame_.volume_to_caller(part.volume / 6);
        parts.push_back(std::move(part));
    }

    const Hierarchy& hierarchy_;
    const ConvexOptions options_;
    Progress& progress_;
    double done_ = 0;
    std::span<const Point> caller_;
    Frame frame_;
    std::vector<Point> points_;
    std::span<const Tetrahedron> solid_;
    HullKernel kernel_;        // of the points, and those where planes cross edges
    std::vector<Edge> edges_;  // these
    std::optional<Distances> distances_;  // where an error is asked for
    double error_;                        // working
};

}  // namespace

std::vector<ConvexPart> convex_parts(const Hierarchy& hierarchy, const ConvexOptions& options, Progress& progress) {
    return Maker(hierarchy, options, progress).make();
}

}  // namespace partwheel
