// The saved form of a hierarchy: the arrays from which all others follow, packed as bytes, and their validation.
#pragma once

#include "base/geometry.h"
#include "base/progress.h"
#include "partwheel.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace partwheel {

// A flag in shell_fills: a proxy of the shell was filled.
inline constexpr uint8_t is_proxy = 128;

// Notes consist of these characters.
inline bool is_printable(char c) { return c >= ' ' && c <= '~'; }

struct SavedHierarchy {
    uint32_t fill_method = 0;
    uint64_t components = 0, cavities = 0, added_vertices = 0, proxy_triangles = 0;
    double deviation = 0, hull_volume = 0;
    std::string notes;
    std::vector<int32_t> borders;  // of each merge, the border between two tetrahedra that it removes
    std::vector<double> concavities;
    std::vector<Point> vertices;
    std::vector<int32_t> source;
    std::vector<Tetrahedron> tetrahedra;
    std::vector<int32_t> leaf;
    std::vector<double> face_area;
    std::vector<int32_t> outer_faces;
    std::vector<double> scores;
    std::vector<uint8_t> shell_fills;  // of each shell its pw_fill_method, plus is_proxy

    std::vector<uint8_t> pack(Progress& progress = unobserved_progress()) const;

    // Throws Error(PW_ERROR_DATA) for bytes that pack() does not write. The arrays have matching sizes, no more: see
    // check().
    static SavedHierarchy unpack(std::span<const uint8_t> bytes);

    // Throws Error(PW_ERROR_DATA) unless everything holds that a hierarchy and its queries rely on: a hash can be
    // forged.
    void check() const;
};

}  // namespace partwheel
