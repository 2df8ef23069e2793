// Copies part labels across a symmetry plane: on the surface first, from where they spread to the tetrahedra inside.
#include "parts/mirror/mirror_parts.h"

#include "base/sorted.h"
#include "hull/hull.h"
#include "mesh/nearest.h"
#include "parts/boundary.h"
#include "parts/majority.h"
#include "parts/mirror/components.h"

namespace partwheel {

namespace {

// A part belongs to a side of the plane if at least this share of its volume lies there.
constexpr double min_share = 0.25;
// A part and its image are one part (two halves of the model's middle, not two limbs) if the hull of both exceeds the
// sum of their hulls by at most this share.
constexpr double max_excess = 0.05;
// Passes in which borders move toward their mirror images, and the weight of a facet's own label; an image's has 1.
constexpr int border_passes = 4;
constexpr double own_weight = 0.9;
// Decides ties on exactly symmetric models, such as a tetrahedron in the plane, despite rounding errors.
constexpr double rounding = 1e-7;
constexpr int32_t fixed = -2;  // a label below unlabeled, so that it never changes

bool is_near(const TetMesh& mesh, const Plane& plane, size_t t) {
    return plane.height(centroid(mesh.vertices, mesh.tetrahedra[t])) >= -rounding;
}

// The largest distance of a facet's mirror image from the surface.
double counterpart_tolerance(const TetMesh& mesh) { return 2 * mirror_tolerance * Box::around(mesh.vertices).diagonal(); }

Plane reversed(const Plane& plane) { return {-1 * plane.normal, -plane.offset}; }

// Whether the side below the plane has the higher mean score. scores: of each tetrahedron, counted by its boundary
// area.
bool is_far_side_better(const TetMesh& mesh, const Plane& plane, std::span<const double> scores) {
    double near_score = 0, near_area = 0, total_score = 0, total_area = 0;
    for_each_boundary_facet(mesh, [&](size_t t, size_t k) {
        const double size = facet_area(mesh, t, k), weighted_score = size * scores[t];
        total_area += size;
        total_score += weighted_score;
        if (!is_near(mesh, plane, t)) return;
        near_area += size;
        near_score += weighted_score;
    });
    return near_score * total_area < (1 - rounding) * total_score * near_area;
}

class SymmetricLabelCopy {
public:
    SymmetricLabelCopy(const TetMesh& mesh, Plane plane, TetLabels parts, std::span<const double> scores,
                       Progress& progress, const Regions* regions)
        : mesh_(mesh), plane_(plane), old_(std::move(parts)), scores_(scores), progress_(progress),
          patch_of_(regions ? regions->patches() : std::span<const int32_t>()),
          keeps_patches_(regions && regions->has_hints) {}

    TetLabels run() {
        choose_side();
        choose_parts();
        label_near_side();
        find_self_symmetric_parts();
        find_counterparts();
        if (!patch_of_.empty()) match_patches();
        copy_to_far_side();
        return renumber();
    }

private:
    Point center(size_t t) const { return centroid(mesh_.vertices, mesh_.tetrahedra[t]); }

    void choose_side() {
        is_reversed_ = is_far_side_better(mesh_, plane_, scores_);
        if (is_reversed_) plane_ = reversed(plane_);
        for (size_t t = 0; t < mesh_.tetrahedra.size(); ++t) is_near_tet_.push_back(is_near(mesh_, plane_, t));
    }

