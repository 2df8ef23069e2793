// A surface in a canonical order, and the checks: closed, manifold, oriented, free of self-intersection.
#pragma once

#include "base/geometry.h"
#include "base/progress.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace partwheel {

// The caller's arrays, as pw_build documents them.
struct MeshView {
    std::span<const Point> vertices;
    std::span<const Triangle> triangles;
    std::span<const int32_t> faces;  // of the triangles; none: triangle i is face i
    size_t face_count = 0;
    bool is_part = false;  // of a larger mesh: some faces have no triangle here
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
    Point in_cube(const Point& p) const;  // of that side, from the origin: 0 to 1
    Point to_caller(const Point& p) const;
    double volume_to_caller(double v) const { return v * scale * scale * scale; }
    double area_to_caller(double a) const { return a * scale * scale; }
};

// A part of a source face, and the triangle of the surface used that it goes with.
struct Piece {
    int32_t face = 0;
    int32_t triangle = 0;
    double area = 0;  // working

    auto operator<=>(const Piece&) const = default;
};

// Vertices are sorted along a space-filling curve, those at the same point as the caller had them; each triangle starts
// with its lowest vertex, and triangles are sorted: so nothing downstream depends on the order of the caller's arrays,
// and what is near in space is mostly near in memory. A surface that encloses a negative volume has been turned.
struct Surface {
    Frame frame;
    std::vector<Point> vertices;         // working coordinates of the vertices in use
    std::vector<int32_t> source_vertex;  // the caller's index of each; -1: not a vertex of the caller's
    std::vector<Triangle> triangles;
    std::vector<Piece> pieces;  // of every source face at least one; pieces[t] of triangle t where the surface is exact
    size_t face_count = 0;      // the caller's
    // Of each source face the one that it is a duplicate of, which alone has pieces, or itself. Empty: there is none.
    std::vector<int32_t> original;

    // How it came from the caller's mesh: see pw_summary and pw_hierarchy_notes.
    pw_fill_method fill_method = PW_FILL_EXACT;
    size_t proxy_triangles = 0;  // of the coarser copy that it is of; 0: of the mesh itself
    double deviation = 0;
    std::string account;
};

// Throws an Error where the caller's arrays are no mesh: no faces, an index or a coordinate that can't be. The API has
// seen to it that there are not too many.
void check_arrays(const MeshView& mesh);

// Throws an Error for a source face without triangles, unless the mesh is a part of another.
void check_all_faces_used(const MeshView& mesh);

// The caller's arrays in canonical order, good or bad. Throws an Error where they aren't a mesh with an extent.
Surface read_mesh(const MeshView& mesh);

// The place of each vertex on Morton's space-filling curve through their bounding box, so that what is near in space is
// mostly near along it. Moving and scaling a model change that no more than they change the ratios of its coordinates'
// differences.
std::vector<uint64_t> morton_codes(std::span<const Point> vertices);

// A surface in canonical order from working coordinates of vertices, all in use, the caller's index of each (or -1) and
// triangles of them. Triangle t of those given is the piece of face t.
Surface canonical(const Frame& frame, std::span<const Point> vertices, std::span<const int32_t> source_vertex,
                  std::span<const Triangle> triangles);

// Checks what pw_build documents of the exact fill method, in the order of pw_status; throws an Error that names the first
// thing that fails.
void check_surface(const Surface& surface, Progress& progress);

// Its verdict: the status of that Error, or PW_OK. Throws if canceled.
pw_status surface_status(const Surface& surface, Progress& progress);

// Whether two triangles have anything in common but corners and edges that they share.
bool crosses_itself(const Surface& surface, Progress& progress);

// read_mesh() and check_surface() in one.
Surface check_surface(const MeshView& mesh, Progress& progress);

}  // namespace partwheel
