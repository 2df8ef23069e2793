// Borders in the creases nearby: bands around the splits, and the sheets of facets that cost least.
#include "parts/snap/snap.h"

#include "base/adjacency.h"
#include "parts/snap/minimum_cut.h"
#include "mesh/crease.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace partwheel {

namespace {

// The band reaches this far on both sides, times the square root of the smaller half's area.
constexpr double band_reach = 0.6;
// The band ends where it has so many tetrahedra, the nearest to the split.
constexpr size_t most_tetrahedra = 12000;
// What is less than this share of the model's area is split as it was: nobody tells the difference.
constexpr double least_area = 0.01;
// What the area of a sheet counts beside its length on the surface, the reach being the unit: enough for a smooth cap.
constexpr double sheet_weight = 0.3;
// A facet at the rim of the band costs by this share more than the same one at the split: of two creases that are alike
// the nearer one is taken.
constexpr double pull = 0.3;
// Depths that differ by less, relatively, are the same.
constexpr double same_depth = 1e-9;
// Depths are measured in so many steps of the reach.
constexpr size_t rings = 256;
// The smallest area of a half that is cut off from the rest, relative to the model's.
constexpr double min_region_area_fraction = 0.001;
// A component of a half is small if its area is below this fraction of the area of the half's largest component.
constexpr double small_component_fraction = 0.1;
constexpr double infinite = std::numeric_limits<double>::infinity();

enum : int8_t { elsewhere = -1, left_half = 0, right_half = 1, unassigned = 2 };

class Snapping {
public:
    // components_only: no border moves, and only small components change sides.
    Snapping(const TetMesh& mesh, const PartTree& tree, bool components_only, Progress& progress)
        : mesh_(mesh),
          part_(tree.label),
          children_(tree.children),
          components_only_(components_only),
          progress_(progress),
          parts_(tree.count) {
        const size_t tetrahedra = mesh.tetrahedra.size();
        measure();
        side_.assign(tetrahedra, elsewhere);
        depth_.assign(tetrahedra, infinite);
        node_.assign(tetrahedra, -1);
        seed_.assign(tetrahedra, -1);
    }

