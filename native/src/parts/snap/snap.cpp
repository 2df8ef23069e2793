// Border snapping from the root down: the band around each split, and its minimum cut.
#include "parts/snap/snap.h"

#include "base/adjacency.h"
#include "base/minimum_cut.h"
#include "mesh/crease.h"
#include "parts/boundary.h"

namespace partwheel {

namespace {

// Width of the band on both sides, times the square root of the smaller half's area.
constexpr double band_reach = 0.6;
// The largest number of tetrahedra in the band, nearest to the split.
constexpr size_t max_band_tets = 12000;
// Parts below this fraction of the model's area keep their split: the difference is not visible.
constexpr double min_area_fraction = 0.01;
// Weight of a sheet's area relative to its length on the surface, in units of the reach: enough for a smooth cap.
constexpr double sheet_weight = 0.3;
// Facets at the rim of the band cost this share more than at the split: of two similar creases the nearer one wins.
constexpr double rim_penalty = 0.3;
// Relative tolerance of depths.
constexpr double depth_tolerance = 1e-9;
// The smallest area of a half that is cut off from the rest, relative to the model's.
constexpr double min_region_area_fraction = 0.001;
// A component of a half is small if its area is below this fraction of the area of the half's largest component.
constexpr double small_component_fraction = 0.1;
constexpr double infinite = std::numeric_limits<double>::infinity();

enum : int8_t { outside_split = -1, left_half = 0, right_half = 1, unassigned = 2 };

class BorderSnapper {
public:
    // components_only: no border moves, and only small components change sides.
    BorderSnapper(const TetMesh& mesh, const PartTree& tree, std::span<const int32_t> limb_of, const Regions* regions,
                  bool components_only, Progress& progress)
        : mesh_(mesh),
          part_(tree.label),
          limb_(limb_of),
          children_(tree.children),
          regions_(regions),
          components_only_(components_only),
          progress_(progress),
          parts_(tree.count) {
        const size_t tetrahedra = mesh.tetrahedra.size();
        compute_geometry();
        side_.assign(tetrahedra, outside_split);
        depth_.assign(tetrahedra, infinite);
        limb_depth_.assign(4 * parts_, 0);
        node_.assign(tetrahedra, -1);
        seed_.assign(tetrahedra, -1);
    }

    std::vector<int32_t> run() {
        std::vector<int32_t> result(part_.size()), order = iota(part_.size());
        struct Task {
            int32_t node;
            std::span<int32_t> tetrahedra;  // a slice of `order`
            bool is_connected;              // known to be
        };
        std::vector<Task> todo = {{static_cast<int32_t>(2 * parts_ - 2), order, false}};
        number_parts();
        while (!todo.empty()) {
            const auto [node, tets, is_known_connected] = todo.back();
            todo.pop_back();
            if (idx(node) < parts_) {
                for (const int32_t t : tets) result[idx(t)] = node;
                continue;
            }
            for (const int32_t t : tets) side_[idx(t)] = unassigned;
            const bool is_connected =
                !components_only_ && (is_known_connected || find_components(tets, unassigned).components.size() < 2);
            const bool has_connected_halves = split(tets, node, is_connected) && is_connected;
            const auto in_left = [&](int32_t t) { return side_[idx(t)] == left_half; };
            const auto middle = std::stable_partition(tets.begin(), tets.end(), in_left);
            for (const int32_t t : tets) side_[idx(t)] = outside_split;
            const auto& children = children_[idx(node) - parts_];
            const std::span left(tets.begin(), middle), right(middle, tets.end());
            if (!left.empty()) todo.push_back({children[0], left, has_connected_halves});
            if (!right.empty()) todo.push_back({children[1], right, has_connected_halves});
            progress_.advance_by(1 / static_cast<double>(parts_));
        }
        return result;
    }

private:
    // The surface areas and centers of tetrahedra.
    void compute_geometry() {
        const BoundaryFacets surface(mesh_);
        std::vector<Point> normals, centers(part_.size(), Point{});
        std::vector<double> counts(part_.size(), 0);  // of facets
        area_.assign(part_.size(), 0);
        for (size_t f = 0; f < surface.triangles.size(); ++f) {
            const size_t t = idx(surface.tetrahedra[f]);
            const auto [a, b, c] = corner_points(mesh_.vertices, surface.triangles[f]);
            const Point normal = cross(b - a, c - a);
            const double size = length(normal);
            normals.push_back(size > 0 ? 1 / size * normal : Point{});
            area_[t] += size / 2;
            for (const int32_t v : surface.triangles[f]) centers[t] = centers[t] + 1.0 / 3 * mesh_.vertices[idx(v)];
            ++counts[t];
        }
        for (size_t t = 0; t < part_.size(); ++t) {
            model_area_ += area_[t];
            center_.push_back(counts[t] > 0 ? 1 / counts[t] * centers[t] : centroid(mesh_.vertices, mesh_.tetrahedra[t]));
        }
        if (!components_only_) compute_costs(surface, normals);
    }

