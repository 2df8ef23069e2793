// Snapped parts, their division along the tree, and the merging of patches.
#include "edit/seams.h"

#include "base/parallel.h"
#include "base/sorted.h"
#include "edit/border.h"
#include "edit/conformal_map.h"
#include "edit/patch.h"

#include <atomic>

namespace partwheel {

namespace {

constexpr double max_overlap_fraction = 0.0005;  // of a patch's area: less is below the resolution of the grid
// A round cuts a patch to at most max_peaks_per_round peaks, or to one once the area distortion - 1 is less than near_factor
// times the allowed one; or to cuts_share of the cuts made so far if that is more, so that the number of rounds grows
// with the logarithm of the number of peaks, which is large on fur.
constexpr double near_factor = 2, cuts_share = 1.0 / 8;
constexpr size_t max_peaks_per_round = 16;
constexpr size_t max_merge_work = 8;  // triangles of all merges tried, relative to the part's; ordinary parts need 6
constexpr double failed_distortion = 1.5;   // of an island after unwrapping: only a failed solver leaves so much
constexpr double max_triangle_factor = 10;  // limit of a triangle's area distortion after unwrapping
constexpr int max_component_rounds = 64;    // each merges the small components next to larger ones; most models need two or three
constexpr double small_component_fraction = 0.1;  // of the area of a part's largest component: smaller ones go to a neighbor
constexpr double min_side_fraction = 0.05;  // of a patch's area: either side of a division is larger
constexpr double tiny = 1e-300;

using Labels = std::vector<int32_t>;  // of each triangle
using LabelPair = std::pair<int32_t, int32_t>;

bool is_side(double fraction) { return min_side_fraction <= fraction && fraction <= 1 - min_side_fraction; }

// Gives the small components of each label the label of the neighbor with the costliest common border.
Labels merge_small_components(const SeamMesh& mesh, Labels labels) {
    for (int round = 0; round < max_component_rounds; ++round) {
        const std::vector<std::vector<int32_t>> components = mesh.components(mesh.borders(labels));
        Labels component(labels.size());
        std::vector<int32_t> label;  // of each component
        std::vector<double> area(components.size(), 0);
        std::map<int32_t, double> largest_area;  // of each label
        for (size_t c = 0; c < components.size(); ++c) {
            for (const int32_t t : components[c]) component[idx(t)] = static_cast<int32_t>(c), area[c] += mesh.faces[idx(t)].area;
            label.push_back(labels[idx(components[c][0])]);
            largest_area[label[c]] = std::max(largest_area[label[c]], area[c]);
        }
        std::vector<uint8_t> is_small;
        for (size_t c = 0; c < components.size(); ++c) is_small.push_back(area[c] < small_component_fraction * largest_area[label[c]]);
        std::map<LabelPair, double> border_cost;  // between a small component and another one
        for (const SeamMesh::Edge& edge : mesh.edges) {
            LabelPair pair{component[idx(edge.triangle(0))], component[idx(edge.triangle(1))]};
            if (!is_small[idx(pair.first)]) std::swap(pair.first, pair.second);
            if (is_small[idx(pair.first)] && !is_small[idx(pair.second)]) border_cost[pair] += edge.cost;
        }
        if (border_cost.empty()) return labels;
        std::map<int32_t, double> highest_cost;  // of each small component
        for (const auto& [pair, cost] : border_cost) {
            double& highest = highest_cost[pair.first];
            if (cost >= highest) highest = cost, label[idx(pair.first)] = label[idx(pair.second)];
        }
        for (size_t t = 0; t < labels.size(); ++t) labels[t] = label[idx(component[t])];
    }
    return labels;
}

// Divides patches along the merge tree of a hierarchy.
class PatchDivider {
public:
    PatchDivider(const Hierarchy& hierarchy, const MeshView& mesh) : creases(mesh), merges_(hierarchy.merges()) {
        position_.resize(hierarchy.face_count());
        for (size_t i = 0; i < position_.size(); ++i) position_[idx(hierarchy.arrays().order[i])] = static_cast<int32_t>(i);
        const size_t leaves = hierarchy.tetrahedron_count();
        std::vector<int32_t> face_count(leaves, 0);
        for (const int32_t leaf : hierarchy.leaves()) ++face_count[idx(leaf)];
        for (const int32_t count : face_count) {
            const int32_t first = slices_.empty() ? 0 : slices_.back().last;
            slices_.push_back({first, first + count});
        }
        for (const Merge& merge : merges_) slices_.push_back({slices_[idx(merge.left)].first, slices_[idx(merge.right)].last});
    }

    const Creases creases;

