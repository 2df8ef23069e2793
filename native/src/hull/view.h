// The facets of a hull as planes, and the side of them that a point is on.
#pragma once

#include "base/predicates.h"
#include "hull/hull.h"
#include "hull/vectors.h"

namespace partwheel {

// Up to this many facets, a set of facets is a 64-bit mask.
inline constexpr size_t max_bitset_facets = 64;

// A hull with at most so many facets is searched through, or all facets of a plane are replaced, where the fast way
// fails.
inline constexpr size_t max_searched_facets = 4096;

// |error of a side| <= size * radius * side_error, where radius bounds the coordinates of the point and of the hull's
// vertices relative to the origin: 4 roundings in a normal, 2 in the two differences with the origin, 3 in each dot
// product, all of these twice because point and vertex differ by up to 2 radius, and 2 in the last subtraction.
inline constexpr double side_error = 24 * 0x1p-53;

inline constexpr size_t plane_values = 5;

inline double radius_of(const Point& p) { return std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])}); }

// The facets of a stored or loaded hull with their planes. For a point p relative to the hull's origin,
// x px + y py + z pz - offset is six times the signed volume of the tetrahedron (facet, p).
struct FacetsView {
    const double *x, *y, *z, *offset;
    const double* size;  // the sums of the absolute products in the normals x, y, z
    const HullFacet* facets;
    size_t count;
    Point origin;
    double radius;
    bool origin_is_inside;

    double side(size_t f, const Point& p) const { return x[f] * p[0] + y[f] * p[1] + z[f] * p[2] - offset[f]; }
    Double2 sides(size_t f, const Point& p) const {
        return vector_at<Double2>(x + f) * p[0] + vector_at<Double2>(y + f) * p[1] + vector_at<Double2>(z + f) * p[2] -
               vector_at<Double2>(offset + f);
    }
    // |error of a side| <= size * error_factor.
    double error_factor(const Point& p) const { return side_error * std::max(radius, radius_of(p)); }
};

inline FacetsView HullKernel::view(const Hull& hull) {
    Hull::Block& b = *hull.block_;
    const size_t n = b.facet_count;
    const double* p = b.planes();
    return {p, p + n, p + 2 * n, p + 3 * n, p + 4 * n, b.facets(), n, b.origin, b.radius, b.origin_is_inside};
}

inline FacetsView HullKernel::view() const {
    return {x_.data(),    y_.data(),      z_.data(), offset_.data(), size_.data(),
            facets_.data(), count_, origin_, radius_, origin_is_inside_};
}

// 1 if the vertex is outside the facet, 0 if in its plane, -1 if inside.
inline int HullKernel::exact_side(const FacetsView& h, size_t f, int32_t vertex) const {
    const Triangle& t = h.facets[f].corners;
    return orientation(at(t[0]), at(t[1]), at(t[2]), at(vertex));
}

// The side of the plane through the origin and a facet's edge, which runs as in the facet: 1 if the vertex is on the
// facet's. The origin must be inside.
inline int HullKernel::side_of_edge(const FacetsView& h, int32_t from, int32_t to, int32_t vertex) const {
    return orientation(at(from), at(to), h.origin, at(vertex));
}

}  // namespace partwheel