    // The cost of a sheet through each facet. normals: of the facets of the surface.
    void compute_costs(const BoundaryFacets& surface, std::span<const Point> normals) {
        struct SurfaceEdge {
            int32_t high;
            double cost;
        };
        std::vector<std::pair<int32_t, SurfaceEdge>> edges;  // by lower vertex
        for_each_edge(mesh_.vertices.size(), surface.triangles, [&](int32_t low, std::span<const Side> sides) {
            double cost = 0;
            for (size_t i = 0; i + 1 < sides.size(); i += 2) {
                const size_t s = idx(sides[i].number / 3), t = idx(sides[i + 1].number / 3);
                const Point &m = normals[s], &n = normals[t];
                const Point along = mesh_.vertices[idx(sides[i].high)] - mesh_.vertices[idx(low)];
                const double turn = dot(cross(m, n), along) * (sides[i].is_ascending ? 1 : -1);
                const double mark = regions_ ? double{regions_->strength(surface.tetrahedra[s], surface.tetrahedra[t])} : 0;
                cost += length(along) * (1 - mark) * (turn == 0 ? 1 : crease_weight(n, m, turn > 0));
            }
            edges.push_back({low, {sides[0].high, cost}});
        });
        const CsrArray<SurfaceEdge> edges_from(mesh_.vertices.size(), [&](const auto& put) {
            for (const auto& [low, edge] : edges) put(idx(low), edge);
        });
        facets_.resize(part_.size());
        for (size_t t = 0; t < part_.size(); ++t)
            for (size_t k = 0; k < 4; ++k) {
                if (mesh_.neighbors[t][k] < 0) continue;
                const Triangle f = facet(mesh_.tetrahedra[t], k);
                facets_[t][k].area = facet_area(mesh_, t, k);
                for (size_t i = 0; i < 3; ++i) {
                    const auto [low, high] = std::minmax(f[i], f[(i + 1) % 3]);
                    const auto row = edges_from.row(idx(low));  // ascending
                    const auto edge = std::ranges::lower_bound(row, high, {}, &SurfaceEdge::high);
                    if (edge != row.end() && edge->high == high) facets_[t][k].edges += edge->cost;
                }
            }
    }

    // Numbers the parts depth-first: each node has consecutive ones.
    void number_parts() {
        first_number_.assign(2 * parts_ - 1, 0);
        count_.assign(2 * parts_ - 1, 1);
        for (size_t j = 0; j < children_.size(); ++j)
            count_[parts_ + j] = count_[idx(children_[j][0])] + count_[idx(children_[j][1])];
        for (size_t j = children_.size(); j-- > 0;) {
            const auto [left, right] = children_[j];
            first_number_[idx(left)] = first_number_[parts_ + j];
            first_number_[idx(right)] = first_number_[idx(left)] + count_[idx(left)];
        }
    }

    bool contains(int32_t node, int32_t part) const {
        const size_t first = first_number_[idx(node)], number = first_number_[idx(part)];
        return first <= number && number < first + count_[idx(node)];
    }

    // Sets side_ of these tetrahedra. Returns whether other components have changed sides, so that halves of a connected
    // set are connected; not if the split stays along marks.
    bool split(std::span<const int32_t> tetrahedra, int32_t node, bool is_connected) {
        const auto& children = children_[idx(node) - parts_];
        double areas[2] = {0, 0};
        for (const int32_t t : tetrahedra)
            for (const int8_t half : {left_half, right_half})
                if (contains(children[idx(half)], part_[idx(t)])) {
                    side_[idx(t)] = half;
                    areas[half] += area_[idx(t)];
                }
        const bool is_along_marks = has_marked_split(tetrahedra);
        const auto is_too_small = [&](double area) {
            return components_only_ ? area == 0
                                    : areas[0] + areas[1] >= min_area_fraction * model_area_ &&
                                          area < min_region_area_fraction * model_area_;
        };
        for (const int8_t half : {left_half, right_half})
            if (!is_along_marks && is_too_small(areas[half]) && !tets_at_split(tetrahedra).empty())
                for (const int32_t t : tetrahedra)
                    if (side_[idx(t)] == half) side_[idx(t)] = unassigned;
        assign_to_nearest_half(tetrahedra);
        if (is_along_marks) return false;
        std::vector<int32_t> border = tets_at_split(tetrahedra);
        if (!reassign_components(tetrahedra, border, is_connected).empty()) border = tets_at_split(tetrahedra);
        if (!components_only_) move_border(tetrahedra, std::move(border), is_connected);
        return true;
    }

