// Convex decomposition of a hierarchy's solid.
//
// The search for cut planes runs on a coarse copy of the solid; its steps are then replayed on the solid itself. So
// the search takes about the same time for all models, and the hulls are exact.
#include "convex/convex_parts.h"

#include "base/corners.h"
#include "base/sorted.h"
#include "convex/concave_edges.h"
#include "convex/distance.h"
#include "convex/simplify.h"
#include "convex/search.h"
#include "convex/coarse_tets.h"
#include "mesh/surface.h"

#include <memory>

namespace partwheel {

namespace {

using namespace convex;
using Tetrahedra = std::vector<Tetrahedron>;

constexpr size_t coarse_points = 2000, coarse_points_per_hull = 30;
constexpr double max_shift = 0.5;          // of a point by the coarse copy, relative to the error
constexpr double excess_pieces = 1.5;      // pieces per wanted hull before merging
constexpr size_t excess_parts = 2;         // parts of the hierarchy per wanted hull before merging
constexpr double relative_slack = 0.01;
constexpr double coarse_slack = 0.01;    // in working coordinates, to find a point that is nearly the farthest
constexpr double tie = 1e-5;             // costs that differ by less, relative, are the same
constexpr size_t max_wall_pieces = 128, wall_pieces_per_hull = 4;  // before merging
constexpr size_t max_open_pieces = 256;  // before merging, to keep openings free
constexpr double expected_ticks_per_hull = 6, expected_ticks_for_error = 200;  // for the progress bar only

// The corners of some tetrahedra; representative[i] is the one that stands for point i of the kernel.
struct CoarsePoints {
    std::vector<Point> points;
    std::vector<int32_t> representative;
};

double largest_shift(std::span<const Point> points, std::span<const int32_t> representative) {
    double largest = 0;
    for (size_t i = 0; i < points.size(); ++i) largest = std::max(largest, length(points[i] - points[idx(representative[i])]));
    return largest;
}

// About point_count points, or as many more as keep each within a distance.
CoarsePoints coarse_points_of(std::span<const Tetrahedron> tetrahedra, const HullKernel& kernel, size_t point_count,
                              double distance, Progress& progress) {
    CoarsePoints coarse;
    const std::vector<int32_t> vertices = corner_vertices(tetrahedra);
    progress.reach(0);
    for (const int32_t v : vertices) coarse.points.push_back(kernel.point(v));
    std::vector<int32_t> representative;
    do {
        representative = cluster_vertices(coarse.points, point_count, progress);
        point_count *= 2;
    } while (largest_shift(coarse.points, representative) > distance);
    coarse.representative.resize(kernel.point_count());
    for (size_t i = 0; i < vertices.size(); ++i) coarse.representative[idx(vertices[i])] = representative[i];
    return coarse;
}

// Pieces of the solid, and a coarse copy of each.
struct Start {
    std::vector<Tetrahedra> pieces, copies;
};

// A search on a coarse copy of some pieces.
struct CoarseSearch {
    using IsGood = std::function<bool(const TriangleMesh&)>;  // of hulls

    std::vector<Tetrahedra> pieces;
    PieceFactory factory;
    Search search;

    CoarseSearch(const Start& start, const CoarsePoints& coarse, ThreadPool& threads, std::span<const Plane> walls,
                 std::function<Point(const TriangleMesh&)> farthest, Search::Tick tick, IsGood is_good)
        : pieces(start.pieces), factory(coarse.points, threads, walls),
          search(
              factory, start.copies, std::move(tick),
              [this, farthest](const auto& piece) { return farthest(surface(piece)); },
              is_good ? [this, is_good](const auto& piece) { return is_good(surface(piece)); } : Search::Predicate{}) {}

private:
    TriangleMesh surface(const convex::ConvexPiece& piece) const { return factory.kernel().surface(piece.hull); }
};

class ConvexDecomposer {
public:
    ConvexDecomposer(const Hierarchy& hierarchy, const ConvexOptions& options, Progress& progress)
        : hierarchy_(hierarchy), options_(options), progress_(progress), threads_(options.threads),
          caller_points_(hierarchy.vertices()), frame_(Frame::around(caller_points_)),
          points_(hierarchy.data().working_vertices()),
          solid_(chosen_tetrahedra(hierarchy, options)), kernel_(points_, progress_),
          bound_((options.hulls > 0         ? options.keep_open
                  : options.keep_open > 0 ? std::min(options.error, options.keep_open)
                                          : options.error) /
                 frame_.scale) {}

