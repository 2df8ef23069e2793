// Double walls: rays reject most meshes quickly; a voxel grid finds what is visible from outside.
//
// A ball that rolls around the model (a morphological closing) gets into cups and halls, but not through small holes.
// Space that it can't reach is enclosed. Narrow space belongs to the region with the widest connection to it: gaps
// between fingers to the outside, the inside of a finger to the cavity. A triangle is outer if it is the nearest to
// some voxel of the outside.
#include "prepare/double_walls.h"

#include "base/adjacency.h"
#include "base/corners.h"
#include "mesh/nearest.h"
#include "mesh/rays.h"

namespace partwheel {

namespace {

// Lengths are relative to the diagonal of the bounding box, areas to its square.
constexpr double max_thickness = 0.03;  // of a wall

// The inner triangles of a double wall have at least this area, relative to the outer ones, and at least this share of
// it is within max_thickness of the outer ones.
constexpr double min_inner_area = 0.5, min_close_area = 0.8;

// Walls are parallel if the cosine between their normals is at least this.
constexpr double min_parallel = 0.7;

// Patches of inner or outer triangles with less than this share of the area are errors.
constexpr double min_patch_area = 0.002;

// There is no double wall if fewer than min_enclosed_samples of the samples are on the inside of a wall.
constexpr size_t sample_count = 64, min_enclosed_samples = 12;
constexpr size_t ray_count = 32;       // from each sample
constexpr size_t max_crossings = 100;  // counting stops there

// Rays start this far from the surface; they don't hit triangles that are closer.
constexpr double ray_offset = 1e-6;

// Side of a voxel, and the radius of the ball in voxels. The ball is a cube of 2 * ball_radius + 1 voxels.
constexpr double voxel = 1.0 / 200;
constexpr uint8_t ball_radius = 2;

// Meshes whose triangles cover more voxels, summed over the triangles, are not examined. Of 108 assets none covers
// more than 270,000.
constexpr double max_triangle_voxels = 2e6;

// Steps of a loop between two checks for cancellation.
constexpr size_t steps_between_polls = 256;

struct WallMesh {
    std::vector<Point> vertices;      // of a bounding box with diagonal 1, whose lower corner is the origin
    std::vector<Triangle> triangles;  // in canonical order
    std::vector<int32_t> source;      // the caller's number of each
    Point high{};                     // the upper corner of that box
    double area = 0;

