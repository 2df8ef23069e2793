// The invariants of hierarchies of known meshes, by independent computations.
#include "support/built.h"

#include "cluster/cluster.h"
#include "support/reference_hull.h"
#include "support/sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace partwheel::test {

namespace {

// Closed, outward, and no vertex of the tetrahedra outside; the volume by the divergence theorem.
double expect_convex(const HullMesh& mesh, const pw_arrays& a, size_t tet_first, size_t tet_last) {
    std::set<std::pair<int32_t, int32_t>> edges;
    for (const Triangle& t : mesh.triangles)
        for (size_t k = 0; k < 3; ++k) EXPECT_TRUE(edges.emplace(t[k], t[(k + 1) % 3]).second);
    for (const auto& [from, to] : edges) EXPECT_TRUE(edges.contains({to, from}));
    EXPECT_EQ(mesh.vertices.size() + mesh.triangles.size(), edges.size() / 2 + 2);

    Point low = mesh.vertices.at(0), high = low;
    for (const Point& p : mesh.vertices)
        for (size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    // The hull is exact in working coordinates; in the caller's, a few roundings may show.
    double size = 0;
    for (size_t k = 0; k < 3; ++k) size = std::max({size, std::fabs(low[k]), std::fabs(high[k])});
    const double slack = 1e-14 * size * (high[0] - low[0] + high[1] - low[1] + high[2] - low[2]) *
                         (high[0] - low[0] + high[1] - low[1] + high[2] - low[2]);
    std::set<int32_t> members(a.tetrahedra + 4 * tet_first, a.tetrahedra + 4 * tet_last);
    const size_t step = 1 + mesh.triangles.size() * members.size() / 20000;  // all of small ones, some of large ones
    for (size_t i = 0; i < mesh.triangles.size(); i += step) {
        const Triangle& t = mesh.triangles[i];
        const auto at = [&](size_t k) -> const Point& { return mesh.vertices[static_cast<size_t>(t[k])]; };
        for (const int32_t v : members) {
            const double* p = a.vertices + 3 * static_cast<size_t>(v);
            EXPECT_LE(signed_volume6(at(0), at(1), at(2), {p[0], p[1], p[2]}), slack);
        }
    }
    TriMesh surface;
    surface.vertices = mesh.vertices;
    surface.triangles = mesh.triangles;
    return enclosed_volume(surface);
}

class Invariants {
public:
    Invariants(const Handle& handle, const TriMesh& mesh)
        : handle_(handle), mesh_(mesh), a_(arrays(handle)), faces_(a_.face_count), nodes_(a_.node_count),
          tets_(a_.tetrahedron_count) {}

    void expect_sizes(double volume) const;
    void expect_vertices() const;
    void expect_measures() const;
    void expect_faces() const;
    void expect_hulls() const;
    void expect_convex_nodes() const;

private:
    bool leaf(size_t n) const { return n < tets_; }
    double measure_slack() const { return 1e-12 * summary(handle_).hull_volume; }

    const Handle& handle_;
    const TriMesh& mesh_;
    pw_arrays a_;
    size_t faces_, nodes_, tets_;
};

void Invariants::expect_sizes(double volume) const {
    const pw_summary s = summary(handle_);
    EXPECT_EQ(faces_, mesh_.face_count);
    EXPECT_GE(tets_, 1U);
    EXPECT_GE(nodes_, tets_);
    EXPECT_LE(nodes_, 2 * tets_ - 1);
    EXPECT_NEAR(s.volume, volume, 1e-9 * volume);
    EXPECT_NEAR(std::accumulate(a_.volume, a_.volume + tets_, 0.0), volume, 1e-9 * volume);
    EXPECT_EQ(s.volume, a_.volume[nodes_ - 1]);
    EXPECT_GE(s.hull_volume, s.volume * (1 - 1e-12));
    EXPECT_GE(s.components, 1U);
    EXPECT_NEAR(a_.area[nodes_ - 1], surface_area(mesh_), 1e-9 * surface_area(mesh_));
}

void Invariants::expect_vertices() const {
    size_t added = 0;
    std::set<int32_t> used(a_.tetrahedra, a_.tetrahedra + 4 * tets_), sources;
    EXPECT_EQ(used.size(), a_.vertex_count);
    EXPECT_GE(*used.begin(), 0);
    EXPECT_LT(static_cast<size_t>(*used.rbegin()), a_.vertex_count);
    for (size_t v = 0; v < a_.vertex_count; ++v) {
        if (a_.source[v] < 0) {
            EXPECT_EQ(a_.source[v], -1);
            ++added;
            continue;
        }
        EXPECT_EQ(added, 0U) << "a source vertex after an added one";
        ASSERT_LT(static_cast<size_t>(a_.source[v]), mesh_.vertices.size());
        EXPECT_TRUE(sources.insert(a_.source[v]).second);
        for (size_t k = 0; k < 3; ++k)
            EXPECT_EQ(a_.vertices[3 * v + k], mesh_.vertices[static_cast<size_t>(a_.source[v])][k]);
    }
    EXPECT_EQ(summary(handle_).added_vertices, added);
}

void Invariants::expect_measures() const {
    std::vector<double> volume(nodes_, 0), area(nodes_, 0);
    for (size_t n = 0; n < nodes_; ++n) {
        if (leaf(n)) {
            const int32_t* t = a_.tetrahedra + 4 * n;
            const auto at = [&](size_t k) {
                const double* p = a_.vertices + 3 * static_cast<size_t>(t[k]);
                return Point{p[0], p[1], p[2]};
            };
            EXPECT_NEAR(signed_volume6(at(0), at(1), at(2), at(3)) / 6, a_.volume[n], measure_slack());
            EXPECT_GE(a_.volume[n], 0);
            volume[n] = a_.volume[n];
            area[n] = a_.area[n];
        }
        EXPECT_NEAR(volume[n], a_.volume[n], measure_slack());
        EXPECT_NEAR(area[n], a_.area[n], 1e-12 * a_.area[nodes_ - 1]);
        if (a_.parent[n] < 0) continue;
        volume[static_cast<size_t>(a_.parent[n])] += volume[n];
        area[static_cast<size_t>(a_.parent[n])] += area[n];
    }
}

void Invariants::expect_faces() const {
    // order is a permutation, sorted by leaf.
    std::vector<int32_t> sorted(a_.order, a_.order + faces_);
    std::sort(sorted.begin(), sorted.end());
    for (size_t f = 0; f < faces_; ++f) ASSERT_EQ(sorted[f], static_cast<int32_t>(f));
    for (size_t i = 0; i < faces_; ++i) {
        const int32_t l = a_.leaf[a_.order[i]];
        ASSERT_GE(l, 0);
        ASSERT_LT(static_cast<size_t>(l), tets_);
        EXPECT_LE(a_.first[l], static_cast<int32_t>(i));
        EXPECT_GT(a_.last[l], static_cast<int32_t>(i));
    }
    // A face's leaf is the tetrahedron that has most of its area; between equals any.
    std::map<std::set<int32_t>, std::vector<size_t>> owners;  // facet of source vertices -> tetrahedra
    for (size_t t = 0; t < tets_; ++t)
        for (size_t corner = 0; corner < 4; ++corner) {
            std::set<int32_t> facet;
            for (size_t k = 0; k < 4; ++k)
                if (k != corner) facet.insert(a_.source[a_.tetrahedra[4 * t + k]]);
            if (!facet.contains(-1)) owners[facet].push_back(t);
        }
    std::vector<std::map<size_t, double>> share(faces_);
    for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
        const Triangle& t = mesh_.triangles[i];
        const auto at = [&](size_t k) -> const Point& { return mesh_.vertices[static_cast<size_t>(t[k])]; };
        const auto owner = owners.find({t[0], t[1], t[2]});
        ASSERT_NE(owner, owners.end()) << "triangle " << i << " is no facet of any tetrahedron";
        for (const size_t tet : owner->second)
            share[static_cast<size_t>(mesh_.face_of(i))][tet] += area(at(0), at(1), at(2));
    }
    for (size_t f = 0; f < faces_; ++f) {
        const auto mine = share[f].find(static_cast<size_t>(a_.leaf[f]));
        ASSERT_NE(mine, share[f].end()) << "face " << f << " lies in a tetrahedron that it doesn't touch";
        for (const auto& [tet, area_there] : share[f]) EXPECT_GE(mine->second, area_there * (1 - 1e-9));
    }
}

void Invariants::expect_hulls() const {
    const size_t most = sized<size_t>(400, 60);
    const size_t step = 1 + (nodes_ - tets_) / most;
    for (size_t n = nodes_; n-- > tets_;) {
        if ((nodes_ - 1 - n) % step != 0) continue;
        const auto first = static_cast<size_t>(a_.tet_first[n]), last = static_cast<size_t>(a_.tet_last[n]);
        const double hull_volume = expect_convex(hull(handle_, first, last), a_, first, last);
        // The hull contains the cluster, and the cost, unless it is C2, is the rest of its volume.
        EXPECT_GE(hull_volume, a_.volume[n] * (1 - 1e-12));
        const double concavity = hull_volume - a_.volume[n];
        const double slack = 1e-8 * concavity + 1e-10 * hull_volume;
        if (a_.cost_class[n] == 1)
            EXPECT_NEAR(a_.cost[n], concavity, slack);
        else
            EXPECT_NEAR(0, concavity, slack + convex_tolerance * hull_volume);
        if (last - first > 300) continue;
        std::vector<Point> points;
        for (size_t i = 4 * first; i < 4 * last; ++i) {
            const double* p = a_.vertices + 3 * static_cast<size_t>(a_.tetrahedra[i]);
            points.push_back({p[0], p[1], p[2]});
        }
        EXPECT_NEAR(hull_volume, static_cast<double>(reference_hull_volume(points)), 1e-10 * hull_volume);
    }
    const pw_summary s = summary(handle_);
    const double concavity = a_.cost_class[nodes_ - 1] == 1 ? a_.cost[nodes_ - 1] : 0;
    EXPECT_NEAR(s.hull_volume - s.volume, concavity, 1e-8 * concavity + 1.1 * convex_tolerance * s.hull_volume);
}

// In mode "paper" whatever is convex stays (Eq. 3), else the root alone.
void Invariants::expect_convex_nodes() const {
    for (size_t n = 0; n < nodes_; ++n) EXPECT_EQ(a_.cost_class[n], 0);
    if (a_.score[nodes_ - 1] == 0) return;
    EXPECT_EQ(nodes_, tets_ == 1 ? 1 : tets_ + 1);
    for (size_t t = 0; t + 1 < nodes_; ++t) EXPECT_EQ(static_cast<size_t>(a_.parent[t]), nodes_ - 1);
}

}  // namespace

void expect_invariants(const Handle& handle, const TriMesh& mesh, double volume, bool convex) {
    SCOPED_TRACE(mesh.name);
    ASSERT_NE(handle, nullptr);
    expect_structure(handle);
    const Invariants invariants(handle, mesh);
    invariants.expect_sizes(volume);
    invariants.expect_vertices();
    invariants.expect_measures();
    invariants.expect_faces();
    invariants.expect_hulls();
    if (convex) invariants.expect_convex_nodes();
}

}  // namespace partwheel::test