    std::vector<ConvexPart> run() {
        CoarsePoints coarse;
        threads_.parallel_for(2, 1, [&](size_t task, size_t) {
            if (task == 0)
                concave_ = ConcaveEdges(points_, solid_, progress_);
            else
                coarse = choose_points(solid_, std::max(coarse_points, coarse_points_per_hull * options_.hulls));
        });
        std::vector<Tetrahedra> pieces = options_.hulls > 0 ? decompose_by_count(coarse) : decompose_by_error(coarse);
        if (bound_ > 0) distance();  // before several threads use it
        std::vector<ConvexPart> parts(pieces.size());
        std::vector<std::optional<HullKernel>> kernels(threads_.count());
        threads_.parallel_for_each(pieces.size(), [&](size_t thread, size_t i) {
            if (!kernels[thread]) kernels[thread].emplace(std::span<const Point>{}, progress_).copy_points(kernel_);
            parts[i] = make_part(pieces[i], *kernels[thread]);
        });
        std::erase_if(parts, [](const ConvexPart& part) { return part.hull.triangles.empty(); });  // flat
        std::ranges::stable_sort(parts, std::greater{},
                                 [](const ConvexPart& part) { return enclosed_volume(part.hull); });
        return parts;
    }

private:
    static Tetrahedra chosen_tetrahedra(const Hierarchy& hierarchy, const ConvexOptions& options) {
        const auto all = hierarchy.tetrahedra();
        if (options.slices.empty()) return {all.begin(), all.end()};
        Tetrahedra chosen;
        for (const auto& [first, last] : options.slices) chosen.insert(chosen.end(), all.begin() + first, all.begin() + last);
        return chosen;
    }