    std::array<Point, 3> corners(size_t t) const { return corner_points(vertices, triangles[t]); }
    double area_of(size_t t) const { return partwheel::area(vertices, triangles[t]); }
    Point center(size_t t) const {
        const auto [a, b, c] = corners(t);
        return 1.0 / 3 * (a + b + c);
    }
    Point unit_normal(size_t t) const {
        const auto [a, b, c] = corners(t);
        const Point normal = cross(b - a, c - a);
        return 1 / length(normal) * normal;
    }
};

// Each triangle starts with its lowest vertex, and triangles are sorted, so that the caller's order doesn't matter.
WallMesh to_wall_mesh(std::span<const Point> vertices, std::span<const Triangle> triangles) {
    WallMesh mesh;
    std::vector<std::pair<Triangle, int32_t>> order;
    Box box;
    for (Triangle t : triangles) {
        for (const int32_t v : t) box.add(vertices[idx(v)]);
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        order.emplace_back(t, static_cast<int32_t>(order.size()));
    }
    const double diagonal = box.diagonal();
    if (!(diagonal > 0) || !std::isfinite(1 / diagonal)) return mesh;
    std::sort(order.begin(), order.end());
    mesh.high = 1 / diagonal * (box.high - box.low);
    for (const Point& p : vertices) mesh.vertices.push_back(1 / diagonal * (p - box.low));
    for (const auto& [t, source] : order) {
        mesh.triangles.push_back(t);
        mesh.source.push_back(source);
        mesh.area += mesh.area_of(mesh.triangles.size() - 1);
    }
    return mesh;
}

// The number of triangles that a ray crosses. It is unlikely that a model has edges in its direction.
size_t count_crossings(const RayTarget& target, const Point& p) {
    const Point direction{0.5377, 0.3141, 0.7823};
    size_t count = 0;
    for (RayHit hit{0, ray_offset}; count < max_crossings; ++count) {
        hit = target.first_hit(p, direction, hit.distance);
        if (hit.triangle < 0) break;
    }
    return count;
}

// Whether no ray from p into the half space of the normal leaves the model.
bool is_enclosed(const RayTarget& target, const Point& p, const Point& normal) {
    Point direction = normal;
    Point r{};  // Roberts' R3 sequence: points spread over a cube
    for (size_t i = 0; i < ray_count; ++i) {
        const double side = dot(direction, normal) < 0 ? -1 : 1;
        if (target.first_hit(p, side * direction, ray_offset).triangle < 0) return false;
        r = r + Point{0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
        for (size_t k = 0; k < 3; ++k) {
            r[k] = std::fmod(r[k], 1);
            direction[k] = 2 * r[k] - 1;
        }
    }
    return true;
}

// Calls sample(point, unit normal) at points distributed evenly over the area.
template <class Function>
void for_each_sample(const WallMesh& mesh, const Function& sample) {
    double passed = 0, u = 0, v = 0;
    size_t count = 0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        passed += mesh.area_of(t);
        const auto [a, b, c] = mesh.corners(t);
        const Point normal = cross(b - a, c - a);
        for (; (static_cast<double>(count) + 0.5) * mesh.area < passed * sample_count; ++count) {
            u = std::fmod(u + 0.7548776662466927, 1), v = std::fmod(v + 0.5698402909980532, 1);  // Roberts' R2 sequence
            const auto [s, r] = u + v > 1 ? std::pair(1 - u, 1 - v) : std::pair(u, v);
            sample(a + s * (b - a) + r * (c - a), 1 / length(normal) * normal);
        }
    }
}

// From a point on the inside of a wall to the next triangle.
struct Segment {
    Point begin, end;
};

// For samples that no ray leaves and that have another surface close behind them. The parity of crossings distinguishes
// cavities from the solid.
std::vector<Segment> find_cavity_segments(const WallMesh& mesh, const RayTarget& target, Progress& progress) {
    std::vector<Segment> segments;
    for_each_sample(mesh, [&](const Point& p, const Point& normal) {
        progress.advance_by(2.0 / sample_count);
        for (const double side : {1.0, -1.0}) {
            const Point free_side = side * normal;
            const RayHit behind = target.first_hit(p, -1 * free_side, ray_offset);
            if (behind.triangle < 0 || behind.distance > max_thickness || !is_enclosed(target, p, free_side)) continue;
            if (count_crossings(target, p + ray_offset * free_side) % 2 != 0) continue;
            segments.push_back({p, p + target.first_hit(p, free_side, ray_offset).distance * free_side});
            break;
        }
    });
    return segments;
}

enum class Region : uint8_t { unknown, outside, enclosed };

// The space around the model as voxels: the distance of each from the surface, and its region.
class VoxelGrid {
public:
    VoxelGrid(const WallMesh& mesh, Progress& progress) {
        for (size_t k = 0; k < 3; ++k) size_[k] = static_cast<size_t>(mesh.high[k] / voxel) + 1 + 2 * margin;
        clearance_.assign(size_[0] * size_[1] * size_[2], ball_radius + 1);
        for (size_t t = 0; t < mesh.triangles.size(); ++t) {
            if (t % steps_between_polls == 0) progress.advance_by(0.1);
            mark(mesh.corners(t));
        }
        measure_clearance();
        progress.advance_by(0.2);
        find_regions();
        progress.advance_by(0.2);
    }

    // The first known region along the segment.
    Region region_along(const Segment& segment) const {
        const Point direction = segment.end - segment.begin;
        const double steps = std::ceil(2 * length(direction) / voxel);
        for (double i = 0; i < steps; ++i) {
            const Region region = region_[index(cell(segment.begin + i / steps * direction))];
            if (region != Region::unknown) return region;
        }
        return Region::unknown;
    }

    // Calls visit(center, region) for every seventh voxel of a known region next to the surface.
    template <class Function>
    void for_each_near_surface(const Function& visit) const {
        for (size_t i = 0; i < clearance_.size(); ++i)
            if (clearance_[i] == 1 && region_[i] != Region::unknown && is_sampled(i)) visit(center(i), region_[i]);
    }

private:
    static constexpr size_t margin = ball_radius + 2;  // of free voxels around the model

    using Cell = std::array<size_t, 3>;

    Cell cell(size_t i) const { return {i % size_[0], i / size_[0] % size_[1], i / size_[0] / size_[1]}; }
    Cell cell(const Point& p) const {
        const auto coordinate = [&](size_t k) { return static_cast<size_t>(p[k] / voxel + margin); };
        return {coordinate(0), coordinate(1), coordinate(2)};
    }
    size_t index(const Cell& c) const { return c[0] + size_[0] * (c[1] + size_[1] * c[2]); }
    // True for exactly one of each voxel and its six neighbors.
    bool is_sampled(size_t i) const {
        const Cell c = cell(i);
        return (c[0] + 2 * c[1] + 4 * c[2]) % 7 == 0;
    }
    bool is_on_border(size_t i) const {
        const Cell c = cell(i);
        for (size_t k = 0; k < 3; ++k)
            if (c[k] == 0 || c[k] + 1 == size_[k]) return true;
        return false;
    }

