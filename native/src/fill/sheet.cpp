// A sheet as a thin solid: prisms behind its triangles.
#include "fill/sheet.h"

#include "base/adjacency.h"
#include "base/predicates.h"
#include "mesh/face_assignment.h"

namespace partwheel {

namespace {

// The normal of an offset vertex is within acos of this of the normals of its triangles; else each has its own vertex.
constexpr double min_cosine = 0.1;

// Limit of halvings of an offset that would turn a prism inside out.
constexpr int max_halvings = 24;

struct TriangleSide {
    int32_t triangle, corner;  // the side goes from this corner to the next
};

// The triangles with an area, oriented consistently across edges of exactly two triangles, where that is possible.
class OrientedSheet {
public:
    explicit OrientedSheet(const Surface& source) : source_(source) {
        for (size_t t = 0; t < source.triangles.size(); ++t) {
            const Triangle& c = source.triangles[t];
            if (collinear(point(c[0]), point(c[1]), point(c[2])) || !(partwheel::area(point(c[0]), point(c[1]), point(c[2])) > 0))
                continue;
            triangles.push_back(c);
            source_number.push_back(static_cast<int32_t>(t));
        }
        find_inner_edges();
        orient();
    }

    const Point& point(int32_t v) const { return source_.vertices[idx(v)]; }
    Point unit_normal(size_t t) const {
        const Triangle& c = triangles[t];
        const Point n = cross(point(c[1]) - point(c[0]), point(c[2]) - point(c[0]));
        return 1 / length(n) * n;
    }
    double area(size_t t) const {
        const Triangle& c = triangles[t];
        return partwheel::area(point(c[0]), point(c[1]), point(c[2]));
    }

    std::vector<Triangle> triangles;
    std::vector<int32_t> source_number;             // of each triangle
    std::vector<std::array<TriangleSide, 2>> inner_edges;  // between two triangles of one orientation

private:
    void find_inner_edges() {
        for_each_edge(source_.vertices.size(), triangles, [&](int32_t, std::span<const Side> sides) {
            if (sides.size() != 2) return;
            const auto side = [](int32_t n) { return TriangleSide{n / 3, n % 3}; };
            inner_edges.push_back({side(sides[0].number), side(sides[1].number)});
        });
    }

    // Breadth first from the lowest triangle of each component. Removes inner edges where orientations contradict each
    // other.
    void orient() {
        const CsrArray<int32_t> edges(triangles.size(), [&](const auto& put) {
            for (size_t e = 0; e < inner_edges.size(); ++e)
                for (const TriangleSide& side : inner_edges[e]) put(idx(side.triangle), static_cast<int32_t>(e));
        });
        const auto start = [&](const TriangleSide& side) { return triangles[idx(side.triangle)][idx(side.corner)]; };
        std::vector<int8_t> is_reversed(triangles.size(), -1);
        std::vector<size_t> queue;
        for (size_t seed = 0; seed < triangles.size(); ++seed) {
            if (is_reversed[seed] >= 0) continue;
            is_reversed[seed] = 0;
            queue.assign(1, seed);
            for (size_t i = 0; i < queue.size(); ++i)
                for (const int32_t e : edges.row(queue[i])) {
                    const auto& [a, b] = inner_edges[idx(e)];
                    const size_t other = idx(idx(a.triangle) == queue[i] ? b.triangle : a.triangle);
                    if (is_reversed[other] >= 0) continue;
                    is_reversed[other] = is_reversed[queue[i]] ^ (start(a) == start(b) ? 1 : 0);
                    queue.push_back(other);
                }
        }
        std::erase_if(inner_edges, [&](const auto& edge) {
            const bool same_way = start(edge[0]) == start(edge[1]);
            return (is_reversed[idx(edge[0].triangle)] != is_reversed[idx(edge[1].triangle)]) != same_way;
        });
        for (size_t t = 0; t < triangles.size(); ++t)
            if (is_reversed[t] == 1) std::swap(triangles[t][1], triangles[t][2]);
        for (auto& edge : inner_edges)
            for (TriangleSide& side : edge)
                if (is_reversed[idx(side.triangle)] == 1) side.corner = 2 - side.corner;  // sides 0, 1, 2 become 2, 1, 0
    }

