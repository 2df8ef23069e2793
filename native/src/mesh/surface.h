// A surface in a canonical order, and the checks: closed, manifold, oriented, free of self-intersection.
#pragma once

#include "base/geometry.h"
#include "base/progress.h"

namespace partwheel {

// The caller's arrays, see pw_build.
struct MeshView {
    std::span<const Point> vertices;
    std::span<const Triangle> triangles;
    std::span<const int32_t> faces;  // the source face of each triangle; empty: triangle i is face i
    size_t face_count = 0;
    bool is_part = false;  // of a larger mesh, so that some faces have no triangle here
};

// Working coordinates are (x - origin) / scale. The origin is the lower corner of the bounding box, and the scale is
// the power of two for which the longest side of the box is in [1, 2). So working coordinates don't depend on the
// model's position and, apart from rounding of the input, on its unit.
struct Frame {
    Point origin{};
    double longest = 1;  // the longest side of the bounding box
    double scale = 1;    // 0 if `longest` is 0

    static Frame around(std::span<const Point> points);

    Point to_working(const Point& p) const;
    std::vector<Point> to_working(std::span<const Point> points) const;
    Point in_cube(const Point& p) const;  // relative to a cube of side `longest` at the origin: 0 to 1
    Point to_caller(const Point& p) const;
    double volume_to_caller(double v) const { return v * scale * scale * scale; }
    double area_to_caller(double a) const { return a * scale * scale; }
};

// A piece of a source face, and the triangle of the surface that it belongs to.
struct FaceSample {
    int32_t face = 0;
    int32_t triangle = 0;
    double area = 0;            // in working coordinates
    bool is_unchanged = false;  // the triangle is the face's own, in a surface that differs elsewhere

    // What the sample counts in the choice of the triangle's face. Other faces belong to an unchanged triangle only because
    // they are hidden behind it.
    double weight() const { return is_unchanged ? 1e6 * area : area; }

    auto operator<=>(const FaceSample&) const = default;
};

// How many source faces were not used as they are.
struct FaceCounts {
    size_t duplicates = 0;  // counted once
    size_t walls = 0;       // between two regions of the solid
    size_t left_out = 0;    // of the solid, because they enclose nothing

    FaceCounts& operator+=(const FaceCounts& other) {
        duplicates += other.duplicates;
        walls += other.walls;
        left_out += other.left_out;
        return *this;
    }
};

// A surface in canonical order, so that no result depends on the order of the caller's arrays, and what is near in
// space is mostly near in memory. Vertices are sorted along a space-filling curve, coincident ones in the caller's
// order. Each triangle starts with its lowest vertex, and triangles are sorted. If the surface encloses a negative
// volume, its triangles are reversed.
struct Surface {
    Frame frame;
    std::vector<Point> vertices;         // working coordinates of the vertices in use
    std::vector<int32_t> source_vertex;  // the caller's index of each; -1: an added vertex
    std::vector<Triangle> triangles;
    std::vector<FaceSample> samples;  // at least one of every source face; if the surface is exact, samples[t] is triangle t
    size_t face_count = 0;      // the caller's
    // For each source face without samples (a duplicate, or left out) the one that it goes with; itself for the others.
    // Empty: all have samples.
    std::vector<int32_t> original;

    // How it was made from the caller's mesh: see pw_summary and pw_hierarchy_notes.
    pw_fill_method fill_method = PW_FILL_EXACT;
    size_t proxy_triangles = 0;  // of the decimated proxy mesh; 0: the mesh was not decimated
    double deviation = 0;
    FaceCounts face_counts;
    std::string notes;
};

// Throws an Error if there are no faces, an index is out of range, or a coordinate is not finite or too large. The API
// has checked the sizes.
void check_arrays(const MeshView& mesh);

// Throws an Error if a source face has no triangles, unless the mesh is a part of another.
void check_all_faces_used(const MeshView& mesh);

// The caller's arrays in canonical order; the surface may be defective. Throws an Error if check_arrays() does, or if
// all vertices coincide.
Surface read_mesh(const MeshView& mesh);

// A surface in canonical order, from the working coordinates of vertices, which are all in use, the caller's index of
// each (or -1), and triangles. Triangle t of the input is face t.
Surface canonical(const Frame& frame, std::span<const Point> vertices, std::span<const int32_t> source_vertex,
                  std::span<const Triangle> triangles);

// The same of those vertices that `used` lists, in its order.
Surface canonical(const Frame& frame, std::span<const Point> vertices, std::span<const int32_t> source_vertex,
                  std::vector<Triangle> triangles, std::span<const int32_t> used);

// The vertices that triangles use, in the order in which they first do.
std::vector<int32_t> in_order_of_use(size_t vertices, std::span<const Triangle> triangles);

// Checks what the exact fill method requires (see pw_build), in the order of pw_status. Throws an Error for the first
// defect.
void check_surface(const Surface& surface, Progress& progress);

// The status of the Error that check_surface() throws, or PW_OK. Throws if canceled.
pw_status surface_status(const Surface& surface, Progress& progress);

// Whether two triangles intersect anywhere but in shared corners and edges.
bool crosses_itself(const Surface& surface, Progress& progress);

}  // namespace partwheel
