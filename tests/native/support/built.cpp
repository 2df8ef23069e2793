// Hierarchies built through the C API, and what must hold of every one of them.
#include "support/built.h"

#include "cluster.h"
#include "support/reference_hull.h"
#include "support/sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <stdexcept>

namespace partwheel::test {

namespace {

void require_ok(pw_status status) {
    if (status != PW_OK) throw std::runtime_error(pw_error_message());
}

// Asks twice, as the C API's functions that fill arrays are meant to be: for the size, then for the values.
template <typename T, typename Ask>
std::vector<T> filled(Ask ask) {
    size_t count = 0;
    require_ok(ask(nullptr, size_t{0}, &count));
    std::vector<T> values(count);
    require_ok(ask(values.data(), count, &count));
    if (count != values.size()) throw std::runtime_error("two answers of different length");
    return values;
}

}  // namespace

Built try_build(const TriMesh& mesh, double quality, pw_context* context, uint32_t rungs) {
    const pw_build_options options{sizeof(pw_build_options), quality, rungs, 0, 0};
    pw_hierarchy* made = nullptr;
    Built built;
    built.status = pw_build(context, mesh.vertex_data(), mesh.vertices.size(), mesh.triangle_data(),
                            mesh.triangles.size(), mesh.face_data(), mesh.face_count, &options, &made);
    if (built.status != PW_OK) built.message = pw_error_message();
    built.handle.reset(made);
    return built;
}

Handle build(const TriMesh& mesh, double quality) {
    Built built = try_build(mesh, quality);
    if (built.status != PW_OK) throw std::runtime_error(mesh.name + ": " + built.message);
    return std::move(built.handle);
}

pw_arrays arrays(const Handle& handle) {
    pw_arrays a{};
    require_ok(pw_hierarchy_arrays(handle.get(), &a));
    return a;
}

pw_summary summary(const Handle& handle) {
    pw_summary s{};
    require_ok(pw_hierarchy_summary(handle.get(), &s));
    return s;
}

std::vector<uint8_t> save(const Handle& handle) {
    return filled<uint8_t>([&](uint8_t* bytes, size_t capacity, size_t* count) {
        return pw_hierarchy_save(handle.get(), bytes, capacity, count);
    });
}

Built try_load(const std::vector<uint8_t>& bytes) {
    pw_hierarchy* made = nullptr;
    Built built;
    built.status = pw_hierarchy_load(bytes.data(), bytes.size(), &made);
    if (built.status != PW_OK) built.message = pw_error_message();
    built.handle.reset(made);
    return built;
}

std::vector<int32_t> path(const Handle& handle, size_t face) {
    return filled<int32_t>([&](int32_t* nodes, size_t capacity, size_t* count) {
        return pw_hierarchy_path(handle.get(), face, nodes, capacity, count);
    });
}

Wheel wheel(const Handle& handle, size_t face) {
    Wheel result;
    result.stops = filled<int32_t>([&](int32_t* nodes, size_t capacity, size_t* count) {
        return pw_hierarchy_wheel(handle.get(), face, nodes, capacity, count, &result.start);
    });
    return result;
}

HullMesh hull(const Handle& handle, size_t tet_first, size_t tet_last) {
    pw_mesh* made = nullptr;
    require_ok(pw_hierarchy_hull(handle.get(), tet_first, tet_last, &made));
    const std::unique_ptr<pw_mesh, void (*)(pw_mesh*)> owner(made, pw_mesh_free);
    const double* vertices = nullptr;
    const int32_t* triangles = nullptr;
    size_t vertex_count = 0, triangle_count = 0;
    require_ok(pw_mesh_arrays(made, &vertices, &vertex_count, &triangles, &triangle_count));
    HullMesh mesh;
    for (size_t v = 0; v < vertex_count; ++v)
        mesh.vertices.push_back({vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]});
    for (size_t t = 0; t < triangle_count; ++t)
        mesh.triangles.push_back({triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]});
    return mesh;
}

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
            EXPECT_LE(six_volumes(at(0), at(1), at(2), {p[0], p[1], p[2]}), slack);
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
    void expect_tree() const;
    void expect_measures() const;
    void expect_faces() const;
    void expect_hulls() const;
    void expect_merges() const;
    void expect_questions() const;
    void expect_star() const;

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

