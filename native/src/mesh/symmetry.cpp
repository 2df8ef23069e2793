// Mirror planes: candidates, how much of the surface has its mirror image, and where the two sides meet best.
#include "mesh/symmetry.h"

#include "base/principal.h"
#include "mesh/nearest.h"

namespace partwheel {

namespace {

constexpr size_t fewest_samples = 64, few_samples = 256, many_samples = 1024;
constexpr size_t stride = 389;  // has no divisor in common with any of these
constexpr double min_coarse_share = 0.4;  // of the fewest samples, for a plane that is worth moving
constexpr double min_few_share = min_mirrored_share - 0.1;  // of few samples, whose error is not greater
constexpr int max_moves = 6;
constexpr double min_gain = 0.01;  // a plane is only moved if the mirrored share of the area grows by this
constexpr double reach = 1.0 / 20;  // relative to the diagonal: how far off a counterpart is when a plane is moved
constexpr double max_cosine = 0.1;  // between the normals of planes that count as perpendicular

using Axes = std::array<Point, 3>;

// The eigenvectors of a symmetric matrix, that of the least eigenvalue first.
Axes sorted_axes(std::array<Point, 3> m) {
    const Axes axes = diagonalize(m);
    std::array<size_t, 3> order = {0, 1, 2};
    std::ranges::stable_sort(order, {}, [&](size_t i) { return m[i][i]; });
    return {axes[order[0]], axes[order[1]], axes[order[2]]};
}

class Search {
public:
    Search(std::span<const Point> vertices, std::span<const Triangle> triangles, Progress& progress)
        : vertices_(vertices), progress_(progress), nearest_(vertices, triangles) {
        diagonal_ = Box::around(vertices).diagonal();
        sort_triangles(triangles);
        fewest_ = sample_points(fewest_samples);
        few_ = sample_points(few_samples);
        many_ = sample_points(many_samples);
    }

    std::vector<Plane> planes() {
        std::vector<Candidate> found;
        for (const std::array<Plane, 3>& parallel : candidates()) {
            std::array<double, 3> shares;
            for (size_t i = 0; i < 3; ++i) shares[i] = share(parallel[i], fewest_, min_coarse_share);
            const auto best = std::ranges::max_element(shares);
            if (*best < min_coarse_share) continue;
            double most = 0;
            const auto consider = [&](const Plane& plane, double handicap) {
                if (share(plane, few_, min_few_share) <= min_few_share) return;
                found.push_back({plane, handicap});
                if (most < 1 - min_gain) most = std::max(most, measure(found.back()));
            };
            for (size_t i = 0; i < 3; ++i)
                if (shares[i] >= min_coarse_share) consider(parallel[i], 0);
            if (most < 1 - min_gain)  // else it can't gain enough
                consider(fit(parallel[static_cast<size_t>(best - shares.begin())]), min_gain);
        }
        std::vector<Plane> chosen;
        while (chosen.size() < 3) {
            Candidate best{{}, 0, 0};
            for (Candidate& c : found)
                if (best.share - best.handicap < 1 - c.handicap && measure(c) >= min_mirrored_share &&
                    c.share - c.handicap > best.share - best.handicap)
                    best = c;
            if (best.share < min_mirrored_share) break;
            chosen.push_back(best.plane);
            // Makes the other planes exactly perpendicular to it.
            std::erase_if(found, [&](Candidate& c) {
                const double along = dot(c.plane.normal, best.plane.normal);
                if (std::fabs(along) > max_cosine) return true;
                const Point middle = c.plane.mirrored(middle_) + middle_;  // twice a point of the plane
                const Point normal = c.plane.normal - along * best.plane.normal;
                c.plane.normal = 1 / length(normal) * normal;
                c.plane.offset = dot(c.plane.normal, middle) / 2;
                c.share = unknown;
                return false;
            });
        }
        return chosen;
    }

private:
    static constexpr double unknown = -1;
    struct Candidate {
        Plane plane;
        double handicap;  // how much better it must be than others
        double share = unknown;
    };

    // Done only where it may matter: of a symmetric model several candidates are the same plane but for rounding.
    double measure(Candidate& c) {
        if (c.share == unknown) c.share = share(c.plane, many_, min_mirrored_share);
        return c.share;
    }

    // Sorts triangles by their centroids and starts each at its lowest corner, so that their numbering doesn't matter.
    void sort_triangles(std::span<const Triangle> triangles) {
        std::vector<std::pair<Point, Triangle>> order;
        for (Triangle t : triangles) {
            const auto lowest = std::ranges::min_element(t, {}, [&](int32_t v) { return vertices_[idx(v)]; });
            std::rotate(t.begin(), lowest, t.end());
            order.push_back({center(t), t});
        }
        std::ranges::stable_sort(order, {}, [](const auto& entry) -> const Point& { return entry.first; });
        for (const auto& [centroid, triangle] : order) triangles_.push_back(triangle);
    }

