// Bytes of a fuzzer taken as the numbers of a small mesh: coordinates on a grid, some of them wild, and indices that
// may lie beside.
#pragma once

#include "support/shapes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace partwheel::test {

class Bytes {
public:
    Bytes(const uint8_t* data, size_t size) : next_(data), end_(data + size) {}

    size_t left() const { return static_cast<size_t>(end_ - next_); }
    uint8_t next() { return next_ < end_ ? *next_++ : uint8_t{0}; }

    // A byte - 120, or from 240 on one of the wild ones.
    double coordinate(double shift, double unit) {
        const int byte = next();
        return byte < first_wild ? (byte - 120 + shift) * unit : wild[static_cast<size_t>(byte - first_wild)];
    }

    // A byte modulo count, or from 240 on an index that does not exist.
    int32_t index(size_t count) {
        const int byte = next();
        if (byte >= first_wild) return missing[static_cast<size_t>(byte - first_wild)];
        return count == 0 ? 0 : byte % static_cast<int>(count);
    }

    // So many vertices, then triangles for as long as there are bytes, at most so many.
    TriMesh mesh(size_t vertices, size_t most_triangles, double shift, double unit) {
        TriMesh mesh;
        mesh.name = "fuzzed";
        for (size_t v = 0; v < vertices; ++v)
            for (double& c : mesh.vertices.emplace_back()) c = coordinate(shift, unit);
        while (left() >= 3 && mesh.triangles.size() < most_triangles)
            for (int32_t& corner : mesh.triangles.emplace_back()) corner = index(vertices);
        mesh.face_count = mesh.triangles.size();
        return mesh;
    }

private:
    static constexpr int first_wild = 240;
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    static constexpr std::array<double, 16> wild = {
        std::numeric_limits<double>::quiet_NaN(), infinity, -infinity, 1e308, -1e101, 1e100, 1e20, 0.5, 1.0 / 3, 1e-9,
        -1e-16, 1e-80, 1e-300, 5e-324, -0.0, 119.99999};
    static constexpr std::array<int32_t, 16> missing = {
        -1, -2, std::numeric_limits<int32_t>::min(), std::numeric_limits<int32_t>::max(), 1000, 70000, 256, 255, -255,
        1 << 30, 12345, 999999999, 1000000000, 1 << 16, -(1 << 16), 300};

    const uint8_t* next_;
    const uint8_t* end_;
};

// Two triangles each, one after the other, are a polygon.
inline void pair_triangles(TriMesh& mesh) {
    mesh.faces.clear();
    for (size_t t = 0; t < mesh.triangles.size(); ++t) mesh.faces.push_back(static_cast<int32_t>(t / 2));
    mesh.face_count = (mesh.triangles.size() + 1) / 2;
}

}  // namespace partwheel::test