void Invariants::expect_tree() const {
    std::vector<std::vector<int32_t>> children(nodes_);
    for (size_t n = 0; n < nodes_; ++n) {
        if (n + 1 == nodes_) {
            EXPECT_EQ(a_.parent[n], -1);
            break;
        }
        ASSERT_GE(static_cast<size_t>(a_.parent[n]), std::max(n + 1, tets_));
        ASSERT_LT(static_cast<size_t>(a_.parent[n]), nodes_);
        children[static_cast<size_t>(a_.parent[n])].push_back(static_cast<int32_t>(n));
    }
    EXPECT_EQ(a_.tet_first[nodes_ - 1], 0);
    EXPECT_EQ(static_cast<size_t>(a_.tet_last[nodes_ - 1]), tets_);
    EXPECT_EQ(a_.first[nodes_ - 1], 0);
    EXPECT_EQ(static_cast<size_t>(a_.last[nodes_ - 1]), faces_);
    for (size_t n = 0; n < nodes_; ++n) {
        if (leaf(n)) {
            EXPECT_TRUE(children[n].empty());
            ASSERT_EQ(a_.tet_first[n], static_cast<int32_t>(n));
            ASSERT_EQ(a_.tet_last[n], static_cast<int32_t>(n + 1));
            EXPECT_EQ(a_.cost_class[n], 0);
            EXPECT_EQ(a_.cost[n], 0);
            EXPECT_EQ(a_.height[n], 0);
            continue;
        }
        // The children's slices, in order, make up the node's.
        ASSERT_GE(children[n].size(), 2U);
        std::sort(children[n].begin(), children[n].end(),
                  [&](int32_t x, int32_t y) { return a_.tet_first[x] < a_.tet_first[y]; });
        int32_t tet = a_.tet_first[n], face = a_.first[n];
        for (const int32_t c : children[n]) {
            ASSERT_EQ(a_.tet_first[c], tet);
            ASSERT_EQ(a_.first[c], face);
            tet = a_.tet_last[c];
            face = a_.last[c];
            // Listing 2 leaves no child as high as its parent.
            EXPECT_TRUE(leaf(static_cast<size_t>(c)) || a_.height[c] < a_.height[n]);
        }
        ASSERT_EQ(tet, a_.tet_last[n]);
        ASSERT_EQ(face, a_.last[n]);
        EXPECT_EQ(a_.cost_class[n], a_.height[n] > 0 ? 1 : 0);
        if (a_.height[n] > 0) {
            EXPECT_EQ(a_.cost[n], a_.height[n]);
        } else {
            EXPECT_EQ(a_.height[n], 0);
            EXPECT_GT(a_.cost[n], 0);
            EXPECT_LE(a_.cost[n], 1);
        }
    }
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
            EXPECT_NEAR(six_volumes(at(0), at(1), at(2), at(3)) / 6, a_.volume[n], measure_slack());
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
        // The hull holds the cluster, and the height is what it holds beside.
        EXPECT_GE(hull_volume, a_.volume[n] * (1 - 1e-12));
        const double concavity = hull_volume - a_.volume[n];
        const double slack = 1e-8 * concavity + 1e-10 * hull_volume;
        EXPECT_NEAR(a_.height[n], concavity, slack + (a_.cost_class[n] == 0 ? convex_tolerance * hull_volume : 0));
        if (last - first > 300) continue;
        std::vector<Point> points;
        for (size_t i = 4 * first; i < 4 * last; ++i) {
            const double* p = a_.vertices + 3 * static_cast<size_t>(a_.tetrahedra[i]);
            points.push_back({p[0], p[1], p[2]});
        }
        EXPECT_NEAR(hull_volume, static_cast<double>(reference_hull_volume(points)), 1e-10 * hull_volume);
    }
    const pw_summary s = summary(handle_);
    const double height = a_.height[nodes_ - 1];
    EXPECT_NEAR(s.hull_volume - s.volume, height, 1e-8 * height + 1.1 * convex_tolerance * s.hull_volume);
}

void Invariants::expect_merges() const {
    std::vector<std::pair<int32_t, int32_t>> slice(2 * tets_ - 1);
    std::vector<bool> used(2 * tets_ - 1, false);
    for (size_t t = 0; t < tets_; ++t) slice[t] = {static_cast<int32_t>(t), static_cast<int32_t>(t + 1)};
    for (size_t m = 0; m + 1 < tets_; ++m) {
        for (size_t k = 0; k < 2; ++k) {
            const auto c = static_cast<size_t>(a_.merges[2 * m + k]);
            ASSERT_LT(c, tets_ + m);
            ASSERT_FALSE(used[c]) << "a cluster that was merged twice";
            used[c] = true;
        }
        const auto left = slice[static_cast<size_t>(a_.merges[2 * m])],
                   right = slice[static_cast<size_t>(a_.merges[2 * m + 1])];
        ASSERT_EQ(left.second, right.first) << "the leaves aren't in the tree's depth-first order";
        slice[tets_ + m] = {left.first, right.second};
    }
    // Every node of the dendrogram is one of the binary tree.
    const std::set<std::pair<int32_t, int32_t>> known(slice.begin(), slice.end());
    for (size_t n = 0; n < nodes_; ++n) EXPECT_TRUE(known.contains({a_.tet_first[n], a_.tet_last[n]}));
}

