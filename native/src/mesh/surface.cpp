// A surface put in a canonical order, and checked.
#include "mesh/surface.h"

#include "base/adjacency.h"
#include "base/corners.h"
#include "base/morton.h"
#include "base/predicates.h"
#include "mesh/crossings.h"

namespace partwheel {

namespace {

// Limits for which volumes neither overflow nor vanish.
constexpr double largest_coordinate = 1e100;
constexpr double smallest_model = 1e-80;

// A smaller working coordinate counts as 0: predicates are exact as long as no product of three differences underflows.
constexpr double least_working = 0x1p-280;

// The number of defects of one kind, and the lowest source face that has it.
struct Defects {
    size_t count = 0;
    int32_t face = std::numeric_limits<int32_t>::max();

    void add(int32_t at) {
        ++count;
        face = std::min(face, at);
    }
    // Throws an Error if there are any: before, their number, one or many, after, where they are, advice.
    void refuse(pw_status status, const std::string& before, const char* one, const char* many, const char* after,
                const char* advice) const {
        if (count == 0) return;
        throw Error(status, before + std::to_string(count) + " " + (count == 1 ? one : many) + after + ", " +
                                (count == 1 ? "at face " : "the first at face ") + std::to_string(face) + ". " + advice,
                    {.faces = {face, -1}});
    }
};

void check_degenerate(const Surface& surface) {
    Defects flat;
    for (size_t t = 0; t < surface.triangles.size(); ++t) {
        const auto [a, b, c] = corner_points(surface.vertices, surface.triangles[t]);
        if (collinear(a, b, c)) flat.add(surface.samples[t].face);
    }
    flat.refuse(PW_ERROR_DEGENERATE, "", "triangle has", "triangles have", " no area",
                "Merge vertices by distance or dissolve degenerate geometry.");
}

// Closed, manifold, oriented: every edge has two triangles, which traverse it in opposite directions, and the triangles
// of every vertex form one fan.
void check_manifold(const Surface& surface) {
    const size_t count = surface.triangles.size();
    Defects open, non_manifold, inconsistent;
    std::vector<int32_t> twin(3 * count);  // sides: 3 * triangle + k goes from corner k to corner k + 1
    for_each_edge(surface.vertices.size(), surface.triangles, [&](int32_t, std::span<const Side> sides) {
        const int32_t face = surface.samples[idx(sides[0].number) / 3].face;
        if (sides.size() == 1)
            open.add(face);
        else if (sides.size() > 2)
            non_manifold.add(face);
        else if (sides[0].is_ascending == sides[1].is_ascending)
            inconsistent.add(face);
        else {
            twin[idx(sides[0].number)] = sides[1].number;
            twin[idx(sides[1].number)] = sides[0].number;
        }
    });
    open.refuse(PW_ERROR_OPEN, "The surface is open: ", "edge has a face", "edges have a face", " on one side only",
                "Fill the holes, and merge vertices by distance if the faces only seem joined.");
    non_manifold.refuse(PW_ERROR_NON_MANIFOLD, "", "edge joins", "edges join", " more than two faces",
                        "Remove inner faces, so that each edge joins exactly two.");
    inconsistent.refuse(PW_ERROR_ORIENTATION, "", "edge joins faces", "edges join faces", " that look in opposite directions",
                        "Recalculate the normals to the outside.");

    Defects pinched;
    std::vector<bool> visited(3 * count, false), has_fan(surface.vertices.size(), false);
    for (size_t start = 0; start < 3 * count; ++start) {
        if (visited[start]) continue;
        for (size_t h = start; !visited[h]; h = idx(twin[h / 3 * 3 + (h + 2) % 3])) visited[h] = true;
        const auto v = static_cast<size_t>(surface.triangles[start / 3][start % 3]);
        if (has_fan[v]) pinched.add(surface.samples[start / 3].face);
        has_fan[v] = true;
    }
    pinched.refuse(PW_ERROR_NON_MANIFOLD, "Parts of the surface touch in ", "single vertex", "single vertices", "",
                   "Split or merge them there.");
}

void check_self_intersection(const Surface& surface, Progress& progress) {
    CrossingSearch(surface.vertices, surface.triangles).for_each_crossing(progress, [&](size_t t, size_t u) -> bool {
        const auto [low, high] = std::minmax(surface.samples[t].face, surface.samples[u].face);
        const std::string where = low == high ? "within face " + std::to_string(low)
                                              : "where faces " + std::to_string(low) + " and " + std::to_string(high) +
                                                    " meet";
        throw Error(PW_ERROR_SELF_INTERSECTION,
                    "The surface passes through or touches itself, for instance " + where +
                        ". Unite overlapping parts with a Boolean or remesh, and separate parts that touch.",
                    {.faces = {low, low == high ? -1 : high}});
    });
}

}  // namespace

void check_arrays(const MeshView& mesh) {
    if (mesh.vertices.empty() || mesh.triangles.empty() || mesh.face_count == 0)
        throw Error(PW_ERROR_EMPTY, "The mesh has no faces. Choose a mesh object that has some.");
    if (mesh.faces.empty() && mesh.face_count != mesh.triangles.size())
        throw Error(PW_ERROR_ARGUMENT, "Without source faces, face_count must equal triangle_count.");

    for (size_t v = 0; v < mesh.vertices.size(); ++v)
        for (const double x : mesh.vertices[v])
            if (!(std::fabs(x) <= largest_coordinate))
                throw Error(PW_ERROR_NOT_FINITE, "Vertex " + std::to_string(v) +
                                                     " has a coordinate that is not a number, or is too large. Delete "
                                                     "or move that vertex.",
                            {.vertices = {static_cast<int64_t>(v), -1}});

    const auto check_index = [](size_t triangle, const char* what, int32_t index, size_t count) {
        if (index < 0 || idx(index) >= count)
            throw Error(PW_ERROR_INDEX, "Triangle " + std::to_string(triangle) + " refers to " + what + " " +
                                            std::to_string(index) + ", but there are " + std::to_string(count) +
                                            ". The mesh is damaged: export it again.",
                        {.triangle = static_cast<int64_t>(triangle)});
    };
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (const int32_t v : mesh.triangles[t]) check_index(t, "vertex", v, mesh.vertices.size());
    for (size_t t = 0; t < mesh.faces.size(); ++t) check_index(t, "face", mesh.faces[t], mesh.face_count);
}

void check_all_faces_used(const MeshView& mesh) {
    if (mesh.faces.empty() || mesh.is_part) return;
    std::vector<bool> used(mesh.face_count, false);
    for (const int32_t face : mesh.faces) used[idx(face)] = true;
    const auto unused = std::find(used.begin(), used.end(), false);
    if (unused != used.end())
        throw Error(PW_ERROR_INDEX, "Face " + std::to_string(unused - used.begin()) +
                                        " has no triangle. The mesh is damaged: export it again.",
                    {.faces = {unused - used.begin(), -1}});
}

Frame Frame::around(std::span<const Point> points) {
    Frame frame{.longest = 0, .scale = 0};
    if (points.empty()) return frame;
    const Box box = Box::around(points);
    frame.origin = box.low;
    frame.longest = box.longest_side();
    frame.scale = frame.longest > 0 ? std::ldexp(1.0, std::ilogb(frame.longest)) : 0;
    return frame;
}

Point Frame::to_working(const Point& p) const {
    const auto working = [&](size_t k) {
        const double x = (p[k] - origin[k]) / scale;
        return std::fabs(x) < least_working ? 0 : x;
    };
    return {working(0), working(1), working(2)};
}

std::vector<Point> Frame::to_working(std::span<const Point> points) const {
    std::vector<Point> working;
    working.reserve(points.size());
    for (const Point& p : points) working.push_back(to_working(p));
    return working;
}

Point Frame::in_cube(const Point& p) const {
    if (longest == 0) return {};
    return {(p[0] - origin[0]) / longest, (p[1] - origin[1]) / longest, (p[2] - origin[2]) / longest};
}

Point Frame::to_caller(const Point& p) const {
    return {p[0] * scale + origin[0], p[1] * scale + origin[1], p[2] * scale + origin[2]};
}

Surface read_mesh(const MeshView& mesh) {
    check_arrays(mesh);
    check_all_faces_used(mesh);
    std::vector<int32_t> used = in_order_of_use(mesh.vertices.size(), mesh.triangles);
    std::ranges::sort(used);
    const Frame frame = Frame::around(points_at(mesh.vertices, used));
    if (frame.longest == 0)
        throw Error(PW_ERROR_DEGENERATE, "All vertices are at the same place. Choose another mesh.");
    if (frame.longest < smallest_model)
        throw Error(PW_ERROR_NOT_FINITE, "The model is too small to be measured. Scale it up.");
    Surface surface = canonical(frame, frame.to_working(mesh.vertices), iota(mesh.vertices.size()),
                                {mesh.triangles.begin(), mesh.triangles.end()}, used);
    if (!mesh.faces.empty())
        for (FaceSample& sample : surface.samples) sample.face = mesh.faces[sample.face];
    surface.face_count = mesh.face_count;
    return surface;
}

Surface canonical(const Frame& frame, std::span<const Point> vertices, std::span<const int32_t> source_vertex,
                  std::span<const Triangle> triangles) {
    Surface surface;
    surface.frame = frame;
    surface.face_count = triangles.size();
    std::vector<int32_t> number(vertices.size());
    for (const int32_t v : order_on_curve(vertices)) {
        number[idx(v)] = static_cast<int32_t>(surface.vertices.size());
        surface.vertices.push_back(vertices[idx(v)]);
        surface.source_vertex.push_back(source_vertex[idx(v)]);
    }
    const auto at = [&](int32_t v) { return surface.vertices[static_cast<size_t>(v)]; };
    double volume6 = 0;  // enclosed
    const auto renumbered = [&](Triangle tri) {
        for (int32_t& v : tri) v = number[static_cast<size_t>(v)];
        return tri;
    };
    for (const Triangle& given : triangles) {
        const Triangle tri = renumbered(given);
        volume6 += dot(cross(at(tri[0]), at(tri[1])), at(tri[2]));
    }
    using Numbered = std::pair<Triangle, int32_t>;
    CsrArray<Numbered> sorted(surface.vertices.size(), [&](const auto& put) {
        for (size_t t = 0; t < triangles.size(); ++t) {
            Triangle tri = renumbered(triangles[t]);
            if (volume6 < 0) std::swap(tri[1], tri[2]);  // inside out
            std::rotate(tri.begin(), std::min_element(tri.begin(), tri.end()), tri.end());
            put(static_cast<size_t>(tri[0]), Numbered(tri, static_cast<int32_t>(t)));
        }
    });
    surface.triangles.reserve(triangles.size());
    surface.samples.reserve(triangles.size());
    for (size_t v = 0; v < surface.vertices.size(); ++v) {
        std::ranges::sort(sorted.row(v));
        for (const auto& [tri, from] : sorted.row(v)) {
            const auto t = static_cast<int32_t>(surface.triangles.size());
            surface.triangles.push_back(tri);
            surface.samples.push_back({from, t, area(at(tri[0]), at(tri[1]), at(tri[2]))});
        }
    }
    return surface;
}

Surface canonical(const Frame& frame, std::span<const Point> vertices, std::span<const int32_t> source_vertex,
                  std::vector<Triangle> triangles, std::span<const int32_t> used) {
    std::vector<int32_t> sources, number(vertices.size(), -1);
    for (const int32_t v : used) {
        number[idx(v)] = static_cast<int32_t>(sources.size());
        sources.push_back(source_vertex[idx(v)]);
    }
    for (Triangle& t : triangles)
        for (int32_t& v : t) v = number[idx(v)];
    return canonical(frame, points_at(vertices, used), sources, triangles);
}

std::vector<int32_t> in_order_of_use(size_t vertices, std::span<const Triangle> triangles) {
    std::vector<uint8_t> is_used(vertices, 0);
    std::vector<int32_t> order;
    for (const Triangle& t : triangles)
        for (const int32_t v : t)
            if (!std::exchange(is_used[idx(v)], 1)) order.push_back(v);
    return order;
}

void check_surface(const Surface& surface, Progress& progress) {
    progress.advance(0.3);
    check_degenerate(surface);
    check_manifold(surface);
    progress.advance(0.5);
    check_self_intersection(surface, progress);
}

pw_status surface_status(const Surface& surface, Progress& progress) {
    try {
        check_surface(surface, progress);
        return PW_OK;
    } catch (const Error& error) {
        if (error.status() == PW_ERROR_CANCELED) throw;
        return error.status();
    }
}

bool crosses_itself(const Surface& surface, Progress& progress) {
    bool crosses = false;
    CrossingSearch(surface.vertices, surface.triangles).for_each_crossing(progress, [&](size_t, size_t) {
        crosses = true;
        return false;
    });
    return crosses;
}

}  // namespace partwheel
