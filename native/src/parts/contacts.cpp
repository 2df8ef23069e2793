// Contacts between shells, and the tree that joins them.
#include "parts/contacts.h"

#include "base/adjacency.h"
#include "base/corners.h"
#include "base/morton.h"
#include "base/sorted.h"

#include <set>

namespace partwheel {

namespace {

// The finest grid has finest_cells along the diagonal of the bounding box, or fewer so that there are at most
// most_samples samples. Each other grid is half as fine; the coarsest is one cell.
constexpr double finest_cells = 128, most_samples = 400000;

// Vertices of two shells touch if they are closer than this, in diagonals of the bounding box: importers round them.
constexpr double touch_tolerance = 1e-6;

// Weight of contact in a grid, relative to that in the grid half as fine.
constexpr double level_weight = 2;

using Cell = std::array<int32_t, 3>;

Cell cell_of(const Point& p, const Point& origin, double size) {
    Cell cell;
    for (size_t k = 0; k < 3; ++k) cell[k] = static_cast<int32_t>((p[k] - origin[k]) / size);
    return cell;
}

// Calls visit(cell) for the cells of points `first` to `last` of a straight row, by bisection: if both ends of a piece
// are in one cell, so is the rest.
template <class CellOf, class Visit>
void for_each_cell(double first, double last, const CellOf& cell_of_point, const Visit& visit) {
    const Cell from = cell_of_point(first), to = cell_of_point(last);
    visit(from);
    if (from == to) return;
    visit(to);
    const double middle = std::floor((first + last) / 2);
    if (middle == first) return;
    for_each_cell(first, middle, cell_of_point, visit);
    for_each_cell(middle, last, cell_of_point, visit);
}

// Calls visit(cell, shell) for the cells of points spread over each triangle, at most a cell's size apart. Rows of
// points run along the shortest side, so that those of a needle are in few cells.
template <class Function>
void for_each_sample(std::span<const Point> vertices, std::span<const Triangle> triangles,
                     std::span<const int32_t> of_triangle, const Point& origin, double size, const Function& visit) {
    for (size_t t = 0; t < triangles.size(); ++t) {
        std::array<Point, 3> corners = corner_points(vertices, triangles[t]);
        std::ranges::sort(corners);  // so that rounding is the same whichever corner comes first
        const Point a = corners[0], u = corners[1] - a, v = corners[2] - a;
        const std::array<double, 3> sides = {length(u), length(v), length(v - u)};
        const double n = std::max(1.0, std::ceil(*std::ranges::max_element(sides) / size));
        const auto shortest = std::ranges::min_element(sides) - sides.begin();
        for (double row = 0; row <= n; ++row) {
            const auto cell_of_point = [&](double k) {
                const double i = shortest == 0 ? k : shortest == 1 ? row : row - k, j = shortest == 0 ? row : k;
                return cell_of(a + (i / n) * u + (j / n) * v, origin, size);
            };
            const auto visit_cell = [&](const Cell& cell) { visit(cell, of_triangle[t]); };
            for_each_cell(0, shortest == 2 ? row : n - row, cell_of_point, visit_cell);
        }
    }
}

// Pairs of shells, the lower one first, and their contact: the number of cells that both occupy.
using Contacts = std::map<std::pair<int32_t, int32_t>, double>;

// In a cell with more shells than this each is paired with the next one only.
constexpr size_t most_in_cell = 24;

// Morton codes of cells and the shells that occupy them, each pair once, sorted.
using Occupied = std::vector<std::pair<uint64_t, int32_t>>;

uint64_t code_of(const Cell& cell) {
    return morton_code({static_cast<uint64_t>(cell[0]), static_cast<uint64_t>(cell[1]), static_cast<uint64_t>(cell[2])});
}

void add(Occupied& occupied, const Cell& cell, int32_t shell) {
    const std::pair<uint64_t, int32_t> entry = {code_of(cell), shell};
    if (occupied.empty() || occupied.back() != entry) occupied.push_back(entry);
}

Contacts count_shared_cells(const Occupied& occupied) {
    Contacts contacts;
    for (size_t i = 0, end = 0; i < occupied.size(); i = end) {
        while (end < occupied.size() && occupied[end].first == occupied[i].first) ++end;
        for (size_t a = i; a < end; ++a)
            for (size_t b = a + 1; b < (end - i > most_in_cell ? std::min(end, a + 2) : end); ++b)
                ++contacts[{occupied[a].second, occupied[b].second}];
    }
    return contacts;
}

// The cells of the finest grid.
Occupied occupied_cells(std::span<const Point> vertices, std::span<const Triangle> triangles,
                        std::span<const int32_t> of_triangle, const Point& origin, double size) {
    Occupied occupied;
    std::vector<bool> is_occupied;  // by code: whether by the current shell, so that only few are left to sort
    size_t first = 0;               // that the current shell occupies
    for_each_sample(vertices, triangles, of_triangle, origin, size, [&](const Cell& cell, int32_t shell) {
        if (first < occupied.size() && occupied[first].second != shell)
            for (; first < occupied.size(); ++first) is_occupied[occupied[first].first] = false;
        const uint64_t code = code_of(cell);
        if (code >= is_occupied.size()) is_occupied.resize(code + 1);
        if (is_occupied[code]) return;
        is_occupied[code] = true;
        occupied.push_back({code, shell});
    });
    sort_unique(occupied);
    return occupied;
}

// For each shell, its contact with others: a sum over all grids.
std::vector<std::map<int32_t, double>> find_contacts(std::span<const Point> vertices, std::span<const Triangle> triangles,
                                                     std::span<const int32_t> of_triangle, size_t shell_count,
                                                     Progress& progress) {
    Box box;
    double area = 0;
    for (const Triangle& t : triangles) {
        for (const int32_t v : t) box.add(vertices[idx(v)]);
        area += partwheel::area(vertices, t);
    }
    const double finest = std::max(box.diagonal() / finest_cells, std::sqrt(area / most_samples));
    Occupied occupied = occupied_cells(vertices, triangles, of_triangle, box.low, finest);
    std::vector<std::map<int32_t, double>> contacts(shell_count);
    double weight = 1;
    while (true) {
        progress.advance(0);
        for (const auto& [pair, count] : count_shared_cells(occupied)) {
            contacts[idx(pair.first)][pair.second] += weight * count;
            contacts[idx(pair.second)][pair.first] += weight * count;
        }
        if (occupied.back().first == 0) break;
        for (auto& [cell, shell] : occupied) cell >>= 3;  // half of each coordinate
        sort_unique(occupied);
        weight /= level_weight;
    }
    return contacts;
}

// Groups of shells, of which each is named by its lowest shell, and the joins that made them.
class ShellGroups {
public:
    ShellGroups(std::span<const Point> vertices, std::span<const Triangle> triangles, std::span<const int32_t> of_triangle,
                size_t shell_count, Progress& progress)
        : contacts_(find_contacts(vertices, triangles, of_triangle, shell_count, progress)),
          areas_(shell_count, 0), number_(iota(shell_count)), groups_(shell_count) {
        for (size_t t = 0; t < triangles.size(); ++t) areas_[idx(of_triangle[t])] += area(vertices, triangles[t]);
        // Rounded, so that shells that are alike tie in whatever order their triangles are. Relative to a power of two
        // near their sum, so that floats hold the areas of tiny and huge models.
        const double sum = std::accumulate(areas_.begin(), areas_.end(), 0.0);
        const int exponent = sum > 0 ? std::ilogb(sum) : 0;
        for (double& a : areas_) a = static_cast<double>(static_cast<float>(std::ldexp(a, -exponent)));
    }

