// The cells of a surface: the regions that its triangles enclose.
#include "fill/cells.h"

#include "base/adjacency.h"
#include "base/corners.h"
#include "base/predicates.h"
#include "fill/winding.h"
#include "mesh/duplicates.h"
#include "mesh/face_assignment.h"
#include "mesh/nearest.h"
#include "prepare/soup_repair.h"

#include <set>

namespace partwheel {

namespace {

// Triangle t has two sides: 2 t in front, where its normal points, and 2 t + 1 behind.
size_t triangle_of(size_t side) { return side / 2; }
size_t other_side(size_t side) { return side ^ 1; }

// The corners of a side's triangle, counterclockwise seen from the other side: as the region at this side has them.
Triangle outward(const Surface& surface, size_t side) {
    Triangle corners = surface.triangles[triangle_of(side)];
    if (side % 2 == 0) std::swap(corners[1], corners[2]);
    return corners;
}

bool is_degenerate(const Surface& surface) {
    return std::ranges::any_of(surface.triangles, [&](const Triangle& t) {
        return collinear(surface.vertices[idx(t[0])], surface.vertices[idx(t[1])], surface.vertices[idx(t[2])]);
    });
}

// Sorts the triangles at an edge by their angle around it, from that of the first one on. No two may overlap.
void sort_around_edge(const Surface& surface, int32_t low, std::vector<Side>& sides) {
    const auto apex = [&](const Side& side) -> const Point& {
        return surface.vertices[idx(surface.triangles[idx(side.number) / 3][idx(side.number + 2) % 3])];
    };
    const Point &from = surface.vertices[idx(low)], &to = surface.vertices[idx(sides[0].high)], &start = apex(sides[0]);
    std::vector<std::pair<int, Side>> by_half;  // after the first one: 1 below half a turn, 2 at it, 3 above
    for (const Side& side : std::span(sides).subspan(1)) by_half.emplace_back(2 - orientation(from, to, start, apex(side)), side);
    std::ranges::sort(by_half, [&](const auto& a, const auto& b) {
        return a.first != b.first ? a.first < b.first : orientation(from, to, apex(a.second), apex(b.second)) > 0;
    });
    std::ranges::transform(by_half, sides.begin() + 1, [](const auto& entry) { return entry.second; });
}

// The sides of triangles, in components that a walk around edges connects. Each is one boundary of a region.
UnionFind connect_sides(const Surface& surface, const std::vector<bool>& is_kept) {
    UnionFind boundaries(2 * surface.triangles.size());
    std::vector<Side> around;
    for_each_edge(surface.vertices.size(), surface.triangles, [&](int32_t low, std::span<const Side> sides) {
        around.clear();
        std::ranges::copy_if(sides, std::back_inserter(around), [&](const Side& s) { return is_kept[idx(s.number) / 3]; });
        if (around.size() > 2) sort_around_edge(surface, low, around);
        for (size_t i = 0; i < around.size(); ++i) {  // the turn leaves an ascending triangle on its front
            const Side &a = around[i], &b = around[(i + 1) % around.size()];
            boundaries.unite(2 * (idx(a.number) / 3) + (a.is_ascending ? 0 : 1),
                             2 * (idx(b.number) / 3) + (b.is_ascending ? 1 : 0));
        }
    });
    return boundaries;
}

// The triangles at these sides as a surface. Triangle i of the result has samples[i].face: its place among the sides.
// Vertices have as source_vertex their number in `surface`.
Surface extract(const Surface& surface, std::span<const size_t> sides) {
    std::vector<Point> vertices;
    std::vector<int32_t> source_vertex;
    std::map<int32_t, int32_t> number;
    std::vector<Triangle> triangles;
    for (const size_t side : sides)
        for (int32_t& v : triangles.emplace_back(outward(surface, side))) {
            const auto [entry, is_new] = number.try_emplace(v, static_cast<int32_t>(vertices.size()));
            if (is_new) {
                vertices.push_back(surface.vertices[idx(v)]);
                source_vertex.push_back(v);
            }
            v = entry->second;
        }
    return canonical(surface.frame, vertices, source_vertex, triangles);
}

// Most pairs of boundaries that are compared where some are nested.
constexpr size_t max_compared_boundaries = 10000000;

// The regions into which a surface divides space, and which of them are solid. Triangles with the same region on both
// sides enclose nothing, and are left out.
class EnclosedRegions {
public:
    explicit EnclosedRegions(const Surface& source)
        : source_(source), is_kept_(source.triangles.size(), true), all_(connect_sides(source, is_kept_)),
          regions_(0), state_(2 * source.triangles.size(), unknown) {
        for (size_t t = 0; t < is_kept_.size(); ++t) is_kept_[t] = all_.find(2 * t) != all_.find(2 * t + 1);
        regions_ = connect_sides(source, is_kept_);
        is_clear_ = join_nested();
        if (is_clear_) classify();
    }