    // A breadth-first search from the halves through unassigned tetrahedra; what it doesn't reach goes to the first half.
    void assign_to_nearest_half(std::span<const int32_t> tetrahedra) {
        std::vector<int32_t> unassigned_tets, assigned;
        std::ranges::copy_if(tetrahedra, std::back_inserter(unassigned_tets),
                             [&](int32_t t) { return side_[idx(t)] == unassigned; });
        for (const int8_t half : {left_half, right_half})
            for (const int32_t t : unassigned_tets)
                for (const int32_t n : mesh_.neighbors[idx(t)])
                    if (n >= 0 && side_[idx(n)] == half) assigned.push_back(n);
        for (size_t i = 0; i < assigned.size(); ++i)
            for (const int32_t n : mesh_.neighbors[idx(assigned[i])])
                if (n >= 0 && side_[idx(n)] == unassigned) {
                    side_[idx(n)] = side_[idx(assigned[i])];
                    assigned.push_back(n);
                }
        for (const int32_t t : unassigned_tets)
            if (side_[idx(t)] == unassigned) side_[idx(t)] = left_half;
    }

    // Whether a neighbor is in the other half.
    bool is_at_split(int32_t t) const {
        return std::ranges::any_of(mesh_.neighbors[idx(t)], [&](int32_t n) {
            return n >= 0 && side_[idx(n)] != outside_split && side_[idx(n)] != side_[idx(t)];
        });
    }

    // Whether most of what the halves have in common is marked.
    bool has_marked_split(std::span<const int32_t> tetrahedra) const {
        if (!regions_) return false;
        double all = 0, marked = 0;
        for (const int32_t t : tetrahedra)
            for (size_t k = 0; k < 4; ++k) {
                const int32_t n = mesh_.neighbors[idx(t)][k];
                if (n < t || side_[idx(t)] == unassigned || side_[idx(n)] != 1 - side_[idx(t)]) continue;
                const double size = facet_area(mesh_, idx(t), k);
                all += size;
                marked += size * double{regions_->strength(t, n)};
            }
        return marked > 0.5 * all;
    }

    std::vector<int32_t> tets_at_split(std::span<const int32_t> tetrahedra) const {
        std::vector<int32_t> border;
        std::ranges::copy_if(tetrahedra, std::back_inserter(border), [&](int32_t t) { return is_at_split(t); });
        return border;
    }

    void change_sides(std::span<const int32_t> tetrahedra) {
        for (const int32_t t : tetrahedra) side_[idx(t)] = side_[idx(t)] == left_half ? right_half : left_half;
    }

    struct Component {
        double area;
        size_t first, last;  // of `order`
        bool touches_other_half;
    };
    struct ComponentList {
        std::vector<Component> components;
        std::vector<int32_t> order;
    };

    // The connected components of one side.
    ComponentList find_components(std::span<const int32_t> tetrahedra, int8_t side) {
        ComponentList result;
        std::vector<int32_t>& order = result.order;
        for (const int32_t start : tetrahedra) {
            if (side_[idx(start)] != side || seed_[idx(start)] >= 0) continue;
            Component component{0, order.size(), 0, false};
            order.push_back(start);
            seed_[idx(start)] = start;
            for (size_t i = component.first; i < order.size(); ++i) {
                component.area += area_[idx(order[i])];
                for (const int32_t n : mesh_.neighbors[idx(order[i])]) {
                    if (n < 0 || side_[idx(n)] == outside_split) continue;
                    if (side_[idx(n)] != side) {
                        component.touches_other_half = true;
                    } else if (seed_[idx(n)] < 0) {
                        seed_[idx(n)] = start;
                        order.push_back(n);
                    }
                }
            }
            component.last = order.size();
            result.components.push_back(component);
        }
        for (const int32_t t : order) seed_[idx(t)] = -1;
        return result;
    }