    // Points distributed evenly over the area: in the order of the triangles, the same area from each to the next.
    std::vector<Point> sample_points(size_t count) {
        std::vector<double> until;
        double sum = 0;
        for (const Triangle& t : triangles_) until.push_back(sum += area(corner(t, 0), corner(t, 1), corner(t, 2)));
        std::vector<Point> points;
        for (size_t i = 0, t = 0; i < count; ++i) {
            const double place = (static_cast<double>(i) + 0.5) / static_cast<double>(count) * sum;
            while (t + 1 < until.size() && until[t] <= place) ++t;
            // Within the triangle, by a sequence that fills the square evenly (Roberts 2018), folded.
            double u = static_cast<double>(i) * 0.7548776662466927, v = static_cast<double>(i) * 0.5698402909980532;
            u -= std::floor(u);
            v -= std::floor(v);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const Triangle& chosen = triangles_[t];
            const Point& a = corner(chosen, 0);
            points.push_back(a + u * (corner(chosen, 1) - a) + v * (corner(chosen, 2) - a));
        }
        return points;
    }

    // Three parallel planes for each normal: through the centroid, the origin, and the middle of the bounding box.
    std::vector<std::array<Plane, 3>> candidates() {
        double whole = 0;
        for (const Triangle& t : triangles_) {
            const double size = area(corner(t, 0), corner(t, 1), corner(t, 2));
            middle_ = middle_ + size * center(t);
            whole += size;
        }
        if (!std::isfinite(1 / whole)) return {};  // all on a line
        middle_ = 1 / whole * middle_;
        std::array<Point, 3> covariance{};
        for (const Triangle& t : triangles_)
            add_outer_product(covariance, center(t) - middle_, area(corner(t, 0), corner(t, 1), corner(t, 2)));
        std::vector<std::array<Plane, 3>> planes;
        for (const Axes& axes : {Axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, sorted_axes(covariance)})
            for (const Point& normal : axes) {
                double least = HUGE_VAL, most = -HUGE_VAL;
                for (const Point& p : vertices_) {
                    least = std::min(least, dot(normal, p));
                    most = std::max(most, dot(normal, p));
                }
                planes.push_back({{{normal, dot(normal, middle_)}, {normal, 0}, {normal, (least + most) / 2}}});
            }
        return planes;
    }

    // The share of the points whose mirror image lies on the surface; 0 if it is below `least`.
    double share(const Plane& plane, std::span<const Point> points, double least) {
        const double tolerance = mirror_tolerance * diagonal_;
        progress_.advance_by(0.01);
        size_t count = points.size();
        for (size_t i = 0; i < points.size(); ++i) {  // far from each other, so that misses are found early
            if (nearest_.within(plane.mirrored(points[i * stride % points.size()]), tolerance)) continue;
            if (static_cast<double>(--count) < least * static_cast<double>(points.size())) return 0;
        }
        return static_cast<double>(count) / static_cast<double>(points.size());
    }

    // Moves the plane to where its two sides meet best (iterated closest points): through the midpoints of points and
    // the points of the surface nearest to their mirror images. Gives up where a move brings no more points to the
    // surface.
    Plane fit(Plane plane) {
        double mirrored_before = 0;
        for (int move = 0; move < max_moves; ++move) {
            std::array<Point, 3> offsets{};
            Point sum{};
            double count = 0, mirrored = 0;
            for (const Point& p : few_) {
                const Near near = nearest_(plane.mirrored(p), reach * diagonal_);
                if (near.triangle < 0) continue;
                if (std::sqrt(near.squared) <= mirror_tolerance * diagonal_) ++mirrored;
                add_outer_product(offsets, p - near.point);
                sum = sum + 0.5 * (p + near.point);
                ++count;
            }
            const bool is_near = mirrored >= min_few_share * static_cast<double>(few_.size());
            if (count == 0 || (!is_near && mirrored <= mirrored_before)) break;
            mirrored_before = mirrored;
            Point normal = sorted_axes(offsets)[2];
            if (dot(normal, plane.normal) < 0) normal = -1 * normal;
            plane = {normal, dot(normal, 1 / count * sum)};
            progress_.advance(0);
        }
        return plane;
    }

    const Point& corner(const Triangle& t, size_t k) const { return vertices_[idx(t[k])]; }
    Point center(const Triangle& t) const { return 1.0 / 3 * (corner(t, 0) + corner(t, 1) + corner(t, 2)); }

    std::span<const Point> vertices_;
    std::vector<Triangle> triangles_;
    Progress& progress_;
    NearestTriangle nearest_;
    Point middle_{};
    double diagonal_ = 0;
    std::vector<Point> fewest_, few_, many_;
};

}  // namespace

std::vector<Plane> mirror_planes(std::span<const Point> vertices, std::span<const Triangle> triangles,
                                 Progress& progress) {
    if (triangles.empty()) return {};
    return Search(vertices, triangles, progress).planes();
}

}  // namespace partwheel
