// Parts spread into the tetrahedra that have none yet: by claims, layer by layer.
#include "tree/mirror/spread.h"

#include <utility>

namespace partwheel {

namespace {

void add_claims_of(const TetMesh& mesh, size_t t, const std::vector<int32_t>& part, std::vector<Claim>& claims) {
    for (size_t k = 0; k < 4; ++k) {
        const int32_t next = mesh.neighbours[t][k];
        if (next >= 0 && part[at(next)] == -1) claims.push_back({next, part[t], facet_area(mesh, t, k)});
    }
}

}  // namespace

double facet_area(const TetMesh& mesh, size_t tetrahedron, size_t opposite) {
    const auto [a, b, c] = facet(mesh.tetrahedra[tetrahedron], opposite);
    return area(mesh.vertices[at(a)], mesh.vertices[at(b)], mesh.vertices[at(c)]);
}

std::vector<Claim> claims_of_neighbours(const TetMesh& mesh, const std::vector<int32_t>& part) {
    std::vector<Claim> claims;
    for (size_t t = 0; t < part.size(); ++t)
        if (part[t] >= 0) add_claims_of(mesh, t, part, claims);
    return claims;
}

void settle(std::vector<Claim> claims, std::vector<int32_t>& part) {
    settle_claims(std::move(claims), [&](int32_t t, int32_t p) { part[at(t)] = p; });
}

void spread(const TetMesh& mesh, std::vector<Claim> claims, std::vector<int32_t>& part, Progress& progress) {
    std::vector<int32_t> layer;
    while (!claims.empty()) {
        layer.clear();
        settle_claims(std::exchange(claims, {}), [&](int32_t t, int32_t p) {
            part[at(t)] = p;
            layer.push_back(t);
        });
        for (const int32_t t : layer) add_claims_of(mesh, at(t), part, claims);
        progress.advance(0);
    }
}

}  // namespace partwheel