    // For a connected set: whether a half is disconnected. Each component of a half touches the split: all grow from
    // there until each half has grown together. border: contains all tetrahedra at the split.
    bool has_disconnected_half(std::span<const int32_t> border) {
        std::vector<int32_t> reached;
        for (const int32_t t : border)
            if (seed_[idx(t)] < 0 && is_at_split(t)) {
                seed_[idx(t)] = static_cast<int32_t>(reached.size());
                reached.push_back(t);
            }
        size_t count = reached.size();
        UnionFind sets(count);
        for (size_t i = 0; i < reached.size() && count > 2; ++i) {
            const size_t t = idx(reached[i]);
            for (const int32_t n : mesh_.neighbors[t]) {
                if (n < 0 || side_[idx(n)] != side_[t]) continue;
                if (seed_[idx(n)] < 0) {
                    seed_[idx(n)] = seed_[t];
                    reached.push_back(n);
                } else if (sets.find(idx(seed_[idx(n)])) != sets.find(idx(seed_[t]))) {
                    sets.unite(idx(seed_[idx(n)]), idx(seed_[t]));
                    --count;
                }
            }
        }
        for (const int32_t t : reached) seed_[idx(t)] = -1;
        return count > 2;
    }

    // Components other than the largest one of a half change sides if they touch the other half. Returns their
    // tetrahedra.
    std::vector<int32_t> reassign_components(std::span<const int32_t> tetrahedra, std::span<const int32_t> border,
                                             bool is_connected) {
        std::vector<int32_t> changed;
        if (is_connected && !has_disconnected_half(border)) return changed;
        for (const int8_t half : {left_half, right_half}) {
            const auto [components, order] = find_components(tetrahedra, half);
            // Single precision, so that areas that are equal by symmetry tie.
            const auto size = [](const Component& component) {
                return std::pair(static_cast<float>(component.area), component.last - component.first);
            };
            const auto largest = std::ranges::max_element(components, {}, size);
            for (const Component& component : components) {
                if (&component == &*largest || !component.touches_other_half) continue;
                if (components_only_ && component.area >= small_component_fraction * largest->area) continue;
                const auto tets = std::span(order).subspan(component.first, component.last - component.first);
                change_sides(tets);
                changed.insert(changed.end(), tets.begin(), tets.end());
            }
        }
        return changed;
    }

    // Moves the border between the halves to the minimum cut of the band.
    void move_border(std::span<const int32_t> tetrahedra, std::vector<int32_t> border, bool is_connected) {
        double areas[2] = {0, 0};
        for (const int32_t t : tetrahedra) areas[side_[idx(t)]] += area_[idx(t)];
        double reach = band_reach * std::sqrt(std::min(areas[0], areas[1]));
        if (!(reach > 0) || areas[0] + areas[1] < min_area_fraction * model_area_) return;
        const std::vector<int32_t> band = compute_depths(border, reach);
        const std::vector<int32_t> free = choose_free_tets(tetrahedra, band, reach);
        const std::vector<uint8_t> left = minimum_cut(build_cut(free, reach));
        for (const int32_t t : band) {
            depth_[idx(t)] = infinite;
            node_[idx(t)] = -1;
        }
        std::vector<int32_t> moved;
        for (size_t n = 0; n < free.size(); ++n)
            if ((side_[idx(free[n])] == left_half) != (left[n] == 1)) moved.push_back(free[n]);
        for (const int32_t t : moved) {
            areas[1 - side_[idx(t)]] += area_[idx(t)];
            areas[side_[idx(t)]] -= area_[idx(t)];
        }
        if (moved.empty() || std::min(areas[0], areas[1]) < min_region_area_fraction * model_area_) return;
        change_sides(moved);
        for (const int32_t t : moved) {
            border.push_back(t);
            for (const int32_t n : mesh_.neighbors[idx(t)])
                if (n >= 0 && side_[idx(n)] != outside_split) border.push_back(n);
        }
        if (const std::vector<int32_t> reassigned = reassign_components(tetrahedra, border, is_connected);
            !reassigned.empty()) {
            change_sides(reassigned);  // the cut would separate a component: undo it
            change_sides(moved);
        }
    }

    // The tetrahedra that may change sides, which it numbers in node_. Of a half, or a limb in it, that is all within reach
    // the deeper half stays.
    std::vector<int32_t> choose_free_tets(std::span<const int32_t> tetrahedra, std::span<const int32_t> band, double reach) {
        double max_depth[2] = {0, 0};
        for (const int32_t t : tetrahedra) limb_depth(t) = 0;
        for (const int32_t t : tetrahedra)
            for (double* depth : {&max_depth[side_[idx(t)]], &limb_depth(t)}) *depth = std::max(*depth, depth_[idx(t)]);
        std::vector<int32_t> free;
        for (const int32_t t : band) {
            const double whole = std::min(max_depth[side_[idx(t)]], limb(t) >= 0 ? limb_depth(t) : infinite);
            if (depth_[idx(t)] >= std::min(reach, whole / 2) * (1 - depth_tolerance)) continue;
            node_[idx(t)] = static_cast<int32_t>(free.size());
            free.push_back(t);
        }
        return free;
    }

