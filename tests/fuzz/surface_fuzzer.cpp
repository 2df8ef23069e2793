// Fuzzer of what is done with a surface, good or bad: normals, distances, polygons' faults, fairing, borders moved to
// creases and deformation. Each is refused by name, or keeps what the header promises.
//
//   byte 0      a bit each: polygons of two triangles, far away, tiny, huge
//   bytes 1, 2  number of vertices, of triangles
//   3 a vertex, 3 a corner: see bytes.h
//   1 a vertex  its role: modulo 8 a handle below 2, else free up to 5, else fixed; or from 240 on a role that is none
//   1 a face    whether it is in the part: the lowest bit
//   1 + 12 a move of a handle: which, and its matrix, in 1/32 beside the identity, or wild
#include "bytes.h"
#include "partwheel_edit.h"
#include "support/mesh_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <set>
#include <string>
#include <vector>

using namespace partwheel;
using namespace partwheel::test;

namespace {

struct Input {
    TriMesh mesh;
    std::vector<int32_t> roles;
    std::vector<uint8_t> part;
    struct Move {
        size_t handle;
        std::array<double, 12> matrix;
    };
    std::vector<Move> moves;
    bool ordinary = true;  // no number so large or small that sums of squares lose it
};

Input read(const uint8_t* data, size_t size) {
    Bytes bytes(data, size);
    const int flags = bytes.next();
    const size_t vertices = bytes.next(), triangles = bytes.next();
    const double unit = flags & 4 ? 1e-85 : flags & 8 ? 1e80 : 1;
    Input input;
    input.mesh = bytes.mesh(vertices, triangles, flags & 2 ? 1e5 : 0, unit);
    if (flags & 1) pair_triangles(input.mesh);
    for (size_t v = 0; v < vertices; ++v) {
        const int byte = bytes.next(), role = byte % 8;
        input.roles.push_back(byte >= 240 ? byte - 243 : role < 2 ? role : role < 6 ? PW_VERTEX_FREE : PW_VERTEX_FIXED);
    }
    for (size_t f = 0; f < input.mesh.face_count; ++f) input.part.push_back(bytes.next() & 1);
    while (bytes.left() >= 13) {
        Input::Move move{bytes.next() % size_t{3}, {}};
        for (size_t k = 0; k < 12; ++k) move.matrix[k] = (k % 5 == 0 ? 1 : 0) + bytes.coordinate(0, 1.0 / 32);
        input.moves.push_back(move);
    }
    const auto moderate = [](double x) { return x == 0 || (std::fabs(x) > 1e-6 && std::fabs(x) < 1e6); };
    for (const Point& p : input.mesh.vertices) input.ordinary = input.ordinary && std::ranges::all_of(p, moderate);
    for (const auto& m : input.moves) input.ordinary = input.ordinary && std::ranges::all_of(m.matrix, moderate);
    return input;
}

bool refused(pw_status status, std::set<pw_status> documented) {
    if (status == PW_OK) return false;
    EXPECT_TRUE(documented.contains(status)) << pw_status_name(status) << ": " << pw_error_message();
    EXPECT_TRUE(std::string(pw_error_message()).ends_with('.')) << pw_error_message();
    return true;
}

class Any {
public:
    explicit Any(const Input& input) : input_(input), mesh_(input.mesh), view_(mesh_view(input.mesh)) {}

    bool normals() const {
        std::vector<Point> normal(mesh_.vertices.size(), Point{7, 7, 7});
        if (refused(pw_vertex_normals(&view_, out(normal)), broken))
            return false;
        for (const Point& n : normal) EXPECT_TRUE(n == Point{} || std::fabs(length(n) - 1) < 1e-12);
        return true;
    }

    bool distances() const {
        std::vector<double> distance(count(), -7);
        const std::vector<uint8_t> start = where(0);
        if (refused(pw_surface_distances(nullptr, &view_, start.data(), distance.data()), broken))
            return false;
        for (size_t v = 0; v < count(); ++v) EXPECT_TRUE(start[v] ? distance[v] == 0 : distance[v] >= 0);
        return true;
    }

    bool faults() const {
        std::vector<int32_t> begin(mesh_.triangles.size());
        for (size_t t = 0; t < begin.size(); ++t) begin[t] = static_cast<int32_t>(3 * t);
        size_t non_manifold_edges = 0, inconsistent_edges = 0, non_manifold_vertices = 0;
        if (refused(pw_polygon_faults(triangles(), 3 * mesh_.triangles.size(), begin.data(), begin.size(), count(),
                                      &non_manifold_edges, &inconsistent_edges, &non_manifold_vertices),
                    {PW_ERROR_INDEX}))
            return false;
        EXPECT_LE(non_manifold_edges + inconsistent_edges, 3 * mesh_.triangles.size());
        EXPECT_LE(non_manifold_vertices, count());
        return true;
    }

    // Along all sides of the triangles.
    bool fair() const {
        std::vector<int32_t> edges;
        for (const Triangle& t : mesh_.triangles)
            for (size_t k = 0; k < 3; ++k) edges.insert(edges.end(), {t[k], t[(k + 1) % 3]});
        const std::vector<uint8_t> free = where(PW_VERTEX_FREE);
        std::vector<Point> places = mesh_.vertices;
        if (refused(pw_fair_vertices(nullptr, vertices(), count(), edges.data(), edges.size() / 2, free.data(), out(places)),
                    {PW_ERROR_INDEX, PW_ERROR_NOT_FINITE, PW_ERROR_INTERNAL}))
            return false;
        for (size_t v = 0; v < count(); ++v) {
            EXPECT_TRUE(free[v] || places[v] == mesh_.vertices[v]) << "a fixed vertex moved";
            EXPECT_TRUE(!input_.ordinary || std::isfinite(length(places[v])));
        }
        return true;
    }

