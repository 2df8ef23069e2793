// Each source face goes with the triangles of the surface used that are nearest to it.
#include "attach.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace partwheel {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;  // distances are measured, nothing is decided by them
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::iterator>>>;

// Beyond so many samples of one mesh they stand further apart.
constexpr double most_samples = 1e6;

// A distance of less than this, relative to the diagonal, is none.
constexpr double rounding = 1e-12;

Kernel::Point_3 to_cgal(const Point& p) { return {p[0], p[1], p[2]}; }

double diagonal(const Surface& source) {
    Point high{};  // the lower corner is the origin of working coordinates
    for (const Point& p : source.vertices)
        for (size_t k = 0; k < 3; ++k) high[k] = std::max(high[k], p[k]);
    return length(high);
}

// By the parity of crossings along a ray in a direction that no model is likely to be built along. Not exact: it is
// asked of many samples, and only of those far from the surface.
bool is_outside(const Tree& tree, const Point& p) {
    const Kernel::Ray_3 ray(to_cgal(p), Kernel::Vector_3(0.5377, 0.3141, 0.7823));
    return tree.number_of_intersected_primitives(ray) % 2 == 0;
}

}  // namespace

Attached attach(const Surface& source, Surface& surface, Progress& progress) {
    Triangles triangles;
    for (const Triangle& t : surface.triangles) {
        const auto at = [&](size_t k) { return to_cgal(surface.vertices[static_cast<size_t>(t[k])]); };
        triangles.emplace_back(at(0), at(1), at(2));
    }
    Tree tree(triangles.begin(), triangles.end());
    tree.build();

    double area = 0;
    for (const Piece& piece : source.pieces) area += piece.area;
    const double size = diagonal(source);
    const double spacing = std::max(size * sample_spacing, std::sqrt(2 * area / most_samples));
    Tree::Point_and_primitive_id nearest(triangles[0].vertex(0), triangles.begin());
    double farthest = 0, outside = near_enough * size, distance = 0, hidden = 0;
    const auto find = [&](const Point& p) {
        nearest = tree.closest_point_and_primitive(to_cgal(p), nearest);
        distance = std::sqrt(CGAL::squared_distance(nearest.first, to_cgal(p)));
        farthest = std::max(farthest, distance);
        if (distance > outside && is_outside(tree, p)) outside = distance;
        return static_cast<int32_t>(nearest.second - triangles.begin());
    };

    const auto count = static_cast<double>(source.pieces.size());
    surface.pieces.clear();
    for (size_t s = 0; s < source.pieces.size(); ++s) {
        if (s % 256 == 0) progress.advance(0.9 + 0.1 * static_cast<double>(s) / count);
        const Triangle& t = source.triangles[s];
        const auto at = [&](size_t k) { return source.vertices[static_cast<size_t>(t[k])]; };
        const Point u = at(1) - at(0), v = at(2) - at(0);
        for (size_t k = 0; k < 3; ++k) find(at(k));
        // Cut into n^2 equal triangles, of which each is a piece.
        const double longest = std::max({length(u), length(v), length(u - v)});
        const auto n = static_cast<int>(std::max(1.0, std::ceil(longest / spacing)));
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < 2 * (n - i) - 1; ++j) {
                const double a = (i + (j % 2 == 0 ? 1.0 : 2.0) / 3) / n, b = (j / 2 + (j % 2 == 0 ? 1.0 : 2.0) / 3) / n;
                Point p = at(0);
                for (size_t k = 0; k < 3; ++k) p[k] += a * u[k] + b * v[k];
                surface.pieces.push_back({source.pieces[s].face, find(p), source.pieces[s].area / n / n});
                if (distance > hidden_beyond * size) hidden += surface.pieces.back().area;
            }
    }
    surface.face_count = source.face_count;
    surface.deviation = farthest < rounding * size ? 0 : farthest / size;
    return {outside > near_enough * size ? outside / size : 0, area > 0 ? hidden / area : 0};
}

std::string percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g %%", 100 * share);
    return text;
}

}  // namespace partwheel
