// Shells inside shells, and cavities.
#include "fill/cavities.h"

#include "base/adjacency.h"
#include "fill/winding.h"

#include <memory>

namespace partwheel {

namespace {

constexpr size_t max_candidates = 16;

// Bounding box, signed volume and closedness of each shell.
struct Extent {
    Box box;
    double volume6 = 0;
    bool closed = true;  // no border edges
    int32_t lowest = -1, highest = -1;  // vertices, by their coordinates
};

std::vector<Extent> measure(const MeshView& mesh, const Shells& shells) {
    std::vector<Extent> extents(shells.count);
    const auto point = [&](int32_t v) -> const Point& { return mesh.vertices[idx(v)]; };
    std::vector<Triangle> welded;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        Extent& extent = extents[idx(shells.of_triangle[t])];
        Triangle corners = mesh.triangles[t];
        for (int32_t& v : corners) {
            extent.box.add(point(v));
            if (extent.lowest < 0 || point(v) < point(extent.lowest)) extent.lowest = v;
            if (extent.highest < 0 || point(extent.highest) < point(v)) extent.highest = v;
            v = shells.vertex[idx(v)];
        }
        const Point origin = point(extent.lowest);
        extent.volume6 += dot(cross(point(corners[0]) - origin, point(corners[1]) - origin), point(corners[2]) - origin);
        welded.push_back(corners);
    }
    for_each_edge(mesh.vertices.size(), welded, [&](int32_t, std::span<const Side> sides) {
        if (sides.size() == 1) extents[idx(shells.of_triangle[idx(sides[0].number) / 3])].closed = false;
    });
    return extents;
}

}  // namespace

ShellNesting find_nesting(const MeshView& mesh, const Shells& shells) {
    ShellNesting nesting{std::vector<int32_t>(shells.count, -1), std::vector<int32_t>(shells.count, -1)};
    if (shells.count < 2) return nesting;
    const std::vector<Extent> extents = measure(mesh, shells);
    std::vector<int32_t> by_size = iota(shells.count);
    std::ranges::stable_sort(by_size, {}, [&](int32_t s) { return extents[idx(s)].box.diagonal(); });
    const CsrArray<Triangle> triangles(shells.count, [&](const auto& put) {
        for (size_t t = 0; t < mesh.triangles.size(); ++t) put(idx(shells.of_triangle[t]), mesh.triangles[t]);
    });
    std::vector<std::unique_ptr<WindingNumber>> winding(shells.count);
    const auto encloses = [&](size_t outer, const Extent& inner) {
        if (!winding[outer]) winding[outer] = std::make_unique<WindingNumber>(mesh.vertices, triangles.row(outer));
        const auto is_inside = [&](int32_t v) { return std::fabs(winding[outer]->at(mesh.vertices[idx(v)])) > 0.5; };
        return is_inside(inner.lowest) && is_inside(inner.highest);
    };
    for (size_t i = 0; i < by_size.size(); ++i) {
        const Extent& inner = extents[idx(by_size[i])];
        size_t candidates = 0;
        for (size_t j = i + 1; inner.closed && j < by_size.size() && candidates < max_candidates; ++j) {
            const Extent& outer = extents[idx(by_size[j])];
            if (!outer.closed || !outer.box.contains(inner.box.low) || !outer.box.contains(inner.box.high)) continue;
            ++candidates;
            if (!encloses(idx(by_size[j]), inner)) continue;
            nesting.enclosing[idx(by_size[i])] = by_size[j];
            if (inner.volume6 * outer.volume6 < 0) nesting.cavity_of[idx(by_size[i])] = by_size[j];
            break;
        }
    }
    return nesting;
}

Shells join_cavities(const MeshView& mesh, const Shells& shells, const ShellNesting& nesting) {
    if (std::ranges::all_of(nesting.cavity_of, [](int32_t outer) { return outer < 0; })) return shells;
    return join_shells(mesh, shells, nesting.cavity_of);
}

}  // namespace partwheel
