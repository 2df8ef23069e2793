// The expected status of a surface, computed independently.
#include "support/reference_surface.h"

#include "support/reference_hull.h"

#include <map>
#include <set>

namespace partwheel::test {

namespace {

// The triangles about a vertex, each as the directed edge opposite to it, are one ring.
bool one_ring(const std::map<int32_t, int32_t>& next) {
    size_t steps = 0;
    int32_t v = next.begin()->first;
    do {
        v = next.at(v);
        ++steps;
    } while (v != next.begin()->first);
    return steps == next.size();
}

}  // namespace

pw_status expected_status(const TriMesh& mesh) {
    const auto at = [&](int32_t v) -> const Point& { return mesh.vertices[static_cast<size_t>(v)]; };
    std::map<std::set<int32_t>, int> uses;
    std::map<std::pair<int32_t, int32_t>, int> directed;
    for (const auto& [a, b, c] : mesh.triangles)
        if (reference_collinear(at(a), at(b), at(c))) return PW_ERROR_DEGENERATE;
    for (const Triangle& t : mesh.triangles)
        for (size_t k = 0; k < 3; ++k) {
            ++uses[{t[k], t[(k + 1) % 3]}];
            ++directed[{t[k], t[(k + 1) % 3]}];
        }
    bool open = false, crowded = false, turned = false;
    for (const auto& [edge, count] : uses) {
        open = open || count == 1;
        crowded = crowded || count > 2;
    }
    for (const auto& [edge, count] : directed) turned = turned || count > 1;
    if (open) return PW_ERROR_OPEN;
    if (crowded) return PW_ERROR_NON_MANIFOLD;
    if (turned) return PW_ERROR_ORIENTATION;
    std::map<int32_t, std::map<int32_t, int32_t>> link;
    for (const Triangle& t : mesh.triangles)
        for (size_t k = 0; k < 3; ++k) link[t[k]][t[(k + 1) % 3]] = t[(k + 2) % 3];
    for (const auto& [v, next] : link)
        if (!one_ring(next)) return PW_ERROR_NON_MANIFOLD;
    return reference_self_intersects(mesh) ? PW_ERROR_SELF_INTERSECTION : PW_OK;
}

}  // namespace partwheel::test
