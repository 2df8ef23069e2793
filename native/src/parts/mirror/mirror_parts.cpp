// Copies part labels across a symmetry plane: on the surface first, from where they spread to the tetrahedra inside.
#include "parts/mirror/mirror_parts.h"

#include "base/adjacency.h"
#include "base/sorted.h"
#include "hull/hull.h"
#include "parts/mirror/components.h"
#include "parts/mirror/propagate.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace partwheel {

namespace {

// A part belongs to a side of the plane if at least this share of its volume lies there.
constexpr double min_volume_share = 0.25;
// A part and its image are one part (two halves of the model's middle, not two limbs) if the hull of both exceeds the
// sum of their hulls by at most this share.
constexpr double max_excess = 0.05;
// Decides ties on exactly symmetric models, such as a tetrahedron in the plane, despite rounding errors.
constexpr double rounding = 1e-7;
constexpr int32_t fixed = -2;  // a label that does not change

Point center(const TetMesh& mesh, size_t t) {
    Point sum{};
    for (const int32_t v : mesh.tetrahedra[t]) sum = sum + 0.25 * mesh.vertices[idx(v)];
    return sum;
}

double hull_volume(const std::vector<Point>& points, Progress& progress) {
    std::vector<int32_t> ids(points.size());
    std::iota(ids.begin(), ids.end(), 0);
    HullKernel kernel(points, progress);
    return kernel.build(ids).volume();
}

class SymmetricLabelCopy {
public:
    SymmetricLabelCopy(const TetMesh& mesh, Plane plane, TetLabels parts, std::span<const double> scores,
                       Progress& progress)
        : mesh_(mesh), plane_(plane), old_(std::move(parts)), scores_(scores), progress_(progress) {}

    TetLabels run() {
        choose_side();
        label_near_side();
        copy_to_far_side();
        return renumber();
    }

private:
    bool is_near(const Point& p) const { return plane_.height(p) >= -rounding; }

    void choose_side() {
        const size_t tetrahedra = mesh_.tetrahedra.size();
        std::vector<double> near_volume(old_.count, 0), part_volume(old_.count, 0);
        for (size_t t = 0; t < tetrahedra; ++t) {
            const double v = volume(mesh_, t);
            part_volume[idx(old_.label[t])] += v;
            if (is_near(center(mesh_, t))) near_volume[idx(old_.label[t])] += v;
        }
        sum_over_images(near_volume);
        sum_over_images(part_volume);
        double near_score = 0, near_area = 0, total_score = 0, total_area = 0;
        for (size_t t = 0; t < tetrahedra; ++t)
            for (size_t k = 0; k < 4; ++k) {
                if (mesh_.neighbors[t][k] >= 0) continue;
                const double size = facet_area(mesh_, t, k), weighted_score = size * scores_[t];
                total_area += size;
                total_score += weighted_score;
                if (!is_near(center(mesh_, t))) continue;
                near_area += size;
                near_score += weighted_score;
            }
        if (near_score * total_area < (1 - rounding) * total_score * near_area) {
            plane_ = {-1 * plane_.normal, -plane_.offset};
            for (size_t p = 0; p < old_.count; ++p) near_volume[p] = part_volume[p] - near_volume[p];
        }
        is_alive_.assign(old_.count, 0);
        is_self_symmetric_.assign(old_.count, 0);
        for (size_t p = 0; p < old_.count; ++p) {
            is_alive_[p] = near_volume[p] >= (min_volume_share - rounding) * part_volume[p];
            is_self_symmetric_[p] =
                is_alive_[p] && part_volume[p] - near_volume[p] >= (min_volume_share - rounding) * part_volume[p];
        }
        for (size_t t = 0; t < tetrahedra; ++t) is_near_.push_back(is_near(center(mesh_, t)));
    }

    // Replaces the value of each part by the sum over it and its images in the previous planes.
    void sum_over_images(std::vector<double>& sums) const {
        for (const std::vector<int32_t>& image : old_.mirror)
            for (size_t p = 0; p < old_.count; ++p)
                if (const int32_t q = image[p]; q > static_cast<int32_t>(p))
                    sums[p] = sums[idx(q)] = sums[p] + sums[idx(q)];
    }