    // Joins these shells, each alone so far or with others of them, until they are one group: the smallest group first.
    void join(std::span<const int32_t> shells) {
        std::set<std::pair<double, int32_t>> by_area;
        for (const int32_t s : shells) {
            const size_t group = groups_.find(idx(s));
            by_area.insert({areas_[group], static_cast<int32_t>(group)});
        }
        while (by_area.size() > 1) {
            const auto small = idx(by_area.begin()->second);
            by_area.erase(by_area.begin());
            const size_t other = find_partner(small, by_area);
            by_area.erase({areas_[other], static_cast<int32_t>(other)});
            const size_t joined = join(small, other);
            by_area.insert({areas_[joined], static_cast<int32_t>(joined)});
        }
    }

    ShellJoins joins;

private:
    // The group with which a group has most contact for that group's area, or the largest one if it has no contact.
    size_t find_partner(size_t small, const std::set<std::pair<double, int32_t>>& by_area) {
        std::map<int32_t, double> near;  // contacts name shells, of which some are in one group by now
        for (const auto& [shell, contact] : contacts_[small])
            if (const size_t group = groups_.find(idx(shell)); group != small) near[static_cast<int32_t>(group)] += contact;
        size_t other = idx(by_area.rbegin()->second);
        double most = 0;
        for (const auto& [group, contact] : near) {
            const double affinity = contact / areas_[idx(group)];
            if (affinity > most && by_area.contains({areas_[idx(group)], group})) most = affinity, other = idx(group);
        }
        contacts_[small] = std::move(near);
        return other;
    }

    size_t join(size_t small, size_t other) {
        joins.push_back({number_[small], number_[other]});
        std::map<int32_t, double>&near = contacts_[small], &of_other = contacts_[other];
        if (near.size() > of_other.size()) std::swap(near, of_other);
        for (const auto& [shell, contact] : near) of_other[shell] += contact;
        groups_.unite(small, other);
        const size_t joined = std::min(small, other);
        if (joined != other) contacts_[joined] = std::move(of_other);
        areas_[joined] = areas_[small] + areas_[other];
        number_[joined] = static_cast<int32_t>(areas_.size() + joins.size() - 1);
        return joined;
    }