    const Surface& source_;
};

// Corner k of triangle t is number 3 t + k. Corners of a fan of triangles around a vertex share a vertex behind it.
class Prisms {
public:
    // separate: no corners are shared.
    Prisms(const OrientedSheet& sheet, double thickness, bool separate)
        : sheet_(sheet), fan_(3 * sheet.triangles.size()), back_(fan_.size()) {
        UnionFind fans(fan_.size());
        const auto corner = [](const TriangleSide& s, int32_t next) { return idx(3 * s.triangle + (s.corner + next) % 3); };
        for (const auto& [a, b] : sheet.inner_edges) {
            if (separate) break;
            fans.unite(corner(a, 0), corner(b, 1));
            fans.unite(corner(a, 1), corner(b, 0));
        }
        for (size_t c = 0; c < fan_.size(); ++c) fan_[c] = static_cast<int32_t>(fans.find(c));
        split_folds();
        const std::vector<Point> normal = find_normals();
        for (size_t c = 0; c < fan_.size(); ++c) back_[c] = front(c) - thickness * normal[idx(fan_[c])];
    }

    // Halves the thickness at the corners of prisms that aren't three positively oriented tetrahedra, until all are.
    bool shrink_until_valid() {
        for (int pass = 0; pass <= max_halvings; ++pass) {
            std::vector<bool> too_thick(fan_.size(), false);
            for (size_t t = 0; t < sheet_.triangles.size(); ++t)
                for (size_t k = 0; k < 3 && !is_valid(t); ++k) too_thick[idx(fan_[3 * t + k])] = true;
            if (std::ranges::find(too_thick, true) == too_thick.end()) return true;
            for (size_t c = 0; c < fan_.size(); ++c)
                if (too_thick[idx(fan_[c])]) back_[c] = 0.5 * (back_[c] + front(c));
        }
        return false;
    }

    size_t size() const { return sheet_.triangles.size(); }
    int32_t fan(size_t corner) const { return fan_[corner]; }
    const Point& front(size_t corner) const { return sheet_.point(vertex(corner)); }
    const Point& back(size_t corner) const { return back_[corner]; }
    int32_t vertex(size_t corner) const { return sheet_.triangles[corner / 3][corner % 3]; }
    int32_t source_triangle(size_t t) const { return sheet_.source_number[t]; }

    // The corners of a triangle by their fans. Diagonals of its sides go from the front of a lower fan to the back of a
    // higher one, so that adjacent prisms agree.
    std::array<size_t, 3> by_fan(size_t t) const {
        std::array<size_t, 3> corners = {3 * t, 3 * t + 1, 3 * t + 2};
        std::ranges::sort(corners, {}, [&](size_t c) { return fan_[c]; });
        return corners;
    }

private:
    // For each fan, the area-weighted mean of its triangles' normals, moved toward the normal that is farthest from it.
    std::vector<Point> find_normals() const {
        std::vector<Point> normal(fan_.size(), Point{});
        for (size_t c = 0; c < fan_.size(); ++c) {
            Point& n = normal[idx(fan_[c])];
            n = n + sheet_.area(c / 3) * sheet_.unit_normal(c / 3);
        }
        constexpr int passes = 8;
        for (int pass = 0; pass < passes; ++pass) {
            for (Point& n : normal)
                if (const double size = length(n); size > 0) n = 1 / size * n;
            std::vector<std::pair<double, size_t>> farthest(fan_.size(), {0.5, fan_.size()});
            for (size_t c = 0; c < fan_.size(); ++c) {
                auto& worst = farthest[idx(fan_[c])];
                worst = std::min(worst, {dot(normal[idx(fan_[c])], sheet_.unit_normal(c / 3)), c});
            }
            for (size_t f = 0; f < fan_.size() && pass + 1 < passes; ++f)
                if (farthest[f].second < fan_.size()) normal[f] = normal[f] + sheet_.unit_normal(farthest[f].second / 3);
        }
        return normal;
    }

