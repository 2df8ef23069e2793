// Parts copied from one side of a plane to the other, on the surface first, then spread into the tetrahedra behind.
#include "parts/mirror/mirror_parts.h"

#include "base/adjacency.h"
#include "hull/hull.h"
#include "parts/mirror/components.h"
#include "parts/mirror/propagate.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace partwheel {

namespace {

// A part with less of its volume on one side is of the other.
constexpr double fair_share = 0.25;
// A part and its image are one if the hull of both is no more than this share larger than the two hulls: not two
// sides of the model, but two halves of its middle.
constexpr double little_excess = 0.05;
// What would tie on an exactly symmetric model, such as a tetrahedron in the plane, is not left to rounding.
constexpr double rounding = 1e-7;
constexpr int32_t elsewhere = -2;  // as a part: not to be touched

Point center(const TetMesh& mesh, size_t t) {
    Point sum{};
    for (const int32_t v : mesh.tetrahedra[t]) sum = sum + 0.25 * mesh.vertices[idx(v)];
    return sum;
}

double hull_volume(const std::vector<Point>& points) {
    std::vector<int32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0);
    HullKernel kernel(points);
    return kernel.build(all).volume();
}

class Copy {
public:
    Copy(const TetMesh& mesh, Plane plane, TetLabels parts, std::span<const double> worth, Progress& progress)
        : mesh_(mesh), plane_(plane), old_(std::move(parts)), worth_(worth), progress_(progress) {}

    TetLabels run() {
        choose_side();
        settle_near_side();
        copy();
        return renumbered();
    }

private:
    bool near(const Point& p) const { return plane_.height(p) >= -rounding; }

    void choose_side() {
        const size_t tetrahedra = mesh_.tetrahedra.size();
        std::vector<double> here(old_.count, 0), all(old_.count, 0);
        for (size_t t = 0; t < tetrahedra; ++t) {
            const double v = volume(mesh_, t);
            all[idx(old_.of[t])] += v;
            if (near(center(mesh_, t))) here[idx(old_.of[t])] += v;
        }
        add_up_images(here);
        add_up_images(all);
        // What each tetrahedron's outside is worth, by the parts that were given first.
        double worth_here = 0, area_here = 0, worth_all = 0, area_all = 0;
        for (size_t t = 0; t < tetrahedra; ++t)
            for (size_t k = 0; k < 4; ++k) {
                if (mesh_.neighbors[t][k] >= 0) continue;
                const double size = facet_area(mesh_, t, k), worth = size * worth_[t];
                area_all += size;
                worth_all += worth;
                if (!near(center(mesh_, t))) continue;
                area_here += size;
                worth_here += worth;
            }
        if (worth_here * area_all < (1 - rounding) * worth_all * area_here) {
            plane_ = {-1 * plane_.normal, -plane_.offset};
            for (size_t p = 0; p < old_.count; ++p) here[p] = all[p] - here[p];
        }
        lives_.assign(old_.count, 0);
        own_image_.assign(old_.count, 0);
        for (size_t p = 0; p < old_.count; ++p) {
            lives_[p] = here[p] >= (fair_share - rounding) * all[p];
            own_image_[p] = lives_[p] && all[p] - here[p] >= (fair_share - rounding) * all[p];
        }
        for (size_t t = 0; t < tetrahedra; ++t) near_.push_back(near(center(mesh_, t)));
    }

    // What holds of a part holds of its images in the planes before.
    void add_up_images(std::vector<double>& sums) const {
        for (const std::vector<int32_t>& image : old_.images)
            for (size_t p = 0; p < old_.count; ++p)
                if (const int32_t q = image[p]; q > static_cast<int32_t>(p))
                    sums[p] = sums[idx(q)] = sums[p] + sums[idx(q)];
    }

