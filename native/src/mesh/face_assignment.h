// Assigns each source face to the nearest triangles of another surface.
#pragma once

#include "mesh/surface.h"

namespace partwheel {

// Source triangles are divided into pieces of at most this length and width, relative to the bounding box's diagonal,
// larger if there would be more than max_samples more pieces than triangles. A sample is the middle of a piece.
inline constexpr double sample_spacing = 1.0 / 100, max_samples = 1e6;

// A distance of less than this, relative to the diagonal, is close enough.
inline constexpr double near_enough = 1.0 / 200;

// Samples farther from the surface than this, relative to the diagonal, are hidden inside
// the solid.
inline constexpr double hidden_beyond = 1.0 / 100;

// Coincident vertices, where parts only touch, are moved inward by this share of their shortest edge.
inline constexpr double inward_shift = 1e-3;

struct Assignment {
    double outside = 0;  // the distance of the farthest sample outside the solid, relative to the diagonal; 0 if near_enough
    double hidden = 0;   // the hidden share of the source's area
};

// Sets the samples, the deviation and the number of source faces of `surface`, which was made from `source`.
Assignment assign_source_faces_by_distance(const Surface& source, Surface& surface, Progress& progress);

// The diagonal of the bounding box of a surface in working coordinates (its lower corner is the origin).
double diagonal(const Surface& source);

// "12,345"
std::string with_commas(size_t n);

// "12,345 faces are walls"
std::string counted_faces(size_t n, const char* one, const char* many);

// "0.12 %"
std::string percent(double share);

// "The surface used is at most 0.12 % of the model's size away", for a distance relative to the diagonal.
std::string at_most_away(double distance);

}  // namespace partwheel
