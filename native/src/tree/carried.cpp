// Parts carried over: another filling, the part that each tetrahedron is of, and the tree of that.
#include "tree/carried.h"

#include "base/error.h"
#include "cluster/hull/hull.h"
#include "surface/prepare/rough.h"
#include "tree/claims.h"

#include <algorithm>
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
    std::vector<int32_t> number(leaves + merges.size(), -1), todo = {static_cast<int32_t>(number.size()) - 1};
    for (int32_t next = 0; !todo.empty();) {
        const auto c = static_cast<size_t>(todo.back());
        todo.pop_back();
        if (c < leaves + below) {
            number[c] = next++;
        } else {
            number[c] = static_cast<int32_t>(c - leaves - below + joins + 1);
            todo.push_back(merges[c - leaves].right);
            todo.push_back(merges[c - leaves].left);
        }
    }
    Numbers result;
    for (size_t m = below; m < merges.size(); ++m)
        result.joined.push_back(
            {number[static_cast<size_t>(merges[m].left)], number[static_cast<size_t>(merges[m].right)]});
    for (size_t m = below; m-- > 0;)
        for (const int32_t child : {merges[m].left, merges[m].right})
            number[static_cast<size_t>(child)] = number[leaves + m];
    number.resize(leaves);
    result.of_tetrahedron = std::move(number);
    return result;
}

// The part of each tetrahedron: that of most of the surface that it lies behind; else, layer by layer, that of the
// neighbours behind most of its facets' area.
std::vector<int32_t> spread(const Solid& solid, const std::vector<int32_t>& part_of_triangle, Progress& progress) {
    const TetMesh& mesh = solid.mesh;
    const auto size = [&](const Triangle& t) {
        const auto at = [&](int32_t v) -> const Point& { return mesh.vertices[static_cast<size_t>(v)]; };
        return area(at(t[0]), at(t[1]), at(t[2]));
    };
    std::vector<Claim> claims;
    for (size_t i = 0; i < part_of_triangle.size(); ++i) {
        claims.push_back({mesh.tet_of_triangle[i], part_of_triangle[i], size(solid.surface.triangles[i])});
    }
    std::vector<int32_t> part(mesh.tetrahedra.size(), -1), layer;
    while (!claims.empty()) {
        layer.clear();
        settle_claims(std::move(claims), [&](int32_t t, int32_t p) {
            part[static_cast<size_t>(t)] = p;
            layer.push_back(t);
        });
        claims.clear();
        for (const int32_t t : layer)
            for (size_t k = 0; k < 4; ++k) {
                const int32_t next = mesh.neighbours[static_cast<size_t>(t)][k];
                if (next < 0 || part[static_cast<size_t>(next)] >= 0) continue;
                const Tetrahedron& tet = mesh.tetrahedra[static_cast<size_t>(t)];
                claims.push_back({next, part[static_cast<size_t>(t)], size(facet(tet, k))});
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
    Hull hull;
};

// What is in both, or in the one that is any.
Grown joined(Grown a, Grown b, HullKernel& kernel, size_t leaves, std::vector<Merge>& merges) {
    if (a.cluster < 0) return b;
    if (b.cluster < 0) return a;
    if (b.low < a.low) std::swap(a, b);
    const bool by_facets = a.hull.facet_count() > b.hull.facet_count();
    const Hull &large = by_facets ? a.hull : b.hull, &small = by_facets ? b.hull : a.hull;
    Grown both{static_cast<int32_t>(leaves + merges.size()), a.low, a.volume + b.volume,
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
    for (const int32_t t : plain.tet_of_triangle)
        part_of_triangle.push_back(number.of_tetrahedron[static_cast<size_t>(t)]);
    const std::vector<int32_t> part = spread(solid, part_of_triangle, progress);

    // The paper's clusters within each part.
    TetMesh apart = solid.mesh;
    for (size_t t = 0; t < leaves; ++t)
        for (int32_t& n : apart.neighbours[t])
            if (n >= 0 && part[static_cast<size_t>(n)] != part[t]) n = -1;
    Regrouped result;
    result.tree = cluster(apart, progress, threads);
    std::vector<Merge>& merges = result.tree.merges;
    merges.resize(leaves - result.tree.components);
    result.tree.components = parts.tree.components;

    // A part's tetrahedra may be in several pieces.
    std::vector<int32_t> piece(leaves + merges.size());
    for (size_t c = 0; c < piece.size(); ++c) piece[c] = static_cast<int32_t>(c);
    for (size_t m = merges.size(); m-- > 0;)
        for (const int32_t child : {merges[m].left, merges[m].right})
            piece[static_cast<size_t>(child)] = piece[leaves + m];
    struct Fragment {
        int32_t low = -1;
        double volume = 0;
        std::vector<int32_t> corners;
    };
    std::vector<Fragment> pieces(piece.size());
    std::vector<int32_t> in_order;  // by their lowest tetrahedra
    for (size_t t = 0; t < leaves; ++t) {
        Fragment& p = pieces[static_cast<size_t>(piece[t])];
        if (p.low < 0) {
            p.low = static_cast<int32_t>(t);
            in_order.push_back(piece[t]);
        }
        const Tetrahedron& tet = solid.mesh.tetrahedra[t];
        const auto at = [&](size_t k) { return solid.mesh.vertices[static_cast<size_t>(tet[k])]; };
        p.volume += std::max(0.0, six_volumes(at(0), at(1), at(2), at(3)) / 6);
        p.corners.insert(p.corners.end(), tet.begin(), tet.end());
    }
    HullKernel kernel(solid.mesh.vertices);
    std::vector<Grown> grown(2 * count - 1);
    for (const int32_t c : in_order) {
        const Fragment& p = pieces[static_cast<size_t>(c)];
        Grown& whole = grown[static_cast<size_t>(part[static_cast<size_t>(p.low)])];
        whole = joined(std::move(whole), {c, p.low, p.volume, kernel.build(p.corners)}, kernel, leaves, merges);
        progress.advance(1);
    }

    // The joins, and the scores of what isn't empty.
    const size_t top = leaves + merges.size();
    std::vector<double> score(top, 0);
    for (size_t p = 0; p < count; ++p)
        if (grown[p].cluster >= 0) score[static_cast<size_t>(grown[p].cluster)] = parts.scores[p];
    for (size_t j = 0; j + 1 < count; ++j) {
        Grown& a = grown[static_cast<size_t>(number.joined[j][0])];
        Grown& b = grown[static_cast<size_t>(number.joined[j][1])];
        grown[count + j] = joined(std::move(a), std::move(b), kernel, leaves, merges);
        if (leaves + merges.size() > score.size()) score.push_back(parts.scores[count + j]);
        progress.advance(1);
    }
    std::vector<int32_t> todo = {static_cast<int32_t>(score.size()) - 1};
    while (!todo.empty()) {
        const auto c = static_cast<size_t>(todo.back());
        todo.pop_back();
        if (c < top) {
            result.scores.push_back(score[c]);
        } else {
            todo.push_back(merges[c - leaves].right);
            todo.push_back(merges[c - leaves].left);
        }
    }
    result.scores.insert(result.scores.end(), score.begin() + static_cast<std::ptrdiff_t>(top), score.end());
    return result;
}

}  // namespace partwheel