    std::vector<int32_t> run() {
        std::vector<int32_t> result(part_.size()), order(part_.size());
        std::iota(order.begin(), order.end(), 0);
        struct Task {
            int32_t number;
            std::span<int32_t> tetrahedra;  // of the order: each half in a slice of its own
            bool whole;                     // surely in one piece
        };
        std::vector<Task> todo = {{static_cast<int32_t>(2 * parts_ - 2), order, false}};
        place_parts(todo[0].number);
        while (!todo.empty()) {
            const auto [number, here, known] = todo.back();
            todo.pop_back();
            if (idx(number) < parts_) {
                for (const int32_t t : here) result[idx(t)] = number;
                continue;
            }
            for (const int32_t t : here) side_[idx(t)] = unassigned;
            const bool whole = !components_only_ && (known || pieces(here, unassigned).all.size() < 2);
            split(here, number, whole);
            const auto in_left = [&](int32_t t) { return side_[idx(t)] == left_half; };
            const auto middle = std::stable_partition(here.begin(), here.end(), in_left);
            for (const int32_t t : here) side_[idx(t)] = elsewhere;
            // What is in one piece has halves in one piece each: another would have changed sides.
            const auto& halves = children_[idx(number) - parts_];
            const std::span left(here.begin(), middle), right(middle, here.end());
            if (!left.empty()) todo.push_back({halves[0], left, whole});
            if (!right.empty()) todo.push_back({halves[1], right, whole});
            progress_.advance(0);
        }
        return result;
    }

private:
    // Areas on the surface, where each tetrahedron is, and what a sheet through each facet costs.
    void measure() {
        const auto point = [&](int32_t v) -> const Point& { return mesh_.vertices[idx(v)]; };
        const auto across = [&](const Triangle& f) {
            return cross(point(f[1]) - point(f[0]), point(f[2]) - point(f[0]));
        };
        std::vector<Triangle> outer;
        std::vector<Point> normals;
        for (size_t t = 0; t < part_.size(); ++t) {
            Point on_surface{}, inside{};
            double facets = 0, area = 0;
            for (size_t k = 0; k < 4; ++k) {
                inside = inside + 0.25 * point(mesh_.tetrahedra[t][k]);
                if (mesh_.neighbors[t][k] >= 0) continue;
                const Triangle f = facet(mesh_.tetrahedra[t], k);
                const Point normal = across(f);
                const double size = length(normal);
                outer.push_back(f);
                normals.push_back(size > 0 ? 1 / size * normal : Point{});
                area += size / 2;
                for (const int32_t v : f) on_surface = on_surface + 1.0 / 3 * point(v);
                ++facets;
            }
            area_.push_back(area);
            whole_ += area;
            place_.push_back(facets > 0 ? 1 / facets * on_surface : inside);
        }
        if (components_only_) return;  // no sheet is asked for
        struct SurfaceEdge {
            int32_t high;
            double cost;
        };
        std::vector<std::pair<int32_t, SurfaceEdge>> folds;  // by their lower vertices
        for_each_edge(mesh_.vertices.size(), outer, [&](int32_t low, std::span<const Side> sides) {
            double cost = 0;
            for (size_t i = 0; i + 1 < sides.size(); i += 2) {
                const Point &m = normals[idx(sides[i].number / 3)], &n = normals[idx(sides[i + 1].number / 3)];
                const Point along = point(sides[i].high) - point(low);
                const double turn = dot(cross(m, n), along) * (sides[i].upwards ? 1 : -1);
                cost += length(along) * (turn == 0 ? 1 : crease_weight(n, m, turn > 0));
            }
            folds.push_back({low, {sides[0].high, cost}});
        });
        const CsrArray<SurfaceEdge> folds_from(mesh_.vertices.size(), [&](const auto& put) {
            for (const auto& [low, fold] : folds) put(idx(low), fold);
        });
        facets_.resize(part_.size());
        for (size_t t = 0; t < part_.size(); ++t)
            for (size_t k = 0; k < 4; ++k) {
                if (mesh_.neighbors[t][k] < 0) continue;
                const Triangle f = facet(mesh_.tetrahedra[t], k);
                facets_[t][k].area = length(across(f)) / 2;
                for (size_t i = 0; i < 3; ++i) {
                    const auto [low, high] = std::minmax(f[i], f[(i + 1) % 3]);
                    for (const SurfaceEdge& fold : folds_from.with(idx(low)))
                        if (fold.high == high) facets_[t][k].folds += fold.cost;
                }
            }
    }

    // Depth first, so that what is joined is a slice.
    void place_parts(int32_t root) {
        place_of_part_.resize(parts_);
        first_.assign(2 * parts_ - 1, 0);
        last_ = first_;
        std::vector<int32_t> todo = {root};
        int32_t next = 0;
        while (!todo.empty()) {
            const int32_t n = todo.back();
            todo.pop_back();
            if (idx(n) >= parts_)
                for (const int32_t half : children_[idx(n) - parts_]) todo.push_back(half);
            else
                place_of_part_[idx(n)] = next++;
        }
        for (size_t n = 0; n < first_.size(); ++n) {
            if (n < parts_) {
                first_[n] = place_of_part_[n];
                last_[n] = first_[n] + 1;
            } else {
                const auto& [a, b] = children_[n - parts_];
                first_[n] = std::min(first_[idx(a)], first_[idx(b)]);
                last_[n] = std::max(last_[idx(a)], last_[idx(b)]);
            }
        }
    }

