// Closed surfaces and tet meshes made by formula.
#include "support/shapes.h"

#include "base/predicates.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <stdexcept>

namespace partwheel::test {

MeshView TriMesh::view() const {
    return {vertices, triangles, faces, face_count};
}

double enclosed_volume(const TriMesh& mesh) {
    const Point& o = mesh.vertices.at(static_cast<size_t>(mesh.triangles.at(0)[0]));
    long double sum = 0;
    for (const Triangle& t : mesh.triangles) {
        std::array<std::array<long double, 3>, 3> p;
        for (size_t k = 0; k < 3; ++k)
            for (size_t d = 0; d < 3; ++d)
                p[k][d] = static_cast<long double>(mesh.vertices[static_cast<size_t>(t[k])][d]) - o[d];
        sum += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) - p[0][1] * (p[1][0] * p[2][2] - p[1][2] * p[2][0]) +
               p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    return static_cast<double>(sum / 6);
}

double surface_area(const TriMesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        sum += area(mesh.vertices[static_cast<size_t>(a)], mesh.vertices[static_cast<size_t>(b)],
                    mesh.vertices[static_cast<size_t>(c)]);
    return sum;
}

namespace {

TriMesh with_own_faces(TriMesh mesh) {
    mesh.faces.clear();
    mesh.face_count = mesh.triangles.size();
    return mesh;
}

// Adds the quad a, b, c, d (counter-clockwise from outside) as one face of two triangles.
void add_quad(TriMesh& mesh, int32_t a, int32_t b, int32_t c, int32_t d) {
    const auto face = static_cast<int32_t>(mesh.face_count++);
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
    mesh.faces.insert(mesh.faces.end(), 2, face);
}

void add_triangle(TriMesh& mesh, int32_t a, int32_t b, int32_t c) {
    mesh.triangles.push_back({a, b, c});
    mesh.faces.push_back(static_cast<int32_t>(mesh.face_count++));
}

// Numbers grid points as they come up.
class GridPoints {
public:
    explicit GridPoints(const Point& spacing) : spacing_(spacing) {}
    int32_t operator()(const Cell& p) {
        const auto [it, added] = number_.try_emplace(p, static_cast<int32_t>(number_.size()));
        if (added) points.push_back({p[0] * spacing_[0], p[1] * spacing_[1], p[2] * spacing_[2]});
        return it->second;
    }
    std::vector<Point> points;

private:
    Point spacing_;
    std::map<Cell, int32_t> number_;
};

Cell plus(Cell p, size_t axis, int by) {
    p[axis] += by;
    return p;
}

}  // namespace

TriMesh tetrahedron() {
    TriMesh m{"tetrahedron", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}, {}, 0};
    m.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return with_own_faces(m);
}

TriMesh cube() { return named(surface_of("cube", block({0, 0, 0}, {1, 1, 1})), "cube"); }

TriMesh octahedron() {
    TriMesh m{"octahedron", {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}, {}, {}, 0};
    m.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    return with_own_faces(m);
}

Cells block(Cell low, Cell high) {
    Cells cells;
    for (int x = low[0]; x < high[0]; ++x)
        for (int y = low[1]; y < high[1]; ++y)
            for (int z = low[2]; z < high[2]; ++z) cells.push_back({x, y, z});
    return cells;
}

Cells operator+(Cells a, const Cells& b) {
    a.insert(a.end(), b.begin(), b.end());
    std::sort(a.begin(), a.end());
    a.erase(std::unique(a.begin(), a.end()), a.end());
    return a;
}

Cells operator-(const Cells& a, const Cells& b) {
    const std::set<Cell> gone(b.begin(), b.end());
    Cells rest;
    for (const Cell& c : a)
        if (!gone.contains(c)) rest.push_back(c);
    return rest;
}

