// What tests/core asks CGAL: where triangles meet that share no corner there. Not part of the product.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Corners = std::array<int32_t, 3>;

// Whether two triangles have more in common than the corners and edges that they share by number.
bool cross(const std::vector<Point>& points, const Corners& a, const Corners& b) {
    const auto at = [&](int32_t v) -> const Point& { return points[static_cast<size_t>(v)]; };
    std::array<size_t, 3> in_a{}, in_b{};
    size_t shared = 0;
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < 3; ++j)
            if (a[i] == b[j]) {
                in_a[shared] = i;
                in_b[shared++] = j;
            }
    const auto triangle = [&](const Corners& t) { return Kernel::Triangle_3(at(t[0]), at(t[1]), at(t[2])); };
    const auto opposite = [&](const Corners& t, size_t k) {
        return Kernel::Segment_3(at(t[(k + 1) % 3]), at(t[(k + 2) % 3]));
    };
    if (shared == 0) return CGAL::do_intersect(triangle(a), triangle(b));
    if (shared == 1)
        return CGAL::do_intersect(opposite(a, in_a[0]), triangle(b)) ||
               CGAL::do_intersect(opposite(b, in_b[0]), triangle(a));
    if (shared == 3) return true;
    const Point &p = at(a[in_a[0]]), &q = at(a[in_a[1]]);
    const Point &r = at(a[3 - in_a[0] - in_a[1]]), &s = at(b[3 - in_b[0] - in_b[1]]);
    return CGAL::coplanar(p, q, r, s) && CGAL::coplanar_orientation(p, q, r, s) == CGAL::POSITIVE;
}

}  // namespace

// vertices (n,3), triangles (m,3), none of them without area. How many pairs of triangles cross or touch where they
// share no vertex by number.
extern "C" __attribute__((visibility("default"))) size_t crossings(const double* vertices, size_t n,
                                                                   const int32_t* triangles, size_t m) {
    using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, size_t>;
    std::vector<Point> points;
    for (size_t i = 0; i < n; ++i) points.emplace_back(vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]);
    std::vector<Corners> corners(m);
    std::vector<Box> boxes;
    for (size_t t = 0; t < m; ++t) {
        corners[t] = {triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]};
        CGAL::Bbox_3 box;
        for (const int32_t v : corners[t]) box += points[static_cast<size_t>(v)].bbox();
        boxes.emplace_back(box, t);
    }
    size_t count = 0;
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
        count += cross(points, corners[a.info()], corners[b.info()]);
    });
    return count;
}
