// Vertex clustering on a regular grid.
#include "convex/coarse_tets.h"

#include "base/sorted.h"

#include <algorithm>
#include <utility>

namespace partwheel::convex {

namespace {

constexpr size_t n_bisections = 10;

// (cell, point), sorted.
std::vector<std::pair<std::array<int32_t, 3>, int32_t>> sort_by_cell(std::span<const Point> points, const Point& origin,
                                                                  double side) {
    std::vector<std::pair<std::array<int32_t, 3>, int32_t>> cells(points.size());
    for (size_t i = 0; i < points.size(); ++i) {
        for (size_t k = 0; k < 3; ++k)
            cells[i].first[k] = static_cast<int32_t>((points[i][k] - origin[k]) / side);
        cells[i].second = static_cast<int32_t>(i);
    }
    std::sort(cells.begin(), cells.end());
    return cells;
}

}  // namespace

std::vector<int32_t> cluster_vertices(std::span<const Point> points, size_t target_count, Progress& progress) {
    std::vector<int32_t> representative(points.size());
    for (size_t i = 0; i < representative.size(); ++i) representative[i] = static_cast<int32_t>(i);
    if (points.size() <= target_count) return representative;
    const Box box = Box::around(points);
    if (!(box.diagonal() > 0)) return representative;
    Point middle{};
    for (const Point& p : points) middle = middle + 1 / static_cast<double>(points.size()) * p;
    // Bisection between a cell size that gives too many cells and one that gives too few.
    double low = box.diagonal() / 1024, high = box.diagonal();
    for (size_t i = 0; i < n_bisections; ++i) {
        progress.reach(0);
        const double side = std::sqrt(low * high);
        const auto cells = sort_by_cell(points, box.low, side);
        size_t occupied = 1;
        for (size_t j = 1; j < cells.size(); ++j) occupied += cells[j].first != cells[j - 1].first;
        (occupied > target_count ? low : high) = side;
    }
    const auto cells = sort_by_cell(points, box.low, high);
    for (size_t begin = 0, end = 0; begin < cells.size(); begin = end) {
        // The point farthest from the center.
        int32_t best = cells[begin].second;
        double max_distance = -1;
        for (end = begin; end < cells.size() && cells[end].first == cells[begin].first; ++end) {
            const double distance = length(points[idx(cells[end].second)] - middle);
            if (distance > max_distance) {
                max_distance = distance;
                best = cells[end].second;
            }
        }
        for (size_t i = begin; i < end; ++i) representative[idx(cells[i].second)] = best;
    }
    return representative;
}

std::vector<Tetrahedron> coarsen(std::span<const Tetrahedron> tetrahedra, std::span<const int32_t> representative) {
    // By the number of distinct corners; sorted corners, the last one repeated.
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
