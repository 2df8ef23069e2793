// Tetrahedra inside a closed surface, by TetGen.
#include "fill/tetrahedra.h"

#include "base/adjacency.h"
#include "base/elementary.h"
#include "base/error.h"
#include "base/predicates.h"
#include "fill/tetgen_host.h"

#include <tetgen.h>

#include <random>

namespace {

constexpr uint64_t calls_per_poll = 4096;

// Most models take about so many of TetGen's calls per vertex. Only progress bars depend on it.
constexpr double usual_calls_per_vertex = 100;

// State of this thread's call of TetGen. In one variable, since each access to a thread's variable is a call.
struct TetgenState {
    uint32_t random = 1;
    uint64_t steps = 0, most_steps = 0, improves_until = 0, polls = 0;
    partwheel::Progress* progress = nullptr;
    double share_per_poll = 0;

    void poll() {
        if (++polls % calls_per_poll == 0) progress->advance_by(share_per_poll);
    }
};
thread_local constinit TetgenState tetgen_state;

// The share of the most steps that may improve tetrahedra. Of 500 fillings of shells of game assets, 5 don't end improving; the
// others take at most an eighth.
constexpr uint64_t improving_divisor = 5;

[[noreturn]] void throw_too_many_steps() {  // from inside TetGen
    throw partwheel::Error(PW_ERROR_TETRAHEDRA,
                           "The mesh can't be filled: the mesher does not finish. Remesh or smooth it a little and try again.");
}

}  // namespace

int partwheel_tetgen_printf(const char*, ...) { return 0; }

void partwheel_tetgen_srand(unsigned seed) { tetgen_state.random = seed % 2147483646u + 1; }

int partwheel_tetgen_rand() {  // Park and Miller's generator
    uint32_t& random = tetgen_state.random;
    random = static_cast<uint32_t>(uint64_t{random} * 48271 % 2147483647);
    return static_cast<int>(random);
}

double partwheel_tetgen_orient3d(double* a, double* b, double* c, double* d) {
    TetgenState& state = tetgen_state;
    if (++state.steps > state.most_steps) throw_too_many_steps();
    state.poll();
    return orient3d(a, b, c, d);
}

void partwheel_tetgen_poll() { tetgen_state.poll(); }

void partwheel_tetgen_begin_improving() {
    tetgen_state.improves_until = tetgen_state.steps + tetgen_state.most_steps / improving_divisor;
}

bool partwheel_tetgen_must_end_improving() {  // false before it begins
    return tetgen_state.improves_until != 0 && tetgen_state.steps >= tetgen_state.improves_until;
}

double partwheel_tetgen_acos(double cosine) {
    return partwheel::angle_of(std::sqrt((1 - cosine) * (1 + cosine)), cosine);
}

double partwheel_tetgen_cos(double angle) { return partwheel::unit_vector(angle).cosine; }

double partwheel_tetgen_log(double x) { return partwheel::log_of(x); }

namespace partwheel {

namespace {

[[noreturn]] void throw_lost() {
    throw Error(PW_ERROR_TETRAHEDRA,
                "The mesher lost a part of the surface. Remesh or smooth the mesh a little and try again.");
}

[[noreturn]] void throw_failure(int code) {
    switch (code) {
        case 1: throw Error(PW_ERROR_MEMORY, "There is not enough memory to fill this mesh. Decimate it first.");
        case 3:
        case 4:
        case 5:
            throw Error(PW_ERROR_TETRAHEDRA,
                        "The mesh can't be filled: some faces are too close together to be told apart. Merge vertices "
                        "by distance, or move the parts that almost touch further apart.");
        case 200: throw_lost();
        default:
            throw Error(PW_ERROR_TETRAHEDRA, "The mesh can't be filled (TetGen ended with code " +
                                                 std::to_string(code) +
                                                 "). Remesh or smooth it a little and try again.");
    }
}

// The order in which TetGen gets vertices and triangles: unchanged for 0, else a shuffle that is the same on every
// machine.
struct InputOrder {
    std::vector<int32_t> vertices, triangles;

