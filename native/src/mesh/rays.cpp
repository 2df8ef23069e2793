// A tree of boxes around groups of triangles along a space-filling curve.
#include "mesh/rays.h"

#include "base/morton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace partwheel {

namespace {

constexpr size_t group_size = 16;
constexpr int cell_bits = morton_bits - 1;  // so that the far corner of the bounding box is inside the grid

// Relative error by which rounding may put a box's entry behind its exit.
constexpr double rounding = 1e-12;

}  // namespace

RayTarget::RayTarget(const MeshView& mesh, Progress& progress) {
    if (mesh.triangles.empty()) return;
    check_arrays(mesh);
    progress.reach(0.1);
    vertices_.assign(mesh.vertices.begin(), mesh.vertices.end());
    const Frame frame = Frame::around(vertices_);
    std::vector<uint64_t> order;  // the upper 32 bits of the Morton code, then the triangle
    order.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles)
        order.push_back(morton_code_in_unit_cube(frame.in_cube(vertices_[idx(t[0])]), cell_bits) >> 31 << 32 |
                        order.size());
    progress.reach(0.3);
    std::sort(order.begin(), order.end());
    progress.reach(0.6);
    for (const uint64_t place : order) {
        triangle_ids_.push_back(static_cast<int32_t>(place & 0xffffffff));
        triangles_.push_back(mesh.triangles[triangle_ids_.back()]);
    }
    progress.reach(0.8);
    const auto add_level = [&](size_t count, const auto& extend) {
        std::vector<Box> boxes((count + group_size - 1) / group_size);
        for (size_t i = 0; i < count; ++i) extend(boxes[i / group_size], i);
        levels_.push_back(std::move(boxes));
    };
    add_level(triangles_.size(), [&](Box& box, size_t t) {
        for (const int32_t v : triangles_[t]) box.add(vertices_[idx(v)]);
    });
    while (levels_.back().size() > 1) {
        const std::vector<Box> below = levels_.back();
        add_level(below.size(), [&](Box& box, size_t b) { box.add(below[b].low), box.add(below[b].high); });
    }
}

RayHit RayTarget::first_hit(const Point& origin, const Point& direction, double beyond) const {
    RayHit best{-1, std::numeric_limits<double>::infinity()};
    if (!levels_.empty()) search({origin, direction}, beyond, levels_.size() - 1, 0, best);
    return best.triangle < 0 ? RayHit{} : best;
}

void RayTarget::search(const Ray& ray, double beyond, size_t level, size_t index, RayHit& best) const {
    const Box& box = levels_[level][index];
    double near = beyond, far = best.distance;
    for (size_t k = 0; k < 3; ++k) {
        double enter = (box.low[k] - ray.origin[k]) / ray.direction[k];
        double leave = (box.high[k] - ray.origin[k]) / ray.direction[k];
        if (enter > leave) std::swap(enter, leave);
        if (enter > near) near = enter;  // false for NaN, of a ray along a side of the box
        if (leave < far) far = leave;
    }
    if (near > far + rounding * std::fabs(far)) return;

    const size_t begin = index * group_size;
    if (level > 0) {
        const size_t end = std::min(begin + group_size, levels_[level - 1].size());
        for (size_t i = begin; i < end; ++i) search(ray, beyond, level - 1, i, best);
        return;
    }
    for (size_t t = begin; t < std::min(begin + group_size, triangles_.size()); ++t) {
        const auto& [a, b, c] = triangles_[t];
        const double distance = ray.intersect(vertices_[idx(a)], vertices_[idx(b)], vertices_[idx(c)]);
        if (distance > beyond && std::pair(distance, triangle_ids_[t]) < std::pair(best.distance, best.triangle))
            best = {triangle_ids_[t], distance};
    }
}

}  // namespace partwheel