    // Where the sheet folds back, so that no normal fits all triangles of a fan, each triangle gets its own corner.
    void split_folds() {
        const std::vector<Point> normal = find_normals();
        std::vector<bool> folded(fan_.size(), false);
        for (size_t c = 0; c < fan_.size(); ++c)
            if (dot(normal[idx(fan_[c])], sheet_.unit_normal(c / 3)) < min_cosine) folded[idx(fan_[c])] = true;
        for (size_t c = fan_.size(); c-- > 0;)
            if (folded[idx(fan_[c])]) fan_[c] = static_cast<int32_t>(c);
    }

    bool is_valid(size_t t) const {
        const auto [i, j, k] = by_fan(t);
        const bool even = (j == 3 * t + (i + 1 - 3 * t) % 3);  // i, j, k run as the triangle does
        const int sign = even ? -1 : 1;
        return orientation(front(i), front(j), front(k), back_[k]) == sign &&
               orientation(front(i), front(j), back_[j], back_[k]) == -sign &&
               orientation(front(i), back_[i], back_[j], back_[k]) == sign;
    }

    const OrientedSheet& sheet_;
    std::vector<int32_t> fan_;  // of each corner, the lowest corner of its fan
    std::vector<Point> back_;   // of each corner; the same within a fan
};

// The vertices of prisms by fan, the front before the back, and the source vertex of each front.
struct Numbering {
    std::vector<Point> vertices;
    std::vector<int32_t> source;
    std::vector<std::array<int32_t, 2>> of_fan;  // front and back