    // Divides the near side among the parts that belong to it.
    void label_near_side() {
        // A part across the plane may be connected only beyond it: the tetrahedra of a thin sheet lie on both sides.
        label_ = old_.label;
        for (size_t t = 0; t < is_near_.size(); ++t)
            if (!is_alive_[idx(label_[t])] || (!is_near_[t] && !is_self_symmetric_[idx(label_[t])]))
                label_[t] = unassigned;
        keep_largest_components(mesh_, old_.count, label_);
        for (size_t t = 0; t < is_near_.size(); ++t)
            if (!is_near_[t]) label_[t] = fixed;
        propagate_labels(mesh_, neighbor_votes(mesh_, label_), label_, progress_);

        std::vector<std::vector<int32_t>> corners(old_.count);
        for (size_t t = 0; t < is_near_.size(); ++t)
            if (label_[t] >= 0)
                for (const int32_t v : mesh_.tetrahedra[t]) corners[idx(label_[t])].push_back(v);
        std::vector<double> half_hull(old_.count, 0), whole_hull(old_.count, 0);
        for (size_t p = 0; p < old_.count; ++p) {
            if (corners[p].empty()) continue;
            sort_unique(corners[p]);
            std::vector<Point> points;
            for (const int32_t v : corners[p]) points.push_back(mesh_.vertices[idx(v)]);
            half_hull[p] = hull_volume(points, progress_);
            for (const int32_t v : corners[p]) points.push_back(plane_.mirrored(mesh_.vertices[idx(v)]));
            whole_hull[p] = hull_volume(points, progress_);
        }
        sum_over_images(half_hull);
        sum_over_images(whole_hull);
        for (size_t p = 0; p < old_.count; ++p)
            is_self_symmetric_[p] |= whole_hull[p] - 2 * half_hull[p] <= max_excess * whole_hull[p];
    }

    // Labels: part p of the near side stays p; its image is p or count + p. A tetrahedron without a counterpart keeps
    // its old part: p, or 2 count + p if that does not belong to the near side.
    int32_t image(int32_t p) const {
        return is_self_symmetric_[idx(p)] ? p : static_cast<int32_t>(old_.count) + p;
    }

    int32_t old_part(size_t t) const {
        const int32_t p = old_.label[t];
        return is_alive_[idx(p)] ? p : 2 * static_cast<int32_t>(old_.count) + p;
    }

    void copy_to_far_side() {
        std::vector<Triangle> near_facets;
        std::vector<int32_t> near_labels;
        struct FarFacet {
            size_t tetrahedron, opposite;
            Point centroid;
        };
        std::vector<FarFacet> far_facets;
        for (size_t t = 0; t < is_near_.size(); ++t)
            for (size_t k = 0; k < 4; ++k) {
                if (mesh_.neighbors[t][k] >= 0) continue;
                const Triangle f = facet(mesh_.tetrahedra[t], k);
                if (!is_near_[t]) {
                    Point centroid{};
                    for (const int32_t v : f) centroid = centroid + 1.0 / 3 * mesh_.vertices[idx(v)];
                    far_facets.push_back({t, k, centroid});
                } else if (label_[t] >= 0) {
                    near_facets.push_back(f);
                    near_labels.push_back(label_[t]);
                }
            }
        for (size_t t = 0; t < is_near_.size(); ++t)
            if (!is_near_[t]) label_[t] = unassigned;
        std::vector<Vote> votes;
        if (!near_facets.empty()) {
            const double tolerance = 2 * mirror_tolerance * Box::around(mesh_.vertices).diagonal();
            NearestTriangle nearest(mesh_.vertices, near_facets);
            for (const FarFacet& f : far_facets) {
                const Near counterpart = nearest(plane_.mirrored(f.centroid));
                const bool has_counterpart = counterpart.squared < tolerance * tolerance;
                votes.push_back(
                    {static_cast<int32_t>(f.tetrahedron),
                     has_counterpart ? image(near_labels[idx(counterpart.triangle)]) : old_part(f.tetrahedron),
                     facet_area(mesh_, f.tetrahedron, f.opposite)});
                if (votes.size() % 256 == 0) progress_.advance(0);
            }
        }
        assign_majority(std::move(votes), label_);
        connect_components(mesh_, 3 * old_.count, label_);
        propagate_labels(mesh_, neighbor_votes(mesh_, label_), label_, progress_);
        for (size_t t = 0; t < is_near_.size(); ++t)  // a component without votes
            if (label_[t] < 0) label_[t] = old_part(t);
    }