    // Sets side_ of these.
    void split(std::span<const int32_t> tetrahedra, int32_t number, bool whole) {
        const auto& halves = children_[idx(number) - parts_];
        std::vector<int32_t> unassigned_tets, settled;
        double areas[2] = {0, 0};
        for (const int32_t t : tetrahedra) {
            const int32_t place = place_of_part_[idx(part_[idx(t)])];
            for (const int8_t half : {left_half, right_half})
                if (place >= first_[idx(halves[idx(half)])] && place < last_[idx(halves[idx(half)])]) {
                    side_[idx(t)] = half;
                    areas[half] += area_[idx(t)];
                }
        }
        const auto is_none = [&](double area) {
            return components_only_
                       ? area == 0
                       : areas[0] + areas[1] >= least_area * whole_ && area < min_region_area_fraction * whole_;
        };
        for (const int8_t half : {left_half, right_half})
            if (is_none(areas[half]) && std::ranges::any_of(tetrahedra, [&](int32_t t) { return is_at_split(t); }))
                for (const int32_t t : tetrahedra)
                    if (side_[idx(t)] == half) side_[idx(t)] = unassigned;
        std::ranges::copy_if(tetrahedra, std::back_inserter(unassigned_tets),
                             [&](int32_t t) { return side_[idx(t)] == unassigned; });
        // They go with the nearest: from those beside them on.
        for (const int8_t half : {left_half, right_half})
            for (const int32_t t : unassigned_tets)
                for (const int32_t n : mesh_.neighbors[idx(t)])
                    if (n >= 0 && side_[idx(n)] == half) settled.push_back(n);
        for (size_t i = 0; i < settled.size(); ++i)
            for (const int32_t n : mesh_.neighbors[idx(settled[i])])
                if (n >= 0 && side_[idx(n)] == unassigned) {
                    side_[idx(n)] = side_[idx(settled[i])];
                    settled.push_back(n);
                }
        for (const int32_t t : unassigned_tets)
            if (side_[idx(t)] == unassigned) side_[idx(t)] = left_half;
        std::vector<int32_t> border = at_split(tetrahedra);
        if (!gather(tetrahedra, border, whole).empty()) border = at_split(tetrahedra);
        if (!components_only_) cut(tetrahedra, std::move(border), whole);
    }

    // Whether it is beside the other half.
    bool is_at_split(int32_t t) const {
        return std::ranges::any_of(mesh_.neighbors[idx(t)], [&](int32_t n) {
            return n >= 0 && side_[idx(n)] != elsewhere && side_[idx(n)] != side_[idx(t)];
        });
    }

    std::vector<int32_t> at_split(std::span<const int32_t> tetrahedra) const {
        std::vector<int32_t> border;
        std::ranges::copy_if(tetrahedra, std::back_inserter(border), [&](int32_t t) { return is_at_split(t); });
        return border;
    }

    void change_sides(std::span<const int32_t> tetrahedra) {
        for (const int32_t t : tetrahedra) side_[idx(t)] = side_[idx(t)] == left_half ? right_half : left_half;
    }

    struct Piece {
        double area;
        size_t first, last;  // of the order
        bool beside;         // the other half
    };
    struct Pieces {
        std::vector<Piece> all;
        std::vector<int32_t> order;
    };

    // Of those on a side.
    Pieces pieces(std::span<const int32_t> tetrahedra, int8_t side) {
        Pieces found;
        std::vector<int32_t>& order = found.order;
        for (const int32_t start : tetrahedra) {
            if (side_[idx(start)] != side || seed_[idx(start)] >= 0) continue;
            Piece piece{0, order.size(), 0, false};
            order.push_back(start);
            seed_[idx(start)] = start;
            for (size_t i = piece.first; i < order.size(); ++i) {
                piece.area += area_[idx(order[i])];
                for (const int32_t n : mesh_.neighbors[idx(order[i])]) {
                    if (n < 0 || side_[idx(n)] == elsewhere) continue;
                    if (side_[idx(n)] != side) {
                        piece.beside = true;
                    } else if (seed_[idx(n)] < 0) {
                        seed_[idx(n)] = start;
                        order.push_back(n);
                    }
                }
            }
            piece.last = order.size();
            found.all.push_back(piece);
        }
        for (const int32_t t : order) seed_[idx(t)] = -1;
        return found;
    }

    // Whether a half of what is in one piece is in several. Each of those is at the split: from there all grow until
    // each half has met. border: all that is at the split, and more.
    bool parted(std::span<const int32_t> border) {
        std::vector<int32_t> reached;
        for (const int32_t t : border)
            if (seed_[idx(t)] < 0 && is_at_split(t)) {
                seed_[idx(t)] = static_cast<int32_t>(reached.size());
                reached.push_back(t);
            }
        size_t count = reached.size();
        UnionFind met(count);
        for (size_t i = 0; i < reached.size() && count > 2; ++i) {
            const size_t t = idx(reached[i]);
            for (const int32_t n : mesh_.neighbors[t]) {
                if (n < 0 || side_[idx(n)] != side_[t]) continue;
                if (seed_[idx(n)] < 0) {
                    seed_[idx(n)] = seed_[t];
                    reached.push_back(n);
                } else if (met.find(idx(seed_[idx(n)])) != met.find(idx(seed_[t]))) {
                    met.join(idx(seed_[idx(n)]), idx(seed_[t]));
                    --count;
                }
            }
        }
        for (const int32_t t : reached) seed_[idx(t)] = -1;
        return count > 2;
    }

