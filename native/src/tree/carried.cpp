// Parts carried over: another filling, the part that each tetrahedron is of, and the tree of that.
#include "tree/carried.h"

#include "base/error.h"
#include "cluster/hull/hull.h"
#include "surface/prepare/rough.h"
#include "tree/claims.h"
#include "tree/dendrogram.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace partwheel {

namespace {

// Passes of smoothing, as a multiple of the noise: a surface that is only measured may lose more than one that is used.
constexpr double smoothing_passes = 90;

bool sound(const Surface& surface, Progress& progress) {
    try {
        check_surface(surface, progress);
        return true;
    } catch (const Error& error) {
        if (error.status() == PW_ERROR_CANCELLED) throw;
        return false;
    }
}

// Numbers: the parts' in depth-first order, as their scores are, then those of the merges that join them.
struct Numbers {
    std::vector<int32_t> of_tetrahedron;
    std::vector<std::array<int32_t, 2>> joined;  // by each merge
};

Numbers numbers(const Regrouped& parts, size_t leaves) {
    const std::vector<Merge>& merges = parts.tree.merges;
    const size_t joins = parts.scores.size() / 2, below = merges.size() - joins;
    std::vector<int32_t> number(leaves + merges.size(), -1);
    int32_t next = 0;
    for (const int32_t c : cut_undoing_last(merges, joins + 1)) number[at(c)] = next++;
    Numbers result;
    for (size_t m = below; m < merges.size(); ++m) {
        number[leaves + m] = next++;
        result.joined.push_back({number[at(merges[m].left)], number[at(merges[m].right)]});
    }
    hand_down(std::span(merges).first(below), leaves, number);
    number.resize(leaves);
    result.of_tetrahedron = std::move(number);
    return result;
}

// The part of each tetrahedron: that of most of the surface that it lies behind; else, layer by layer, that of the
// neighbours behind most of its facets' area.
std::vector<int32_t> spread(const Solid& solid, const std::vector<int32_t>& part_of_triangle, Progress& progress) {
    const TetMesh& mesh = solid.mesh;
    const auto size = [&](const Triangle& t) {
        const auto point = [&](int32_t v) -> const Point& { return mesh.vertices[at(v)]; };
        return area(point(t[0]), point(t[1]), point(t[2]));
    };
    std::vector<Claim> claims;
    for (size_t i = 0; i < part_of_triangle.size(); ++i) {
        claims.push_back({mesh.tet_of_triangle[i], part_of_triangle[i], size(solid.surface.triangles[i])});
    }
    std::vector<int32_t> part(mesh.tetrahedra.size(), -1), layer;
    while (!claims.empty()) {
        layer.clear();
        settle_claims(std::move(claims), [&](int32_t t, int32_t p) {
            part[at(t)] = p;
            layer.push_back(t);
        });
        claims.clear();
        for (const int32_t t : layer)
            for (size_t k = 0; k < 4; ++k) {
                const int32_t next = mesh.neighbours[at(t)][k];
                if (next < 0 || part[at(next)] >= 0) continue;
                const Tetrahedron& tet = mesh.tetrahedra[at(t)];
                claims.push_back({next, part[at(t)], size(facet(tet, k))});
            }
        progress.advance(0);
    }
    return part;
}

// A cluster of the tree as it grows.
struct Grown {
    int32_t cluster = -1;  // none yet
    int32_t low = 0;       // its lowest tetrahedron
    double volume = 0;
    std::vector<int32_t> corners;  // of all its tetrahedra, while it has no hull
    Hull hull;
};

// What is in both, or in the one that is any.
Grown joined(Grown a, Grown b, HullKernel& kernel, size_t leaves, std::vector<Merge>& merges) {
    if (a.cluster < 0) return b;
    if (b.cluster < 0) return a;
    if (b.low < a.low) std::swap(a, b);
    const auto [small, large] = std::minmax(a.hull, b.hull, fewer_facets);
    Grown both{static_cast<int32_t>(leaves + merges.size()), a.low, a.volume + b.volume, {},
               kernel.unite(large, small.vertices())};
    const double hull = both.hull.volume();
    merges.push_back({a.cluster, b.cluster, ranked_concavity(hull, both.volume), hull});
    return both;
}

}  // namespace

