// Hierarchies built through the C API, and their invariants.
#include "support/built.h"

#include "support/sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <stdexcept>

namespace partwheel::test {

namespace {

void require_ok(pw_status status) {
    if (status != PW_OK) throw std::runtime_error(pw_error_message());
}

// Calls a function that fills an array twice: for the size, then for the values.
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

Built try_build(const TriMesh& mesh, double quality, pw_context* context, uint32_t fill_methods, int32_t mode) {
    pw_build_options options = PW_BUILD_OPTIONS_INIT;
    options.quality = quality;
    options.fill_methods = fill_methods;
    options.mode = mode;
    pw_hierarchy* made = nullptr;
    Built built;
    const pw_mesh_view view = mesh_view(mesh);
    built.status = pw_build(context, &view, &options, &made);
    if (built.status != PW_OK) built.message = pw_error_message();
    built.handle.reset(made);
    return built;
}

Handle build(const TriMesh& mesh, double quality, int32_t mode) {
    Built built = try_build(mesh, quality, nullptr, PW_FILL_EXACT, mode);
    if (built.status != PW_OK) throw std::runtime_error(mesh.name + ": " + built.message);
    return std::move(built.handle);
}

pw_arrays arrays(const Handle& handle) {
    pw_arrays a{};
    a.struct_size = sizeof a;
    require_ok(pw_hierarchy_arrays(handle.get(), &a));
    return a;
}

pw_summary summary(const Handle& handle) {
    pw_summary s{};
    s.struct_size = sizeof s;
    require_ok(pw_hierarchy_summary(handle.get(), &s));
    return s;
}

std::vector<uint8_t> save(const Handle& handle) {
    return filled<uint8_t>([&](uint8_t* bytes, size_t capacity, size_t* count) {
        return pw_hierarchy_save(nullptr, handle.get(), bytes, capacity, count);
    });
}

Built try_load(const std::vector<uint8_t>& bytes) {
    pw_hierarchy* made = nullptr;
    Built built;
    built.status = pw_hierarchy_load(nullptr, bytes.data(), bytes.size(), &made);
    if (built.status != PW_OK) built.message = pw_error_message();
    built.handle.reset(made);
    return built;
}

std::vector<int32_t> path(const Handle& handle, size_t face) {
    return filled<int32_t>([&](int32_t* nodes, size_t capacity, size_t* count) {
        return pw_hierarchy_path(handle.get(), face, nodes, capacity, count);
    });
}

Wheel wheel(const Handle& handle, size_t face, double view) {
    Wheel result;
    result.stops = filled<int32_t>([&](int32_t* nodes, size_t capacity, size_t* count) {
        return pw_hierarchy_wheel(handle.get(), face, view, nodes, capacity, count, &result.start);
    });
    return result;
}

HullMesh hull(const Handle& handle, size_t tet_first, size_t tet_last) {
    pw_mesh* made = nullptr;
    require_ok(pw_hierarchy_hull(nullptr, handle.get(), tet_first, tet_last, &made));
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

class Structure {
public:
    explicit Structure(const Handle& handle)
        : handle_(handle), a_(arrays(handle)), faces_(a_.face_count), nodes_(a_.node_count),
          tets_(a_.tetrahedron_count) {}

    void expect_tree() const;
    void expect_merges() const;
    void expect_questions() const;

private:
    bool leaf(size_t n) const { return n < tets_; }
    bool papers_tree() const { return a_.score[nodes_ - 1] == 0; }

    const Handle& handle_;
    pw_arrays a_;
    size_t faces_, nodes_, tets_;
};

void Structure::expect_tree() const {
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
        double height = a_.cost_class[n] == 1 ? a_.cost[n] : 0;  // its concavity
        for (const int32_t c : children[n]) {
            ASSERT_EQ(a_.tet_first[c], tet);
            ASSERT_EQ(a_.first[c], face);
            tet = a_.tet_last[c];
            face = a_.last[c];
            height = std::max(height, a_.height[c]);
            if (leaf(static_cast<size_t>(c))) continue;
            // Listing 2 leaves no child that costs as much as its parent, or with the merge policy that is as high;
            // the policy's own merges (n has a score, and is above a part) may.
            if (papers_tree())
                EXPECT_LT(std::pair(a_.cost_class[c], a_.cost[c]), std::pair(a_.cost_class[n], a_.cost[n]));
            else
                EXPECT_TRUE(a_.height[c] < a_.height[n] ||
                            (a_.score[n] > 0 && a_.score[c] > 0 && a_.height[c] == a_.height[n]));
        }
        ASSERT_EQ(tet, a_.tet_last[n]);
        ASSERT_EQ(face, a_.last[n]);
        EXPECT_GE(a_.score[n], 0);
        EXPECT_LE(a_.score[n], 1);
        EXPECT_EQ(a_.height[n], height);
        EXPECT_GT(a_.cost[n], 0);
        if (a_.cost_class[n] == 0) {
            EXPECT_LE(a_.cost[n], 1);
        }
    }
}

void Structure::expect_merges() const {
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

void Structure::expect_questions() const {
    const size_t step = 1 + faces_ / sized<size_t>(200, 40);
    for (size_t f = 0; f < faces_; f += step) {
        std::vector<int32_t> expected;
        for (int32_t n = a_.leaf[f]; n >= 0; n = a_.parent[n]) expected.push_back(n);
        ASSERT_EQ(path(handle_, f), expected);
        const Wheel turned = wheel(handle_, f);
        if (papers_tree()) {
            EXPECT_EQ(turned.stops, expected);
            EXPECT_EQ(turned.start, 0U);
            continue;
        }
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
        for (const bool least : {false, true}) {
            const auto bounds = filled<int32_t>([&](int32_t* out, size_t capacity, size_t* count) {
                return least ? pw_hierarchy_cut_least_concavity(nullptr, handle_.get(), parts, out, capacity, count)
                             : pw_hierarchy_cut_parts(handle_.get(), parts, out, capacity, count);
            });
            ASSERT_EQ(bounds.size(), parts + 1);
            EXPECT_EQ(bounds.front(), 0);
            EXPECT_EQ(static_cast<size_t>(bounds.back()), tets_);
            for (size_t k = 0; k < parts; ++k) EXPECT_TRUE(clusters.contains({bounds[k], bounds[k + 1]}));
        }
    }
}

}  // namespace

void expect_structure(const Handle& handle) {
    ASSERT_NE(handle, nullptr);
    const Structure structure(handle);
    structure.expect_tree();
    structure.expect_merges();
    structure.expect_questions();
}

}  // namespace partwheel::test