    // Which parts belong to the near side, and which of them lie across the plane: they are their own images.
    void choose_parts() {
        std::vector<double> near_volume(old_.count, 0), whole_volume(old_.count, 0);
        for (size_t t = 0; t < is_near_tet_.size(); ++t) {
            const double v = volume(mesh_, t);
            whole_volume[idx(old_.label[t])] += v;
            if (is_reversed_ ? plane_.height(center(t)) > rounding : is_near_tet_[t]) near_volume[idx(old_.label[t])] += v;
        }
        sum_over_images(near_volume);
        sum_over_images(whole_volume);
        for (size_t p = 0; p < old_.count; ++p) {
            const double least = (min_share - rounding) * whole_volume[p];
            is_near_part_.push_back(near_volume[p] >= least);
            is_self_symmetric_.push_back(is_near_part_[p] && whole_volume[p] - near_volume[p] >= least);
        }
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
        for (size_t t = 0; t < is_near_tet_.size(); ++t)
            if (!is_near_part_[idx(label_[t])] || (!is_near_tet_[t] && !is_self_symmetric_[idx(label_[t])]))
                label_[t] = unlabeled;
        keep_largest_components(mesh_, old_.count, label_);
        for (size_t t = 0; t < is_near_tet_.size(); ++t)
            if (!is_near_tet_[t]) label_[t] = fixed;
        const std::span<const int32_t> patch_of = keeps_patches_ ? patch_of_ : std::span<const int32_t>();
        propagate_labels(mesh_, neighbor_votes(mesh_, label_, patch_of), label_, progress_, patch_of);
        for (size_t t = 0; t < is_near_tet_.size(); ++t)  // a patch without parts of this side
            if (label_[t] == unlabeled && keeps_patches_) {
                label_[t] = old_.label[t];
                is_near_part_[idx(label_[t])] = 1;
            }
    }

    // Adds the parts whose two halves are one part, see max_excess.
    void find_self_symmetric_parts() {
        std::vector<std::vector<int32_t>> corners(old_.count);
        for (size_t t = 0; t < is_near_tet_.size(); ++t)
            if (label_[t] >= 0)
                for (const int32_t v : mesh_.tetrahedra[t]) corners[idx(label_[t])].push_back(v);
        std::vector<double> half_hull(old_.count, 0), whole_hull(old_.count, 0);
        HullKernel kernel({}, progress_);  // one for all: its scratch memory takes longer than the hull of a small part
        const auto hull_volume = [&] { return kernel.build(iota(kernel.point_count())).volume(); };
        for (size_t p = 0; p < old_.count; ++p) {
            if (corners[p].empty()) continue;
            sort_unique(corners[p]);
            kernel.forget(0);
            for (const int32_t v : corners[p]) kernel.add(mesh_.vertices[idx(v)]);
            half_hull[p] = hull_volume();
            for (const int32_t v : corners[p]) kernel.add(plane_.mirrored(mesh_.vertices[idx(v)]));
            whole_hull[p] = hull_volume();
        }
        sum_over_images(half_hull);
        sum_over_images(whole_hull);
        for (size_t p = 0; p < old_.count; ++p)
            is_self_symmetric_[p] |= whole_hull[p] - 2 * half_hull[p] <= max_excess * whole_hull[p];
    }

    // Finds for each facet on the far side the labeled tetrahedron behind its mirror image.
    void find_counterparts() {
        std::vector<Triangle> near_facets;
        std::vector<int32_t> near_tets;
        for_each_boundary_facet(mesh_, [&](size_t t, size_t k) {
            if (!is_near_tet_[t]) {
                far_facets_.push_back({t, k, -1});
            } else if (label_[t] >= 0) {
                near_facets.push_back(facet(mesh_.tetrahedra[t], k));
                near_tets.push_back(static_cast<int32_t>(t));
            }
        });
        if (near_facets.empty()) return;
        const double tolerance = counterpart_tolerance(mesh_);
        NearestTriangle nearest(mesh_.vertices, near_facets);
        for (size_t i = 0; i < far_facets_.size(); ++i) {
            FarFacet& far = far_facets_[i];
            const Triangle corners = facet(mesh_.tetrahedra[far.tetrahedron], far.opposite);
            const Near image = nearest(plane_.mirrored(centroid(mesh_.vertices, corners)));
            if (image.squared < tolerance * tolerance) far.counterpart = near_tets[idx(image.triangle)];
            if (i % 256 == 0) progress_.advance(0);
        }
    }

