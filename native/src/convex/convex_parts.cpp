// Convex decomposition of a hierarchy's solid.
//
// The search for cut planes runs on a coarse copy of the solid; its steps are then replayed on the solid itself. So
// the search takes about the same time for all models, and the hulls are exact.
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
constexpr double excess_pieces = 1.5;      // as many pieces are made per wanted hull, then merged
constexpr size_t excess_parts = 2;              // as many parts of the hierarchy per wanted hull are merged
constexpr double relative_slack = 0.01;
constexpr double expected_ticks_per_hull = 6, expected_ticks_for_error = 200;  // for the progress bar only

// Points and tetrahedra that a search works on.
struct CoarseCopy {
    std::vector<Point> points;
    std::vector<Tetrahedra> pieces;
};

// Of some pieces, with about point_count points.
CoarseCopy make_coarse_copy(std::span<const Tetrahedra> pieces, const HullKernel& kernel, size_t point_count) {
    std::vector<int32_t> used;
    for (const Tetrahedra& piece : pieces)
        for (const Tetrahedron& t : piece) used.insert(used.end(), t.begin(), t.end());
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    CoarseCopy copy;
    for (const int32_t v : used) copy.points.push_back(kernel.point(v));
    const std::vector<int32_t> representative = cluster_vertices(copy.points, point_count);
    for (Tetrahedra piece : pieces) {
        for (Tetrahedron& t : piece)
            for (int32_t& v : t) v = static_cast<int32_t>(std::ranges::lower_bound(used, v) - used.begin());
        copy.pieces.push_back(coarsen(piece, representative));
    }
    return copy;
}

// A search on a coarse copy of some pieces.
struct CoarseSearch {
    std::vector<Tetrahedra> pieces;
    CoarseCopy copy;
    PieceFactory factory;
    Search search;

    CoarseSearch(std::vector<Tetrahedra>&& start, const HullKernel& kernel, size_t points, Search::Tick tick)
        : pieces(std::move(start)), copy(make_coarse_copy(pieces, kernel, points)), factory(copy.points),
          search(factory, copy.pieces, std::move(tick)) {}
};

class ConvexDecomposer {
public:
    ConvexDecomposer(const Hierarchy& hierarchy, const ConvexOptions& options, Progress& progress)
        : hierarchy_(hierarchy), options_(options), progress_(progress), caller_points_(hierarchy.vertices()),
          frame_(Frame::around(caller_points_)), points_(to_working(caller_points_, frame_)),
          solid_(hierarchy.tetrahedra()), kernel_(points_),
          error_(options.error / frame_.scale) {
        if (options.error > 0) distance_.emplace(points_, solid_);
    }

    std::vector<ConvexPart> run() {
        std::vector<Tetrahedra> pieces = options_.hulls > 0 ? decompose_by_count() : decompose_by_error();
        std::vector<ConvexPart> parts;
        for (const Tetrahedra& piece : pieces) add_part(piece, parts);
        std::ranges::stable_sort(parts, std::greater{},
                                 [](const ConvexPart& part) { return enclosed_volume(part.hull); });
        return parts;
    }

private:
    static std::vector<Point> to_working(std::span<const Point> caller, const Frame& frame) {
        std::vector<Point> points;
        points.reserve(caller.size());
        for (const Point& p : caller) points.push_back(frame.to_working(p));
        return points;
    }

    static double enclosed_volume(const TriangleMesh& mesh) {
        double volume6 = 0;
        for (const auto& [a, b, c] : mesh.triangles)
            volume6 +=
                signed_volume6(mesh.vertices[0], mesh.vertices[idx(a)], mesh.vertices[idx(b)], mesh.vertices[idx(c)]);
        return volume6 / 6;
    }

    // Advances by 1 / expected_ticks of the remaining progress.
    void tick(double expected_ticks) {
        fraction_ += (1 - fraction_) / expected_ticks;
        progress_.reach(fraction_);
    }

    // The solid cut into this many of the hierarchy's parts.
    std::vector<Tetrahedra> cut_into_parts(size_t parts) const {
        std::vector<Tetrahedra> pieces;
        const auto bounds = hierarchy_.cut_least_concavity(std::min({parts, max_parts, solid_.size()}));
        for (size_t k = 0; k + 1 < bounds.size(); ++k)
            pieces.emplace_back(solid_.begin() + bounds[k], solid_.begin() + bounds[k + 1]);
        return pieces;
    }

    // Starts from the whole solid or from the hierarchy's parts, whichever costs less after merging.
    std::vector<Tetrahedra> decompose_by_count() {
        const size_t points = std::max(coarse_points, coarse_points_per_hull * options_.hulls);
        const auto piece_count = static_cast<size_t>(std::ceil(excess_pieces * static_cast<double>(options_.hulls)));
        const double expected_ticks = expected_ticks_per_hull * static_cast<double>(options_.hulls);
        std::unique_ptr<CoarseSearch> best;
        for (const size_t start : {size_t{1}, excess_parts * options_.hulls}) {
            auto candidate =
                std::make_unique<CoarseSearch>(cut_into_parts(start), kernel_, points, [&] { tick(expected_ticks); });
            if (options_.hulls > 1) candidate->search.divide_until(piece_count);
            candidate->search.merge_until(options_.hulls);
            if (!best || candidate->search.cost() < best->search.cost()) best = std::move(candidate);
        }
        best->search.refine_borders();
        best->search.trade_pieces();
        best->search.merge_until(options_.hulls);
        replay(best->search.steps(), best->pieces);
        return std::move(best->pieces);
    }