    bool is_clear() const { return is_clear_; }  // false: rounding hides which region is which
    bool is_kept(size_t triangle) const { return is_kept_[triangle]; }
    bool is_solid(size_t side) { return is_kept_[triangle_of(side)] && state_[regions_.find(side)] == solid; }
    size_t cavities() const { return static_cast<size_t>(std::ranges::count(state_, cavity)); }

    // The sides of each solid region.
    std::vector<std::vector<size_t>> solids() {
        std::map<size_t, std::vector<size_t>> sides;
        for_sides([&](size_t side) {
            if (is_solid(side)) sides[regions_.find(side)].push_back(side);
        });
        std::vector<std::vector<size_t>> result;
        for (auto& [region, own] : sides) result.push_back(std::move(own));
        return result;
    }

    // A side of each triangle that was left out around the solid, not inside it.
    std::vector<size_t> outer_sheets() {
        std::vector<bool> is_inside(state_.size(), false);
        for_sides([&](size_t side) {
            if (state_[regions_.find(side)] != outside) is_inside[all_.find(side)] = true;
        });
        std::vector<size_t> sheets;
        for (size_t t = 0; t < is_kept_.size(); ++t)
            if (!is_kept_[t] && !is_inside[all_.find(2 * t)]) sheets.push_back(2 * t);
        return sheets;
    }

private:
    enum State : uint8_t { unknown, outside, solid, cavity };

    struct Boundary {
        size_t side;
        std::vector<Triangle> triangles;
        Box box;
        double volume6 = 0;  // enclosed; below 0 if the region is around it
    };

    template <class Visit>
    void for_sides(const Visit& visit) const {
        for (size_t side = 0; side < 2 * is_kept_.size(); ++side)
            if (is_kept_[triangle_of(side)]) visit(side);
    }

    std::vector<Boundary> find_boundaries() {
        std::vector<Boundary> boundaries;
        std::vector<int32_t> number(state_.size(), -1);
        for_sides([&](size_t side) {
            int32_t& n = number[regions_.find(side)];
            if (n < 0) {
                n = static_cast<int32_t>(boundaries.size());
                boundaries.push_back({side, {}, {}});
            }
            Boundary& boundary = boundaries[idx(n)];
            const Triangle c = boundary.triangles.emplace_back(outward(source_, side));
            const auto point = [&](size_t k) -> const Point& { return source_.vertices[idx(c[k])]; };
            for (size_t k = 0; k < 3; ++k) boundary.box.add(point(k));
            boundary.volume6 += dot(cross(point(0), point(1)), point(2));
        });
        return boundaries;
    }

    // Unites the boundaries of each region. Each connected set of triangles has one boundary toward the region around
    // it, with negative volume; its other boundaries enclose regions. Returns false if rounding hides this.
    bool join_nested() {
        const std::vector<Boundary> boundaries = find_boundaries();
        UnionFind connected = regions_;
        for_sides([&](size_t side) { connected.unite(side, other_side(side)); });
        std::vector<size_t> around, enclosing;
        std::set<size_t> known;
        for (size_t b = 0; b < boundaries.size(); ++b) {
            (boundaries[b].volume6 < 0 ? around : enclosing).push_back(b);
            if (boundaries[b].volume6 < 0 && !known.insert(connected.find(boundaries[b].side)).second) return false;
        }
        for (const size_t b : enclosing)
            if (!known.contains(connected.find(boundaries[b].side))) return false;
        if (around.size() > 1 && around.size() * enclosing.size() > max_compared_boundaries) return false;
        std::ranges::stable_sort(enclosing, {}, [&](size_t b) { return boundaries[b].volume6; });
        std::map<size_t, WindingNumber> winding;
        outside_ = state_.size();
        for (const size_t inner : around) {
            const Point middle = centroid(source_.vertices, boundaries[inner].triangles.front());
            const auto encloses = [&](size_t outer) {
                if (around.size() == 1 || !boundaries[outer].box.contains(middle)) return false;
                if (connected.find(boundaries[outer].side) == connected.find(boundaries[inner].side)) return false;
                return winding.try_emplace(outer, source_.vertices, boundaries[outer].triangles).first->second.at(middle) > 0.5;
            };
            const auto outer = std::ranges::find_if(enclosing, encloses);
            if (outer != enclosing.end())
                regions_.unite(boundaries[inner].side, boundaries[*outer].side);
            else if (outside_ == state_.size())
                outside_ = boundaries[inner].side;
            else
                regions_.unite(outside_, boundaries[inner].side);
        }
        return outside_ < state_.size();
    }