void Invariants::expect_questions() const {
    const size_t step = 1 + faces_ / sized<size_t>(200, 40);
    for (size_t f = 0; f < faces_; f += step) {
        std::vector<int32_t> expected;
        for (int32_t n = a_.leaf[f]; n >= 0; n = a_.parent[n]) expected.push_back(n);
        ASSERT_EQ(path(handle_, f), expected);
        const Wheel turned = wheel(handle_, f);
        ASSERT_FALSE(turned.stops.empty());
        ASSERT_LT(turned.start, turned.stops.size());
        EXPECT_EQ(static_cast<size_t>(turned.stops.back()), nodes_ - 1);
        for (size_t s = 0; s < turned.stops.size(); ++s) {
            ASSERT_TRUE(std::find(expected.begin(), expected.end(), turned.stops[s]) != expected.end());
            const auto n = static_cast<size_t>(turned.stops[s]);
            const int32_t *begin = a_.order + a_.first[n], *end = a_.order + a_.last[n];
            EXPECT_TRUE(std::find(begin, end, static_cast<int32_t>(f)) != end) << "a stop without the face clicked";
            if (s == 0) continue;
            const auto before = static_cast<size_t>(turned.stops[s - 1]);
            EXPECT_GT(n, before);
            EXPECT_GE(a_.area[n], (s + 1 < turned.stops.size() ? 1.1 : 1.0) * a_.area[before]);
        }
    }
    for (const size_t n : {size_t{0}, nodes_ / 2, nodes_ - 1}) {
        const int32_t* slice = nullptr;
        size_t count = 0;
        ASSERT_EQ(pw_hierarchy_faces(handle_.get(), n, &slice, &count), PW_OK);
        EXPECT_EQ(slice, a_.order + a_.first[n]);
        EXPECT_EQ(count, static_cast<size_t>(a_.last[n] - a_.first[n]));
    }
    // Cuts at a height: the largest nodes of at most that height.
    std::vector<double> heights{0, std::numeric_limits<double>::infinity()};
    for (size_t n = tets_; n < nodes_; n += 1 + (nodes_ - tets_) / 10) {
        heights.push_back(a_.height[n]);
        heights.push_back(std::nextafter(a_.height[n], 0));
    }
    for (const double height : heights) {
        std::set<int32_t> expected{0};
        for (size_t n = 0; n < nodes_; ++n)
            if (a_.height[n] <= height && (a_.parent[n] < 0 || a_.height[a_.parent[n]] > height))
                expected.insert(a_.tet_last[n]);
        const auto bounds = filled<int32_t>([&](int32_t* out, size_t capacity, size_t* count) {
            return pw_hierarchy_cut_height(handle_.get(), height, out, capacity, count);
        });
        EXPECT_EQ(bounds, std::vector<int32_t>(expected.begin(), expected.end())) << "height " << height;
    }
    // Cuts into parts: slices of clusters, as many as asked for.
    std::set<std::pair<int32_t, int32_t>> clusters;
    for (size_t t = 0; t < tets_; ++t) clusters.insert({static_cast<int32_t>(t), static_cast<int32_t>(t + 1)});
    std::vector<std::pair<int32_t, int32_t>> slice(clusters.begin(), clusters.end());
    for (size_t m = 0; m + 1 < tets_; ++m) {
        slice.push_back({slice[static_cast<size_t>(a_.merges[2 * m])].first,
                         slice[static_cast<size_t>(a_.merges[2 * m + 1])].second});
        clusters.insert(slice.back());
    }
    for (const size_t parts : {size_t{1}, size_t{2}, size_t{5}, size_t{40}, tets_}) {
        if (parts > std::min<size_t>(tets_, 4096)) continue;
        const auto bounds = filled<int32_t>([&](int32_t* out, size_t capacity, size_t* count) {
            return pw_hierarchy_cut_parts(handle_.get(), parts, out, capacity, count);
        });
        ASSERT_EQ(bounds.size(), parts + 1);
        EXPECT_EQ(bounds.front(), 0);
        EXPECT_EQ(static_cast<size_t>(bounds.back()), tets_);
        for (size_t k = 0; k < parts; ++k) EXPECT_TRUE(clusters.contains({bounds[k], bounds[k + 1]}));
    }
}

void Invariants::expect_star() const {
    EXPECT_EQ(nodes_, tets_ == 1 ? 1 : tets_ + 1);
    for (size_t t = 0; t + 1 < nodes_; ++t) EXPECT_EQ(static_cast<size_t>(a_.parent[t]), nodes_ - 1);
}

}  // namespace

void expect_invariants(const Handle& handle, const TriMesh& mesh, double volume, bool convex) {
    SCOPED_TRACE(mesh.name);
    ASSERT_NE(handle, nullptr);
    const Invariants invariants(handle, mesh);
    invariants.expect_sizes(volume);
    invariants.expect_vertices();
    invariants.expect_tree();
    invariants.expect_measures();
    invariants.expect_faces();
    invariants.expect_hulls();
    invariants.expect_merges();
    invariants.expect_questions();
    if (convex) invariants.expect_star();
}

}  // namespace partwheel::test
