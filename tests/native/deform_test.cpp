// Deformation: memory, and the same result for any number of threads.
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

}  // namespace
}  // namespace partwheel::test