    explicit Numbering(const Prisms& prisms) : of_fan(3 * prisms.size(), {-1, -1}) {
        for (size_t c = 0; c < of_fan.size(); ++c) {
            auto& numbers = of_fan[idx(prisms.fan(c))];
            if (numbers[0] >= 0) continue;
            numbers = {static_cast<int32_t>(vertices.size()), static_cast<int32_t>(vertices.size() + 1)};
            vertices.insert(vertices.end(), {prisms.front(c), prisms.back(c)});
            source.insert(source.end(), {prisms.vertex(c), -1});
        }
    }
};

// Three tetrahedra for each prism; facets with the same vertices are shared. Nothing if three tetrahedra share a facet,
// or if a front facet is shared.
std::optional<std::vector<std::array<Corner, 4>>> make_tetrahedra(const Prisms& prisms, const Numbering& numbering) {
    std::vector<Tetrahedron> tetrahedra;
    for (size_t t = 0; t < prisms.size(); ++t) {
        const auto c = prisms.by_fan(t);
        const auto f = [&](size_t i) { return numbering.of_fan[idx(prisms.fan(c[i]))][0]; };
        const auto b = [&](size_t i) { return numbering.of_fan[idx(prisms.fan(c[i]))][1]; };
        tetrahedra.push_back({f(0), f(1), f(2), b(2)});
        tetrahedra.push_back({f(0), f(1), b(1), b(2)});
        tetrahedra.push_back({f(0), b(0), b(1), b(2)});
    }
    const auto neighbors = neighbors_across_facets(tetrahedra);
    if (!neighbors) return {};
    std::vector<std::array<Corner, 4>> corners(tetrahedra.size());
    for (size_t t = 0; t < corners.size(); ++t) {
        if (t % 3 == 0 && (*neighbors)[t][3] >= 0) return {};  // a front behind another
        for (size_t k = 0; k < 4; ++k) corners[t][k] = {tetrahedra[t][k], (*neighbors)[t][k]};
    }
    return corners;
}

// For each source triangle, the front triangle of its face: its own, or one at its first vertex that has any.
std::vector<int32_t> fronts_of_source(const Surface& source, const Prisms& prisms) {
    std::vector<int32_t> front(source.triangles.size(), -1), at_vertex(source.vertices.size(), -1);
    for (size_t t = prisms.size(); t-- > 0;) {
        front[idx(prisms.source_triangle(t))] = static_cast<int32_t>(t);
        for (size_t k = 0; k < 3; ++k) at_vertex[idx(prisms.vertex(3 * t + k))] = static_cast<int32_t>(t);
    }
    for (size_t t = 0; t < front.size(); ++t)
        for (const int32_t v : source.triangles[t])
            if (front[t] < 0) front[t] = at_vertex[idx(v)];
    std::ranges::replace(front, -1, 0);
    return front;
}

// The tetrahedra with their boundary, whose first triangles are the fronts.
Filling add_boundary(const Prisms& prisms, const Numbering& numbering, std::vector<std::array<Corner, 4>> corners) {
    Filling filling{numbering.vertices, std::move(corners), {}, {}};
    const auto front = [&](size_t c) { return numbering.of_fan[idx(prisms.fan(c))][0]; };
    for (size_t t = 0; t < prisms.size(); ++t) {
        filling.triangles.push_back({front(3 * t), front(3 * t + 1), front(3 * t + 2)});
        filling.behind.push_back(static_cast<int32_t>(3 * t));
    }
    for (size_t t = 0; t < filling.corners.size(); ++t) {
        const std::array<Corner, 4>& c = filling.corners[t];
        const auto point = [&](size_t k) -> const Point& { return filling.vertices[idx(c[k].vertex)]; };
        const bool positive = orientation(point(0), point(1), point(2), point(3)) > 0;
        for (size_t k = 0; k < 4; ++k) {
            if (c[k].beyond >= 0 || (t % 3 == 0 && k == 3)) continue;
            Triangle f = facet({c[0].vertex, c[1].vertex, c[2].vertex, c[3].vertex}, k);
            if (!positive) std::swap(f[1], f[2]);
            filling.triangles.push_back(f);
            filling.behind.push_back(static_cast<int32_t>(t));
        }
    }
    return filling;
}

}  // namespace

void throw_sheet() {
    throw Error(PW_ERROR_NOT_SOLID,
                "The mesh is a sheet, not a solid: it is open, and closing it would take as much new surface as there is. "
                "Give it a thickness (Solidify), close it, or allow open surfaces, which are then filled as thin solids.");
}

Solid fill_sheet(const Surface& source, Progress& progress) {
    progress.enter(PW_STAGE_TETRAHEDRA);
    const OrientedSheet sheet(source);
    if (sheet.triangles.empty())
        throw Error(PW_ERROR_NO_VOLUME, "The faces of the mesh have no area. Choose another mesh.");
    const double thickness = sheet_thickness * diagonal(source);
    std::optional<Prisms> prisms;
    std::optional<Numbering> numbering;
    std::optional<std::vector<std::array<Corner, 4>>> corners;
    for (const bool separate : {false, true}) {
        prisms.emplace(sheet, thickness, separate);
        if (!prisms->shrink_until_valid() && !separate) continue;
        numbering.emplace(*prisms);
        corners = make_tetrahedra(*prisms, *numbering);
        if (corners) break;
    }
    progress.advance(0.5);

    const std::vector<int32_t> on_surface = iota(numbering->vertices.size());  // all
    Solid solid = canonical(source.frame, add_boundary(*prisms, *numbering, std::move(*corners)), on_surface, progress);
    for (int32_t& v : solid.surface.source_vertex) {
        const int32_t known = numbering->source[idx(v)];
        v = known < 0 ? -1 : source.source_vertex[idx(known)];
    }
    std::vector<int32_t> triangle_place(solid.surface.samples.size());
    for (const FaceSample& sample : solid.surface.samples) triangle_place[idx(sample.face)] = sample.triangle;
    solid.surface.samples.clear();
    const std::vector<int32_t> fronts = fronts_of_source(source, *prisms);
    for (size_t t = 0; t < source.triangles.size(); ++t)
        solid.surface.samples.push_back({source.samples[t].face, triangle_place[idx(fronts[t])], source.samples[t].area});
    solid.surface.face_count = source.face_count;
    solid.surface.fill_method = PW_FILL_SHEET;
    solid.surface.notes = "Filled as a thin solid, because it is a sheet.";
    return solid;
}

}  // namespace partwheel
