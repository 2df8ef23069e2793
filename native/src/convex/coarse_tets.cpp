// Vertex clustering: points of one cell become one.
#include "convex/coarse_tets.h"

#include <algorithm>
#include <utility>

namespace partwheel::convex {

namespace {

constexpr size_t trials = 10;

// Each point's cell, and it.
std::vector<std::pair<std::array<int32_t, 3>, int32_t>> in_cells(std::span<const Point> points, const Point& origin,
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

std::vector<int32_t> representatives(std::span<const Point> points, size_t wanted) {
    std::vector<int32_t> of(points.size());
    for (size_t i = 0; i < of.size(); ++i) of[i] = static_cast<int32_t>(i);
    if (points.size() <= wanted) return of;
    const Box box = Box::around(points);
    if (!(box.diagonal() > 0)) return of;
    Point middle{};
    for (const Point& p : points) middle = middle + 1 / static_cast<double>(points.size()) * p;
    // The sides of cells of which there are too many and too few.
    double low = box.diagonal() / 1024, high = box.diagonal();
    for (size_t i = 0; i < trials; ++i) {
        const double side = std::sqrt(low * high);
        const auto cells = in_cells(points, box.low, side);
        size_t occupied = 1;
        for (size_t j = 1; j < cells.size(); ++j) occupied += cells[j].first != cells[j - 1].first;
        (occupied > wanted ? low : high) = side;
    }
    const auto cells = in_cells(points, box.low, high);
    for (size_t begin = 0, end = 0; begin < cells.size(); begin = end) {
        // The one farthest out.
        int32_t best = cells[begin].second;
        double farthest = -1;
        for (end = begin; end < cells.size() && cells[end].first == cells[begin].first; ++end) {
            const double away = length(points[idx(cells[end].second)] - middle);
            if (away > farthest) {
                farthest = away;
                best = cells[end].second;
            }
        }
        for (size_t i = begin; i < end; ++i) of[idx(cells[i].second)] = best;
    }
    return of;
}

std::vector<Tetrahedron> coarse(std::span<const Tetrahedron> tetrahedra, std::span<const int32_t> representative) {
    // By how many corners are left, in rising order; the last is repeated.
    std::array<std::vector<Tetrahedron>, 5> simplices;
    for (Tetrahedron t : tetrahedra) {
        for (int32_t& v : t) v = representative[idx(v)];
        std::sort(t.begin(), t.end());
        const auto end = std::unique(t.begin(), t.end());
        std::fill(end, t.end(), end[-1]);
        simplices[static_cast<size_t>(end - t.begin())].push_back(t);
    }
    std::vector<Tetrahedron> made, covered;  // covered: facets of those of one corner more
    for (size_t corners = 4; corners > 0; --corners) {
        const auto only_once = [](std::vector<Tetrahedron>& some) {
            std::sort(some.begin(), some.end());
            some.erase(std::unique(some.begin(), some.end()), some.end());
        };
        only_once(simplices[corners]);
        only_once(covered);
        std::set_difference(simplices[corners].begin(), simplices[corners].end(), covered.begin(), covered.end(),
                            std::back_inserter(made));
        std::vector<Tetrahedron> all, facets;
        std::set_union(simplices[corners].begin(), simplices[corners].end(), covered.begin(), covered.end(),
                       std::back_inserter(all));
        for (const Tetrahedron& t : all)
            for (size_t out = 0; corners > 1 && out < corners; ++out) {
                Tetrahedron facet = t;
                std::copy(t.begin() + static_cast<std::ptrdiff_t>(out) + 1, t.end(),
                          facet.begin() + static_cast<std::ptrdiff_t>(out));
                if (out + 1 == corners) std::fill(facet.begin() + static_cast<std::ptrdiff_t>(out), facet.end(), t[out - 1]);
                facets.push_back(facet);
            }
        covered = std::move(facets);
    }
    return made;
}

}  // namespace partwheel::convex