    std::vector<std::map<int32_t, double>> contacts_;  // the next three are valid at the lowest shell of each group
    std::vector<double> areas_;
    std::vector<int32_t> number_;
    UnionFind groups_;
};

// Shells with vertices less than touch_tolerance of the diagonal apart, and those that are connected through such
// shells.
CsrArray<int32_t> find_touching(std::span<const Point> vertices, std::span<const Triangle> triangles,
                                std::span<const int32_t> of_triangle, size_t shell_count) {
    std::vector<int32_t> shell_of_vertex(vertices.size(), -1);
    Box box;
    for (size_t t = 0; t < triangles.size(); ++t)
        for (const int32_t v : triangles[t]) {
            shell_of_vertex[idx(v)] = of_triangle[t];
            box.add(vertices[idx(v)]);
        }
    UnionFind touching(shell_count);
    // Of the two grids that are half a cell apart, on each axis at least one has both vertices in one cell.
    const double size = 2 * touch_tolerance * box.diagonal();
    for (unsigned shift = 0; shift < 8; ++shift) {
        const auto origin = box.low - Point{shift & 1 ? size / 2 : 0, shift & 2 ? size / 2 : 0, shift & 4 ? size / 2 : 0};
        Occupied occupied;
        for (size_t v = 0; v < vertices.size(); ++v)
            if (shell_of_vertex[v] >= 0) add(occupied, cell_of(vertices[v], origin, size), shell_of_vertex[v]);
        sort_unique(occupied);
        for (size_t i = 1; i < occupied.size(); ++i)
            if (occupied[i].first == occupied[i - 1].first) touching.unite(idx(occupied[i].second), idx(occupied[i - 1].second));
    }
    return {shell_count, [&](const auto& put) {
                for (size_t s = 0; s < shell_count; ++s) put(touching.find(s), static_cast<int32_t>(s));
            }};
}

}  // namespace

ShellJoins join_by_contact(std::span<const Point> vertices, std::span<const Triangle> triangles,
                           std::span<const int32_t> of_triangle, size_t shell_count, Progress& progress) {
    ShellGroups groups(vertices, triangles, of_triangle, shell_count, progress);
    const CsrArray<int32_t> touching = find_touching(vertices, triangles, of_triangle, shell_count);
    for (size_t s = 0; s < shell_count; ++s) groups.join(touching.row(s));
    groups.join(iota(shell_count));
    return std::move(groups.joins);
}

double matched_border_share(std::span<const Point> vertices, std::span<const Triangle> triangles,
                            std::span<const int32_t> of_triangle) {
    struct Border {
        Point from, to;
        int32_t shell;
    };
    std::vector<Border> borders;
    Box box;
    double length_of_all = 0;
    for_each_edge(vertices.size(), triangles, [&](int32_t low, std::span<const Side> sides) {
        if (sides.size() != 1) return;
        borders.push_back({vertices[idx(low)], vertices[idx(sides[0].high)], of_triangle[idx(sides[0].number) / 3]});
        for (const Point& p : {borders.back().from, borders.back().to}) box.add(p);
        length_of_all += length(borders.back().to - borders.back().from);
    });
    if (borders.empty()) return 0;
    const double size = std::max(border_tolerance * box.diagonal(), length_of_all / most_samples);
    for (size_t k = 0; k < 3; ++k) box.low[k] -= 2 * size;  // cells are counted from 1
    std::vector<std::pair<Cell, int32_t>> samples;  // and their shells
    Occupied occupied;
    for (const Border& b : borders) {
        const double count = std::ceil(length(b.to - b.from) / size);
        for (double i = 0; i <= count; ++i) {
            const Point p = b.from + (count > 0 ? i / count : 0) * (b.to - b.from);
            samples.emplace_back(cell_of(p, box.low, size), b.shell);
            add(occupied, samples.back().first, b.shell);
        }
    }
    sort_unique(occupied);
    size_t matched = 0;
    for (const auto& [cell, shell] : samples) {
        bool near = false;
        for (int32_t i = 0; i < 27 && !near; ++i) {
            const Cell beside = {cell[0] + i / 9 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i % 3 - 1};
            const uint64_t code = code_of(beside);
            auto o = std::ranges::lower_bound(occupied, std::pair(code, int32_t{0}));
            for (; !near && o != occupied.end() && o->first == code; ++o) near = o->second != shell;
        }
        matched += near;
    }
    return static_cast<double>(matched) / static_cast<double>(samples.size());
}

}  // namespace partwheel
