// The area distortion and the outline of a conformal map of a disk to the plane, without computing the map.
#pragma once

#include "base/progress.h"
#include "edit/patch.h"

namespace partwheel {

// The conformal map that keeps the length of the boundary, which minimizes area distortion (Springborn, Schroeder,
// Pinkall 2008). Its scale factor e^u follows from the curvature: L u = -K, with cotangent weights L and angle defects
// K, and u = 0 on the boundary.
class ConformalMap {
public:
    // guess: u at each corner of the mesh. The patch must outlive the map.
    ConformalMap(const Patch& patch, std::span<const double> guess, Progress& progress = unobserved_progress());

    // u, at each vertex of the patch: negative on bulges, positive on saddles.
    const std::vector<double>& log_scale() const { return log_scale_; }
    // The same at each corner of the mesh.
    std::vector<double> corner_log_scale() const;

    double area_distortion() const;  // see partwheel::area_distortion()

    // The vertices where |u|, smoothed, is largest. Each is farther from the other ones than from the boundary.
    // boundary_distance: of each vertex.
    std::vector<int32_t> peaks(std::span<const double> boundary_distance, size_t max_count) const;

    // The fraction of the area inside the outline that the map covers more than once.
    double overlap_fraction() const;

private:
    const Patch& patch_;
    std::vector<double> log_scale_;
    std::vector<double> turning_angle_;  // of each vertex; at the boundary the angle by which the outline turns there
};

// The area-weighted mean of max(f, 1/f), with f the factor by which each triangle's area is scaled, relative to the
// mean factor, and max_factor at most; 1 if there is no distortion.
double area_distortion(const SeamMesh& mesh, std::span<const double> factors, double max_factor = 1e9);

// The fraction of the inside of a closed polygon where its winding number exceeds 1 in size, by the pixels of a grid.
double overlap_fraction(std::span<const std::array<double, 2>> outline);

}  // namespace partwheel
