// Borders in the creases nearby: bands around the splits, and the sheets of facets that cost least.
#include "tree/snap/snap.h"

#include "base/groups.h"
#include "tree/snap/minimum_cut.h"
#include "surface/crease.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
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
constexpr double infinite = std::numeric_limits<double>::infinity();

enum : int8_t { elsewhere = -1, left_half = 0, right_half = 1, unsettled = 2 };

class Snapping {
public:
    Snapping(const TetMesh& mesh, const Joins& joins, Progress& progress)
        : mesh_(mesh), part_(joins.of), joined_(joins.joined), progress_(progress), parts_(joins.count) {
        const size_t tetrahedra = mesh.tetrahedra.size();
        measure();
        side_.assign(tetrahedra, elsewhere);
        depth_.assign(tetrahedra, infinite);
        node_.assign(tetrahedra, -1);
        piece_.assign(tetrahedra, -1);
    }

    std::vector<int32_t> run() {
        std::vector<int32_t> result(part_.size());
        struct Task {
            int32_t number;
            std::vector<int32_t> tetrahedra;
        };
        std::vector<Task> todo(1);
        todo[0].number = static_cast<int32_t>(2 * parts_ - 2);
        for (size_t t = 0; t < part_.size(); ++t) todo[0].tetrahedra.push_back(static_cast<int32_t>(t));
        place_parts(todo[0].number);
        while (!todo.empty()) {
            const Task task = std::move(todo.back());
            todo.pop_back();
            if (at(task.number) < parts_) {
                for (const int32_t t : task.tetrahedra) result[at(t)] = task.number;
                continue;
            }
            split(task.tetrahedra, task.number);
            const auto& halves = joined_[at(task.number) - parts_];
            Task each[2] = {{halves[0], {}}, {halves[1], {}}};
            for (const int32_t t : task.tetrahedra) {
                each[side_[at(t)]].tetrahedra.push_back(t);
                side_[at(t)] = elsewhere;
            }
            for (Task& half : each)
                if (!half.tetrahedra.empty()) todo.push_back(std::move(half));
            progress_.advance(0);
        }
        return result;
    }

private:
    // Areas on the surface, where each tetrahedron is, and what a sheet through each facet costs.
    void measure() {
        const auto point = [&](int32_t v) -> const Point& { return mesh_.vertices[at(v)]; };
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
                if (mesh_.neighbours[t][k] >= 0) continue;
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
        struct Fold {
            int32_t high;
            double cost;
        };
        std::vector<std::pair<int32_t, Fold>> folds;  // by their lower vertices
        for_edges(mesh_.vertices.size(), outer, [&](int32_t low, std::span<const Side> sides) {
            double cost = 0;
            for (size_t i = 0; i + 1 < sides.size(); i += 2) {
                const Point &m = normals[at(sides[i].number / 3)], &n = normals[at(sides[i + 1].number / 3)];
                const Point along = point(sides[i].high) - point(low);
                const double turn = dot(cross(m, n), along) * (sides[i].upwards ? 1 : -1);
                cost += length(along) * (turn == 0 ? 1 : crease_weight(n, m, turn > 0));
            }
            folds.push_back({low, {sides[0].high, cost}});
        });
        const Grouped<Fold> folds_from(mesh_.vertices.size(), [&](const auto& put) {
            for (const auto& [low, fold] : folds) put(at(low), fold);
        });
        facets_.resize(part_.size());
        for (size_t t = 0; t < part_.size(); ++t)
            for (size_t k = 0; k < 4; ++k) {
                if (mesh_.neighbours[t][k] < 0) continue;
                const Triangle f = facet(mesh_.tetrahedra[t], k);
                facets_[t][k].area = length(across(f)) / 2;
                for (size_t i = 0; i < 3; ++i) {
                    const auto [low, high] = std::minmax(f[i], f[(i + 1) % 3]);
                    for (const Fold& fold : folds_from.with(at(low)))
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
            if (at(n) >= parts_)
                for (const int32_t half : joined_[at(n) - parts_]) todo.push_back(half);
            else
                place_of_part_[at(n)] = next++;
        }
        for (size_t n = 0; n < first_.size(); ++n) {
            if (n < parts_) {
                first_[n] = place_of_part_[n];
                last_[n] = first_[n] + 1;
            } else {
                const auto& [a, b] = joined_[n - parts_];
                first_[n] = std::min(first_[at(a)], first_[at(b)]);
                last_[n] = std::max(last_[at(a)], last_[at(b)]);
            }
        }
    }

    // Sets side_ of these.
    void split(std::span<const int32_t> tetrahedra, int32_t number) {
        const auto& halves = joined_[at(number) - parts_];
        std::vector<int32_t> settled;
        for (const int32_t t : tetrahedra) {
            const int32_t place = place_of_part_[at(part_[at(t)])];
            int8_t side = unsettled;
            for (const int8_t half : {left_half, right_half})
                if (place >= first_[at(halves[at(half)])] && place < last_[at(halves[at(half)])]) side = half;
            side_[at(t)] = side;
        }
        for (const int8_t half : {left_half, right_half})
            for (const int32_t t : tetrahedra)
                if (side_[at(t)] == half) settled.push_back(t);
        for (size_t i = 0; i < settled.size(); ++i)  // what came from elsewhere goes with the nearest
            for (const int32_t n : mesh_.neighbours[at(settled[i])])
                if (n >= 0 && side_[at(n)] == unsettled) {
                    side_[at(n)] = side_[at(settled[i])];
                    settled.push_back(n);
                }
        for (const int32_t t : tetrahedra)
            if (side_[at(t)] == unsettled) side_[at(t)] = left_half;
        gather(tetrahedra);
        cut(tetrahedra);
    }

    // What of a half is apart from its largest piece, and beside the other half, changes sides. Whether anything did.
    bool gather(std::span<const int32_t> tetrahedra) {
        bool changed = false;
        for (const int8_t half : {left_half, right_half}) {
            struct Piece {
                double area = 0;
                size_t first, last;
                bool beside = false;  // the other half
            };
            std::vector<Piece> pieces;
            std::vector<int32_t> order;  // of them all
            for (const int32_t start : tetrahedra) {
                if (side_[at(start)] != half || piece_[at(start)] >= 0) continue;
                const auto number = static_cast<int32_t>(pieces.size());
                Piece piece{0, order.size(), 0};
                order.push_back(start);
                piece_[at(start)] = number;
                for (size_t i = piece.first; i < order.size(); ++i) {
                    piece.area += area_[at(order[i])];
                    for (const int32_t n : mesh_.neighbours[at(order[i])]) {
                        if (n < 0 || side_[at(n)] == elsewhere) continue;
                        if (side_[at(n)] != half) {
                            piece.beside = true;
                        } else if (piece_[at(n)] < 0) {
                            piece_[at(n)] = number;
                            order.push_back(n);
                        }
                    }
                }
                piece.last = order.size();
                pieces.push_back(piece);
            }
            for (const int32_t t : order) piece_[at(t)] = -1;
            // In single precision, so that those tie that do by symmetry.
            const auto size = [](const Piece& piece) {
                return std::pair(static_cast<float>(piece.area), piece.last - piece.first);
            };
            const auto largest = std::ranges::max_element(pieces, {}, size);
            for (const Piece& piece : pieces) {
                if (&piece == &*largest || !piece.beside) continue;
                changed = true;
                for (size_t i = piece.first; i < piece.last; ++i)
                    side_[at(order[i])] = half == left_half ? right_half : left_half;
            }
        }
        return changed;
    }

    // Moves the border between the halves to where it costs least.
    void cut(std::span<const int32_t> tetrahedra) {
        double areas[2] = {0, 0}, deepest[2] = {0, 0};
        for (const int32_t t : tetrahedra) areas[side_[at(t)]] += area_[at(t)];
        double reach = band_reach * std::sqrt(std::min(areas[0], areas[1]));
        if (!(reach > 0) || areas[0] + areas[1] < least_area * whole_) return;
        const std::vector<int32_t> band = measure_depths(tetrahedra, reach);
        for (const int32_t t : tetrahedra) {
            double& depth = deepest[side_[at(t)]];
            depth = std::max(depth, depth_[at(t)]);
        }
        std::vector<int32_t> free;
        for (const int32_t t : band) {
            // Of a half that is all within reach the deeper half stays.
            if (depth_[at(t)] >= std::min(reach, deepest[side_[at(t)]] / 2) * (1 - same_depth)) continue;
            node_[at(t)] = static_cast<int32_t>(free.size());
            free.push_back(t);
        }
        Cut problem;
        problem.to_part.assign(free.size(), 0);
        problem.to_rest.assign(free.size(), 0);
        for (size_t n = 0; n < free.size(); ++n) {
            const size_t t = at(free[n]);
            for (size_t k = 0; k < 4; ++k) {
                const int32_t other = mesh_.neighbours[t][k];
                if (other < 0 || side_[at(other)] == elsewhere || (node_[at(other)] >= 0 && at(other) < t)) continue;
                const bool at_split = side_[t] != side_[at(other)];
                const double away = at_split ? 0 : std::min((depth_[t] + depth_[at(other)]) / 2 / reach, 1.0);
                const double plain = sheet_weight * facets_[t][k].area / reach + facets_[t][k].folds;
                const int64_t cost = whole_cost((1 + pull * away) * plain / reach);
                if (node_[at(other)] >= 0)
                    problem.edges.push_back({static_cast<int32_t>(n), node_[at(other)], cost});
                else
                    (side_[at(other)] == left_half ? problem.to_part : problem.to_rest)[n] += cost;
            }
        }
        std::vector<int8_t> before;
        for (const int32_t t : tetrahedra) before.push_back(side_[at(t)]);
        const std::vector<uint8_t> left = minimum_cut(problem);
        for (size_t n = 0; n < free.size(); ++n) side_[at(free[n])] = left[n] ? left_half : right_half;
        if (gather(tetrahedra))  // what holds a piece where it is was not free
            for (size_t i = 0; i < tetrahedra.size(); ++i) side_[at(tetrahedra[i])] = before[i];
        for (const int32_t t : band) {
            depth_[at(t)] = infinite;
            node_[at(t)] = -1;
        }
    }

    // How deep in its half each tetrahedron lies: the way to the split over places of tetrahedra; infinity beyond
    // reach, which is made less where so many are within it. Returns those within, in rising order.
    std::vector<int32_t> measure_depths(std::span<const int32_t> tetrahedra, double& reach) {
        using Reached = std::pair<double, int32_t>;
        std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
        std::vector<int32_t> band;
        const auto come = [&](int32_t t, double way) {
            if (way > reach || way >= depth_[at(t)]) return;
            if (depth_[at(t)] == infinite) band.push_back(t);
            depth_[at(t)] = way;
            front.push({way, t});
        };
        const auto apart = [&](int32_t t, int32_t n) { return length(place_[at(t)] - place_[at(n)]); };
        for (const int32_t t : tetrahedra)
            for (const int32_t n : mesh_.neighbours[at(t)])
                if (n >= 0 && side_[at(n)] != elsewhere && side_[at(n)] != side_[at(t)]) come(t, apart(t, n) / 2);
        for (size_t done = 0; !front.empty();) {
            const auto [way, t] = front.top();
            front.pop();
            if (way > depth_[at(t)]) continue;
            if (done++ == most_tetrahedra) {
                reach = way;
                break;
            }
            for (const int32_t n : mesh_.neighbours[at(t)])
                if (n >= 0 && side_[at(n)] == side_[at(t)]) come(n, way + apart(t, n));
        }
        for (const int32_t t : band)
            if (depth_[at(t)] > reach) depth_[at(t)] = infinite;
        std::erase_if(band, [&](int32_t t) { return depth_[at(t)] == infinite; });
        std::sort(band.begin(), band.end());
        return band;
    }

    struct FacetCost {
        double area = 0, folds = 0;
    };

    const TetMesh& mesh_;
    std::span<const int32_t> part_;
    std::span<const std::array<int32_t, 2>> joined_;
    Progress& progress_;
    const size_t parts_;
    std::vector<int32_t> place_of_part_, first_, last_;  // depth first; the slice of each number
    double whole_ = 0;
    std::vector<double> area_;  // of each tetrahedron, on the surface
    std::vector<Point> place_;  // likewise: the middle of its outer facets, or its own
    std::vector<std::array<FacetCost, 4>> facets_;

    // Of each tetrahedron, while what it is in is split.
    std::vector<int8_t> side_;
    std::vector<double> depth_;
    std::vector<int32_t> node_, piece_;
};

}  // namespace

Joins snapped(const TetMesh& mesh, const Joins& joins, Progress& progress) {
    return with_parts(joins, Snapping(mesh, joins, progress).run());
}

}  // namespace partwheel
