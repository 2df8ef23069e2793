// Convex parts of a hierarchy's solid.
//
// What planes divide the solid is searched for on a coarse copy, and done again on the solid itself: so the search takes
// much the same time for all models, and the hulls are exact.
#include "part/convex/convex_parts.h"

#include "part/convex/apart.h"
#include "part/convex/fewer.h"
#include "part/convex/search.h"
#include "part/convex/tets/coarse.h"
#include "surface/surface.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <utility>

namespace partwheel {

namespace {

using namespace convex;
using Tetrahedra = std::vector<Tetrahedron>;

constexpr size_t most_parts = 4096;
constexpr size_t coarse_points = 1000, coarse_points_per_hull = 30, coarse_points_for_error = 2000;
constexpr double more_than_wanted = 1.5;      // so many times as many pieces are made, and joined again
constexpr double slack_of_error = 0.01;
constexpr double usual_ticks_per_hull = 6, usual_ticks_for_error = 200;  // only the look of a progress bar depends on it

// The points and tetrahedra between them that a search works on.
struct Copy {
    std::vector<Point> points;
    Tetrahedra tetrahedra;
};

// Of some tetrahedra, coarse, with about so many points.
Copy coarse_copy(const Tetrahedra& tetrahedra, const HullKernel& kernel, size_t wanted) {
    const std::vector<int32_t> used = Outline(tetrahedra).vertices;
    Copy copy;
    for (const int32_t v : used) copy.points.push_back(kernel.point(v));
    copy.tetrahedra = tetrahedra;
    for (Tetrahedron& t : copy.tetrahedra)
        for (int32_t& v : t) v = static_cast<int32_t>(std::ranges::lower_bound(used, v) - used.begin());
    copy.tetrahedra = coarse(copy.tetrahedra, representatives(copy.points, wanted));
    return copy;
}

class Maker {
public:
    Maker(const Hierarchy& hierarchy, const ConvexOptions& options, Progress& progress)
        : options_(options), progress_(progress), caller_(hierarchy.vertices()), frame_(Frame::around(caller_)),
          points_(working(caller_, frame_)), solid_(hierarchy.tetrahedra()), kernel_(points_),
          error_(options.error / frame_.scale) {
        if (options.error > 0) distances_.emplace(points_, solid_);
    }

    std::vector<ConvexPart> make() {
        std::vector<Tetrahedra> pieces{Tetrahedra(solid_.begin(), solid_.end())};
        if (options_.hulls > 0) {
            divide_by_count(pieces);
        } else {
            divide_by_error(pieces);
            keep_error(pieces);
        }
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
            six += six_volumes(mesh.vertices[0], mesh.vertices[at(a)], mesh.vertices[at(b)], mesh.vertices[at(c)]);
        return six / 6;
    }

    // Takes its share of what of the progress is left, where usually so many are taken.
    void tick(double usual) {
        done_ += (1 - done_) / usual;
        progress_.reach(done_);
    }

    void divide_by_count(std::vector<Tetrahedra>& pieces) {
        const Copy copy = coarse_copy(pieces[0], kernel_, std::max(coarse_points, coarse_points_per_hull * options_.hulls));
        const auto count = static_cast<double>(options_.hulls);
        Pieces made(copy.points);
        Search search(made, copy.tetrahedra, [&] { tick(usual_ticks_per_hull * count); });
        search.divide_until(static_cast<size_t>(std::ceil(more_than_wanted * count)));
        search.join_until(options_.hulls);
        search.move_borders();
        search.exchange();
        replay(search.steps(), pieces);
    }

    void divide_by_error(std::vector<Tetrahedra>& pieces) {
        const Copy copy = coarse_copy(pieces[0], kernel_, coarse_points_for_error);
        Pieces made(copy.points);
        const auto good = [&](const convex::Piece& piece) { return keeps_error(made.kernel().surface(piece.hull)); };
        Search search(made, copy.tetrahedra, [&] { tick(usual_ticks_for_error); });
        search.divide_until_good(good, most_parts);
        search.join_while_good(good);
        replay(search.steps(), pieces);
    }

    // Where the coarse hulls kept the error and the exact ones don't, these are divided on.
    void keep_error(std::vector<Tetrahedra>& pieces) {
        for (size_t i = 0; i < pieces.size() && pieces.size() < most_parts;) {
            tick(usual_ticks_for_error);
            if (keeps_error(kernel_.surface(hull_of(pieces[i])))) {
                ++i;
                continue;
            }
            const Copy copy = coarse_copy(pieces[i], kernel_, coarse_points);
            Pieces made(copy.points);
            const Division best = made.best_division(made.piece(copy.tetrahedra));
            Sliced sides;
            if (best.cost < HUGE_VAL) sides = slice(pieces[i], best.plane, kernel_);
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
            Sliced sides = slice(a, step.plane, kernel_);
            a = std::move(sides.below);
            if (step.what == Step::divide)
                pieces.push_back(std::move(sides.above));
            else
                pieces[step.b] = std::move(sides.above);
        }
    }

    Hull hull_of(const Tetrahedra& piece) { return kernel_.build(Outline(piece).vertices); }

    TriangleMesh limited(const TriangleMesh& hull) const {
        return options_.max_vertices > 0 ? fewer_around(hull, options_.max_vertices) : hull;
    }

    bool keeps_error(const TriangleMesh& hull) const {
        return distances_->farthest(limited(hull), slack_of_error * error_, error_) <= error_;
    }

    void add_part(const Tetrahedra& piece, std::vector<ConvexPart>& parts) {
        progress_.reach(done_);
        const Hull hull = hull_of(piece);
        if (hull.facet_count() == 0) return;  // nothing but splinters in a plane
        const TriangleMesh exact = kernel_.surface(hull);
        ConvexPart part{limited(exact), 0, 0};
        part.error = options_.hulls > 0
                         ? -1
                         : frame_.scale * distances_->farthest(part.hull, slack_of_error * error_, error_);
        const bool as_it_was = part.hull.vertices.size() == exact.vertices.size();
        for (size_t i = 0; i < part.hull.vertices.size(); ++i) {
            const size_t v = as_it_was ? at(hull.vertices()[i]) : caller_.size();
            part.hull.vertices[i] = v < caller_.size() ? caller_[v] : frame_.to_caller(part.hull.vertices[i]);
        }
        for (const auto& [a, b, c, d] : piece)
            part.volume += std::fabs(six_volumes(kernel_.point(a), kernel_.point(b), kernel_.point(c), kernel_.point(d)));
        part.volume = frame_.volume_to_caller(part.volume / 6);
        parts.push_back(std::move(part));
    }

    const ConvexOptions options_;
    Progress& progress_;
    double done_ = 0;
    std::span<const Point> caller_;
    Frame frame_;
    std::vector<Point> points_;
    std::span<const Tetrahedron> solid_;
    HullKernel kernel_;  // of the points, and those where planes cross edges
    std::optional<Distances> distances_;  // where an error is asked for
    double error_;                        // working
};

}  // namespace

std::vector<ConvexPart> convex_parts(const Hierarchy& hierarchy, const ConvexOptions& options, Progress& progress) {
    return Maker(hierarchy, options, progress).make();
}

}  // namespace partwheel