    // Regions next to the outside are solid, whatever their orientation. From there inward: a region next to a cavity
    // is solid; any other region is a cavity if all triangles around it face it, which agrees with the winding number.
    void classify() {
        const size_t outermost = regions_.find(outside_);
        double facing_outward = 0;  // the area of outer triangles that face outward, minus that of the others
        for_sides([&](size_t side) {
            const double area = source_.samples[triangle_of(side)].area;
            if (regions_.find(side) == outermost) facing_outward += side % 2 == 0 ? area : -area;
        });
        std::vector<bool> faces_away(state_.size(), false), is_beside_empty(state_.size(), false);
        for_sides([&](size_t side) {
            if ((side % 2 == 1) == (facing_outward > 0)) faces_away[regions_.find(side)] = true;
        });
        const CsrArray<size_t> neighbors(state_.size(), [&](const auto& put) {
            for_sides([&](size_t side) { put(regions_.find(side), regions_.find(other_side(side))); });
        });
        state_[outermost] = outside;
        for (std::vector<size_t> front = {outermost}; !front.empty();) {
            std::vector<size_t> next;
            for (const size_t region : std::exchange(front, {}))
                for (const size_t other : neighbors.row(region)) {
                    if (state_[other] != unknown) continue;
                    next.push_back(other);
                    if (state_[region] != solid) is_beside_empty[other] = true;
                }
            for (const size_t region : next) {
                if (state_[region] != unknown) continue;
                state_[region] = is_beside_empty[region] || faces_away[region] ? solid : cavity;
                front.push_back(region);
            }
        }
    }

    const Surface& source_;
    std::vector<bool> is_kept_;
    UnionFind all_;      // boundaries of regions, before triangles were left out
    UnionFind regions_;  // sides of the triangles that are left
    std::vector<State> state_;  // of each region, at its lowest side
    size_t outside_ = 0;        // a side of the outermost region
    bool is_clear_ = false;
};

// The tetrahedra of all solid regions. Each has its own copies of vertices, also where it touches itself.
class RegionFill {
public:
    explicit RegionFill(const Surface& source) : source_(source) {}

    void add(EnclosedRegions& regions, const std::vector<size_t>& sides, double quality, Progress& progress) {
        const Surface cell = extract(source_, sides);
        const TetMesh mesh = tetrahedralize(cell, quality, progress);
        // Corners of tetrahedra at a vertex share a copy of it if steps across facets connect them.
        const auto corner_of = [&](size_t tet, int32_t vertex) {
            return static_cast<size_t>(std::ranges::find(mesh.tetrahedra[tet], vertex) - mesh.tetrahedra[tet].begin());
        };
        UnionFind fans(4 * mesh.tetrahedra.size());
        for (size_t t = 0; t < mesh.tetrahedra.size(); ++t)
            for (size_t k = 0; k < 4; ++k)
                for (size_t c = 0; c < 4 && mesh.neighbors[t][k] >= 0; ++c)
                    if (c != k)
                        fans.unite(4 * t + c, 4 * idx(mesh.neighbors[t][k]) +
                                                  corner_of(idx(mesh.neighbors[t][k]), mesh.tetrahedra[t][c]));
        const auto first = static_cast<int32_t>(filling_.corners.size());
        std::vector<int32_t> number(4 * mesh.tetrahedra.size(), -1);
        for (size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
            std::array<Corner, 4>& corners = filling_.corners.emplace_back();
            for (size_t k = 0; k < 4; ++k) {
                int32_t& n = number[fans.find(4 * t + k)];
                const size_t v = idx(mesh.tetrahedra[t][k]);
                if (n < 0) {
                    n = static_cast<int32_t>(filling_.vertices.size());
                    filling_.vertices.push_back(mesh.vertices[v]);
                    source_vertex_.push_back(v < cell.vertices.size() ? source_.source_vertex[idx(cell.source_vertex[v])] : -1);
                }
                corners[k] = {n, mesh.neighbors[t][k] < 0 ? -1 : mesh.neighbors[t][k] + first};
            }
        }
        for (size_t i = 0; i < cell.triangles.size(); ++i) {
            const size_t tet = idx(mesh.tet_of_triangle[i]), side = sides[idx(cell.samples[i].face)];
            Triangle& triangle = filling_.triangles.emplace_back(cell.triangles[i]);
            for (int32_t& v : triangle) v = filling_.corners[idx(first) + tet][corner_of(tet, v)].vertex;
            filling_.behind.push_back(first + static_cast<int32_t>(tet));
            // A wall's source face belongs to the region behind it.
            const bool is_own = side % 2 == 1 || !regions.is_solid(other_side(side));
            triangle_of_.push_back(is_own ? static_cast<int32_t>(triangle_of(side)) : -1);
        }
    }