    Point center(size_t i) const {
        const Cell c = cell(i);
        const auto coordinate = [](size_t n) { return (static_cast<double>(n) + 0.5 - margin) * voxel; };
        return {coordinate(c[0]), coordinate(c[1]), coordinate(c[2])};
    }

    // Marks the voxels of a triangle: divides it until no side is longer than a voxel, then takes the bounding boxes.
    void mark(const std::array<Point, 3>& corners) {
        const auto& [a, b, c] = corners;
        const double ab = length(b - a), bc = length(c - b), ca = length(a - c);
        if (ab > voxel && ab >= bc && ab >= ca) return split(a, b, c);
        if (bc > voxel && bc >= ca) return split(b, c, a);
        if (ca > voxel) return split(c, a, b);
        const Box box = Box::around(corners);
        const Cell low = cell(box.low), high = cell(box.high);
        for (size_t z = low[2]; z <= high[2]; ++z)
            for (size_t y = low[1]; y <= high[1]; ++y)
                for (size_t x = low[0]; x <= high[0]; ++x) clearance_[index({x, y, z})] = 0;
    }

    void split(const Point& a, const Point& b, const Point& c) {
        const Point middle = 0.5 * (a + b);
        mark({a, middle, c});
        mark({middle, b, c});
    }

    // The six voxels that share a side with a voxel, which is not on the border of the grid.
    std::array<size_t, 6> neighbors(size_t i) const {
        const size_t row = size_[0], layer = size_[0] * size_[1];
        return {i - layer, i - row, i - 1, i + 1, i + row, i + layer};
    }

    // Chebyshev distance, computed along one axis after the other.
    void measure_clearance() {
        for (const size_t stride : {size_t{1}, size_[0], size_[0] * size_[1]}) {
            const std::vector<uint8_t> before = clearance_;
            for (size_t i = ball_radius * stride; i + ball_radius * stride < before.size(); ++i)
                for (uint8_t d = 1; d <= ball_radius; ++d) {
                    const uint8_t nearer = std::min(before[i - d * stride], before[i + d * stride]);
                    clearance_[i] = std::min(clearance_[i], std::max(d, nearer));
                }
        }
    }

    void find_regions() {
        region_.assign(clearance_.size(), Region::unknown);
        for (size_t i = 0; i < region_.size(); ++i)
            if (is_on_border(i)) region_[i] = Region::outside;
        std::vector<size_t> queue{1 + size_[0] + size_[0] * size_[1]};
        region_[queue[0]] = Region::outside;
        grow(queue, ball_radius + 1);
        for (size_t i = 0; i < region_.size(); ++i)
            if (clearance_[i] > ball_radius && region_[i] == Region::unknown) region_[i] = Region::enclosed;
        for (uint8_t least = ball_radius; least > 0; --least) {
            queue.clear();
            for (size_t i = 0; i < region_.size(); ++i)
                if (clearance_[i] == least + 1 && region_[i] != Region::unknown && !is_on_border(i)) queue.push_back(i);
            grow(queue, least);
        }
    }

    // Extends the regions breadth first, from the voxels of the queue to unknown ones with at least this clearance.
    void grow(std::vector<size_t>& queue, uint8_t min_clearance) {
        for (size_t next = 0; next < queue.size(); ++next)
            for (const size_t i : neighbors(queue[next])) {
                if (clearance_[i] < min_clearance || region_[i] != Region::unknown) continue;
                region_[i] = region_[queue[next]];
                queue.push_back(i);
            }
    }

