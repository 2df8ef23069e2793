// The two halves of a tet mesh: planes tried on a sample of it.
#include "halves.h"

#include "geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace partwheel {

namespace {

// One tetrahedron in so many is asked where the middle is, and what a plane cuts: so many planes in each direction,
// with no less than half but this part of the tetrahedra on either side.
constexpr size_t sample = 16, planes = 7;
constexpr double off_middle = 0.01;

struct Sampled {
    Point own;
    std::array<Point, 4> neighbours;  // its own again where there is none
};

struct Plane {
    size_t cut = 0;
    double place = 0;
};

// Four times a tetrahedron's centroid.
Point middle(const TetMesh& mesh, size_t t) {
    Point sum = {};
    for (const int32_t v : mesh.tetrahedra[t])
        for (size_t k = 0; k < 3; ++k) sum[k] += mesh.vertices[static_cast<size_t>(v)][k];
    return sum;
}

Plane best_plane(const std::vector<Sampled>& sampled, const Point& direction) {
    std::vector<double> places;
    places.reserve(sampled.size());
    for (const Sampled& s : sampled) places.push_back(dot(s.own, direction));
    const auto quantile = [&](double part) {
        const auto at = places.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(places.size()));
        std::nth_element(places.begin(), at, places.end());
        return *at;
    };
    const double first = quantile(0.5 - off_middle), last = quantile(0.5 + off_middle);
    std::array<Plane, planes> tried;
    for (size_t k = 0; k < planes; ++k) tried[k].place = std::lerp(first, last, static_cast<double>(k) / (planes - 1));
    for (const auto& [own, neighbours] : sampled) {
        const double from = dot(own, direction);
        for (const Point& neighbour : neighbours) {
            const auto [low, high] = std::minmax({from, dot(neighbour, direction)});
            if (low < last && high >= first)
                for (Plane& plane : tried) plane.cut += low < plane.place && plane.place <= high;
        }
    }
    return std::ranges::min(tried, {}, &Plane::cut);
}

}  // namespace

std::vector<uint8_t> halves(const TetMesh& mesh) {
    std::vector<Sampled> sampled;
    for (size_t t = 0; t < mesh.tetrahedra.size(); t += sample) {
        auto& [own, neighbours] = sampled.emplace_back();
        neighbours.fill(own = middle(mesh, t));
        for (size_t k = 0; k < 4; ++k)
            if (const int32_t n = mesh.neighbours[t][k]; n >= 0) neighbours[k] = middle(mesh, static_cast<size_t>(n));
    }
    Plane best;
    Point normal = {};
    for (size_t i = 0; i < lattice_directions; ++i) {
        const Plane plane = best_plane(sampled, lattice_direction(i));
        if (i == 0 || plane.cut < best.cut) {
            best = plane;
            normal = lattice_direction(i);
        }
    }
    std::vector<uint8_t> half(mesh.tetrahedra.size());
    for (size_t t = 0; t < half.size(); ++t) half[t] = dot(middle(mesh, t), normal) < best.place ? 0 : 1;
    return half;
}

}  // namespace partwheel
