// Convex parts of a hierarchy.
#include "part/convex/convex_parts.h"

#include "part/convex/search.h"
#include "surface/surface.h"

#include <algorithm>
#include <cstdlib>
#include <cmath>

namespace partwheel {

namespace {

using namespace convex;

constexpr size_t most_parts = 4096;

std::vector<convex::Piece> pieces_of_cut(const Hierarchy& hierarchy, std::span<const int32_t> bounds, Pieces& made) {
    std::vector<convex::Piece> pieces;
    for (size_t k = 0; k + 1 < bounds.size(); ++k) {
        const auto tets = hierarchy.tetrahedra().subspan(at(bounds[k]), at(bounds[k + 1] - bounds[k]));
        pieces.push_back(made.piece({tets.begin(), tets.end()}));
    }
    return pieces;
}

// In the caller's coordinates, and its own vertices exactly.
TriangleMesh mesh_of(const Hull& hull, const HullKernel& kernel, const Frame& frame, std::span<const Point> vertices) {
    TriangleMesh mesh;
    const auto corners = hull.vertices();
    for (const int32_t v : corners)
        mesh.vertices.push_back(at(v) < vertices.size() ? vertices[at(v)] : frame.to_caller(kernel.point(v)));
    for (const HullFacet& facet : hull.facets()) {
        Triangle t = facet.corners;
        for (int32_t& v : t)
            v = static_cast<int32_t>(std::lower_bound(corners.begin(), corners.end(), v) - corners.begin());
        mesh.triangles.push_back(t);
    }
    return mesh;
}

}  // namespace

std::vector<ConvexPart> convex_parts(const Hierarchy& hierarchy, const Solids& solids, const ConvexOptions& options) {
    (void)solids;
    const auto vertices = hierarchy.vertices();
    const Frame frame = Frame::around(vertices);
    std::vector<Point> points;
    for (const Point& p : vertices) points.push_back(frame.to_working(p));
    Pieces made(points);
    const size_t tets = hierarchy.tetrahedron_count();
    const size_t count = std::min(options.hulls, most_parts);
    const char* e = getenv("CV_START");
    const double start = e ? atof(e) : 1;
    e = getenv("CV_OVER");
    const double over = e ? atof(e) : 2;
    const int mode = getenv("CV_MODE") ? atoi(getenv("CV_MODE")) : 7;
    const auto begin = static_cast<size_t>(std::max(1.0, start * static_cast<double>(count)));
    Search search(made, pieces_of_cut(hierarchy, hierarchy.cut_least_concavity(std::min(begin, tets)), made));
    if (mode & 1) search.divide_until(static_cast<size_t>(over * static_cast<double>(count)));
    search.join_until(count);
    if (mode & 2) search.move_borders();
    if (mode & 4) search.exchange();
    if (mode & 8) search.move_borders();
    std::vector<convex::Piece> pieces = search.take();
    std::vector<ConvexPart> parts;
    for (const convex::Piece& piece : pieces) {
        double volume = 0;
        for (const Tetrahedron& t : piece.tetrahedra)
            volume += std::fabs(six_volumes(made.kernel().point(t[0]), made.kernel().point(t[1]),
                                            made.kernel().point(t[2]), made.kernel().point(t[3]))) / 6;
        parts.push_back({mesh_of(piece.hull, made.kernel(), frame, vertices), frame.volume_to_caller(volume), 0});
    }
    return parts;
}

}  // namespace partwheel