    InputOrder(const Surface& surface, uint64_t shuffle)
        : vertices(iota(surface.vertices.size())), triangles(iota(surface.triangles.size())) {
        std::mt19937_64 random(shuffle);
        for (auto* order : {&vertices, &triangles})
            for (size_t i = order->size(); shuffle != 0 && i > 1; --i) std::swap((*order)[i - 1], (*order)[random() % i]);
    }
};

// Limit of TetGen's steps, which are calls of orient3d(), per vertex (plus 100 vertices), unless quality is given. Of
// 172 clean models none took more than 120 without added points inside. Of 481 shells of assets that were filled none
// took more than 645, but two of CGAL's models need more than 750 (anchor.off, pipe.off).
constexpr uint64_t max_steps_per_vertex = 1000;

// TetGen's options. Its text switches are not used: it parses their numbers by the host's locale.
tetgenbehavior tetgen_options(double quality) {
    tetgenbehavior b;
    b.plc = 1;
    b.nobisect = 2;             // keeps the surface; ends where points on it are left
    b.collinear_ang_tol = 180;  // check_surface() has tested for intersections
    b.quiet = 1;
    b.nofacewritten = 1;  // its own code for boundary faces is unsafe
    b.neighout = 1;
    if (quality > 0) {
        b.quality = 1;
        b.minratio = quality;
        b.mindihedral = 0;
    } else {
        b.optmaxdihedral = 179.9;  // flatter tetrahedra are flipped, or split by points inside
    }
    return b;
}

void run_tetgen(const Surface& surface, const InputOrder& order, double quality, tetgenio& out, Progress& progress) {
    tetgenio in;
    in.firstnumber = 0;
    in.numberofpoints = static_cast<int>(surface.vertices.size());
    in.pointlist = new REAL[3 * surface.vertices.size()];
    std::vector<int32_t> place(surface.vertices.size());
    for (size_t i = 0; i < order.vertices.size(); ++i) {
        const auto v = static_cast<size_t>(order.vertices[i]);
        place[v] = static_cast<int32_t>(i);
        std::copy_n(surface.vertices[v].begin(), 3, in.pointlist + 3 * i);
    }
    in.facetlist = new tetgenio::facet[surface.triangles.size()];
    in.numberoffacets = static_cast<int>(surface.triangles.size());
    // Initializes all facets before any owns memory, so that `in` can always be destroyed.
    for (size_t i = 0; i < surface.triangles.size(); ++i) tetgenio::init(&in.facetlist[i]);
    for (size_t i = 0; i < order.triangles.size(); ++i) {
        tetgenio::facet& f = in.facetlist[i];
        f.polygonlist = new tetgenio::polygon[1];
        f.numberofpolygons = 1;
        tetgenio::polygon& p = f.polygonlist[0];
        tetgenio::init(&p);
        p.vertexlist = new int[3];
        p.numberofvertices = 3;
        const Triangle& t = surface.triangles[static_cast<size_t>(order.triangles[i])];
        for (size_t k = 0; k < 3; ++k) p.vertexlist[k] = place[static_cast<size_t>(t[k])];
    }
    tetgenbehavior b = tetgen_options(quality);
    partwheel_tetgen_srand(1);
    tetgen_state.steps = tetgen_state.improves_until = 0;
    tetgen_state.most_steps =
        quality > 0 ? std::numeric_limits<uint64_t>::max() : max_steps_per_vertex * (surface.vertices.size() + 100);
    tetgen_state.progress = &progress;
    tetgen_state.share_per_poll =
        std::min(0.5, 2 * calls_per_poll / (usual_calls_per_vertex * static_cast<double>(surface.vertices.size() + 100)));
    try {
        tetrahedralize(&b, &in, &out);
    } catch (int code) {
        throw_failure(code);
    }
    if (out.numberoftetrahedra <= 0 || !out.tetrahedronlist || !out.neighborlist) throw_failure(2);
    check_tetrahedron_count(static_cast<size_t>(out.numberoftetrahedra));
}

constexpr size_t tets_between_polls = 65536;  // between two checks for cancellation

// All of TetGen's tetrahedra, even those in cavities, in canonical order.
TetMesh read_tetgen(const Surface& surface, const InputOrder& order, const tetgenio& out, Progress& progress) {
    const auto points = static_cast<size_t>(out.numberofpoints), tets = static_cast<size_t>(out.numberoftetrahedra);
    const size_t given = surface.vertices.size();
    std::vector<Point> vertices = surface.vertices;
    bool is_unchanged = points >= given;
    for (size_t i = 0; i < points && is_unchanged; ++i) {
        const REAL* p = out.pointlist + 3 * i;
        const Point point = {p[0], p[1], p[2]};
        if (i < given)
            is_unchanged = point == surface.vertices[static_cast<size_t>(order.vertices[i])];
        else
            vertices.push_back(point);
    }
    if (!is_unchanged)
        throw Error(PW_ERROR_TETRAHEDRA, "The mesher moved or merged vertices of the surface, because some are too "
                                         "close together. Merge vertices by distance.");

    std::vector<std::array<Corner, 4>> read(tets);
    for (size_t i = 0; i < tets; ++i) {
        if (i % tets_between_polls == 0) progress.advance(0.9);
        const int* corners = out.tetrahedronlist + i * static_cast<size_t>(out.numberofcorners);
        const int* beyond = out.neighborlist + 4 * i;
        for (size_t k = 0; k < 4; ++k) {
            const bool added = static_cast<size_t>(corners[k]) >= given;
            read[i][k] = {added ? corners[k] : order.vertices[static_cast<size_t>(corners[k])], beyond[k]};
        }
    }
    return canonical(std::move(vertices), std::move(read), progress);
}

// A facet of a tetrahedron that is a triangle of the surface.
struct Wall {
    int32_t triangle = -1;
    bool behind = false;  // whether the tetrahedron is on the inner side
};

// The walls opposite the corners of each tetrahedron.
std::vector<std::array<Wall, 4>> find_walls(const Surface& surface, const TetMesh& mesh, Progress& progress) {
    // Grouped by the corner with the fewest triangles, because a fan's triangles all have one corner in common.
    std::vector<size_t> degree(mesh.vertices.size(), 0);
    for (const Triangle& t : surface.triangles)
        for (const int32_t v : t) ++degree[idx(v)];
    const auto from_rarest = [&](Triangle t) {
        const auto rarest = std::ranges::min_element(t, {}, [&](int32_t v) { return std::pair(degree[idx(v)], v); });
        std::rotate(t.begin(), rarest, t.end());
        return t;
    };
    struct Corners {
        int32_t triangle, second, third;
    };
    const CsrArray<Corners> by_rarest(mesh.vertices.size(), [&](const auto& put) {
        for (size_t t = 0; t < surface.triangles.size(); ++t) {
            const auto [first, second, third] = from_rarest(surface.triangles[t]);
            put(idx(first), Corners{static_cast<int32_t>(t), second, third});
        }
    });
    std::vector<std::array<Wall, 4>> walls(mesh.tetrahedra.size());
    for (size_t tet = 0; tet < walls.size(); ++tet) {
        if (tet % tets_between_polls == 0) progress.advance(0.95);
        for (size_t k = 0; k < 4; ++k) {
            const Triangle f = from_rarest(facet(mesh.tetrahedra[tet], k));
            for (const Corners& c : by_rarest.row(idx(f[0]))) {
                const bool behind = c.second == f[1] && c.third == f[2];
                if (!behind && (c.second != f[2] || c.third != f[1])) continue;
                walls[tet][k] = {c.triangle, behind};
                break;
            }
        }
    }
    return walls;
}

// The winding number of the surface around each tetrahedron: 0 outside, one more behind each triangle.
std::vector<int32_t> winding_numbers(const TetMesh& mesh, const std::vector<std::array<Wall, 4>>& walls,
                                     size_t& empty_regions) {
    constexpr int32_t unknown = std::numeric_limits<int32_t>::min();
    const auto step = [](const Wall& wall) { return wall.triangle < 0 ? 0 : wall.behind ? 1 : -1; };
    std::vector<int32_t> winding(mesh.tetrahedra.size(), unknown);

    // Visits one region after the other, so that those with winding number 0 can be counted.
    std::vector<int32_t> next_regions, region;
    for (size_t t = 0; t < walls.size(); ++t)
        for (size_t k = 0; k < 4; ++k)
            if (mesh.neighbors[t][k] < 0) {
                if (walls[t][k].triangle < 0) throw_lost();
                winding[t] = step(walls[t][k]);
                next_regions.push_back(static_cast<int32_t>(t));
            }
    std::vector<bool> visited(mesh.tetrahedra.size(), false);
    empty_regions = 0;
    for (size_t i = 0; i < next_regions.size(); ++i) {
        const int32_t seed = next_regions[i];
        if (visited[static_cast<size_t>(seed)]) continue;
        if (winding[static_cast<size_t>(seed)] == 0) ++empty_regions;
        visited[static_cast<size_t>(seed)] = true;
        region.assign(1, seed);
        while (!region.empty()) {
            const auto t = static_cast<size_t>(region.back());
            region.pop_back();
            for (size_t k = 0; k < 4; ++k) {
                const int32_t n = mesh.neighbors[t][k];
                if (n < 0) continue;
                const auto other = static_cast<size_t>(n);
                const int32_t expected = winding[t] - step(walls[t][k]);
                if (winding[other] == unknown)
                    winding[other] = expected;
                else if (winding[other] != expected)
                    throw_lost();
                if (visited[other]) continue;
                if (walls[t][k].triangle < 0) {
                    visited[other] = true;
                    region.push_back(n);
                } else {
                    next_regions.push_back(n);
                }
            }
        }
    }
    return winding;
}

// Removes the tetrahedra outside the solid and finds the one behind each triangle.
void keep_solid(const Surface& surface, TetMesh& mesh, Progress& progress) {
    const std::vector<std::array<Wall, 4>> walls = find_walls(surface, mesh, progress);
    const std::vector<int32_t> winding = winding_numbers(mesh, walls, mesh.cavities);
    progress.advance(0.95);

    std::vector<int32_t> number(mesh.tetrahedra.size(), -1);
    size_t kept = 0;
    for (size_t t = 0; t < number.size(); ++t)
        if (winding[t] != 0) number[t] = static_cast<int32_t>(kept++);
    if (kept == 0) throw Error(PW_ERROR_NO_VOLUME, "The surface encloses no volume. Give it some thickness.");

    mesh.tet_of_triangle.assign(surface.triangles.size(), -1);
    for (size_t t = 0; t < number.size(); ++t) {
        if (number[t] < 0) continue;
        for (size_t k = 0; k < 4; ++k) {
            const int32_t triangle = walls[t][k].triangle;
            if (triangle < 0) continue;
            int32_t& owner = mesh.tet_of_triangle[static_cast<size_t>(triangle)];
            if (owner < 0 || walls[t][k].behind) owner = number[t];
        }
    }
    if (std::find(mesh.tet_of_triangle.begin(), mesh.tet_of_triangle.end(), -1) != mesh.tet_of_triangle.end())
        throw_lost();
    for (size_t t = 0; t < number.size(); ++t) {
        if (number[t] < 0) continue;
        const auto to = static_cast<size_t>(number[t]);
        mesh.tetrahedra[to] = mesh.tetrahedra[t];
        for (size_t k = 0; k < 4; ++k) {
            const int32_t n = mesh.neighbors[t][k];
            mesh.neighbors[to][k] = n < 0 ? -1 : number[static_cast<size_t>(n)];
        }
    }
    mesh.tetrahedra.resize(kept);
    mesh.neighbors.resize(kept);

    // Removes points that TetGen added in cavities.
    const auto given = static_cast<int32_t>(surface.vertices.size());
    std::vector<int32_t> place(mesh.vertices.size(), -1);
    for (const Tetrahedron& t : mesh.tetrahedra)
        for (int32_t v : t) place[static_cast<size_t>(v)] = v;
    int32_t next = given;
    for (size_t v = surface.vertices.size(); v < place.size(); ++v) {
        if (place[v] < 0) continue;
        mesh.vertices[static_cast<size_t>(next)] = mesh.vertices[v];
        place[v] = next++;
    }
    mesh.vertices.resize(static_cast<size_t>(next));
    for (Tetrahedron& t : mesh.tetrahedra)
        for (int32_t& v : t) v = place[static_cast<size_t>(v)];
}

}  // namespace

TetMesh canonical(std::vector<Point> vertices, std::vector<std::array<Corner, 4>> corners, Progress& progress,
                  std::vector<int32_t>* number) {
    for (auto& c : corners) std::ranges::sort(c, {}, &Corner::vertex);
    CsrArray<int32_t> by_lowest(vertices.size(), [&](const auto& put) {
        for (size_t i = 0; i < corners.size(); ++i) put(idx(corners[i][0].vertex), static_cast<int32_t>(i));
    });
    const auto rest = [&](int32_t t) {
        const auto& c = corners[idx(t)];
        return std::array{c[1].vertex, c[2].vertex, c[3].vertex};
    };
    for (size_t v = 0; v < vertices.size(); ++v) std::ranges::sort(by_lowest.row(v), {}, rest);
    const std::span<const int32_t> sorted = by_lowest.items();
    progress.advance(0.9);
    std::vector<int32_t> place(corners.size());
    for (size_t i = 0; i < corners.size(); ++i) place[idx(sorted[i])] = static_cast<int32_t>(i);
    TetMesh mesh;
    mesh.vertices = std::move(vertices);
    for (const int32_t i : sorted) {
        if (mesh.tetrahedra.size() % tets_between_polls == 0) progress.advance(0.9);
        std::array<Corner, 4> c = corners[idx(i)];
        const auto point = [&](size_t k) { return mesh.vertices[idx(c[k].vertex)]; };
        if (orientation(point(0), point(1), point(2), point(3)) < 0) std::swap(c[2], c[3]);
        mesh.tetrahedra.push_back({c[0].vertex, c[1].vertex, c[2].vertex, c[3].vertex});
        const auto across = [&](size_t k) { return c[k].beyond < 0 ? -1 : place[idx(c[k].beyond)]; };
        mesh.neighbors.push_back({across(0), across(1), across(2), across(3)});
    }
    if (number) *number = std::move(place);
    return mesh;
}

Solid canonical(const Frame& frame, Filling filling, std::span<const int32_t> on_surface, Progress& progress) {
    std::vector<int32_t> place = iota(filling.vertices.size());
    Solid solid;
    solid.surface_from_tetrahedra = true;
    solid.surface = canonical(frame, filling.vertices, place, std::move(filling.triangles), on_surface);
    // Vertices as the surface has them, then those that are inside alone.
    std::vector<Point> points = solid.surface.vertices;
    std::ranges::fill(place, -1);
    for (size_t v = 0; v < points.size(); ++v) place[idx(solid.surface.source_vertex[v])] = static_cast<int32_t>(v);
    for (std::array<Corner, 4>& corners : filling.corners)
        for (Corner& corner : corners) {
            int32_t& n = place[idx(corner.vertex)];
            if (n < 0) {
                n = static_cast<int32_t>(points.size());
                points.push_back(filling.vertices[idx(corner.vertex)]);
            }
            corner.vertex = n;
        }
    std::vector<int32_t> tet_place;
    solid.mesh = canonical(std::move(points), std::move(filling.corners), progress, &tet_place);
    for (const FaceSample& sample : solid.surface.samples)
        solid.mesh.tet_of_triangle.push_back(tet_place[idx(filling.behind[idx(sample.face)])]);
    return solid;
}

// TetGen sometimes fails, or leaves a point that it had to add on the surface. That depends on the order of its input:
// another order usually helps, at the latest the third.
TetMesh tetrahedralize(const Surface& surface, double quality, Progress& progress) {
    constexpr uint64_t attempts = 4;
    constexpr double attempt_share = 0.7;  // of what is left of the stage
    for (uint64_t attempt = 0;; ++attempt) {
        const double done = progress.part();  // by other attempts, also of other fill methods
        const Progress::Section section(progress, done, done + attempt_share * (1 - done));
        try {
            const InputOrder order(surface, attempt);
            tetgenio out;
            run_tetgen(surface, order, quality, out, progress);
            progress.advance(0.9);
            TetMesh mesh = read_tetgen(surface, order, out, progress);
            keep_solid(surface, mesh, progress);
            progress.advance(1);
            return mesh;
        } catch (const Error& e) {
            if (e.status() != PW_ERROR_TETRAHEDRA || attempt + 1 == attempts) throw;
        }
    }
}

}  // namespace partwheel