    Cut build_cut(std::span<const int32_t> free, double reach) const {
        Cut cut;
        cut.set_node_count(free.size());
        for (size_t n = 0; n < free.size(); ++n) {
            const size_t t = idx(free[n]);
            for (size_t k = 0; k < 4; ++k) {
                const int32_t other = mesh_.neighbors[t][k];
                if (other < 0 || side_[idx(other)] == outside_split || (node_[idx(other)] >= 0 && idx(other) < t))
                    continue;
                const bool is_at_border = side_[t] != side_[idx(other)];
                const double relative_depth =
                    is_at_border ? 0 : std::min((depth_[t] + depth_[idx(other)]) / 2 / reach, 1.0);
                const double base_cost = sheet_weight * facets_[t][k].area / reach + facets_[t][k].edges;
                const int64_t cost = quantize_cost((1 + rim_penalty * relative_depth) * base_cost / reach);
                cut.add_edge(n, node_[idx(other)], side_[idx(other)] == left_half, cost);
            }
        }
        return cut;
    }

    // Computes the depth of each tetrahedron in its half: the length of the shortest path to the split through
    // centers of tetrahedra; infinity beyond reach, which is reduced to the max_band_tets nearest. Returns the
    // tetrahedra within, ascending.
    std::vector<int32_t> compute_depths(std::span<const int32_t> border, double& reach) {
        const auto distance = [&](int32_t t, int32_t n) { return length(center_[idx(t)] - center_[idx(n)]); };
        for (const int32_t t : border)
            for (const int32_t n : mesh_.neighbors[idx(t)])
                if (n >= 0 && side_[idx(n)] != outside_split && side_[idx(n)] != side_[idx(t)])
                    depth_[idx(t)] = std::min(depth_[idx(t)], distance(t, n) / 2);
        std::vector<int32_t> band = find_band(
            reach, max_band_tets, depth_, border, [&](int32_t t, double path_length, const auto& relax) {
                for (const int32_t n : mesh_.neighbors[idx(t)])
                    if (n >= 0 && side_[idx(n)] == side_[idx(t)]) relax(n, path_length + distance(t, n));
            });
        std::ranges::sort(band);
        return band;
    }

    int32_t limb(int32_t t) const { return limb_.empty() ? -1 : limb_[idx(part_[idx(t)])]; }
    // The greatest depth of the limb that contains a tetrahedron, in its half.
    double& limb_depth(int32_t t) { return limb_depth_[2 * idx(limb(t) + 1) + static_cast<size_t>(side_[idx(t)])]; }

    struct FacetCost {
        double area = 0, edges = 0;
    };

    const TetMesh& mesh_;
    std::span<const int32_t> part_;
    std::span<const int32_t> limb_;  // of each part: the limb that contains it, or -1; empty: there are none
    std::span<const std::array<int32_t, 2>> children_;
    const Regions* regions_;
    const bool components_only_;
    Progress& progress_;
    const size_t parts_;
    std::vector<size_t> first_number_, count_;  // of the parts of each node, see number_parts()
    double model_area_ = 0;
    std::vector<double> area_;  // surface area of each tetrahedron
    std::vector<Point> center_;  // of each tetrahedron's boundary facets; without any, its centroid
    std::vector<std::array<FacetCost, 4>> facets_;

    // For each tetrahedron, during its split.
    std::vector<int8_t> side_;
    std::vector<double> depth_;
    std::vector<double> limb_depth_;
    std::vector<int32_t> node_, seed_;
};

}  // namespace

PartTree snap_borders(const TetMesh& mesh, const PartTree& tree, std::span<const int32_t> limb_of, Progress& progress,
                      const Regions* regions) {
    return relabel(tree, BorderSnapper(mesh, tree, limb_of, regions, false, progress).run());
}

PartTree reassign_small_components(const TetMesh& mesh, const PartTree& tree, Progress& progress, const Regions* regions) {
    return relabel(tree, BorderSnapper(mesh, tree, {}, regions, true, progress).run());
}

}  // namespace partwheel