TriMesh surface_of(const std::string& name, const Cells& cells, const Point& spacing) {
    const std::set<Cell> filled(cells.begin(), cells.end());
    GridPoints number(spacing);
    TriMesh mesh;
    mesh.name = name;
    for (const Cell& c : filled)
        for (size_t axis = 0; axis < 3; ++axis)
            for (const int side : {0, 1}) {
                if (filled.contains(plus(c, axis, side == 0 ? -1 : 1))) continue;
                const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
                const Cell low = plus(c, axis, side);
                const int32_t a = number(low), b = number(plus(low, u, 1)), d = number(plus(low, v, 1));
                const int32_t far = number(plus(plus(low, u, 1), v, 1));
                if (side == 1)
                    add_quad(mesh, a, b, far, d);  // the diagonal from the lowest corner, as Kuhn's subdivision has it
                else
                    add_quad(mesh, a, d, far, b);
            }
    mesh.vertices = std::move(number.points);
    return mesh;
}

TriMesh lathe(const std::string& name, const std::vector<Ring>& rings, int segments) {
    TriMesh m;
    m.name = name;
    for (const Ring& ring : rings)
        for (int s = 0; s < segments; ++s) {
            const double angle = 2 * std::numbers::pi * s / segments;
            m.vertices.push_back({ring.radius * std::cos(angle), ring.radius * std::sin(angle), ring.z});
        }
    const auto count = static_cast<int>(rings.size());
    const auto at = [&](int ring, int s) { return ring * segments + s % segments; };
    for (int r = 0; r + 1 < count; ++r)
        for (int s = 0; s < segments; ++s) add_quad(m, at(r, s), at(r, s + 1), at(r + 1, s + 1), at(r + 1, s));
    const auto bottom = static_cast<int32_t>(m.vertices.size());
    m.vertices.push_back({0, 0, rings.front().z});
    m.vertices.push_back({0, 0, rings.back().z});
    for (int s = 0; s < segments; ++s) {
        add_triangle(m, bottom, at(0, s + 1), at(0, s));
        add_triangle(m, bottom + 1, at(count - 1, s), at(count - 1, s + 1));
    }
    return m;
}

namespace {

// A sphere's rings with its poles left out, so that the fans of the lathe close it with small flat caps.
std::vector<Ring> arc(double radius, double z, double from, double to, int count) {
    std::vector<Ring> rings;
    for (int i = 0; i < count; ++i) {
        const double angle = from + (to - from) * i / (count - 1);
        rings.push_back({radius * std::sin(angle), z - radius * std::cos(angle)});
    }
    return rings;
}

}  // namespace

TriMesh sphere(int rings, int segments) {
    const double step = std::numbers::pi / (rings + 1);
    return lathe("sphere", arc(1, 0, step, std::numbers::pi - step, rings), segments);
}

TriMesh snowman(int rings, int segments) {
    auto profile = arc(1, 0, 0.3, 2.5, rings);
    const auto head = arc(0.7, 1.4, 0.9, std::numbers::pi - 0.3, rings);
    profile.insert(profile.end(), head.begin(), head.end());
    return lathe("snowman", profile, segments);
}

TriMesh stacked_cylinders(int segments) {
    return lathe("stacked cylinders",
                 {{1, 0}, {1, 0.5}, {0.5, 0.5}, {0.5, 1.5}, {1.25, 1.5}, {1.25, 2}, {0.25, 2}, {0.25, 4}}, segments);
}

TriMesh torus(int around, int across, double radius, double tube) {
    TriMesh m;
    m.name = "torus";
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
            const double r = radius + tube * std::cos(v);
            m.vertices.push_back({r * std::cos(u), r * std::sin(u), tube * std::sin(v)});
        }
    const auto at = [&](int i, int j) { return (i % around) * across + j % across; };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) add_quad(m, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    return m;
}

TriMesh star_prism(int points, double inner, double outer, double height) {
    TriMesh m = lathe("star prism", {{1, 0}, {1, height}}, 2 * points);
    for (size_t i = 0; i < static_cast<size_t>(4 * points); ++i) {
        const double r = i % 2 == 0 ? outer : inner;
        m.vertices[i][0] *= r;
        m.vertices[i][1] *= r;
    }
    return m;
}