    Solid finish(Progress& progress) {
        const std::vector<int32_t> on_surface = in_order_of_use(filling_.vertices.size(), filling_.triangles);
        Solid solid = canonical(source_.frame, std::move(filling_), on_surface, progress);
        for (int32_t& v : solid.surface.source_vertex) v = source_vertex_[idx(v)];
        std::vector<FaceSample> samples;
        for (const FaceSample& sample : solid.surface.samples) {
            const int32_t triangle = triangle_of_[idx(sample.face)];
            if (triangle < 0) continue;
            const FaceSample& own = source_.samples[idx(triangle)];
            samples.push_back({own.face, sample.triangle, own.area});
        }
        solid.surface.samples = std::move(samples);
        solid.surface.face_count = source_.face_count;
        return solid;
    }

private:
    const Surface& source_;
    Filling filling_;
    std::vector<int32_t> source_vertex_;  // of each vertex
    std::vector<int32_t> triangle_of_;    // of each triangle the source's, or -1
};

// The number of source faces that some triangles belong to.
template <class Select>
size_t count_faces(const Surface& source, const Select& select) {
    std::set<int32_t> faces;
    for (size_t t = 0; t < source.triangles.size(); ++t)
        if (select(t)) faces.insert(source.samples[t].face);
    return faces.size();
}

// Faces that have no sample go with the face that is nearest to them.
void attach_left_out(const Surface& source, const EnclosedRegions& regions, Surface& surface) {
    std::vector<int32_t> face_of(surface.triangles.size(), -1);
    std::vector<bool> has_sample(source.face_count, false);
    for (const FaceSample& sample : surface.samples) {
        face_of[idx(sample.triangle)] = sample.face;
        has_sample[idx(sample.face)] = true;
    }
    std::vector<Triangle> triangles;
    std::vector<int32_t> faces;
    for (size_t t = 0; t < face_of.size(); ++t)
        if (face_of[t] >= 0) {
            triangles.push_back(surface.triangles[t]);
            faces.push_back(face_of[t]);
        }
    surface.original = iota(source.face_count);
    NearestTriangle nearest(surface.vertices, triangles);
    double farthest = 0;
    for (size_t t = 0; t < source.triangles.size(); ++t) {
        if (regions.is_kept(t)) continue;
        for (const int32_t v : source.triangles[t]) farthest = std::max(farthest, nearest(source.vertices[idx(v)]).squared);
        const Point middle = centroid(source.vertices, source.triangles[t]);
        const auto face = idx(source.samples[t].face);
        if (!has_sample[face]) surface.original[face] = faces[idx(nearest(middle).triangle)];
    }
    surface.deviation = std::sqrt(farthest) / diagonal(source);
}

}  // namespace

bool has_non_manifold_edges(const Surface& surface) {
    bool non_manifold = false;
    for_each_edge(surface.vertices.size(), surface.triangles,
                  [&](int32_t, std::span<const Side> sides) { non_manifold = non_manifold || sides.size() > 2; });
    return non_manifold;
}

std::optional<Solid> fill_cells(const Surface& source, double quality, Progress& progress) {
    if (!has_non_manifold_edges(source) || is_degenerate(source) || crosses_itself(source, progress)) return {};
    EnclosedRegions regions(source);
    if (!regions.is_clear()) return {};
    const std::vector<size_t> sheets = regions.outer_sheets();
    if (!sheets.empty() && repair_soup(extract(source, sheets), progress).solids > 0) return {};
    FaceCounts counts;
    counts.walls = count_faces(source, [&](size_t t) { return regions.is_solid(2 * t) && regions.is_solid(2 * t + 1); });
    counts.left_out = count_faces(source, [&](size_t t) { return !regions.is_kept(t); });
    if (counts.walls + counts.left_out == 0) return {};  // it only touches itself
    progress.enter(PW_STAGE_TETRAHEDRA);
    RegionFill fill(source);
    size_t sides = 0;
    try {
        for (const std::vector<size_t>& own : regions.solids()) {
            const auto share = [&] { return static_cast<double>(sides) / static_cast<double>(2 * source.triangles.size()); };
            const double begin = share();
            sides += own.size();
            const Progress::Section section(progress, begin, share());
            fill.add(regions, own, quality, progress);
        }
    } catch (const Error& error) {
        if (error.status() != PW_ERROR_TETRAHEDRA) throw;
        return {};
    }
    Solid solid = fill.finish(progress);
    solid.mesh.cavities = regions.cavities();
    solid.surface.fill_method = PW_FILL_REPAIRED;
    solid.surface.face_counts = counts;
    add_face_notes(counts, solid.surface.notes);
    if (counts.left_out > 0) attach_left_out(source, regions, solid.surface);
    return solid;
}

}  // namespace partwheel
