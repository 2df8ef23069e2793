// Vertex clustering on a regular grid.
#include "convex/coarse_tets.h"

#include "base/sorted.h"

namespace partwheel::convex {

namespace {

constexpr size_t n_bisections = 10;

constexpr double most_cells = 1024;  // along the diagonal
constexpr int cell_bits = 11, point_bits = 31;

struct Place {
    uint64_t value;  // the cell, then the point
    uint64_t cell() const { return value >> point_bits; }
    size_t point() const { return value & ((uint64_t{1} << point_bits) - 1); }
    auto operator<=>(const Place&) const = default;
};

// Sorted.
std::vector<Place> sort_by_cell(std::span<const Point> points, const Point& origin, double side) {
    std::vector<Place> places(points.size());
    for (size_t i = 0; i < points.size(); ++i) {
        uint64_t cell = 0;
        for (size_t k = 0; k < 3; ++k) cell = cell << cell_bits | static_cast<uint64_t>((points[i][k] - origin[k]) / side);
        places[i].value = cell << point_bits | i;
    }
    std::sort(places.begin(), places.end());
    return places;
}

}  // namespace

std::vector<int32_t> cluster_vertices(std::span<const Point> points, size_t target_count, Progress& progress) {
    std::vector<int32_t> representative = iota(points.size());
    if (points.size() <= target_count) return representative;
    const Box box = Box::around(points);
    if (!(box.diagonal() > 0)) return representative;
    const Point middle = centroid(points);
    // Bisection between a cell size that gives too many cells and one that gives too few.
    double low = box.diagonal() / most_cells, high = box.diagonal();
    for (size_t i = 0; i < n_bisections; ++i) {
        progress.reach(0);
        const double side = std::sqrt(low * high);
        const auto cells = sort_by_cell(points, box.low, side);
        size_t occupied = 1;
        for (size_t j = 1; j < cells.size(); ++j) occupied += cells[j].cell() != cells[j - 1].cell();
        (occupied > target_count ? low : high) = side;
    }
    const auto cells = sort_by_cell(points, box.low, high);
    for (size_t begin = 0, end = 0; begin < cells.size(); begin = end) {
        // The point farthest from the center.
        size_t best = cells[begin].point();
        double max_distance = -1;
        for (end = begin; end < cells.size() && cells[end].cell() == cells[begin].cell(); ++end) {
            const double distance = length(points[cells[end].point()] - middle);
            if (distance > max_distance) {
                max_distance = distance;
                best = cells[end].point();
            }
        }
        for (size_t i = begin; i < end; ++i) representative[cells[i].point()] = static_cast<int32_t>(best);
    }
    return representative;
}

std::vector<Tetrahedron> coarsen(std::span<const Tetrahedron> tetrahedra, std::span<const int32_t> representative) {
    // [n]: the simplices with n distinct corners, as sorted corners, the last one repeated.
    std::array<std::vector<Tetrahedron>, 5> simplices;
    for (Tetrahedron t : tetrahedra) {
        for (int32_t& v : t) v = representative[idx(v)];
        std::sort(t.begin(), t.end());
        const auto end = std::unique(t.begin(), t.end());
        std::fill(end, t.end(), end[-1]);
        simplices[static_cast<size_t>(end - t.begin())].push_back(t);
    }
    std::vector<Tetrahedron> result, covered;  // covered: faces of simplices with one more corner
    for (size_t corners = 4; corners > 0; --corners) {
        sort_unique(simplices[corners]);
        sort_unique(covered);
        std::set_difference(simplices[corners].begin(), simplices[corners].end(), covered.begin(), covered.end(),
                            std::back_inserter(result));
        std::vector<Tetrahedron> all, facets;
        std::set_union(simplices[corners].begin(), simplices[corners].end(), covered.begin(), covered.end(),
                       std::back_inserter(all));
        for (const Tetrahedron& t : all)
            for (size_t out = 0; corners > 1 && out < corners; ++out) {
                Tetrahedron facet = t;
                std::copy(t.begin() + static_cast<std::ptrdiff_t>(out) + 1, t.end(),
                          facet.begin() + static_cast<std::ptrdiff_t>(out));
                if (out + 1 == corners)
                    std::fill(facet.begin() + static_cast<std::ptrdiff_t>(out), facet.end(), t[out - 1]);
                facets.push_back(facet);
            }
        covered = std::move(facets);
    }
    return result;
}

}  // namespace partwheel::convex