TriMesh hedgehog(int spikes) {
    TriMesh m = without_faces(sphere(7, 12));
    m.name = "hedgehog";
    std::mt19937 random(11);
    std::vector<size_t> triangle(m.triangles.size());
    std::iota(triangle.begin(), triangle.end(), size_t{0});
    std::shuffle(triangle.begin(), triangle.end(), random);
    for (size_t i = 0; i < static_cast<size_t>(spikes); ++i) {
        const Triangle t = m.triangles[triangle[i]];
        Point tip{};
        for (const int32_t v : t)
            for (size_t d = 0; d < 3; ++d) tip[d] += m.vertices[static_cast<size_t>(v)][d] / 3;
        for (double& x : tip) x *= 2 + 0.1 * static_cast<double>(i);
        const auto v = static_cast<int32_t>(m.vertices.size());
        m.vertices.push_back(tip);
        m.triangles[triangle[i]] = {t[0], t[1], v};
        m.triangles.push_back({t[1], t[2], v});
        m.triangles.push_back({t[2], t[0], v});
    }
    return with_own_faces(m);
}

TriMesh named(TriMesh mesh, const std::string& name) {
    mesh.name = name;
    return mesh;
}

TriMesh stretched(TriMesh mesh, const Point& factors) {
    for (Point& p : mesh.vertices)
        for (size_t d = 0; d < 3; ++d) p[d] *= factors[d];
    return mesh;
}

TriMesh moved(TriMesh mesh, const Point& by) {
    for (Point& p : mesh.vertices)
        for (size_t d = 0; d < 3; ++d) p[d] += by[d];
    return mesh;
}

TriMesh rotated(TriMesh mesh, double angle, Point axis) {
    const double length = std::sqrt(dot(axis, axis));
    for (double& x : axis) x /= length;
    for (Point& p : mesh.vertices) {  // Rodrigues' formula
        const Point q = cross(axis, p);
        const double along = dot(axis, p) * (1 - std::cos(angle));
        for (size_t d = 0; d < 3; ++d) p[d] = p[d] * std::cos(angle) + q[d] * std::sin(angle) + axis[d] * along;
    }
    return mesh;
}

TriMesh inside_out(TriMesh mesh) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

TriMesh together(const std::string& name, const TriMesh& a, const TriMesh& b) {
    TriMesh m;
    m.name = name;
    m.vertices = a.vertices;
    m.vertices.insert(m.vertices.end(), b.vertices.begin(), b.vertices.end());
    const auto shift = static_cast<int32_t>(a.vertices.size());
    m.triangles = a.triangles;
    for (const Triangle& t : b.triangles) m.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    for (size_t t = 0; t < a.triangles.size(); ++t) m.faces.push_back(a.face_of(t));
    for (size_t t = 0; t < b.triangles.size(); ++t)
        m.faces.push_back(static_cast<int32_t>(a.face_count) + b.face_of(t));
    m.face_count = a.face_count + b.face_count;
    return m;
}

namespace {

void perturb(std::vector<Point>& points, double amount, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> offset(-amount, amount);
    for (Point& p : points)
        for (double& x : p) x += offset(random);
}

}  // namespace

TriMesh perturbed(TriMesh mesh, double amount, unsigned seed) {
    perturb(mesh.vertices, amount, seed);
    mesh.name += ", perturbed";
    return mesh;
}

TriMesh snapped(TriMesh mesh, double step) {
    for (Point& p : mesh.vertices)
        for (double& x : p) x = std::round(x / step) * step;
    return mesh;
}

TriMesh without_faces(TriMesh mesh) { return with_own_faces(std::move(mesh)); }