    // Divides a patch by a cluster of the tree: of those on the path from the root to the largest piece of the patch,
    // and their siblings, the one with the least border cost / area of the smaller side. Returns 1 for triangles on one
    // side, else 0; none if no cluster divides the patch.
    Labels divide(const SeamMesh& mesh) const {
        const double area = std::max(mesh.area(), tiny);
        std::vector<std::pair<int32_t, double>> areas;  // (position, area of the triangles before it and of this one)
        for (const SeamMesh::Face& face : mesh.faces) areas.emplace_back(position_[idx(face.polygon)], face.area);
        std::ranges::sort(areas);
        for (size_t i = 1; i < areas.size(); ++i) areas[i].second += areas[i - 1].second;
        const auto fraction_before = [&](int32_t position) {
            const auto end = std::ranges::lower_bound(areas, std::pair(position, 0.0));
            return end == areas.begin() ? 0 : std::prev(end)->second / area;
        };
        std::vector<EdgePositions> edges;
        for (const SeamMesh::Edge& edge : mesh.edges)
            edges.push_back({position_[idx(mesh.faces[idx(edge.triangle(0))].polygon)],
                             position_[idx(mesh.faces[idx(edge.triangle(1))].polygon)], edge.cost});
        double best = HUGE_VAL;
        std::optional<Slice> best_slice;
        for (size_t cluster = slices_.size() - 1, leaves = slices_.size() - merges_.size(); cluster >= leaves;) {
            const Merge& merge = merges_[cluster - leaves];
            double larger = 0;
            for (const int32_t child : {merge.left, merge.right}) {
                const Slice slice = slices_[idx(child)];
                const double fraction = fraction_before(slice.last) - fraction_before(slice.first);
                if (fraction > larger) larger = fraction, cluster = idx(child);
                if (!is_side(fraction)) continue;
                const double cost = border_cost(edges, slice) / std::min(fraction, 1 - fraction);
                if (cost < best) best = cost, best_slice = slice;
            }
            if (larger < min_side_fraction) break;
        }
        if (!best_slice) return {};
        std::vector<int32_t> part;  // faces of the surface
        for (const SeamMesh::Face& face : mesh.faces)
            if (best_slice->contains(position_[idx(face.polygon)])) part.push_back(face.polygon);
        sort_unique(part);
        const Creases near(creases, part);
        std::vector<uint8_t> inside, snapped(near.count());
        for (const int32_t face : near.whole_faces()) inside.push_back(std::ranges::binary_search(part, face));
        snap_border(near, inside, snapped);
        Labels labels, snapped_labels;
        double snapped_area = 0;
        for (const SeamMesh::Face& face : mesh.faces) {
            const auto found = std::ranges::lower_bound(near.whole_faces(), face.polygon);
            const bool is_near = found != near.whole_faces().end() && *found == face.polygon;
            const size_t i = idx(static_cast<int32_t>(found - near.whole_faces().begin()));
            labels.push_back(is_near && inside[i]), snapped_labels.push_back(is_near && snapped[i]);
            snapped_area += snapped_labels.back() ? face.area : 0;
        }
        return merge_small_components(mesh, is_side(snapped_area / area) ? std::move(snapped_labels) : std::move(labels));
    }

private:
    struct Slice {
        int32_t first, last;  // of the hierarchy's order of faces

        bool contains(int32_t position) const { return first <= position && position < last; }
    };
    struct EdgePositions {
        int32_t one, other;  // of the faces at an edge
        double cost;
    };

    static double border_cost(std::span<const EdgePositions> edges, const Slice& slice) {
        double sum = 0;
        for (const auto& [one, other, cost] : edges) sum += slice.contains(one) != slice.contains(other) ? cost : 0;
        return sum;
    }

