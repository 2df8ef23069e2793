// Each source face goes with the triangles of the surface used that are nearest to it.
#pragma once

#include "mesh/surface.h"

#include <cmath>
#include <memory>
#include <span>
#include <vector>

namespace partwheel {

// A source triangle is sampled in the middle of pieces that are at most this part of the bounding box's diagonal long
// and wide; larger ones where there would be so many more pieces than triangles.
inline constexpr double sample_spacing = 1.0 / 100, most_samples = 1e6;

// Less than this, relative to the diagonal, is not looked at more closely.
inline constexpr double near_enough = 1.0 / 200;

// What lies further from the surface used than this, relative to the diagonal, is hidden: inside
// the solid.
inline constexpr double hidden_beyond = 1.0 / 100;

// Vertices at one place, where parts only touch, are moved inwards by this share of their shortest edge.
inline constexpr double nudge = 1e-3;

struct Assignment {
    double outside = 0;  // how far the source reaches out of the solid, relative to the diagonal; 0 if near enough
    double hidden = 0;   // the share of the source's area that is
};

// Gives `surface`, which was made from `source`, its pieces, its deviation and its number of source faces.
Assignment assign_source_faces_by_distance(const Surface& source, Surface& surface, Progress& progress);

// The triangle of a surface that is nearest to a point, the square of its distance, and its point that is nearest.
struct Near {
    int32_t triangle = -1;
    double squared = HUGE_VAL;
    Point point{};
};

// Triangles, at least one, of which the nearest to a point can be asked for. What is asked for next is best near.
class NearestTriangle {
public:
    NearestTriangle(std::span<const Point> vertices, std::span<const Triangle> triangles);
    ~NearestTriangle();
    Near operator()(const Point& p);
    // Whether some triangle is at most so far from p: quicker than to find the nearest.
    bool within(const Point& p, double distance) const;
    // By the parity of crossings along a ray in a direction that no model is likely to be built along. Not exact: it is
    // asked of many samples, and only of those far from the surface.
    bool outside(const Point& p) const;

private:
    struct Boxes;
    std::unique_ptr<Boxes> boxes_;
};

// Of the bounding box of a surface in working coordinates, whose lower corner is the origin.
double diagonal(const Surface& source);

// "12,345"
std::string with_commas(size_t n);

// "12,345 faces are walls"
std::string counted_faces(size_t n, const char* one, const char* many);

// "0.12 %"
std::string percent(double share);

// A sentence for the account, of a distance relative to the diagonal.
std::string at_most_away(double distance);

}  // namespace partwheel