    Cell size_{};
    std::vector<uint8_t> clearance_;  // distance from the surface in voxels, at most ball_radius + 1; 0: on the surface
    std::vector<Region> region_;
};

// For each triangle, the triangles that share an edge with it.
using Neighbors = CsrArray<int32_t>;

Neighbors find_neighbors(const WallMesh& mesh) {
    return Neighbors(mesh.triangles.size(), [&](const auto& put) {
        for_each_edge(mesh.vertices.size(), mesh.triangles, [&](int32_t, std::span<const Side> sides) {
            for (size_t i = 1; i < sides.size(); ++i) {
                const int32_t a = sides[i - 1].number / 3, b = sides[i].number / 3;
                put(idx(a), b), put(idx(b), a);
            }
        });
    });
}

// Triangles of an unknown region get the region of the nearest triangle along the surface (breadth first).
void propagate(const Neighbors& neighbors, std::vector<Region>& regions) {
    std::vector<size_t> queue;
    for (size_t t = 0; t < regions.size(); ++t)
        if (regions[t] != Region::unknown) queue.push_back(t);
    for (size_t next = 0; next < queue.size(); ++next)
        for (const int32_t t : neighbors.row(queue[next])) {
            if (regions[idx(t)] != Region::unknown) continue;
            regions[idx(t)] = regions[queue[next]];
            queue.push_back(idx(t));
        }
}

// Small patches of one region inside the other, as where walls touch, get the region around them.
void absorb_small_patches(const WallMesh& mesh, const Neighbors& neighbors, std::vector<Region>& regions) {
    UnionFind patches(regions.size());
    for (size_t t = 0; t < regions.size(); ++t)
        for (const int32_t n : neighbors.row(t))
            if (regions[t] == regions[idx(n)]) patches.unite(t, idx(n));
    std::vector<double> areas(regions.size(), 0);
    for (size_t t = 0; t < regions.size(); ++t) areas[patches.find(t)] += mesh.area_of(t);
    std::vector<Region> around(regions.size(), Region::unknown);  // of each patch, if a larger one is next to it
    for (size_t t = 0; t < regions.size(); ++t)
        for (const int32_t n : neighbors.row(t))
            if (areas[patches.find(idx(n))] > areas[patches.find(t)]) around[patches.find(t)] = regions[idx(n)];
    for (size_t t = 0; t < regions.size(); ++t) {
        const size_t patch = patches.find(t);
        if (areas[patch] < min_patch_area * mesh.area && around[patch] != Region::unknown) regions[t] = around[patch];
    }
}

// A shell with more outer than inner area is not an inner wall: a boss sunk into a shield encloses space together with
// the shield, but is visible. Only the shell with the largest outer area may have both kinds, because of leaks.
void absorb_visible_shells(const WallMesh& mesh, const Neighbors& neighbors, std::vector<Region>& regions) {
    UnionFind shells(regions.size());
    for (size_t t = 0; t < regions.size(); ++t)
        for (const int32_t n : neighbors.row(t)) shells.unite(t, idx(n));
    std::vector<double> outer(regions.size(), 0), inner(regions.size(), 0);  // area of each shell
    for (size_t t = 0; t < regions.size(); ++t)
        (regions[t] == Region::outside ? outer : inner)[shells.find(t)] += mesh.area_of(t);
    const auto outermost = static_cast<size_t>(std::ranges::max_element(outer) - outer.begin());
    for (size_t t = 0; t < regions.size(); ++t)
        if (const size_t s = shells.find(t); s != outermost && outer[s] > inner[s]) regions[t] = Region::outside;
}

// Whether the inner wall runs behind a triangle, in parallel. The parity of crossings tells where the solid is.
bool has_inner_wall_behind(const WallMesh& mesh, const RayTarget& target, const std::vector<Region>& regions, size_t t) {
    if (!(mesh.area_of(t) > 0)) return false;
    const Point normal = mesh.unit_normal(t), center = mesh.center(t);
    for (const double side : {1.0, -1.0}) {
        if (count_crossings(target, center + side * ray_offset * normal) % 2 == 0) continue;
        const RayHit hit = target.first_hit(center, side * normal, ray_offset);
        if (hit.triangle >= 0 && hit.distance <= max_thickness && regions[idx(hit.triangle)] == Region::enclosed &&
            std::abs(dot(normal, mesh.unit_normal(idx(hit.triangle)))) >= min_parallel)
            return true;
    }
    return false;
}

// The sides of leaks go with the inner wall, so that leaks are closed at the outer wall, not at the bottom of a pit.
// They are within max_thickness of the inner wall.
void absorb_sides_of_leaks(const WallMesh& mesh, const RayTarget& target, const Neighbors& neighbors,
                           std::vector<Region>& regions, Progress& progress) {
    const std::vector<Region> walls = regions;
    std::vector<std::pair<size_t, Point>> queue;  // with a corner of the inner wall
    for (size_t t = 0; t < regions.size(); ++t)
        if (regions[t] == Region::enclosed)
            for (const int32_t v : mesh.triangles[t]) queue.emplace_back(t, mesh.vertices[idx(v)]);
    for (size_t next = 0; next < queue.size(); ++next) {
        if (next % steps_between_polls == 0) progress.advance_by(0.01);
        const size_t t = queue[next].first;
        const Point begin = queue[next].second;
        for (const int32_t n : neighbors.row(t)) {
            const auto is_near = [&](const Point& corner) { return length(corner - begin) <= max_thickness; };
            if (regions[idx(n)] == Region::enclosed || !std::ranges::all_of(mesh.corners(idx(n)), is_near) ||
                has_inner_wall_behind(mesh, target, walls, idx(n)))
                continue;
            regions[idx(n)] = Region::enclosed;
            queue.emplace_back(idx(n), begin);
        }
    }
}

// The region that each triangle bounds; if it bounds both, the outside.
std::vector<Region> find_triangle_regions(const WallMesh& mesh, const Neighbors& neighbors, const VoxelGrid& grid,
                                          Progress& progress) {
    std::vector<Region> regions(mesh.triangles.size(), Region::unknown);
    NearestTriangle nearest(mesh.vertices, mesh.triangles);
    size_t count = 0;
    grid.for_each_near_surface([&](const Point& center, Region region) {
        if (count++ % steps_between_polls == 0) progress.advance_by(0.01);
        Region& nearest_region = regions[idx(nearest(center).triangle)];
        if (nearest_region != Region::outside) nearest_region = region;
    });
    propagate(neighbors, regions);
    absorb_small_patches(mesh, neighbors, regions);
    absorb_visible_shells(mesh, neighbors, regions);
    return regions;
}

// Whether the work of voxelization is bounded: there may be many large triangles.
bool fits_grid(const WallMesh& mesh) {
    double count = mesh.area / (voxel * voxel);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = mesh.corners(t);
        count += std::max({length(b - a), length(c - b), length(a - c)}) / voxel;
    }
    return count <= max_triangle_voxels;
}

// For each of the caller's triangles: -1 if it is outer, else the nearest outer triangle. Empty if the others are no
// inner wall.
std::vector<int32_t> assign_inner_triangles(const WallMesh& mesh, const std::vector<Region>& regions, Progress& progress) {
    std::vector<Triangle> outer;
    std::vector<int32_t> outer_source;
    for (size_t t = 0; t < regions.size(); ++t)
        if (regions[t] == Region::outside) {
            outer.push_back(mesh.triangles[t]);
            outer_source.push_back(mesh.source[t]);
        }
    if (outer.empty()) return {};
    NearestTriangle nearest(mesh.vertices, outer);
    std::vector<int32_t> behind(regions.size(), -1);
    double inner_area = 0, close_area = 0;
    for (size_t t = 0; t < regions.size(); ++t) {
        if (regions[t] == Region::outside) continue;
        if (t % steps_between_polls == 0) progress.advance_by(0.01);
        const Near near = nearest(mesh.center(t));
        behind[idx(mesh.source[t])] = outer_source[idx(near.triangle)];
        inner_area += mesh.area_of(t);
        if (near.squared <= max_thickness * max_thickness) close_area += mesh.area_of(t);
    }
    if (inner_area < min_inner_area * (mesh.area - inner_area) || close_area < min_close_area * inner_area) return {};
    return behind;
}

}  // namespace

