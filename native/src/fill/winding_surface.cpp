// The repaired mesh as a surface to wind around, and points on it.
#include "fill/winding_surface.h"

#include "base/adjacency.h"
#include "base/sorted.h"
#include "fill/winding.h"

#include <unordered_set>

namespace partwheel {

namespace {

// Side of the cells of a grid, in spacings: each cell gets at most one added point.
constexpr double cell_size = 0.5;

// Limit of candidate points along edges: long, thin triangles have hardly any area.
constexpr double max_candidates = 2e6;

int32_t number(CgalMesh::Vertex_index v) { return static_cast<int32_t>(static_cast<size_t>(v)); }

// Adds triangles: the other side of each sheet, and along its borders.
void thicken(const CgalMesh& mesh, double thickness, WindingSurface& shell) {
    UnionFind parts(shell.vertices.size());
    std::vector<Point> normal(shell.vertices.size(), Point{});
    for (const Triangle& t : shell.triangles) {
        const auto point = [&](size_t k) { return shell.vertices[idx(t[k])]; };
        const Point n = cross(point(1) - point(0), point(2) - point(0));
        for (const int32_t v : t) {
            parts.unite(idx(t[0]), idx(v));
            normal[idx(v)] = normal[idx(v)] + n;
        }
    }
    std::vector<std::pair<int32_t, int32_t>> rims;  // as their triangles run along them
    std::vector<bool> open(shell.vertices.size(), false);
    for (const auto h : mesh.halfedges())
        if (mesh.is_border(h)) {
            rims.emplace_back(number(mesh.target(h)), number(mesh.source(h)));
            open[parts.find(idx(rims.back().first))] = true;
        }
    std::vector<int32_t> beyond(shell.vertices.size(), -1);  // of each vertex of a sheet, the one on the other side
    for (size_t v = 0; v < beyond.size(); ++v) {
        if (!open[parts.find(v)]) continue;
        const double size = length(normal[v]);
        const Point half = size > 0 ? thickness / 2 / size * normal[v] : Point{};
        beyond[v] = static_cast<int32_t>(shell.vertices.size());
        shell.vertices.push_back(shell.vertices[v] - half);
        shell.vertices[v] = shell.vertices[v] + half;
    }
    for (size_t i = 0, given = shell.triangles.size(); i < given; ++i) {
        const auto [a, b, c] = shell.triangles[i];
        if (beyond[idx(a)] >= 0) shell.triangles.push_back({beyond[idx(a)], beyond[idx(c)], beyond[idx(b)]});
    }
    for (const auto& [from, to] : rims) {
        shell.triangles.push_back({to, from, beyond[idx(from)]});
        shell.triangles.push_back({to, beyond[idx(from)], beyond[idx(to)]});
    }
}

// Reverses components that are inside out. One inside others is a cavity of them if its orientation is opposite to
// theirs.
void turn_outwards(WindingSurface& shell) {
    UnionFind parts(shell.vertices.size());
    for (const Triangle& t : shell.triangles)
        for (const int32_t v : t) parts.unite(idx(t[0]), idx(v));
    std::vector<double> volume(shell.vertices.size(), 0);  // six times, of each part
    for (const auto& [a, b, c] : shell.triangles) {
        const size_t part = parts.find(idx(a));
        volume[part] += signed_volume6(shell.vertices[part], shell.vertices[idx(a)], shell.vertices[idx(b)],
                                    shell.vertices[idx(c)]);
    }
    if (std::none_of(volume.begin(), volume.end(), [](double v) { return v < 0; })) return;

    const auto outward = [&](Triangle t) {
        if (volume[parts.find(idx(t[0]))] < 0) std::swap(t[1], t[2]);
        return t;
    };
    std::vector<Triangle> all = shell.triangles;
    for (Triangle& t : all) t = outward(t);
    const WindingNumber given(shell.vertices, shell.triangles), solid(shell.vertices, all);
    const CsrArray<Triangle> own(shell.vertices.size(), [&](const auto& put) {
        for (const Triangle& t : all) put(parts.find(idx(t[0])), t);
    });
    std::vector<bool> is_cavity(shell.vertices.size(), false);
    for (size_t part = 0; part < is_cavity.size(); ++part) {
        if (own.row(part).empty()) continue;
        const Point& p = shell.vertices[part];
        const double mine = winding_number(shell.vertices, own.row(part), p);
        const double others = given.at(p) - (volume[part] < 0 ? -mine : mine);
        is_cavity[part] = solid.at(p) - mine > 0.5 && (others < 0) != (volume[part] < 0);
    }
    for (size_t t = 0; t < all.size(); ++t) {
        shell.triangles[t] = all[t];
        if (is_cavity[parts.find(idx(all[t][0]))]) std::swap(shell.triangles[t][1], shell.triangles[t][2]);
    }
}

}  // namespace

double WindingSurface::area() const {
    double sum = 0;
    for (const auto& [a, b, c] : triangles) sum += partwheel::area(vertices[idx(a)], vertices[idx(b)], vertices[idx(c)]);
    return sum;
}

std::vector<Point> WindingSurface::points(size_t count, double least_spacing) const {
    double sides = 0;
    for (const Triangle& t : triangles)
        for (size_t k = 0; k < 3; ++k) sides += length(vertices[idx(t[(k + 1) % 3])] - vertices[idx(t[k])]);
    const double spread = std::sqrt(area() / static_cast<double>(count));
    const double spacing = std::max({spread, sides / max_candidates, least_spacing});
    std::vector<Point> found = vertices;
    // Where long, thin triangles lie side by side, a cell of a grid gets one point.
    std::unordered_set<uint64_t> occupied;
    uint64_t facing = 0;  // of the triangle, along an axis: both sides of a thin plate get points
    const auto add_points = [&](const Point& from, const Point& to) {
        const double parts = std::round(length(to - from) / spacing);
        for (double i = 1; i < parts; ++i) {
            const Point p = from + i / parts * (to - from);
            uint64_t cell = facing;
            for (const double x : p)
                cell = cell << 20 | (static_cast<uint64_t>(std::llround(x / spacing / cell_size)) & 0xfffff);
            if (occupied.insert(cell).second) found.push_back(p);
        }
    };
    for (const Triangle& t : triangles) {
        const Point &p = vertices[idx(t[0])], n = cross(vertices[idx(t[1])] - p, vertices[idx(t[2])] - p);
        size_t axis = 0;
        for (size_t k = 1; k < 3; ++k) axis = std::fabs(n[k]) > std::fabs(n[axis]) ? k : axis;
        facing = 2 * axis + (n[axis] < 0);
        size_t longest = 0;
        double size = 0;
        for (size_t k = 0; k < 3; ++k) {
            const int32_t v = t[k], w = t[(k + 1) % 3];
            const double side = length(vertices[idx(w)] - vertices[idx(v)]);
            if (v < w) add_points(vertices[idx(v)], vertices[idx(w)]);  // only one of the two triangles
            if (side > size) size = side, longest = k;
        }
        const auto corner = [&](size_t k) { return vertices[idx(t[(longest + k) % 3])]; };
        const Point a = corner(0), b = corner(1), c = corner(2);
        const double rows = size > 0 ? std::round(2 * partwheel::area(a, b, c) / size / spacing) : 0;
        for (double row = 1; row < rows; ++row) add_points(a + row / rows * (c - a), b + row / rows * (c - b));
    }
    sort_unique(found);
    return found;
}

WindingSurface make_winding_surface(const RepairedSoup& repaired, double thickness) {
    const CgalMesh& mesh = repaired.mesh;
    WindingSurface shell;
    for (const auto v : mesh.vertices()) {
        const auto& p = mesh.point(v);
        shell.vertices.push_back({p.x(), p.y(), p.z()});
    }
    for (const auto f : mesh.faces()) {
        Triangle& t = shell.triangles.emplace_back();
        size_t k = 0;
        for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) t[k++] = number(v);
    }
    if (repaired.sheets > 0) thicken(mesh, thickness, shell);
    turn_outwards(shell);
    return shell;
}

}  // namespace partwheel
