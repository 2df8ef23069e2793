// A hierarchy of boxes around groups of triangles along a space-filling curve.
#include "mesh/rays.h"

#include "base/morton.h"

namespace partwheel {

namespace {

constexpr size_t group_size = 8;
constexpr int cell_bits = morton_bits - 1;  // so that the far corner of the bounding box is inside the grid

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
    std::vector<Box> boxes((triangles_.size() + group_size - 1) / group_size);
    for (size_t t = 0; t < triangles_.size(); ++t)
        for (const int32_t v : triangles_[t]) boxes[t / group_size].add(vertices_[idx(v)]);
    groups_ = Bvh(boxes);
}

RayHit RayTarget::first_hit(const Point& origin, const Point& direction, double min_distance) const {
    const Ray ray(origin, direction);
    RayHit best{-1, std::numeric_limits<double>::infinity()};
    const auto may_hit = [&](const Box& box) { return ray.may_hit(box, min_distance, best.distance); };
    groups_.any_of(may_hit, [&](size_t group) {
        for (size_t t = group * group_size; t < std::min((group + 1) * group_size, triangles_.size()); ++t) {
            const auto& [a, b, c] = triangles_[t];
            const double distance = ray.intersect(vertices_[idx(a)], vertices_[idx(b)], vertices_[idx(c)]);
            if (distance > min_distance &&
                std::pair(distance, triangle_ids_[t]) < std::pair(best.distance, best.triangle))
                best = {triangle_ids_[t], distance};
        }
        return false;
    });
    return best.triangle < 0 ? RayHit{} : best;
}

}  // namespace partwheel