    // Two patches are images of each other if each covers more of the area opposite the other than any third patch.
    void match_patches() {
        std::vector<Vote> votes;
        for (const auto& [t, k, counterpart] : far_facets_) {
            if (counterpart < 0) continue;
            const int32_t far = patch_of_[t], near = patch_of_[idx(counterpart)];
            const double size = facet_area(mesh_, t, k);
            votes.push_back({far, near, size});
            votes.push_back({near, far, size});
        }
        std::map<int32_t, int32_t> opposite;
        for_each_majority(std::move(votes), [&](int32_t patch, int32_t winner) { opposite[patch] = winner; });
        for (const auto& [patch, image] : opposite)
            if (opposite[image] == patch) image_of_patch_[patch] = image;
        patch_of_part_ = majority_patches(mesh_, old_.label, old_.count, patch_of_);
    }

    // Labels: part p of the near side stays p; its image is p or count + p. A tetrahedron without a counterpart keeps
    // its old part: p, or 2 count + p if that does not belong to the near side.
    int32_t image(int32_t p) const {
        return is_self_symmetric_[idx(p)] ? p : static_cast<int32_t>(old_.count) + p;
    }

    int32_t old_part(size_t t) const {
        const int32_t p = old_.label[t];
        return is_near_part_[idx(p)] ? p : 2 * static_cast<int32_t>(old_.count) + p;
    }

    void copy_to_far_side() {
        for (size_t t = 0; t < is_near_tet_.size(); ++t)
            if (!is_near_tet_[t]) label_[t] = unlabeled;
        std::vector<Vote> votes;
        for (const auto& [t, k, counterpart] : far_facets_)
            votes.push_back({static_cast<int32_t>(t), has_image(t, counterpart) ? image(label_[idx(counterpart)]) : old_part(t),
                             facet_area(mesh_, t, k)});
        assign_majority(std::move(votes), label_);
        connect_components(mesh_, 3 * old_.count, label_);
        propagate_labels(mesh_, neighbor_votes(mesh_, label_), label_, progress_);
        for (size_t t = 0; t < is_near_tet_.size(); ++t)  // a component without votes
            if (label_[t] == unlabeled) label_[t] = old_part(t);
    }

    bool has_image(size_t t, int32_t counterpart) const {
        if (counterpart < 0) return false;
        if (patch_of_.empty()) return true;
        const auto found = image_of_patch_.find(patch_of_[t]);
        return found != image_of_patch_.end() && found->second == patch_of_part_[idx(label_[idx(counterpart)])];
    }

    TetLabels renumber() const {
        std::vector<int32_t> new_id(3 * old_.count, -1);
        for (const int32_t p : label_) new_id[idx(p)] = 0;
        TetLabels result;
        result.count = number_in_sequence(new_id);
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
        result.old_area = old_.old_area;
        return result;
    }

