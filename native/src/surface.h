// The input triangles, checked: closed, manifold, oriented, free of self-intersection; in a canonical order.
#pragma once

#include "geometry.h"
#include "progress.h"

#include <cstddef>
#include <span>
#include <vector>

namespace partwheel {

// The caller's arrays, as pw_build documents them.
struct MeshView {
    const double* vertices = nullptr;
    size_t vertex_count = 0;
    const int32_t* triangles = nullptr;
    size_t triangle_count = 0;
    const int32_t* faces = nullptr;  // null: triangle i is face i
    size_t face_count = 0;
};

// How working coordinates come from the caller's: (x - origin) / scale. The origin is the lower corner of the bounding
// box and the scale a power of two, so that the longest side of the box is in [1, 2): the same numbers wherever the
// model stands and, but for input rounding, whatever its unit.
struct Frame {
    Point origin{};
    double longest = 1;  // side of the bounding box
    double scale = 1;    // 0 if longest is

    static Frame around(std::span<const Point> points);

    Point to_working(const Point& p) const;
    Point to_caller(const Point& p) const;
    double volume_to_caller(double v) const { return v * scale * scale * scale; }
    double area_to_caller(double a) const { return a * scale * scale; }
};

// Vertices are sorted by x, y, z; each triangle starts with its lowest vertex, and triangles are sorted: so nothing
// downstream depends on the order of the caller's arrays. A surface that encloses a negative volume has been turned.
struct Surface {
    Frame frame;
    std::vector<Point> vertices;         // working coordinates of the vertices in use
    std::vector<int32_t> source_vertex;  // the caller's index of each
    std::vector<Triangle> triangles;
    std::vector<int32_t> source_face;  // the caller's face of each triangle
    size_t face_count = 0;
};

// Checks what pw_build documents, in the order of pw_status; throws an Error that names the first thing that fails.
Surface check_surface(const MeshView& mesh, Progress& progress);

}  // namespace partwheel
