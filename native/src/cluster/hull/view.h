// The facets of a hull as planes, and on which side of them a point is.
#pragma once

#include "base/predicates.h"
#include "cluster/hull/hull.h"
#include "cluster/hull/vectors.h"

#include <cmath>

namespace partwheel {

// So many facets at most are a set of bits.
inline constexpr size_t set_bits = 64;

// A side is wrong by at most size * reach * this, where reach bounds the coordinates of the point and of the hull's
// vertices relative to the origin: 4 roundings in a normal, 2 in the two differences with the origin, 3 in each dot
// product, all of these twice as the difference of point and vertex is up to 2 reach, and 2 in the last subtraction.
inline constexpr double side_error = 24 * 0x1p-53;

inline constexpr size_t plane_numbers = 5;

inline double reach_of(const Point& p) { return std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])}); }

// A hull's facets, at rest or at work, with their planes: of a point p relative to the hull's origin,
// x px + y py + z pz - offset is six times the volume of facet and p.
struct FacetsView {
    const double *x, *y, *z, *offset;
    const double* size;  // the sums of the absolute products in the normals x, y, z
    const HullFacet* facets;
    size_t count;
    Point origin;
    double reach;
    bool centred;

    double side(size_t f, const Point& p) const { return x[f] * p[0] + y[f] * p[1] + z[f] * p[2] - offset[f]; }
    Two sides(size_t f, const Point& p) const {
        return vector_at<Two>(x + f) * p[0] + vector_at<Two>(y + f) * p[1] + vector_at<Two>(z + f) * p[2] -
               vector_at<Two>(offset + f);
    }
    // A facet's size times this bounds the error of a side.
    double error_factor(const Point& p) const { return side_error * std::max(reach, reach_of(p)); }
};

inline FacetsView HullKernel::view(const Hull& hull) {
    Hull::Block& b = *hull.block_;
    const size_t n = b.facet_count;
    const double* p = b.planes();
    return {p, p + n, p + 2 * n, p + 3 * n, p + 4 * n, b.facets(), n, b.origin, b.reach, b.centred};
}

inline FacetsView HullKernel::view() const {
    return {x_.data(),    y_.data(),      z_.data(), offset_.data(), size_.data(),
            facets_.data(), count_, origin_, reach_, centred_};
}

// 1: the vertex is outside the facet, 0: in its plane.
inline int HullKernel::exact_side(const FacetsView& h, size_t f, int32_t vertex) const {
    const Triangle& t = h.facets[f].corners;
    return orientation(at(t[0]), at(t[1]), at(t[2]), at(vertex));
}

}  // namespace partwheel