std::optional<TetMesh> plain_filling(const Solid& solid, bool points_inside, Progress& progress) {
    Surface surface = solid.surface;
    const double noise = roughness(surface.vertices, surface.triangles);
    bool smooth = false;
    if (noise > 0) {
        surface.vertices = smoothed(surface.vertices, surface.triangles, smoothing_passes * noise);
        smooth = sound(surface, progress);
        if (!smooth) surface.vertices = solid.surface.vertices;
    }
    if (!smooth && !points_inside) return {};
    try {
        return tetrahedralize(surface, 0, progress);
    } catch (const Error& error) {
        if (error.status() != PW_ERROR_TETRAHEDRA) throw;
        return {};
    }
}

Regrouped carried(const TetMesh& plain, const Regrouped& parts, const Solid& solid, Progress& progress, size_t threads) {
    const size_t leaves = solid.mesh.tetrahedra.size(), count = parts.scores.size() / 2 + 1;
    const Numbers number = numbers(parts, plain.tetrahedra.size());
    std::vector<int32_t> part_of_triangle;
    for (const int32_t t : plain.tet_of_triangle) part_of_triangle.push_back(number.of_tetrahedron[at(t)]);
    const std::vector<int32_t> part = spread(solid, part_of_triangle, progress);

    // The paper's clusters within each part.
    TetMesh apart = solid.mesh;
    for (size_t t = 0; t < leaves; ++t)
        for (int32_t& n : apart.neighbours[t])
            if (n >= 0 && part[at(n)] != part[t]) n = -1;
    Regrouped result;
    result.tree = cluster(apart, progress, threads);
    std::vector<Merge>& merges = result.tree.merges;
    merges.resize(leaves - result.tree.components);
    result.tree.components = parts.tree.components;

    // A part's tetrahedra may be in several pieces.
    std::vector<int32_t> piece(leaves + merges.size());
    std::iota(piece.begin(), piece.end(), 0);
    hand_down(merges, leaves, piece);
    HullKernel kernel(solid.mesh.vertices);  // outlives all hulls
    std::vector<Grown> pieces(piece.size());
    std::vector<int32_t> in_order;  // by their lowest tetrahedra
    for (size_t t = 0; t < leaves; ++t) {
        Grown& p = pieces[at(piece[t])];
        if (p.cluster < 0) {
            p.cluster = piece[t];
            p.low = static_cast<int32_t>(t);
            in_order.push_back(piece[t]);
        }
        const Tetrahedron& tet = solid.mesh.tetrahedra[t];
        const auto corner = [&](size_t k) { return solid.mesh.vertices[at(tet[k])]; };
        p.volume += std::max(0.0, six_volumes(corner(0), corner(1), corner(2), corner(3)) / 6);
        p.corners.insert(p.corners.end(), tet.begin(), tet.end());
    }
    std::vector<Grown> grown(2 * count - 1);
    for (const int32_t c : in_order) {
        Grown &p = pieces[at(c)], &whole = grown[at(part[at(p.low)])];
        p.hull = kernel.build(p.corners);
        whole = joined(std::move(whole), std::move(p), kernel, leaves, merges);
        progress.advance(1);
    }

    // The joins, and the scores of what isn't empty.
    const size_t top = leaves + merges.size();
    std::vector<double> score(top, 0);
    for (size_t p = 0; p < count; ++p)
        if (grown[p].cluster >= 0) score[at(grown[p].cluster)] = parts.scores[p];
    for (size_t j = 0; j + 1 < count; ++j) {
        Grown& a = grown[at(number.joined[j][0])];
        Grown& b = grown[at(number.joined[j][1])];
        grown[count + j] = joined(std::move(a), std::move(b), kernel, leaves, merges);
        if (leaves + merges.size() > score.size()) score.push_back(parts.scores[count + j]);
        progress.advance(1);
    }
    for (const int32_t c : cut_undoing_last(merges, score.size() - top + 1)) result.scores.push_back(score[at(c)]);
    result.scores.insert(result.scores.end(), score.begin() + static_cast<std::ptrdiff_t>(top), score.end());
    return result;
}

}  // namespace partwheel