    // What of a half is apart from its largest piece, and beside the other half, changes sides. Returns all that did.
    std::vector<int32_t> gather(std::span<const int32_t> tetrahedra, std::span<const int32_t> border, bool whole) {
        std::vector<int32_t> changed;
        if (whole && !parted(border)) return changed;
        for (const int8_t half : {left_half, right_half}) {
            const auto [all, order] = pieces(tetrahedra, half);
            // In single precision, so that those tie that do by symmetry.
            const auto size = [](const Piece& piece) {
                return std::pair(static_cast<float>(piece.area), piece.last - piece.first);
            };
            const auto largest = std::ranges::max_element(all, {}, size);
            for (const Piece& piece : all) {
                if (&piece == &*largest || !piece.beside) continue;
                if (components_only_ && piece.area >= small_component_fraction * largest->area) continue;
                const auto apart = std::span(order).subspan(piece.first, piece.last - piece.first);
                change_sides(apart);
                changed.insert(changed.end(), apart.begin(), apart.end());
            }
        }
        return changed;
    }

    // Moves the border between the halves to where it costs least.
    void cut(std::span<const int32_t> tetrahedra, std::vector<int32_t> border, bool whole) {
        double areas[2] = {0, 0}, deepest[2] = {0, 0};
        size_t beyond[2] = {0, 0};  // the band
        for (const int32_t t : tetrahedra) {
            areas[side_[idx(t)]] += area_[idx(t)];
            ++beyond[side_[idx(t)]];
        }
        double reach = band_reach * std::sqrt(std::min(areas[0], areas[1]));
        if (!(reach > 0) || areas[0] + areas[1] < least_area * whole_) return;
        const std::vector<int32_t> band = measure_depths(border, reach);
        for (const int32_t t : band) {
            double& depth = deepest[side_[idx(t)]];
            depth = std::max(depth, depth_[idx(t)]);
            --beyond[side_[idx(t)]];
        }
        for (const int8_t half : {left_half, right_half})
            if (beyond[half] > 0) deepest[half] = infinite;
        std::vector<int32_t> free;
        for (const int32_t t : band) {
            // Of a half that is all within reach the deeper half stays.
            if (depth_[idx(t)] >= std::min(reach, deepest[side_[idx(t)]] / 2) * (1 - same_depth)) continue;
            node_[idx(t)] = static_cast<int32_t>(free.size());
            free.push_back(t);
        }
        Cut problem;
        problem.to_part.assign(free.size(), 0);
        problem.to_rest.assign(free.size(), 0);
        for (size_t n = 0; n < free.size(); ++n) {
            const size_t t = idx(free[n]);
            for (size_t k = 0; k < 4; ++k) {
                const int32_t other = mesh_.neighbors[t][k];
                if (other < 0 || side_[idx(other)] == elsewhere || (node_[idx(other)] >= 0 && idx(other) < t)) continue;
                const bool at_split = side_[t] != side_[idx(other)];
                const double away = at_split ? 0 : std::min((depth_[t] + depth_[idx(other)]) / 2 / reach, 1.0);
                const double plain = sheet_weight * facets_[t][k].area / reach + facets_[t][k].folds;
                const int64_t cost = quantize_cost((1 + pull * away) * plain / reach);
                if (node_[idx(other)] >= 0)
                    problem.edges.push_back({static_cast<int32_t>(n), node_[idx(other)], cost});
                else
                    (side_[idx(other)] == left_half ? problem.to_part : problem.to_rest)[n] += cost;
            }
        }
        for (const int32_t t : band) {
            depth_[idx(t)] = infinite;
            node_[idx(t)] = -1;
        }
        const std::vector<uint8_t> left = minimum_cut(problem);
        std::vector<int32_t> moved;
        for (size_t n = 0; n < free.size(); ++n)
            if ((side_[idx(free[n])] == left_half) != (left[n] == 1)) moved.push_back(free[n]);
        for (const int32_t t : moved) {
            areas[1 - side_[idx(t)]] += area_[idx(t)];
            areas[side_[idx(t)]] -= area_[idx(t)];
        }
        if (moved.empty() || std::min(areas[0], areas[1]) < min_region_area_fraction * whole_) return;
        change_sides(moved);
        for (const int32_t t : moved) {
            border.push_back(t);
            for (const int32_t n : mesh_.neighbors[idx(t)])
                if (n >= 0 && side_[idx(n)] != elsewhere) border.push_back(n);
        }
        if (const std::vector<int32_t> apart = gather(tetrahedra, border, whole); !apart.empty()) {
            change_sides(apart);  // what holds a piece where it is was not free
            change_sides(moved);
        }
    }