    TetLabels renumber() const {
        std::vector<int32_t> new_id(3 * old_.count, -1);
        for (const int32_t p : label_) new_id[idx(p)] = 0;
        TetLabels result;
        for (int32_t& n : new_id)
            if (n == 0) n = static_cast<int32_t>(result.count++);
        for (const int32_t p : label_) result.label.push_back(new_id[idx(p)]);
        const auto count = static_cast<int32_t>(old_.count);
        const auto map_images = [&](const auto& pairs_of) {
            std::vector<int32_t> image(result.count, -1);
            for (int32_t p = 0; p < count; ++p)
                for (const auto& [from, to] : pairs_of(p)) {
                    if (from < 0 || to < 0 || new_id[idx(from)] < 0 || new_id[idx(to)] < 0) continue;
                    image[idx(new_id[idx(from)])] = new_id[idx(to)];
                }
            return image;
        };
        using Pairs = std::vector<std::pair<int32_t, int32_t>>;  // of old labels: a part and its image
        for (const std::vector<int32_t>& mirror : old_.mirror)  // images in previous planes lie on the same side
            result.mirror.push_back(map_images([&](int32_t p) -> Pairs {
                const int32_t q = mirror[idx(p)];
                if (q < 0) return {};
                return {{p, q}, {image(p), image(q)}, {2 * count + p, 2 * count + q}};
            }));
        result.mirror.push_back(map_images([&](int32_t p) -> Pairs { return {{p, image(p)}, {image(p), p}}; }));
        for (const int32_t old : old_.new_part) {
            const int32_t p = old < 0 ? -1 : new_id[idx(old)];
            result.new_part.push_back(old >= 0 && p < 0 ? new_id[idx(2 * count + old)] : p);
        }
        return result;
    }

    const TetMesh& mesh_;
    Plane plane_;
    const TetLabels old_;
    const std::span<const double> scores_;  // of each tetrahedron
    Progress& progress_;
    std::vector<uint8_t> is_alive_, is_self_symmetric_;  // of each old part
    std::vector<uint8_t> is_near_;               // of each tetrahedron
    std::vector<int32_t> label_;               // likewise
};

}  // namespace

TetLabels copy_symmetric_labels(const TetMesh& mesh, std::span<const Plane> planes, std::span<const int32_t> label,
                                size_t count, std::span<const double> scores, Progress& progress) {
    TetLabels parts{{label.begin(), label.end()}, count, {}, std::vector<int32_t>(count)};
    std::iota(parts.new_part.begin(), parts.new_part.end(), 0);
    for (const Plane& plane : planes) parts = SymmetricLabelCopy(mesh, plane, std::move(parts), scores, progress).run();
    return parts;
}

TetLabels dissolve_parts(const TetMesh& mesh, TetLabels parts, std::span<const int32_t> dissolved, Progress& progress) {
    const std::vector<int32_t> old_label = parts.label;
    std::vector<int32_t> new_id(parts.count, 0);
    for (const int32_t p : dissolved) new_id[idx(p)] = unassigned;
    for (int32_t& p : parts.label)
        if (new_id[idx(p)] < 0) p = unassigned;
    propagate_labels(mesh, neighbor_votes(mesh, parts.label), parts.label, progress);
    for (size_t t = 0; t < old_label.size(); ++t)
        if (parts.label[t] < 0) {  // no neighboring part
            parts.label[t] = old_label[t];
            new_id[idx(old_label[t])] = 0;
        }
    parts.count = 0;
    for (int32_t& n : new_id)
        if (n == 0) n = static_cast<int32_t>(parts.count++);
    for (int32_t& p : parts.label) p = new_id[idx(p)];
    for (int32_t& p : parts.new_part) p = p < 0 ? -1 : new_id[idx(p)];
    for (std::vector<int32_t>& image : parts.mirror) {
        std::vector<int32_t> new_image(parts.count, -1);
        for (size_t p = 0; p < image.size(); ++p)
            if (new_id[p] >= 0 && image[p] >= 0) new_image[idx(new_id[p])] = new_id[idx(image[p])];
        image = std::move(new_image);
    }
    return parts;
}

}  // namespace partwheel