    bool snap() const {
        pw_creases* creases = nullptr;
        if (refused(pw_creases_create(nullptr, &view_, &creases), broken)) {
            EXPECT_EQ(creases, nullptr);
            return false;
        }
        const std::unique_ptr<pw_creases, void (*)(pw_creases*)> owner(creases, pw_creases_free);
        std::vector<uint8_t> moved(input_.part.size(), 7), in_place = input_.part;
        const pw_status status = pw_creases_snap(creases, input_.part.data(), moved.size(), moved.data());
        const auto all = static_cast<std::ptrdiff_t>(moved.size()), faces = std::ranges::count(input_.part, 1);
        EXPECT_EQ(status, faces == 0 ? PW_ERROR_EMPTY : PW_OK);
        if (status != PW_OK) return false;
        EXPECT_EQ(pw_creases_snap(creases, in_place.data(), in_place.size(), in_place.data()), PW_OK);
        EXPECT_EQ(moved, in_place);
        const auto left = std::ranges::count(moved, 1);
        EXPECT_EQ(left + std::ranges::count(moved, 0), all);
        EXPECT_TRUE(left > 0 && (left < all) == (faces < all)) << "all or nothing is left";
        return moved != input_.part;
    }

    bool deform() const {
        pw_deformation* made = nullptr;
        std::set<pw_status> documented = broken;
        documented.insert(PW_ERROR_DEGENERATE);
        if (refused(pw_deformation_create(nullptr, &view_, input_.roles.data(), 0, &made), documented)) {
            EXPECT_EQ(made, nullptr);
            return false;
        }
        const std::unique_ptr<pw_deformation, void (*)(pw_deformation*)> owner(made, pw_deformation_free);
        EXPECT_EQ(positions(made), mesh_.vertices);
        for (const Input::Move& move : input_.moves) {
            if (refused(pw_deformation_move(made, move.handle, move.matrix.data()),
                        {PW_ERROR_ARGUMENT, PW_ERROR_NOT_FINITE}))
                continue;
            double before = energy(made);
            for (int turn = 0; turn < 3; ++turn) {
                EXPECT_EQ(pw_deformation_iterate(nullptr, made, 1), PW_OK);
                const double after = energy(made);
                if (input_.ordinary) {
                    EXPECT_LE(after, before + 1e-6 * (1 + std::fabs(before))) << "an iteration raised the energy";
                }
                before = after;
            }
        }
        const std::vector<Point> now = positions(made);
        for (size_t v = 0; v < count(); ++v) {
            EXPECT_TRUE(input_.roles[v] != PW_VERTEX_FIXED || now[v] == mesh_.vertices[v]) << "a fixed vertex moved";
            EXPECT_TRUE(!input_.ordinary || std::isfinite(length(now[v])));
        }
        EXPECT_EQ(pw_deformation_reset(made), PW_OK);
        EXPECT_EQ(positions(made), mesh_.vertices);
        return !input_.moves.empty();
    }

private:
    size_t count() const { return mesh_.vertices.size(); }
    const double* vertices() const { return mesh_.vertices.empty() ? nullptr : mesh_.vertex_data(); }
    const int32_t* triangles() const { return mesh_.triangles.empty() ? nullptr : mesh_.triangle_data(); }
    static double* out(std::vector<Point>& points) { return points.empty() ? nullptr : points.data()->data(); }

    std::vector<uint8_t> where(int32_t role) const {
        std::vector<uint8_t> is;
        for (const int32_t each : input_.roles) is.push_back(each == role);
        return is;
    }
    std::vector<Point> positions(pw_deformation* made) const {
        std::vector<Point> now(count());
        EXPECT_EQ(pw_deformation_positions(made, out(now), now.size()), PW_OK);
        return now;
    }
    static double energy(pw_deformation* made) {
        double energy = -1;
        EXPECT_EQ(pw_deformation_energy(made, &energy), PW_OK);
        return energy;
    }

    inline static const std::set<pw_status> broken = {PW_ERROR_EMPTY, PW_ERROR_INDEX, PW_ERROR_NOT_FINITE,
                                                      PW_ERROR_ARGUMENT};
    const Input& input_;
    const TriMesh& mesh_;
    const pw_mesh_view view_;
};

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    GTEST_FLAG_SET(throw_on_failure, true);  // out of the fuzzer: a crash for libFuzzer
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const Input input = read(data, size);
    const Any surface(input);
    const bool done[] = {surface.normals(), surface.distances(), surface.faults(),
                         surface.fair(),    surface.snap(),      surface.deform()};
    if (std::getenv("PARTWHEEL_FUZZ_REPORT")) {  // for the test that seeds reach the code that they should
        const char* names[] = {"normals", "distances", "faults", "fair", "snapped", "deformed"};
        std::fprintf(stderr, "input:");
        for (size_t k = 0; k < std::size(names); ++k)
            if (done[k]) std::fprintf(stderr, " %s", names[k]);
        std::fprintf(stderr, "\n");
    }
    return 0;
}