Shuffled shuffled(const TriMesh& mesh, unsigned seed) {
    std::mt19937 random(seed);
    constexpr size_t unused = 3;
    const auto permutation = [&](size_t count) {
        std::vector<int32_t> p(count);
        std::iota(p.begin(), p.end(), 0);
        std::shuffle(p.begin(), p.end(), random);
        return p;
    };
    Shuffled result;
    result.mesh.name = mesh.name + ", shuffled";

    const std::vector<int32_t> place = permutation(mesh.vertices.size() + unused);
    result.mesh.vertices.assign(place.size(), {1e3, -1e3, 0.5});
    result.vertex.assign(place.size(), -1);
    for (size_t v = 0; v < mesh.vertices.size(); ++v) {
        result.mesh.vertices[static_cast<size_t>(place[v])] = mesh.vertices[v];
        result.vertex[static_cast<size_t>(place[v])] = static_cast<int32_t>(v);
    }

    result.face = permutation(mesh.face_count);
    std::vector<int32_t> face_place(mesh.face_count);
    for (size_t f = 0; f < mesh.face_count; ++f)
        face_place[static_cast<size_t>(result.face[f])] = static_cast<int32_t>(f);

    for (const int32_t t : permutation(mesh.triangles.size())) {
        Triangle corners = mesh.triangles[static_cast<size_t>(t)];
        for (int32_t& v : corners) v = place[static_cast<size_t>(v)];
        std::rotate(corners.begin(), corners.begin() + random() % 3, corners.end());
        result.mesh.triangles.push_back(corners);
        result.mesh.faces.push_back(face_place[static_cast<size_t>(mesh.face_of(static_cast<size_t>(t)))]);
    }
    result.mesh.face_count = mesh.face_count;
    return result;
}

TetMesh tet_mesh(std::vector<Point> vertices, std::vector<Tetrahedron> tetrahedra) {
    TetMesh mesh;
    mesh.vertices = std::move(vertices);
    mesh.tetrahedra = std::move(tetrahedra);
    const auto point = [&](int32_t v) -> const Point& { return mesh.vertices[static_cast<size_t>(v)]; };
    std::map<std::array<int32_t, 3>, std::pair<size_t, size_t>> waiting;  // facet -> tetrahedron, corner
    mesh.neighbors.assign(mesh.tetrahedra.size(), {-1, -1, -1, -1});
    for (size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        Tetrahedron& tet = mesh.tetrahedra[t];
        const int sign = orientation(point(tet[0]), point(tet[1]), point(tet[2]), point(tet[3]));
        if (sign == 0) throw std::logic_error("a flat tetrahedron in a test's mesh");
        if (sign < 0) std::swap(tet[0], tet[1]);
        for (size_t corner = 0; corner < 4; ++corner) {
            std::array<int32_t, 3> facet{tet[(corner + 1) % 4], tet[(corner + 2) % 4], tet[(corner + 3) % 4]};
            std::sort(facet.begin(), facet.end());
            const auto [it, added] = waiting.try_emplace(facet, t, corner);
            if (added) continue;
            const auto [other, other_corner] = it->second;
            mesh.neighbors[t][corner] = static_cast<int32_t>(other);
            mesh.neighbors[other][other_corner] = static_cast<int32_t>(t);
        }
    }
    return mesh;
}

TetMesh tets_of(const Cells& cells, const Point& spacing) {
    GridPoints number(spacing);
    std::vector<Tetrahedron> tets;
    for (const Cell& c : cells) {
        std::array<size_t, 3> axes{0, 1, 2};
        do {
            Cell p = c;
            Tetrahedron tet{number(p), 0, 0, 0};
            for (size_t i = 0; i < 3; ++i) tet[i + 1] = number(p = plus(p, axes[i], 1));
            tets.push_back(tet);
        } while (std::next_permutation(axes.begin(), axes.end()));
    }
    return tet_mesh(std::move(number.points), std::move(tets));
}

TetMesh figure_4() {
    const std::vector<Point> points{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}, {0, 0, 0}};
    return tet_mesh(points, {{0, 1, 2, 4}, {0, 1, 3, 4}, {0, 2, 3, 4}, {1, 2, 3, 4}});
}

TetMesh perturbed(TetMesh mesh, double amount, unsigned seed) {
    perturb(mesh.vertices, amount, seed);
    return tet_mesh(mesh.vertices, mesh.tetrahedra);
}

}  // namespace partwheel::test