    // The parts that live on the near side share all of it.
    void settle_near_side() {
        // What lies across the plane hangs together beyond it: of something thin the tetrahedra lie on either side in
        // turns.
        part_ = old_.of;
        for (size_t t = 0; t < near_.size(); ++t)
            if (!lives_[idx(part_[t])] || (!near_[t] && !own_image_[idx(part_[t])])) part_[t] = unassigned;
        keep_largest_components(mesh_, old_.count, part_);
        for (size_t t = 0; t < near_.size(); ++t)
            if (!near_[t]) part_[t] = elsewhere;
        spread(mesh_, neighbor_votes(mesh_, part_), part_, progress_);

        std::vector<std::vector<int32_t>> corners(old_.count);
        for (size_t t = 0; t < near_.size(); ++t)
            if (part_[t] >= 0)
                for (const int32_t v : mesh_.tetrahedra[t]) corners[idx(part_[t])].push_back(v);
        std::vector<double> one(old_.count, 0), both(old_.count, 0);
        for (size_t p = 0; p < old_.count; ++p) {
            if (corners[p].empty()) continue;
            std::sort(corners[p].begin(), corners[p].end());
            corners[p].erase(std::unique(corners[p].begin(), corners[p].end()), corners[p].end());
            std::vector<Point> points;
            for (const int32_t v : corners[p]) points.push_back(mesh_.vertices[idx(v)]);
            one[p] = hull_volume(points);
            for (const int32_t v : corners[p]) points.push_back(plane_.mirrored(mesh_.vertices[idx(v)]));
            both[p] = hull_volume(points);
        }
        add_up_images(one);
        add_up_images(both);
        for (size_t p = 0; p < old_.count; ++p) own_image_[p] |= both[p] - 2 * one[p] <= little_excess * both[p];
    }

    // Numbers: part p of the near side is still p; its image is p or count + p. What has no counterpart is of the
    // part that it was of: p, or if that does not live on the near side 2 count + p.
    int32_t image(int32_t p) const {
        return own_image_[idx(p)] ? p : static_cast<int32_t>(old_.count) + p;
    }

    int32_t kept(size_t t) const {
        const int32_t p = old_.of[t];
        return lives_[idx(p)] ? p : 2 * static_cast<int32_t>(old_.count) + p;
    }

    void copy() {
        std::vector<Triangle> facets;  // of the near side
        std::vector<int32_t> part_behind;
        struct Far {
            size_t tetrahedron, opposite;
            Point middle;
        };
        std::vector<Far> far;
        for (size_t t = 0; t < near_.size(); ++t)
            for (size_t k = 0; k < 4; ++k) {
                if (mesh_.neighbors[t][k] >= 0) continue;
                const Triangle f = facet(mesh_.tetrahedra[t], k);
                if (!near_[t]) {
                    Point middle{};
                    for (const int32_t v : f) middle = middle + 1.0 / 3 * mesh_.vertices[idx(v)];
                    far.push_back({t, k, middle});
                } else if (part_[t] >= 0) {
                    facets.push_back(f);
                    part_behind.push_back(part_[t]);
                }
            }
        for (size_t t = 0; t < near_.size(); ++t)
            if (!near_[t]) part_[t] = unassigned;
        std::vector<Vote> claims;
        if (!facets.empty()) {
            const double tolerance = 2 * mirror_tolerance * Box::around(mesh_.vertices).diagonal();
            NearestTriangle nearest(mesh_.vertices, facets);
            for (const Far& f : far) {
                const Near found = nearest(plane_.mirrored(f.middle));
                const bool counterpart = found.squared < tolerance * tolerance;
                claims.push_back({static_cast<int32_t>(f.tetrahedron),
                                  counterpart ? image(part_behind[idx(found.triangle)]) : kept(f.tetrahedron),
                                  facet_area(mesh_, f.tetrahedron, f.opposite)});
                if (claims.size() % 256 == 0) progress_.advance(0);
            }
        }
        settle(std::move(claims), part_);
        connect_components(mesh_, 3 * old_.count, part_);
        spread(mesh_, neighbor_votes(mesh_, part_), part_, progress_);
        for (size_t t = 0; t < near_.size(); ++t)  // a component that no triangle of is of
            if (part_[t] < 0) part_[t] = kept(t);
    }

