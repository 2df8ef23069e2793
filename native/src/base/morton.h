// Morton codes: positions on a space-filling curve (Z-order).
#pragma once

#include "base/geometry.h"

namespace partwheel {

inline constexpr int morton_bits = 21;  // per coordinate

// Interleaves the bits of the coordinates, the first one highest.
inline uint64_t morton_code(const std::array<uint64_t, 3>& cell) {
    uint64_t code = 0;
    for (uint64_t n : cell) {  // two zeros after each bit
        n = (n | n << 32) & 0x001f00000000ffff;
        n = (n | n << 16) & 0x001f0000ff0000ff;
        n = (n | n << 8) & 0x100f00f00f00f00f;
        n = (n | n << 4) & 0x10c30c30c30c30c3;
        n = (n | n << 2) & 0x1249249249249249;
        code = code << 1 | n;
    }
    return code;
}

// Of a point in the unit cube, on a grid of 2^bits cells a side.
inline uint64_t morton_code_in_unit_cube(const Point& p, int bits) {
    const auto cell = [&](size_t k) { return static_cast<uint64_t>(std::ldexp(std::max(p[k], 0.0), bits)); };
    return morton_code({cell(0), cell(1), cell(2)});
}

// Of points, through their bounding box. Translation and scaling of the points don't change them, apart from rounding.
inline std::vector<uint64_t> morton_codes(std::span<const Point> points) {
    // The longest side of the box, relative to the grid's. It is no round number, so that models rarely have vertices
    // on borders of cells, where rounding would decide.
    constexpr double share_of_grid = 0.7390851332151607;
    const Box box = Box::around(points);
    const double longest = box.longest_side();
    std::vector<uint64_t> codes;
    codes.reserve(points.size());
    for (const Point& p : points) {
        const auto [x, y, z] = p - box.low;
        const Point in_cube = longest > 0 ? Point{x / longest, y / longest, z / longest} : Point{};
        codes.push_back(morton_code_in_unit_cube(share_of_grid * in_cube, morton_bits));
    }
    return codes;
}

// Points along the curve: by grid cell, then by x, y, z, then by index.
inline std::vector<int32_t> order_on_curve(std::span<const Point> points) {
    std::vector<std::pair<uint64_t, int32_t>> places;
    for (const uint64_t cell : morton_codes(points)) places.emplace_back(cell, static_cast<int32_t>(places.size()));
    std::ranges::sort(places, [&](const auto& a, const auto& b) {
        const Point &p = points[idx(a.second)], &q = points[idx(b.second)];
        return a.first != b.first ? a.first < b.first : p != q ? p < q : a.second < b.second;
    });
    std::vector<int32_t> order;
    for (const auto& [cell, v] : places) order.push_back(v);
    return order;
}

}  // namespace partwheel