std::vector<int32_t> find_double_wall(std::span<const Point> vertices, std::span<const Triangle> triangles,
                                      Progress& progress) {
    const WallMesh mesh = to_wall_mesh(vertices, triangles);
    if (mesh.triangles.empty() || !fits_grid(mesh)) return {};
    const RayTarget target({mesh.vertices, mesh.triangles, {}, mesh.triangles.size()});
    std::vector<Segment> segments = find_cavity_segments(mesh, target, progress);
    if (segments.size() < min_enclosed_samples) return {};
    const VoxelGrid grid(mesh, progress);
    std::erase_if(segments, [&](const Segment& segment) { return grid.region_along(segment) == Region::outside; });
    if (segments.size() < min_enclosed_samples) return {};
    const Neighbors neighbors = find_neighbors(mesh);
    std::vector<Region> regions = find_triangle_regions(mesh, neighbors, grid, progress);
    std::vector<int32_t> inner_walls = assign_inner_triangles(mesh, regions, progress);
    if (inner_walls.empty()) return {};
    const std::vector<Region> without_leaks = regions;
    absorb_sides_of_leaks(mesh, target, neighbors, regions, progress);
    return regions == without_leaks ? inner_walls : assign_inner_triangles(mesh, regions, progress);
}

}  // namespace partwheel