    // How deep in its half each tetrahedron lies: the way to the split over places of tetrahedra; infinity beyond
    // reach, which is made less where so many are within it. Returns those within, in rising order.
    std::vector<int32_t> measure_depths(std::span<const int32_t> border, double& reach) {
        // Ring by ring, each in any order until no way in it gets shorter: cheaper than by the shortest way first.
        for (std::vector<Reached>& ring : rings_) ring.clear();
        std::vector<int32_t> band;
        const auto come = [&](int32_t t, double way) {
            if (way > reach || way >= depth_[idx(t)]) return;
            if (depth_[idx(t)] == infinite) band.push_back(t);
            depth_[idx(t)] = way;
            rings_[static_cast<size_t>(way / reach * rings)].push_back({way, t});
        };
        const auto apart = [&](int32_t t, int32_t n) { return length(place_[idx(t)] - place_[idx(n)]); };
        for (const int32_t t : border)
            for (const int32_t n : mesh_.neighbors[idx(t)])
                if (n >= 0 && side_[idx(n)] != elsewhere && side_[idx(n)] != side_[idx(t)]) come(t, apart(t, n) / 2);
        size_t done = 0;
        for (size_t r = 0; r <= rings && done <= most_tetrahedra; ++r) {
            for (size_t i = 0; i < rings_[r].size(); ++i) {
                const auto [way, t] = rings_[r][i];
                if (way > depth_[idx(t)]) continue;
                for (const int32_t n : mesh_.neighbors[idx(t)])
                    if (n >= 0 && side_[idx(n)] == side_[idx(t)]) come(n, way + apart(t, n));
            }
            for (const auto& [way, t] : rings_[r]) done += way == depth_[idx(t)];
        }
        if (done > most_tetrahedra) {  // the others are deeper than these
            std::vector<double> depths;
            for (const int32_t t : band) depths.push_back(depth_[idx(t)]);
            std::ranges::nth_element(depths, depths.begin() + most_tetrahedra);
            reach = depths[most_tetrahedra];
        }
        std::erase_if(band, [&](int32_t t) {
            if (depth_[idx(t)] <= reach) return false;
            depth_[idx(t)] = infinite;
            return true;
        });
        std::ranges::sort(band);
        return band;
    }

    struct FacetCost {
        double area = 0, folds = 0;
    };

    const TetMesh& mesh_;
    std::span<const int32_t> part_;
    std::span<const std::array<int32_t, 2>> children_;
    const bool components_only_;
    Progress& progress_;
    const size_t parts_;
    std::vector<int32_t> place_of_part_, first_, last_;  // depth first; the slice of each number
    double whole_ = 0;
    std::vector<double> area_;  // of each tetrahedron, on the surface
    std::vector<Point> place_;  // likewise: the middle of its outer facets, or its own
    std::vector<std::array<FacetCost, 4>> facets_;

    struct Reached {
        double way;
        int32_t tetrahedron;
    };
    std::array<std::vector<Reached>, rings + 1> rings_;  // of measure_depths()

    // Of each tetrahedron, while what it is in is split.
    std::vector<int8_t> side_;
    std::vector<double> depth_;
    std::vector<int32_t> node_, seed_;
};

}  // namespace

PartTree snap_borders(const TetMesh& mesh, const PartTree& tree, Progress& progress) {
    return relabel(tree, Snapping(mesh, tree, false, progress).run());
}

PartTree reassign_small_components(const TetMesh& mesh, const PartTree& tree, Progress& progress) {
    return relabel(tree, Snapping(mesh, tree, true, progress).run());
}

}  // namespace partwheel