    const TetMesh& mesh_;
    Plane plane_;
    bool is_reversed_ = false;
    const TetLabels old_;
    const std::span<const double> scores_;  // of each tetrahedron
    Progress& progress_;
    const std::span<const int32_t> patch_of_;  // of each tetrahedron; empty: no marks
    const bool keeps_patches_;
    struct FarFacet {
        size_t tetrahedron, opposite;
        int32_t counterpart;  // the tetrahedron behind its mirror image; -1: no surface is there
    };
    std::vector<FarFacet> far_facets_;
    std::map<int32_t, int32_t> image_of_patch_;          // of those that have one
    std::vector<int32_t> patch_of_part_;                 // of each old part
    std::vector<uint8_t> is_near_part_, is_self_symmetric_;  // of each old part
    std::vector<uint8_t> is_near_tet_;                      // of each tetrahedron
    std::vector<int32_t> label_;                            // likewise
};

}  // namespace

std::vector<double> surface_areas(const TetMesh& mesh, std::span<const int32_t> label, size_t count) {
    std::vector<double> areas(count, 0);
    for_each_boundary_facet(mesh, [&](size_t t, size_t k) { areas[idx(label[t])] += facet_area(mesh, t, k); });
    return areas;
}

TetLabels copy_symmetric_labels(const TetMesh& mesh, std::span<const Plane> planes, std::span<const int32_t> label,
                                size_t count, std::span<const double> scores, Progress& progress, const Regions* regions) {
    TetLabels parts{{label.begin(), label.end()}, count, {}, iota(count), {}};
    if (regions) parts.old_area = surface_areas(mesh, label, count);
    for (const Plane& plane : planes) parts = SymmetricLabelCopy(mesh, plane, std::move(parts), scores, progress, regions).run();
    return parts;
}

void restore_lost_parts(const PartTree& tree, std::vector<int32_t>& label) {
    for (bool is_complete = false; !is_complete;) {
        is_complete = true;
        std::vector<uint8_t> is_left(tree.count, 0);
        for (const int32_t p : label) is_left[idx(p)] = 1;
        for (size_t t = 0; t < label.size(); ++t) {
            if (is_left[idx(tree.label[t])]) continue;
            label[t] = tree.label[t];
            is_complete = false;
        }
    }
}

std::vector<int32_t> align_borders(const TetMesh& mesh, std::span<const Plane> planes, const PartTree& tree,
                                   std::span<const double> scores, Progress& progress) {
    std::vector<int32_t> label = tree.label;
    if (planes.empty()) return label;
    std::vector<uint8_t> is_original(label.size(), 1);  // of each tetrahedron: on the side that was copied, of all planes
    for (const Plane& plane : planes) {
        const Plane upward = is_far_side_better(mesh, plane, scores) ? reversed(plane) : plane;
        for (size_t t = 0; t < label.size(); ++t) is_original[t] &= is_near(mesh, upward, t);
    }
    const BoundaryFacets facets(mesh);
    NearestTriangle nearest(mesh.vertices, facets.triangles);
    const double tolerance = counterpart_tolerance(mesh);
    // For each plane, and each facet that isn't original, the tetrahedron behind its mirror image; -1: there is none.
    std::vector counterpart(planes.size(), std::vector<int32_t>(facets.triangles.size(), -1));
    for (size_t k = 0; k < planes.size(); ++k)
        for (size_t f = 0; f < facets.triangles.size(); ++f) {
            if (f % 256 == 0) progress.advance_by(0.01);
            if (is_original[idx(facets.tetrahedra[f])]) continue;
            const Near image = nearest(planes[k].mirrored(centroid(mesh.vertices, facets.triangles[f])), tolerance);
            if (image.triangle >= 0) counterpart[k][f] = facets.tetrahedra[idx(image.triangle)];
        }
    for (int pass = 0; pass < border_passes; ++pass) {
        std::vector<Vote> votes;
        for (size_t f = 0; f < facets.triangles.size(); ++f) {
            const int32_t t = facets.tetrahedra[f], own = label[idx(t)];
            if (is_original[idx(t)]) continue;
            const double size = area(mesh.vertices, facets.triangles[f]);
            votes.push_back({t, own, own_weight * size});
            for (size_t k = 0; k < planes.size(); ++k) {
                const int32_t c = counterpart[k][f], image = c < 0 ? -1 : tree.mirror[k][idx(label[idx(c)])];
                votes.push_back({t, image < 0 || idx(image) >= tree.count ? own : image, size});
            }
        }
        assign_majority(std::move(votes), label);
    }
    restore_lost_parts(tree, label);
    return label;
}

TetLabels dissolve_parts(const TetMesh& mesh, TetLabels parts, std::span<const int32_t> dissolved, Progress& progress) {
    const std::vector<int32_t> old_label = parts.label;
    std::vector<int32_t> new_id(parts.count, 0);
    for (const int32_t p : dissolved) new_id[idx(p)] = unlabeled;
    for (int32_t& p : parts.label)
        if (new_id[idx(p)] < 0) p = unlabeled;
    propagate_labels(mesh, neighbor_votes(mesh, parts.label), parts.label, progress);
    for (size_t t = 0; t < old_label.size(); ++t)
        if (parts.label[t] < 0) {  // no neighboring part
            parts.label[t] = old_label[t];
            new_id[idx(old_label[t])] = 0;
        }
    parts.count = number_in_sequence(new_id);
    for (int32_t& p : parts.label) p = new_id[idx(p)];
    for (int32_t& p : parts.new_part) p = p < 0 ? -1 : new_id[idx(p)];
    for (std::vector<int32_t>& image : parts.mirror) image = renumber_images(image, new_id, parts.count);
    return parts;
}

}  // namespace partwheel
