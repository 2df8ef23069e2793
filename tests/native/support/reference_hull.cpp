// Convex hulls and predicates by CGAL's exact kernels.
#include "support/reference_hull.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace partwheel::test {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using KernelPoint = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<KernelPoint>;

KernelPoint to_cgal(const Point& p) { return {p[0], p[1], p[2]}; }

// False if the points lie in one plane.
bool spatial(const std::vector<KernelPoint>& points) {
    const auto differs = [&](const KernelPoint& p) { return p != points[0]; };
    const auto b = std::find_if(points.begin(), points.end(), differs);
    if (b == points.end()) return false;
    const auto c = std::find_if(b, points.end(), [&](const auto& p) { return !CGAL::collinear(points[0], *b, p); });
    if (c == points.end()) return false;
    return std::any_of(c, points.end(), [&](const auto& p) { return !CGAL::coplanar(points[0], *b, *c, p); });
}

Mesh hull_mesh(const std::vector<KernelPoint>& points) {
    Mesh mesh;
    CGAL::convex_hull_3(points.begin(), points.end(), mesh);
    return mesh;
}

long double signed_volume6(const KernelPoint& o, const KernelPoint& a, const KernelPoint& b, const KernelPoint& c) {
    using Real = long double;
    const auto minus = [&](const KernelPoint& p) {
        return std::array<Real, 3>{Real(p.x()) - o.x(), Real(p.y()) - o.y(), Real(p.z()) - o.z()};
    };
    const auto u = minus(a), v = minus(b), w = minus(c);
    return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
           u[2] * (v[0] * w[1] - v[1] * w[0]);
}

// Calls visit(a, b, c) for the triangles of each face, outward.
template <typename Visit>
void for_each_triangle(const Mesh& mesh, Visit visit) {
    for (const auto face : mesh.faces()) {
        const auto first = mesh.halfedge(face);
        const auto apex = mesh.source(first);
        for (auto h = mesh.next(first); mesh.target(h) != apex; h = mesh.next(h))
            visit(apex, mesh.source(h), mesh.target(h));
    }
}

long double volume_of(const Mesh& mesh) {
    const KernelPoint& o = mesh.point(*mesh.vertices().begin());
    long double sum = 0;
    for_each_triangle(mesh, [&](auto a, auto b, auto c) {
        sum += signed_volume6(o, mesh.point(a), mesh.point(b), mesh.point(c));
    });
    return sum / 6;
}

// Whether a vertex of a hull is one of its corners: in the middle of an edge two planes meet, in that of a facet one.
bool is_extreme(const Mesh& mesh, Mesh::Vertex_index v) {
    std::vector<Mesh::Vertex_index> ring;
    for (const auto u : CGAL::vertices_around_target(v, mesh)) ring.push_back(u);
    const KernelPoint& p = mesh.point(v);
    std::vector<std::array<KernelPoint, 2>> planes;  // each by two points beside p
    for (size_t i = 0; i < ring.size(); ++i) {
        const KernelPoint &a = mesh.point(ring[i]), &b = mesh.point(ring[(i + 1) % ring.size()]);
        if (std::none_of(planes.begin(), planes.end(), [&](const auto& plane) {
                return CGAL::coplanar(p, plane[0], plane[1], a) && CGAL::coplanar(p, plane[0], plane[1], b);
            }))
            planes.push_back({a, b});
    }
    return planes.size() >= 3;
}

}  // namespace

ReferenceHull reference_hull(std::span<const Point> points) {
    std::vector<KernelPoint> all;
    std::map<std::array<double, 3>, int32_t> number;
    for (size_t i = 0; i < points.size(); ++i) {
        all.push_back(to_cgal(points[i]));
        number.try_emplace(points[i], static_cast<int32_t>(i));
    }
    ReferenceHull hull;
    if (all.empty() || !spatial(all)) return hull;
    hull.flat = false;
    const Mesh mesh = hull_mesh(all);
    hull.volume = volume_of(mesh);
    const auto index = [&](auto v) {
        const KernelPoint& p = mesh.point(v);
        return number.at({p.x(), p.y(), p.z()});
    };
    for (const auto v : mesh.vertices())
        if (is_extreme(mesh, v)) hull.extreme.push_back(index(v));
    std::sort(hull.extreme.begin(), hull.extreme.end());
    for_each_triangle(mesh, [&](auto a, auto b, auto c) { hull.facets.push_back({index(a), index(b), index(c)}); });
    return hull;
}

long double reference_hull_volume(std::span<const Point> points) {
    std::vector<KernelPoint> all;
    all.reserve(points.size());
    for (const Point& p : points) all.push_back(to_cgal(p));
    if (all.empty() || !spatial(all)) return 0;
    return volume_of(hull_mesh(all));
}

int reference_orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
    using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;
    const auto exact = [](const Point& p) { return Exact::Point_3(p[0], p[1], p[2]); };
    return CGAL::orientation(exact(a), exact(b), exact(c), exact(d));
}

bool reference_collinear(const Point& a, const Point& b, const Point& c) {
    return CGAL::collinear(to_cgal(a), to_cgal(b), to_cgal(c));
}

bool reference_self_intersects(const TriMesh& mesh) {
    std::vector<KernelPoint> points;
    for (const Point& p : mesh.vertices) points.push_back(to_cgal(p));
    Mesh surface;
    for (const KernelPoint& p : points) surface.add_vertex(p);
    using Index = Mesh::Vertex_index;
    for (const Triangle& t : mesh.triangles)
        if (surface.add_face(Index(t[0]), Index(t[1]), Index(t[2])) == Mesh::null_face())
            throw std::logic_error("self-intersection asked of a surface that isn't manifold");
    return CGAL::Polygon_mesh_processing::does_self_intersect(surface);
}

}  // namespace partwheel::test