    std::span<const Merge> merges_;
    std::vector<int32_t> position_;  // of each face
    std::vector<Slice> slices_;      // of each cluster
};

Labels triangle_labels(const SeamMesh& mesh, std::span<const int32_t> face_labels) {
    Labels result;
    for (const SeamMesh::Face& face : mesh.faces) result.push_back(face_labels[idx(face.polygon)]);
    return result;
}

// Snaps the border of each part to the creases nearby, the largest part's last, and merges small components. labels:
// of each face.
Labels snap_labels(const SeamMesh& mesh, const Creases& creases, std::vector<int32_t> labels, Progress& progress, double end) {
    const int32_t no_label = *std::ranges::max_element(labels) + 1;
    std::vector<double> area(idx(no_label), 0);
    for (const SeamMesh::Face& face : mesh.faces) area[idx(labels[idx(face.polygon)])] += face.area;
    std::vector<int32_t> order = iota(area.size());
    std::ranges::stable_sort(order, {}, [&](int32_t part) { return area[idx(part)]; });
    std::vector<std::vector<int32_t>> faces(area.size());  // of each part, and some that left it
    for (size_t f = 0; f < labels.size(); ++f) faces[idx(labels[f])].push_back(static_cast<int32_t>(f));
    const auto is_at_border = [&](int32_t f) {
        return std::ranges::any_of(creases.neighbor_faces(idx(f)), [&](int32_t g) { return labels[idx(g)] != labels[idx(f)]; });
    };
    for (size_t i = 0; i < order.size(); ++i) {
        progress.reach(end * static_cast<double>(i) / static_cast<double>(order.size()));
        const int32_t part = order[i];
        std::erase_if(faces[idx(part)], [&](int32_t f) { return labels[idx(f)] != part; });
        // Whole shells have nothing to snap, and there may be thousands.
        if (std::ranges::none_of(faces[idx(part)], is_at_border)) continue;
        std::vector<uint8_t> inside, snapped(labels.size(), 0);
        for (const int32_t label : labels) inside.push_back(label == part ? 1 : 0);
        snap_border(creases, inside, snapped);
        if (!std::ranges::count(snapped, 1)) continue;
        std::vector<int32_t> front;  // faces without a label, which get the label of a neighbor
        for (size_t f = 0; f < labels.size(); ++f) {
            if (snapped[f]) labels[f] = part;
            else if (inside[f]) labels[f] = no_label, front.push_back(static_cast<int32_t>(f));
        }
        while (!front.empty()) {
            std::vector<LabelPair> spread;  // face, label
            for (const int32_t f : front) {
                int32_t lowest = no_label;
                for (const int32_t neighbor : creases.neighbor_faces(idx(f)))
                    if (labels[idx(neighbor)] != part) lowest = std::min(lowest, labels[idx(neighbor)]);
                if (lowest < no_label) spread.emplace_back(f, lowest);
            }
            if (spread.empty())
                for (const int32_t f : front) spread.emplace_back(f, part);
            for (const auto& [f, label] : spread) labels[idx(f)] = label, faces[idx(label)].push_back(f);
            std::erase_if(front, [&](int32_t f) { return labels[idx(f)] != no_label; });
        }
    }
    return merge_small_components(mesh, triangle_labels(mesh, labels));
}

struct PatchCuts {
    std::vector<int32_t> edges;  // of the whole mesh
    double distortion;           // of areas, by the conformal map
    bool is_injective;           // the map does not overlap itself
};

// Cuts a connected mesh to a disk, then from the boundary to the peaks of its conformal map while that distorts areas
// too much.
PatchCuts cut_patch(const SeamMesh& mesh, double max_distortion, Progress& progress) {
    std::vector<uint8_t> is_cut = cut_to_disk(mesh, std::vector<uint8_t>(mesh.edges.size(), 0));
    std::vector<double> guess(3 * mesh.faces.size(), 0);
    for (size_t cut_count = 0;;) {
        const Patch patch(mesh, is_cut);
        const ConformalMap map(patch, guess, progress);
        const double distortion = map.area_distortion();
        std::vector<int32_t> peaks;
        if (distortion > max_distortion) {
            const ShortestPaths paths = patch.shortest_paths(patch.boundary_vertices());
            const bool is_near = distortion - 1 < near_factor * (max_distortion - 1);
            const auto share = static_cast<size_t>(cuts_share * static_cast<double>(cut_count));
            peaks = map.peaks(paths.distance, std::max(is_near ? size_t{1} : max_peaks_per_round, share));
            for (const int32_t peak : peaks) patch.cut_path(paths, peak, is_cut);
        }
        if (peaks.empty()) {
            PatchCuts cuts{{}, distortion, map.overlap_fraction() <= max_overlap_fraction};
            for (size_t e = 0; e < is_cut.size(); ++e)
                if (is_cut[e]) cuts.edges.push_back(mesh.edges[e].number);
            return cuts;
        }
        cut_count += peaks.size();
        guess = map.corner_log_scale();
    }
}

struct OpenPatch {
    size_t part;
    std::vector<int32_t> triangles, cuts;  // cuts: edges
};

// Cuts a patch. Returns it, or if it can't be mapped, what it is divided into along the tree.
std::vector<OpenPatch> cut_or_divide(const SeamMesh& mesh, OpenPatch patch, const PatchDivider& divider, double max_distortion,
                                     Progress& progress) {
    const SeamMesh patch_mesh(mesh, patch.triangles);
    PatchCuts cuts = cut_patch(patch_mesh, max_distortion, progress);
    const Labels sides = cuts.is_injective ? Labels{} : divider.divide(patch_mesh);
    patch.cuts = std::move(cuts.edges);
    if (sides.empty()) return {std::move(patch)};
    std::vector<OpenPatch> pieces;
    for (const std::vector<int32_t>& component : patch_mesh.components(patch_mesh.borders(sides))) {
        pieces.push_back({patch.part, {}, {}});
        for (const int32_t t : component) pieces.back().triangles.push_back(patch.triangles[idx(t)]);
    }
    return pieces;
}

// Merges patches of a part, longest borders first, if their union can be mapped; then sets is_seam, of each edge.
void merge_patches(const SeamMesh& mesh, std::vector<OpenPatch> patches, double max_distortion, std::vector<int32_t>& label,
                   std::vector<uint8_t>& is_seam, Progress& progress) {
    struct Border {
        double cost = 0;
        bool is_rejected = false;
    };
    std::map<LabelPair, Border> borders;
    size_t n_triangles = 0;
    const auto number = [&](const OpenPatch& patch, size_t as) {
        for (const int32_t t : patch.triangles) label[idx(t)] = static_cast<int32_t>(as);
    };
    const auto for_each_border_edge = [&](const auto& visit) {
        for (const OpenPatch& patch : patches)
            for (const int32_t t : patch.triangles)
                for (const int32_t side : {3 * t, 3 * t + 1, 3 * t + 2}) {
                    const int32_t e = mesh.side_edge[idx(side)];
                    if (e < 0 || is_seam[idx(e)] || mesh.edges[idx(e)].side(0) != side) continue;
                    const auto [one, other] = std::minmax(label[idx(t)], label[idx(mesh.edges[idx(e)].triangle(1))]);
                    if (one != other) visit(LabelPair(one, other), idx(e));
                }
    };
    for (size_t p = 0; p < patches.size(); ++p) number(patches[p], p), n_triangles += patches[p].triangles.size();
    for_each_border_edge([&](const LabelPair& pair, size_t e) { borders[pair].cost += mesh.edges[e].cost; });
    for (size_t work = 0;;) {
        const auto cost = [](const auto& border) { return border.second.is_rejected ? -1 : border.second.cost; };
        const auto longest = std::ranges::max_element(borders, {}, cost);
        if (longest == borders.end() || longest->second.is_rejected) break;
        const auto [one, other] = longest->first;
        OpenPatch both{patches[idx(one)].part, {}, {}};
        std::ranges::merge(patches[idx(one)].triangles, patches[idx(other)].triangles, std::back_inserter(both.triangles));
        work += both.triangles.size();
        if (work > max_merge_work * n_triangles) break;
        PatchCuts cuts = cut_patch(SeamMesh(mesh, both.triangles), max_distortion, progress);
        longest->second.is_rejected = !cuts.is_injective || cuts.distortion > max_distortion;
        if (longest->second.is_rejected) continue;
        both.cuts = std::move(cuts.edges);
        const auto merged = static_cast<int32_t>(patches.size());
        std::map<LabelPair, Border> new_borders;
        for (auto border = borders.begin(); border != borders.end();) {
            const auto [a, b] = border->first;
            const bool has_a = a == one || a == other, has_b = b == one || b == other;
            if (has_a != has_b) new_borders[{has_a ? b : a, merged}].cost += border->second.cost;
            border = has_a || has_b ? borders.erase(border) : std::next(border);
        }
        borders.merge(new_borders);
        number(both, idx(merged));
        patches[idx(one)] = patches[idx(other)] = {};
        patches.push_back(std::move(both));
    }
    for_each_border_edge([&](const LabelPair&, size_t e) { is_seam[e] = 1; });
    for (const OpenPatch& patch : patches)
        for (const int32_t e : patch.cuts) is_seam[idx(e)] = 1;
}

// Finds the seams within connected parts: divides each along the tree until each patch can be mapped, then merges patches.
// parts: the triangles of each part, ascending. is_seam: of each edge; only edges between parts are seams before. The
// progress starts at `begin`.
void add_seams(const SeamMesh& mesh, std::vector<std::vector<int32_t>> parts, const PatchDivider& divider, double max_distortion,
               std::vector<uint8_t>& is_seam, Progress& progress, double begin) {
    std::vector<OpenPatch> queue;
    std::vector<std::vector<OpenPatch>> finished(parts.size());
    for (size_t p = 0; p < parts.size(); ++p) queue.push_back({p, std::move(parts[p]), {}});
    ThreadPool pool;
    std::atomic<size_t> n_done{0};  // triangles, of patches and then of parts
    const auto reach = [&](double phase, size_t triangles) {
        const double done = phase + static_cast<double>(n_done += triangles) / static_cast<double>(mesh.faces.size());
        progress.reach(begin + (1 - begin) * done / 2);
    };
    while (!queue.empty()) {
        std::vector<std::vector<OpenPatch>> results(queue.size());
        pool.parallel_for(queue.size(), 1, [&](size_t i, size_t) {
            results[i] = cut_or_divide(mesh, std::move(queue[i]), divider, max_distortion, progress);
            if (results[i].size() == 1) reach(0, results[i][0].triangles.size());
        });
        queue.clear();
        for (std::vector<OpenPatch>& result : results)
            for (OpenPatch& patch : result) (result.size() == 1 ? finished[patch.part] : queue).push_back(std::move(patch));
    }
    n_done = 0;
    std::vector<int32_t> label(mesh.faces.size(), -1);
    pool.parallel_for(finished.size(), 1, [&](size_t p, size_t) {
        size_t triangles = 0;
        for (const OpenPatch& patch : finished[p]) triangles += patch.triangles.size();
        merge_patches(mesh, std::move(finished[p]), max_distortion, label, is_seam, progress);
        reach(1, triangles);
    });
}

void write_sides(const SeamMesh& mesh, std::span<const uint8_t> is_edge_seam, std::span<uint8_t> is_seam) {
    for (size_t e = 0; e < mesh.edges.size(); ++e)
        for (size_t t = 0; t < 2; ++t) is_seam[idx(mesh.edges[e].side(t))] = is_edge_seam[e];
}

}  // namespace

std::vector<uint8_t> find_seams(const Hierarchy& hierarchy, const MeshView& view, std::span<const int32_t> face_labels,
                                bool keep_borders, double max_distortion, Progress& progress) {
    const PatchDivider divider(hierarchy, view);
    progress.reach(0.05);
    const SeamMesh mesh(view);
    constexpr double snapped = 0.2;  // progress
    const std::vector<int32_t> given(face_labels.begin(), face_labels.end());
    const Labels labels =
        keep_borders ? triangle_labels(mesh, given) : snap_labels(mesh, divider.creases, given, progress, snapped);
    std::vector<uint8_t> is_edge_seam = mesh.borders(labels);
    add_seams(mesh, mesh.components(is_edge_seam), divider, max_distortion, is_edge_seam, progress, snapped);
    std::vector<uint8_t> is_seam(3 * mesh.faces.size(), 0);
    write_sides(mesh, is_edge_seam, is_seam);
    for (const int32_t side : mesh.non_manifold_sides) is_seam[idx(side)] = 1;
    return is_seam;
}

void refine_seams(const Hierarchy& hierarchy, const MeshView& view, std::span<const TriangleUvs> uvs, double max_distortion,
                  std::span<uint8_t> is_seam, Progress& progress) {
    check_arrays(view);
    const SeamMesh mesh(view);
    std::vector<uint8_t> is_edge_seam;
    for (const SeamMesh::Edge& edge : mesh.edges)
        is_edge_seam.push_back(is_seam[idx(edge.side(0))] || is_seam[idx(edge.side(1))] ? 1 : 0);
    std::optional<PatchDivider> divider;
    std::vector<std::vector<int32_t>> parts;  // of failed islands
    for (const std::vector<int32_t>& triangles : mesh.components(is_edge_seam)) {
        progress.reach(0);
        const SeamMesh island(mesh, triangles);
        std::vector<double> factors;
        for (const int32_t t : triangles) {
            const auto& [a, b, c] = uvs[idx(t)];
            const double doubled_area = std::fabs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
            factors.push_back(doubled_area / std::max(mesh.faces[idx(t)].area, tiny));
        }
        if (area_distortion(island, factors, max_triangle_factor) <= failed_distortion) continue;
        if (!divider) divider.emplace(hierarchy, view);
        const Labels sides = divider->divide(island);
        if (sides.empty()) continue;
        const std::vector<uint8_t> is_border = island.borders(sides);
        for (size_t e = 0; e < is_border.size(); ++e)
            is_edge_seam[idx(island.edges[e].number)] = is_border[e];  // cuts into the island are computed again
        for (std::vector<int32_t>& component : island.components(is_border)) {
            for (int32_t& t : component) t = triangles[idx(t)];
            parts.push_back(std::move(component));
        }
    }
    if (divider) add_seams(mesh, std::move(parts), *divider, max_distortion, is_edge_seam, progress, 0.1);
    write_sides(mesh, is_edge_seam, is_seam);
}

}  // namespace partwheel
