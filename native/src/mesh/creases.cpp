// Creases of hard surfaces: sharp dihedral edges, on shells most of whose area lies in flat polygons.
#include "mesh/creases.h"

#include "base/corners.h"

namespace partwheel {

namespace {

constexpr double min_flat_cosine = 0.99985;  // 1 degree, between the normals of triangles of one flat polygon
constexpr double min_flat_share = 0.6;       // of the area of a shell with a hard surface
constexpr double max_crease_cosine = 0.643;  // 50 degrees: sharper than between the sides of an octagonal tube

struct ShellSums {
    double area = 0, flat_area = 0, volume = 0;
    Point moment{};  // area x center
};

// An edge between two triangles of a shell.
struct DihedralEdge {
    std::array<int32_t, 2> ends;
    size_t shell;
    double turn;  // below 0: concave, if the normals point outward
};

class CreaseFinder {
public:
    CreaseFinder(const MeshView& mesh, const Shells& shells) : mesh_(mesh), shells_(shells), sums_(shells.count) {
        for (size_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto [a, b, c] = corners(t);
            const Point n = cross(b - a, c - a);
            const double twice = length(n);
            normals_.push_back(twice > 0 ? 1 / twice * n : Point{});
            areas_.push_back(twice / 2);
            sums_of(t).area += areas_[t];
            sums_of(t).moment = sums_of(t).moment + areas_[t] / 3 * (a + b + c);
        }
    }

    std::vector<std::array<int32_t, 2>> find() {
        const std::vector<DihedralEdge> edges = find_sharp_edges();
        // Relative to the center of the surface, so that the volume of an open shell has a sign, too.
        for (size_t t = 0; t < areas_.size(); ++t) {
            if (!(areas_[t] > 0)) continue;
            const auto [a, b, c] = corners(t);
            const Point center = 1 / sums_of(t).area * sums_of(t).moment;
            sums_of(t).volume += areas_[t] / 3 * dot(normals_[t], 1.0 / 3 * (a + b + c) - center);
        }
        std::vector<std::array<int32_t, 2>> creases;
        for (const DihedralEdge& edge : edges) {
            const ShellSums& sums = sums_[edge.shell];
            if (sums.flat_area >= min_flat_share * sums.area && edge.turn * sums.volume < 0) creases.push_back(edge.ends);
        }
        return creases;
    }

private:
    std::array<Point, 3> corners(size_t t) const { return corner_points(mesh_.vertices, mesh_.triangles[t]); }
    ShellSums& sums_of(size_t t) { return sums_[idx(shells_.of_triangle[t])]; }

    // The edges of more than 50 degrees between triangles that are oriented alike. Also measures the flat areas.
    std::vector<DihedralEdge> find_sharp_edges() {
        std::vector<DihedralEdge> edges;
        std::vector<bool> is_flat(areas_.size(), false);
        for_each_welded_edge(mesh_, shells_, [&](int32_t low, std::span<const Side> sides) {
            for (size_t i = 1; i < sides.size(); ++i) {
                const size_t s = idx(sides[i - 1].number / 3), t = idx(sides[i].number / 3);
                if (sides[i - 1].is_ascending == sides[i].is_ascending || !(areas_[s] > 0) || !(areas_[t] > 0)) continue;
                const double cosine = dot(normals_[s], normals_[t]);
                if (cosine > min_flat_cosine) is_flat[s] = is_flat[t] = true;
                if (cosine > max_crease_cosine) continue;
                const Point along = mesh_.vertices[idx(sides[i].high)] - mesh_.vertices[idx(low)];
                const double turn = dot(cross(normals_[s], normals_[t]), along);
                edges.push_back({{low, sides[i].high}, idx(shells_.of_triangle[s]), sides[i - 1].is_ascending ? turn : -turn});
            }
        });
        for (size_t t = 0; t < areas_.size(); ++t)
            if (is_flat[t]) sums_of(t).flat_area += areas_[t];
        return edges;
    }

    const MeshView& mesh_;
    const Shells& shells_;
    std::vector<Point> normals_;  // of each triangle, unit; 0: it has no area
    std::vector<double> areas_;
    std::vector<ShellSums> sums_;
};

}  // namespace

std::vector<std::array<int32_t, 2>> find_creases(const MeshView& mesh, const Shells& shells) {
    return CreaseFinder(mesh, shells).find();
}

}  // namespace partwheel