    std::vector<Tetrahedra> decompose_by_error() {
        CoarseSearch candidate(cut_into_parts(1), kernel_, coarse_points, [&] { tick(expected_ticks_for_error); });
        const auto is_good = [&](const convex::ConvexPiece& piece) {
            return is_within_error(candidate.factory.kernel().surface(piece.hull));
        };
        candidate.search.divide_until_good(is_good, max_parts);
        candidate.search.merge_while_good(is_good);
        replay(candidate.search.steps(), candidate.pieces);
        enforce_error(candidate.pieces);
        return std::move(candidate.pieces);
    }

    // Divides pieces whose exact hull violates the error although the coarse one did not.
    void enforce_error(std::vector<Tetrahedra>& pieces) {
        for (size_t i = 0; i < pieces.size() && pieces.size() < max_parts;) {
            tick(expected_ticks_for_error);
            if (is_within_error(kernel_.surface(piece_hull(pieces[i])))) {
                ++i;
                continue;
            }
            const CoarseCopy copy = make_coarse_copy({&pieces[i], 1}, kernel_, coarse_points);
            PieceFactory factory(copy.points);
            const Division best = factory.find_best_division(factory.build_piece(copy.pieces[0]));
            SliceResult sides;
            if (best.cost < HUGE_VAL) sides = slice_piece(pieces[i], best.plane);
            if (sides.below.empty() || sides.above.empty()) {
                ++i;
                continue;
            }
            pieces[i] = std::move(sides.below);
            pieces.push_back(std::move(sides.above));
        }
    }

    // Applies the steps of a search on coarse pieces to these exact ones.
    void replay(std::span<const Step> steps, std::vector<Tetrahedra>& pieces) {
        for (const Step& step : steps) {
            progress_.reach(fraction_);
            Tetrahedra& a = pieces[step.a];
            if (step.kind != Step::divide) a.insert(a.end(), pieces[step.b].begin(), pieces[step.b].end());
            if (step.kind == Step::merge) {
                pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(step.b));
                continue;
            }
            SliceResult sides = slice_piece(a, step.plane);
            a = std::move(sides.below);
            if (step.kind == Step::divide)
                pieces.push_back(std::move(sides.above));
            else
                pieces[step.b] = std::move(sides.above);
        }
    }

    SliceResult slice_piece(const Tetrahedra& piece, const CutPlane& plane) {
        SliceResult sides = slice(piece, plane, kernel_);
        edges_.insert(edges_.end(), sides.edges.begin(), sides.edges.end());
        return sides;
    }

    // Without the vertices that a plane added on an edge if the piece, merged again, contains both ends of the edge.
    Hull piece_hull(const Tetrahedra& piece) {
        const std::vector<int32_t> vertices = VertexEdgeSet(piece).vertices;
        std::vector<int32_t> extreme;
        std::ranges::copy_if(vertices, std::back_inserter(extreme), [&](int32_t v) {
            return idx(v) < caller_points_.size() ||
                   !std::ranges::all_of(edges_[idx(v) - caller_points_.size()],
                                        [&](int32_t end) { return std::ranges::binary_search(vertices, end); });
        });
        return kernel_.build(extreme);
    }

    TriangleMesh simplify(const TriangleMesh& hull) const {
        return options_.max_vertices > 0 ? simplify_outer_hull(hull, options_.max_vertices) : hull;
    }

    bool is_within_error(const TriangleMesh& hull) const {
        return distance_->max_distance(simplify(hull), relative_slack * error_, error_) <= error_;
    }

    void add_part(const Tetrahedra& piece, std::vector<ConvexPart>& parts) {
        progress_.reach(fraction_);
        const Hull hull = piece_hull(piece);
        if (hull.facet_count() == 0) return;  // flat
        const TriangleMesh exact = kernel_.surface(hull);
        ConvexPart part{simplify(exact), 0, 0};
        part.error = options_.hulls > 0
                         ? -1
                         : frame_.scale * distance_->max_distance(part.hull, relative_slack * error_, error_);
        const bool is_exact = part.hull.vertices.size() == exact.vertices.size();
        std::vector<Point> corners = part.hull.vertices;
        for (size_t i = 0; i < corners.size(); ++i) {
            const size_t v = is_exact ? idx(hull.vertices()[i]) : caller_points_.size();
            corners[i] = v < caller_points_.size() ? caller_points_[v] : frame_.to_caller(corners[i]);
        }
        part.hull = convex_hull(corners);  // again: rounded corners of a planar facet may be concave
        for (const auto& [a, b, c, d] : piece)
            part.volume +=
                std::fabs(signed_volume6(kernel_.point(a), kernel_.point(b), kernel_.point(c), kernel_.point(d)));
        part.volume = frame_.volume_to_caller(part.volume / 6);
        parts.push_back(std::move(part));
    }

    const Hierarchy& hierarchy_;
    const ConvexOptions options_;
    Progress& progress_;
    double fraction_ = 0;
    std::span<const Point> caller_points_;
    Frame frame_;
    std::vector<Point> points_;
    std::span<const Tetrahedron> solid_;
    HullKernel kernel_;        // of the points, then those where planes cross edges
    std::vector<Edge> edges_;  // that each added point lies on
    std::optional<SolidDistance> distance_;  // if options_.error > 0
    double error_;                        // in working coordinates
};

}  // namespace

std::vector<ConvexPart> convex_parts(const Hierarchy& hierarchy, const ConvexOptions& options, Progress& progress) {
    return ConvexDecomposer(hierarchy, options, progress).run();
}

}  // namespace partwheel
