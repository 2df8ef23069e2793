// What tests/core and scripts/bench_index ask CGAL: each point, ray and place against every tetrahedron and triangle, no tree.
// Not part of the product.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#define SHOWN extern "C" __attribute__((visibility("default")))

namespace {

using Exact = CGAL::Exact_predicates_inexact_constructions_kernel;
using Rounded = CGAL::Simple_cartesian<double>;

template <class Kernel>
std::vector<typename Kernel::Point_3> points_of(const double* numbers, size_t n) {
    std::vector<typename Kernel::Point_3> points;
    for (size_t i = 0; i < n; ++i) points.emplace_back(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
    return points;
}

struct Bodies {
    std::vector<std::array<Exact::Point_3, 4>> corners;
    std::vector<CGAL::Bbox_3> boxes;

    Bodies(const std::vector<Exact::Point_3>& points, const int32_t* tetrahedra, size_t n) {
        for (size_t t = 0; t < n; ++t) {
            const auto corner = [&](size_t k) { return points[static_cast<size_t>(tetrahedra[4 * t + k])]; };
            corners.push_back({corner(0), corner(1), corner(2), corner(3)});
            boxes.push_back(corner(0).bbox() + corner(1).bbox() + corner(2).bbox() + corner(3).bbox());
        }
    }

    int32_t locate(const Exact::Point_3& p) const {
        for (size_t t = 0; t < corners.size(); ++t) {
            if (!CGAL::do_overlap(boxes[t], p.bbox())) continue;
            const auto& [a, b, c, d] = corners[t];
            const int all = CGAL::orientation(a, b, c, d);
            if (all == 0) continue;
            const auto same = [&](const Exact::Point_3& u, const Exact::Point_3& v, const Exact::Point_3& w,
                                  const Exact::Point_3& x) { return CGAL::orientation(u, v, w, x) * all >= 0; };
            if (same(p, b, c, d) && same(a, p, c, d) && same(a, b, p, d) && same(a, b, c, p)) return static_cast<int32_t>(t);
        }
        return -1;
    }
};

}  // namespace

// vertices (v,3), tetrahedra (t,4), points (n,3) -> parts (n,): the lowest that holds each, -1 if none.
SHOWN void every_holding(const double* vertices, size_t v, const int32_t* tetrahedra, size_t t, const double* points, size_t n,
                         int32_t* parts) {
    const Bodies bodies(points_of<Exact>(vertices, v), tetrahedra, t);
    const auto given = points_of<Exact>(points, n);
    for (size_t i = 0; i < n; ++i) parts[i] = bodies.locate(given[i]);
}

// corners (t,3,3) of triangles -> the distance to the first hit, infinity if none, and its triangle: Moeller's test in long
// doubles.
SHOWN void every_hit(const double* corners, size_t t, const double* origins, const double* directions, size_t n,
                     int32_t* triangles, double* distances) {
    using Long = std::array<long double, 3>;
    const auto minus = [](const Long& a, const Long& b) { return Long{a[0] - b[0], a[1] - b[1], a[2] - b[2]}; };
    const auto dot = [](const Long& a, const Long& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    const auto cross = [](const Long& a, const Long& b) {
        return Long{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    std::vector<std::array<Long, 3>> given;
    for (size_t i = 0; i < t; ++i) {
        const double* p = corners + 9 * i;
        const Long a{p[0], p[1], p[2]};
        given.push_back({a, minus({p[3], p[4], p[5]}, a), minus({p[6], p[7], p[8]}, a)});
    }
    for (size_t r = 0; r < n; ++r) {
        const double *from = origins + 3 * r, *along = directions + 3 * r;
        const Long origin{from[0], from[1], from[2]}, way{along[0], along[1], along[2]};
        distances[r] = std::numeric_limits<double>::infinity();
        triangles[r] = -1;
        for (size_t i = 0; i < t; ++i) {
            const auto& [a, u, v] = given[i];
            const Long p = cross(way, v);
            const long double det = dot(u, p);
            if (det == 0) continue;
            const Long s = minus(origin, a), q = cross(s, u);
            const long double x = dot(s, p) / det, y = dot(way, q) / det, far = dot(v, q) / det;
            if (x < 0 || y < 0 || x + y > 1 || far < 0 || !(static_cast<double>(far) < distances[r])) continue;
            distances[r] = static_cast<double>(far);
            triangles[r] = static_cast<int32_t>(i);
        }
    }
}

// The distance from each point to the nearest of the triangles.
SHOWN void every_distance(const double* corners, size_t t, const double* points, size_t n, double* distances) {
    const auto corner = points_of<Rounded>(corners, 3 * t);
    std::vector<Rounded::Triangle_3> triangles;
    for (size_t i = 0; i < t; ++i) triangles.emplace_back(corner[3 * i], corner[3 * i + 1], corner[3 * i + 2]);
    const auto given = points_of<Rounded>(points, n);
    for (size_t i = 0; i < n; ++i) {
        double least = std::numeric_limits<double>::infinity();
        for (const auto& triangle : triangles) least = std::min(least, CGAL::squared_distance(given[i], triangle));
        distances[i] = std::sqrt(least);
    }
}

// Two solids, each of vertices, tetrahedra and the triangles around them; matrices (n,3,4) of the second -> touch (n,): whether
// any triangles meet or any vertex is inside the other.
SHOWN void every_touch(const double* vertices, size_t v, const int32_t* tetrahedra, size_t t, const int32_t* triangles, size_t f,
                       const double* others, size_t w, const int32_t* other_tetrahedra, size_t u,
                       const int32_t* other_triangles, size_t g, const double* matrices, size_t n, uint8_t* touch) {
    struct Facet {
        Exact::Triangle_3 triangle;
        CGAL::Bbox_3 box;
    };
    const auto facets = [](const std::vector<Exact::Point_3>& points, const int32_t* corners, size_t count) {
        std::vector<Facet> made;
        for (size_t i = 0; i < count; ++i) {
            const auto corner = [&](size_t k) { return points[static_cast<size_t>(corners[3 * i + k])]; };
            const Exact::Triangle_3 triangle(corner(0), corner(1), corner(2));
            made.push_back({triangle, triangle.bbox()});
        }
        return made;
    };
    const auto points = points_of<Exact>(vertices, v);
    const Bodies bodies(points, tetrahedra, t);
    const auto surface = facets(points, triangles, f);
    CGAL::Bbox_3 all;
    for (const Facet& facet : surface) all += facet.box;
    for (size_t i = 0; i < n; ++i) {
        const double* m = matrices + 12 * i;
        std::vector<Exact::Point_3> moved;
        for (size_t j = 0; j < w; ++j) {
            const double *p = others + 3 * j, *q = m + 4, *r = m + 8;
            moved.emplace_back(m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3], q[0] * p[0] + q[1] * p[1] + q[2] * p[2] + q[3],
                               r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3]);
        }
        const auto other_surface = facets(moved, other_triangles, g);
        touch[i] = std::any_of(other_surface.begin(), other_surface.end(), [&](const Facet& b) {
            return CGAL::do_overlap(all, b.box) && std::any_of(surface.begin(), surface.end(), [&](const Facet& a) {
                return CGAL::do_overlap(a.box, b.box) && CGAL::do_intersect(a.triangle, b.triangle);
            });
        });
        if (touch[i]) continue;
        const auto inside = [](const Bodies& in, const std::vector<Exact::Point_3>& which) {
            return std::any_of(which.begin(), which.end(), [&](const auto& p) { return in.locate(p) >= 0; });
        };
        touch[i] = inside(bodies, moved) || inside(Bodies(moved, other_tetrahedra, u), points);
    }
}