    static double enclosed_volume(const TriangleMesh& mesh) {
        double volume6 = 0;
        for (const auto& [a, b, c] : mesh.triangles) volume6 += signed_volume6(mesh.vertices, {0, a, b, c});
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

    CoarsePoints choose_points(std::span<const Tetrahedron> tetrahedra, size_t count) const {
        return coarse_points_of(tetrahedra, kernel_, count, bound_ > 0 ? max_shift * bound_ : HUGE_VAL, progress_);
    }

    Start make_start(std::vector<Tetrahedra> pieces, const CoarsePoints& coarse) const {
        Start start{std::move(pieces), {}};
        for (const Tetrahedra& piece : start.pieces) {
            progress_.reach(fraction_);
            start.copies.push_back(coarsen(piece, coarse.representative));
        }
        return start;
    }

    std::unique_ptr<CoarseSearch> start_search(const Start& start, const CoarsePoints& coarse, double expected_ticks) {
        CoarseSearch::IsGood is_good;
        if (bound_ > 0) is_good = [this](const TriangleMesh& hull) { return is_within_bound(hull); };
        return std::make_unique<CoarseSearch>(
            start, coarse, threads_, concave_.walls,
            [this](const TriangleMesh& hull) { return distance().farthest(hull, coarse_slack).point; },
            [this, expected_ticks] { tick(expected_ticks); }, std::move(is_good));
    }

    // Searches from three starts: the solid divided at walls, the whole solid, and the hierarchy's parts. Takes the
    // result whose hulls cover the fewest openings after merging, of several the one that costs least.
    std::vector<Tetrahedra> decompose_by_count(const CoarsePoints& coarse) {
        std::array<Start, 2> starts;  // the whole solid; the hierarchy's parts, if all of it is wanted
        const size_t start_count = options_.slices.empty() ? 2 : 1;
        threads_.parallel_for(start_count, 1, [&](size_t i, size_t) {
            auto pieces = i == 0 ? std::vector<Tetrahedra>{solid_} : cut_into_parts(excess_parts * options_.hulls);
            starts[i] = make_start(std::move(pieces), coarse);
        });
        const auto piece_count = static_cast<size_t>(std::ceil(excess_pieces * static_cast<double>(options_.hulls)));
        const double expected_ticks = expected_ticks_per_hull * static_cast<double>(options_.hulls);
        std::unique_ptr<CoarseSearch> best;
        std::pair<size_t, double> least;
        const auto compare = [&](const Start& start, auto divide) {
            auto candidate = start_search(start, coarse, expected_ticks);
            Search& search = candidate->search;
            if (options_.hulls > 1) divide(search);
            if (bound_ > 0) {
                search.divide_until_good(std::max(max_open_pieces, piece_count));
                search.merge_while_good(options_.hulls);
            }
            search.merge_until(options_.hulls);
            const std::pair cost{search.count_bad(), search.cost()};
            // In a tie the earlier one, which has fewer pieces.
            if (best && !(std::pair{cost.first, (1 + tie) * cost.second} < least)) return;
            best = std::move(candidate);
            least = cost;
        };
        if (!concave_.walls.empty())
            compare(starts[0], [&](Search& search) {
                search.divide_at_walls(concave_, std::min(max_wall_pieces, wall_pieces_per_hull * options_.hulls));
            });
        for (const Start& start : std::span(starts).first(start_count))
            compare(start, [&](Search& search) { search.divide_until(piece_count); });
        best->search.refine_borders();
        best->search.trade_pieces();
        best->search.merge_until(options_.hulls);
        replay(best->search.steps(), best->pieces);
        return std::move(best->pieces);
    }

    std::vector<Tetrahedra> decompose_by_error(const CoarsePoints& coarse) {
        const auto candidate = start_search(make_start({solid_}, coarse), coarse, expected_ticks_for_error);
        candidate->search.divide_at_walls(concave_, max_wall_pieces);
        candidate->search.divide_until_good(max_parts);
        candidate->search.merge_while_good(1);
        replay(candidate->search.steps(), candidate->pieces);
        enforce_error(candidate->pieces);
        return std::move(candidate->pieces);
    }

    // Divides pieces whose exact hull violates the error although the coarse one did not.
    void enforce_error(std::vector<Tetrahedra>& pieces) {
        for (size_t i = 0; i < pieces.size() && pieces.size() < max_parts;) {
            tick(expected_ticks_for_error);
            if (is_within_bound(kernel_.surface(piece_hull(pieces[i], kernel_)))) {
                ++i;
                continue;
            }
            const CoarsePoints coarse = choose_points(pieces[i], coarse_points);
            const auto candidate = start_search(make_start({pieces[i]}, coarse), coarse, expected_ticks_for_error);
            SliceResult sides;
            if (candidate->search.divide_further(0)) sides = slice_piece(pieces[i], candidate->search.steps()[0].plane);
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

    SliceResult slice_piece(const Tetrahedra& piece, const Plane& plane) {
        SliceResult sides = slice(piece, plane, kernel_);
        edges_.insert(edges_.end(), sides.edges.begin(), sides.edges.end());
        return sides;
    }

    // Without the vertices that a plane added on an edge if the piece, merged again, contains both ends of the edge.
    Hull piece_hull(const Tetrahedra& piece, HullKernel& kernel) const {
        const std::vector<int32_t> vertices = corner_vertices(piece);
        std::vector<int32_t> extreme;
        std::ranges::copy_if(vertices, std::back_inserter(extreme), [&](int32_t v) {
            return idx(v) < caller_points_.size() ||
                   !std::ranges::all_of(edges_[idx(v) - caller_points_.size()],
                                        [&](int32_t end) { return std::ranges::binary_search(vertices, end); });
        });
        return kernel.build(extreme);
    }

    TriangleMesh simplify(const TriangleMesh& hull) const {
        return options_.max_vertices > 0 ? simplify_outer_hull(hull, options_.max_vertices, progress_) : hull;
    }

    const SolidDistance& distance() {
        if (!distance_) distance_.emplace(points_, hierarchy_.tetrahedra(), progress_);
        return *distance_;
    }

    double bounded_distance(const TriangleMesh& hull) {
        return distance().max_distance(hull, relative_slack * bound_, bound_);
    }

    bool is_within_bound(const TriangleMesh& hull) { return bounded_distance(simplify(hull)) <= bound_; }

    // Without triangles if it is flat.
    ConvexPart make_part(const Tetrahedra& piece, HullKernel& kernel) {
        progress_.reach(fraction_);
        const Hull hull = piece_hull(piece, kernel);
        if (hull.facet_count() == 0) return {};
        const TriangleMesh exact = kernel.surface(hull);
        ConvexPart part{simplify(exact), 0, 0};
        part.error = bound_ > 0 ? frame_.scale * bounded_distance(part.hull) : -1;
        const bool is_exact = part.hull.vertices.size() == exact.vertices.size();
        std::vector<Point> corners = part.hull.vertices;
        for (size_t i = 0; i < corners.size(); ++i) {
            const size_t v = is_exact ? idx(hull.vertices()[i]) : caller_points_.size();
            corners[i] = v < caller_points_.size() ? caller_points_[v] : frame_.to_caller(corners[i]);
        }
        part.hull = convex_hull(corners, progress_);  // again: rounded corners of a planar facet may be concave
        for (const auto& [a, b, c, d] : piece)
            part.volume +=
                std::fabs(signed_volume6(kernel.point(a), kernel.point(b), kernel.point(c), kernel.point(d)));
        part.volume = frame_.volume_to_caller(part.volume / 6);
        return part;
    }

    const Hierarchy& hierarchy_;
    const ConvexOptions options_;
    Progress& progress_;
    ThreadPool threads_;
    double fraction_ = 0;
    std::span<const Point> caller_points_;
    Frame frame_;
    std::vector<Point> points_;
    const Tetrahedra solid_;
    HullKernel kernel_;        // of the points, then those where planes cross edges
    std::vector<Edge> edges_;  // that each added point lies on
    ConcaveEdges concave_;
    std::optional<SolidDistance> distance_;  // once needed
    double bound_;  // of the hulls' distance from the solid, in working coordinates; 0: none
};

}  // namespace

std::vector<ConvexPart> convex_parts(const Hierarchy& hierarchy, const ConvexOptions& options, Progress& progress) {
    return ConvexDecomposer(hierarchy, options, progress).run();
}

}  // namespace partwheel