    TetLabels renumbered() const {
        std::vector<int32_t> number(3 * old_.count, -1);
        for (const int32_t p : part_) number[idx(p)] = 0;
        TetLabels result;
        for (int32_t& n : number)
            if (n == 0) n = static_cast<int32_t>(result.count++);
        for (const int32_t p : part_) result.of.push_back(number[idx(p)]);
        // A part, and its images in the planes before, which lie on the same side.
        const auto count = static_cast<int32_t>(old_.count);
        const auto all = [&](const auto& image_of) {
            std::vector<int32_t> image(result.count, -1);
            for (int32_t p = 0; p < count; ++p)
                for (const auto& [from, to] : image_of(p)) {
                    if (from < 0 || to < 0 || number[idx(from)] < 0 || number[idx(to)] < 0) continue;
                    image[idx(number[idx(from)])] = number[idx(to)];
                }
            return image;
        };
        using Ways = std::vector<std::pair<int32_t, int32_t>>;
        for (const std::vector<int32_t>& before : old_.images)
            result.images.push_back(all([&](int32_t p) -> Ways {
                const int32_t q = before[idx(p)];
                if (q < 0) return {};
                return {{p, q}, {image(p), image(q)}, {2 * count + p, 2 * count + q}};
            }));
        result.images.push_back(all([&](int32_t p) -> Ways { return {{p, image(p)}, {image(p), p}}; }));
        for (const int32_t before : old_.stands) {
            const int32_t p = before < 0 ? -1 : number[idx(before)];
            result.stands.push_back(before >= 0 && p < 0 ? number[idx(2 * count + before)] : p);
        }
        return result;
    }

    const TetMesh& mesh_;
    Plane plane_;
    const TetLabels old_;
    const std::span<const double> worth_;  // of each tetrahedron
    Progress& progress_;
    std::vector<uint8_t> lives_, own_image_;  // of each old part
    std::vector<uint8_t> near_;               // of each tetrahedron
    std::vector<int32_t> part_;               // likewise
};

}  // namespace

TetLabels mirrored(const TetMesh& mesh, std::span<const Plane> planes, std::span<const int32_t> part,
                           size_t count, std::span<const double> worth, Progress& progress) {
    TetLabels parts{{part.begin(), part.end()}, count, {}, std::vector<int32_t>(count)};
    std::iota(parts.stands.begin(), parts.stands.end(), 0);
    for (const Plane& plane : planes) parts = Copy(mesh, plane, std::move(parts), worth, progress).run();
    return parts;
}

TetLabels dissolve_parts(const TetMesh& mesh, TetLabels parts, std::span<const int32_t> scraps,
                            Progress& progress) {
    const std::vector<int32_t> before = parts.of;
    std::vector<int32_t> number(parts.count, 0);
    for (const int32_t p : scraps) number[idx(p)] = unassigned;
    for (int32_t& p : parts.of)
        if (number[idx(p)] < 0) p = unassigned;
    spread(mesh, neighbor_votes(mesh, parts.of), parts.of, progress);
    for (size_t t = 0; t < before.size(); ++t)
        if (parts.of[t] < 0) {  // it has no neighbours
            parts.of[t] = before[t];
            number[idx(before[t])] = 0;
        }
    parts.count = 0;
    for (int32_t& n : number)
        if (n == 0) n = static_cast<int32_t>(parts.count++);
    for (int32_t& p : parts.of) p = number[idx(p)];
    for (int32_t& p : parts.stands) p = p < 0 ? -1 : number[idx(p)];
    for (std::vector<int32_t>& image : parts.images) {
        std::vector<int32_t> there(parts.count, -1);
        for (size_t p = 0; p < image.size(); ++p)
            if (number[p] >= 0 && image[p] >= 0) there[idx(number[p])] = number[idx(image[p])];
        image = std::move(there);
    }
    return parts;
}

}  // namespace partwheel
