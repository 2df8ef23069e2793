// Deformation: rigid motions, energy, constraints, refusals, memory; geodesic distances.
#include "edit/deform.h"

#include "support/alone.h"
#include "support/mesh_view.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <new>

namespace {
std::atomic<size_t> allocations{0};
}

// Counts allocations: a mouse move must not allocate. Not inlined, or g++ would warn about new and free().
[[gnu::noinline]] void* operator new(size_t size) {
    ++allocations;
    if (void* p = std::malloc(size ? size : 1)) return p;
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(size_t size, const std::nothrow_t&) noexcept {  // std::stable_sort's
    ++allocations;
    return std::malloc(size ? size : 1);
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, size_t) noexcept { std::free(p); }

namespace partwheel::test {
namespace {

// A square grid of n x n vertices in the plane z = 0, side 1 a cell, bent a little.
struct Sheet {
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;
    std::vector<int32_t> roles;
};

Sheet sheet(int n) {
    Sheet s;
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y) {
            s.vertices.push_back({double(x), double(y), 0.1 * std::sin(x + 0.5 * y)});
            s.roles.push_back(x == 0 ? PW_VERTEX_FIXED : x == n - 1 ? 0 : PW_VERTEX_FREE);
        }
    for (int x = 0; x + 1 < n; ++x)
        for (int y = 0; y + 1 < n; ++y) {
            const int32_t a = x * n + y, b = a + n, c = b + 1, d = a + 1;
            s.triangles.push_back({a, b, c});
            s.triangles.push_back({a, c, d});
        }
    return s;
}

// A rotation about the axis along z through (2, 3, 0), and a translation.
Affine turn(double degrees) {
    const double angle = degrees * std::acos(-1.0) / 180, c = std::cos(angle), s = std::sin(angle);
    return {c, -s, 0, 2 - (c * 2 - s * 3), s, c, 0, 3 - (s * 2 + c * 3), 0, 0, 1, 0.5};
}

double distance(const Point& a, const Point& b) {
    const Point d = a - b;
    return std::sqrt(dot(d, d));
}

std::vector<Point> positions(const Deformation& deformation) {
    std::vector<Point> out(deformation.vertex_count());
    deformation.positions(out);
    return out;
}

TEST(Deform, MovingAllocatesNothing) {
    for (const int n : {20, 80}) {  // the larger one in four threads
        const Sheet s = sheet(n);
        Deformation deformation(s.vertices, s.triangles, s.roles, 4);
        std::vector<Point> out(s.vertices.size());
        const size_t before = allocations;
        deformation.move(0, turn(170));  // far enough for the SVD
        deformation.iterate(5);
        deformation.positions(out);
        EXPECT_GE(deformation.energy(), 0);
        EXPECT_EQ(allocations, before);
    }
}

TEST(Deform, ResultsDoNotDependOnThreads) {
    const Sheet s = sheet(80);
    std::vector<std::vector<Point>> results;
    std::vector<double> energies;
    for (const size_t threads : {1, 2, 5}) {
        Deformation deformation(s.vertices, s.triangles, s.roles, threads);
        for (const double degrees : {20.0, 45.0, 170.0}) {
            deformation.move(0, turn(degrees));
            deformation.iterate(3);
        }
        results.push_back(positions(deformation));
        energies.push_back(deformation.energy());
    }
    EXPECT_EQ(results, std::vector(3, results[0]));
    EXPECT_EQ(energies, std::vector(3, energies[0]));
}

TEST(Deform, HandleMatricesMayBeSingularOrMirrored) {
    const Sheet s = sheet(10);
    Deformation deformation(s.vertices, s.triangles, s.roles);
    for (const Affine& m : {Affine{-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, Affine{1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
                            Affine{}, Affine{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}}) {
        deformation.move(0, m);
        deformation.iterate(3);
        for (const Point& p : positions(deformation))
            for (const double x : p) EXPECT_LT(std::abs(x), 100);
    }
}

TEST(Deform, PointLikeShapes) {
    Sheet s = sheet(6);
    for (const double flat : {0.0, 1e-12}) {
        for (Point& p : s.vertices) p = {p[0], flat * p[1], 0};  // all triangles on one line
        Deformation line(s.vertices, s.triangles, s.roles);
        line.move(0, turn(40));
        line.iterate(5);
        for (const Point& p : positions(line))
            for (const double x : p) EXPECT_LT(std::abs(x), 100);
    }
    for (Point& p : s.vertices) p = {3, 4, 5};
    Deformation point(s.vertices, s.triangles, s.roles);
    point.move(0, turn(40));
    point.iterate(5);
    for (const Point& p : positions(point)) EXPECT_LT(distance(p, {3, 4, 5}), 10);
}

// ---- The C functions

using Handle = std::unique_ptr<pw_deformation, void (*)(pw_deformation*)>;

pw_status create(const Sheet& s, pw_deformation** made) {
    const pw_mesh_view mesh = test::mesh_view(s.vertices[0].data(), s.vertices.size(), s.triangles[0].data(),
                                              s.triangles.size());
    return pw_deformation_create(nullptr, &mesh, s.roles.data(), 0, made);
}

TEST(Deform, ApiChecksItsArguments) {
    const Sheet s = sheet(5);
    pw_deformation* made = nullptr;
    const double* vertices = s.vertices[0].data();
    const int32_t* triangles = s.triangles[0].data();
    const size_t v = s.vertices.size(), t = s.triangles.size();
    const auto status = [&](const double* points, size_t point_count, const int32_t* corners, size_t corner_count,
                            const int32_t* roles, int32_t threads, pw_deformation** out) {
        const pw_mesh_view mesh = test::mesh_view(points, point_count, corners, corner_count);
        return pw_deformation_create(nullptr, &mesh, roles, threads, out);
    };
    const int32_t* roles = s.roles.data();
    EXPECT_EQ(status(nullptr, v, triangles, t, roles, 0, &made), PW_ERROR_ARGUMENT);
    EXPECT_EQ(status(vertices, v, nullptr, t, roles, 0, &made), PW_ERROR_ARGUMENT);
    EXPECT_EQ(status(vertices, v, triangles, t, nullptr, 0, &made), PW_ERROR_ARGUMENT);
    EXPECT_EQ(status(vertices, v, triangles, t, roles, -1, &made), PW_ERROR_ARGUMENT);
    EXPECT_EQ(status(vertices, v, triangles, t, roles, 0, nullptr), PW_ERROR_ARGUMENT);
    EXPECT_EQ(pw_deformation_create(nullptr, nullptr, roles, 0, &made), PW_ERROR_ARGUMENT);
    EXPECT_EQ(status(vertices, v, triangles, 0, roles, 0, &made), PW_ERROR_EMPTY);
    EXPECT_EQ(status(vertices, 0, triangles, t, roles, 0, &made), PW_ERROR_EMPTY);
    EXPECT_EQ(status(vertices, v - 1, triangles, t, roles, 0, &made), PW_ERROR_INDEX);
    for (const int32_t role : {-3, 1, std::numeric_limits<int32_t>::max(), std::numeric_limits<int32_t>::min()}) {
        Sheet bad = s;
        for (int32_t& each : bad.roles) each = each == 0 ? role : each;
        EXPECT_EQ(create(bad, &made), PW_ERROR_ARGUMENT) << role;
        EXPECT_STRNE(pw_error_message(), "");
    }
    for (const double x : {std::nan(""), HUGE_VAL, 1e101}) {
        Sheet bad = s;
        bad.vertices[7][1] = x;
        EXPECT_EQ(create(bad, &made), PW_ERROR_NOT_FINITE);
    }
    Sheet whole = s;
    whole.roles.assign(v, 0);
    EXPECT_EQ(create(whole, &made), PW_ERROR_ARGUMENT);
    EXPECT_EQ(made, nullptr);

    ASSERT_EQ(create(s, &made), PW_OK);
    const Handle handle(made, pw_deformation_free);
    const Affine good = turn(20), bad{HUGE_VAL};
    std::vector<double> out(3 * v);
    double energy = 0;
    EXPECT_EQ(pw_deformation_move(nullptr, 0, good.data()), PW_ERROR_ARGUMENT);
    EXPECT_EQ(pw_deformation_move(made, 0, nullptr), PW_ERROR_ARGUMENT);
    EXPECT_EQ(pw_deformation_move(made, 1, good.data()), PW_ERROR_ARGUMENT);
    EXPECT_EQ(pw_deformation_move(made, 0, bad.data()), PW_ERROR_NOT_FINITE);
    EXPECT_EQ(pw_deformation_iterate(nullptr, nullptr, 1), PW_ERROR_ARGUMENT);
    EXPECT_EQ(pw_deformation_energy(made, nullptr), PW_ERROR_ARGUMENT);
    EXPECT_EQ(pw_deformation_energy(nullptr, &energy), PW_ERROR_ARGUMENT);
    EXPECT_EQ(pw_deformation_positions(made, nullptr, v), PW_ERROR_ARGUMENT);
    EXPECT_EQ(pw_deformation_positions(made, out.data(), v + 1), PW_ERROR_ARGUMENT);
    EXPECT_EQ(pw_deformation_positions(nullptr, out.data(), v), PW_ERROR_ARGUMENT);
    EXPECT_EQ(pw_deformation_reset(nullptr), PW_ERROR_ARGUMENT);
    pw_deformation_free(nullptr);

    EXPECT_EQ(pw_deformation_positions(made, out.data(), v), PW_OK);
    EXPECT_TRUE(std::equal(out.begin(), out.end(), vertices));
    EXPECT_EQ(pw_deformation_move(made, 0, good.data()), PW_OK);
    EXPECT_EQ(pw_deformation_iterate(nullptr, made, 3), PW_OK);
    EXPECT_EQ(pw_deformation_energy(made, &energy), PW_OK);
    EXPECT_GT(energy, 0);
    EXPECT_EQ(pw_deformation_reset(made), PW_OK);
    EXPECT_EQ(pw_deformation_positions(made, out.data(), v), PW_OK);
    EXPECT_TRUE(std::equal(out.begin(), out.end(), vertices));
}

TEST(Deform, WorksWithoutFurtherThreads) {
    const Sheet s = sheet(80);
    const auto deformed = [&] {
        std::vector<Point> out(s.vertices.size());
        pw_deformation* made = nullptr;
        if (create(s, &made) != PW_OK) {
            std::fprintf(stderr, "%s\n", pw_error_message());
            return out;
        }
        const Handle handle(made, pw_deformation_free);
        EXPECT_EQ(pw_deformation_move(made, 0, turn(40).data()), PW_OK);
        EXPECT_EQ(pw_deformation_iterate(nullptr, made, 3), PW_OK);
        EXPECT_EQ(pw_deformation_positions(made, out[0].data(), out.size()), PW_OK);
        return out;
    };
    const std::vector<Point> with_threads = deformed();
    EXPECT_NE(with_threads, s.vertices);
    expect_holds_alone([&] { return deformed() == with_threads; });
}

}  // namespace
}  // namespace partwheel::test
