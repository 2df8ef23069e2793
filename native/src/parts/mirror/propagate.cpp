// Parts spread into the tetrahedra that have none yet: by claims, layer by layer.
#include "parts/mirror/propagate.h"

#include <utility>

namespace partwheel {

namespace {

void add_claims_of(const TetMesh& mesh, size_t t, const std::vector<int32_t>& part, std::vector<Vote>& claims) {
    for (size_t k = 0; k < 4; ++k) {
        const int32_t next = mesh.neighbors[t][k];
        if (next >= 0 && part[idx(next)] == -1) claims.push_back({next, part[t], facet_area(mesh, t, k)});
    }
}

}  // namespace

double facet_area(const TetMesh& mesh, size_t tetrahedron, size_t opposite) {
    const auto [a, b, c] = facet(mesh.tetrahedra[tetrahedron], opposite);
    return area(mesh.vertices[idx(a)], mesh.vertices[idx(b)], mesh.vertices[idx(c)]);
}

std::vector<Vote> neighbor_votes(const TetMesh& mesh, const std::vector<int32_t>& part) {
    std::vector<Vote> claims;
    for (size_t t = 0; t < part.size(); ++t)
        if (part[t] >= 0) add_claims_of(mesh, t, part, claims);
    return claims;
}

void settle(std::vector<Vote> claims, std::vector<int32_t>& part) {
    for_each_majority(std::move(claims), [&](int32_t t, int32_t p) { part[idx(t)] = p; });
}

void spread(const TetMesh& mesh, std::vector<Vote> claims, std::vector<int32_t>& part, Progress& progress) {
    std::vector<int32_t> layer;
    while (!claims.empty()) {
        layer.clear();
        for_each_majority(std::exchange(claims, {}), [&](int32_t t, int32_t p) {
            part[idx(t)] = p;
            layer.push_back(t);
        });
        for (const int32_t t : layer) add_claims_of(mesh, idx(t), part, claims);
        progress.advance(0);
    }
}

}  // namespace partwheel
