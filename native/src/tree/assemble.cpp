// The hierarchies of shells, joined to that of an assembly.
#include "tree/hierarchy.h"

#include "base/checked_index.h"
#include "hull/hull.h"
#include "mesh/duplicates.h"
#include "mesh/face_assignment.h"
#include "tree/saved.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

namespace partwheel {

namespace {

constexpr const char* method_names[] = {"filled exactly", "filled after repair", "filled from points", "filled as thin solids"};

// Shells in the depth-first order of the tree that joins them.
std::vector<size_t> depth_first(std::span<const std::array<int32_t, 2>> joins) {
    const size_t count = joins.size() + 1;
    std::vector<size_t> order, todo = {count + joins.size() - 1};
    while (!todo.empty()) {
        const size_t n = todo.back();
        todo.pop_back();
        if (n < count)
            order.push_back(n);
        else
            for (const int32_t child : joins[n - count]) todo.push_back(idx(child));
    }
    return order;
}

// The merges of all shells that are in the same half (below or above the parts): those of each shell in their order,
// and of several the one with the least concavity first, so that a cut into some parts undoes the most concave ones.
struct MergeRange {
    size_t shell, next, end;
};

template <class Take>
void interleave(std::vector<MergeRange> ranges, const std::vector<std::span<const Merge>>& merges, const Take& take) {
    using Entry = std::tuple<double, size_t, size_t>;  // least first: concavity so far, shell's place, range
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::vector<double> highest(ranges.size(), 0);
    const auto enter = [&](size_t r) {
        if (ranges[r].next == ranges[r].end) return;
        highest[r] = std::max(highest[r], merges[ranges[r].shell][ranges[r].next].concavity);
        queue.emplace(highest[r], ranges[r].shell, r);
    };
    for (size_t r = 0; r < ranges.size(); ++r) enter(r);
    while (!queue.empty()) {
        const size_t r = std::get<2>(queue.top());
        queue.pop();
        take(ranges[r].shell, ranges[r].next++);
        enter(r);
    }
}

}  // namespace

Hierarchy Hierarchy::assemble(std::vector<ShellHierarchy> given, std::span<const std::array<int32_t, 2>> joins,
                              size_t face_count, std::span<const int32_t> original, Progress& progress) {
    std::vector<ShellHierarchy> shells;  // in depth-first order, and so are all arrays by shell
    const std::vector<size_t> order = depth_first(joins);
    for (const size_t s : order) shells.push_back(std::move(given[s]));

    Hierarchy h;
    h.leaf_.assign(face_count, -1);
    h.face_area_.assign(face_count, 0);
    std::vector<size_t> first_tet;
    for (const ShellHierarchy& part : shells) {
        const auto& [shell, faces, vertices, duplicates, inner_faces, welded] = part;
        const auto tet = static_cast<int32_t>(h.tetrahedra_.size()), vertex = static_cast<int32_t>(h.vertices_.size());
        first_tet.push_back(h.tetrahedra_.size());
        h.vertices_.insert(h.vertices_.end(), shell.vertices_.begin(), shell.vertices_.end());
        for (const int32_t v : shell.source_) h.source_.push_back(v < 0 ? -1 : vertices[idx(v)]);
        for (const Tetrahedron& t : shell.tetrahedra_)
            h.tetrahedra_.push_back({t[0] + vertex, t[1] + vertex, t[2] + vertex, t[3] + vertex});
        for (size_t f = 0; f < faces.size(); ++f) {
            h.leaf_[idx(faces[f])] = shell.leaf_[f] + tet;
            h.face_area_[idx(faces[f])] = shell.face_area_[f];
        }
        for (const int32_t f : shell.outer_faces_) h.outer_faces_.push_back(f < 0 ? -1 : faces[idx(f)]);
        const uint8_t fill = shell.shell_fills_.front();
        h.shell_fills_.push_back(part.is_changed() && fill == PW_FILL_EXACT ? uint8_t{PW_FILL_REPAIRED} : fill);
        h.summary_.components += shell.summary_.components;
        h.summary_.cavities += shell.summary_.cavities;
        h.summary_.added_vertices += shell.summary_.added_vertices;
        h.summary_.proxy_triangles += shell.summary_.proxy_triangles;
        h.summary_.fill_method = std::max(h.summary_.fill_method, static_cast<pw_fill_method>(h.shell_fills_.back() & ~is_proxy));
    }
    (void)checked_index(h.tetrahedra_.size() + h.tetrahedra_.size());
    for (size_t f = 0; f < original.size(); ++f)
        if (h.leaf_[f] < 0) h.leaf_[f] = h.leaf_[idx(original[f])];
    h.join_trees(shells, order, first_tet, joins, progress);
    h.describe_assembly(shells);
    h.derive();
    return h;
}

// The merges and scores of all shells, then those of the joins.
void Hierarchy::join_trees(std::span<const ShellHierarchy> shells, std::span<const size_t> order,
                           std::span<const size_t> first_tet, std::span<const std::array<int32_t, 2>> joins,
                           Progress& progress) {
    const size_t count = shells.size(), leaves = tetrahedra_.size();
    std::vector<std::vector<int32_t>> cluster(count);  // of each of a shell's clusters
    std::vector<std::span<const Merge>> merges;
    std::vector<MergeRange> below, above;
    double whole_area = 0;
    for (size_t s = 0; s < count; ++s) {
        const Hierarchy& shell = shells[s].hierarchy;
        const size_t own = shell.tetrahedra_.size(), all = shell.merges_.size(), parts = shell.policy_merge_count();
        whole_area += shell.area_.back();
        cluster[s].resize(own + all);
        std::iota(cluster[s].begin(), cluster[s].begin() + static_cast<std::ptrdiff_t>(own), static_cast<int32_t>(first_tet[s]));
        merges.emplace_back(shell.merges_);
        below.push_back({s, 0, all - parts});
        above.push_back({s, all - parts, all});
    }
    const auto is_small = [&](size_t s) { return shells[s].hierarchy.area_.back() < small_shell * whole_area; };
    for (size_t s = 0; s < count; ++s) {
        const Hierarchy& shell = shells[s].hierarchy;
        const size_t parts = shell.scores_.size() / 2 + 1;
        scores_.insert(scores_.end(), shell.scores_.begin(), shell.scores_.begin() + static_cast<std::ptrdiff_t>(parts));
        if (parts == 1 && is_small(s)) scores_.back() = 1;
    }
    const auto take = [&](size_t s, size_t m) {
        const Hierarchy& shell = shells[s].hierarchy;
        const Merge& merge = shell.merges_[m];
        const size_t own = shell.tetrahedra_.size(), all = shell.merges_.size(), parts = shell.policy_merge_count();
        cluster[s][own + m] = static_cast<int32_t>(leaves + merges_.size());
        merges_.push_back({cluster[s][idx(merge.left)], cluster[s][idx(merge.right)], merge.concavity, 0});
        if (m + parts < all) return;
        const bool is_root = m + 1 == all;
        scores_.push_back(is_root && is_small(s) ? 1 : shell.scores_[parts + 1 + m - (all - parts)]);
    };
    interleave(std::move(below), merges, take);
    interleave(std::move(above), merges, take);

    // Joins: numbers of joins count from `count` on, those of shells are not in depth-first order.
    std::vector<size_t> place(count);
    for (size_t i = 0; i < count; ++i) place[order[i]] = i;
    const Frame frame = Frame::around(vertices_);
    std::vector<Point> points;
    for (const Point& p : vertices_) points.push_back(frame.to_working(p));
    HullKernel kernel(points, progress);
    struct Group {
        int32_t cluster;
        double volume, area, score;
        Hull hull;
    };
    std::vector<Group> groups;
    for (size_t n = 0; n < count; ++n) {
        const size_t s = place[n];
        const Hierarchy& shell = shells[s].hierarchy;
        std::vector<int32_t> corners;
        const size_t end = s + 1 < count ? first_tet[s + 1] : leaves;
        for (size_t t = first_tet[s]; t < end; ++t) corners.insert(corners.end(), tetrahedra_[t].begin(), tetrahedra_[t].end());
        std::ranges::sort(corners);
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
        groups.push_back({cluster[s].back(), shell.summary_.volume, shell.area_.back(), is_small(s) ? 1 : shell.scores_.back(),
                          kernel.build(corners)});
    }
    for (size_t j = 0; j < joins.size(); ++j) {
        progress.advance(static_cast<double>(j) / static_cast<double>(joins.size()));
        // Depth-first order has the second one on the left.
        Group &left = groups[idx(joins[j][1])], &right = groups[idx(joins[j][0])];
        const auto [small, large] = std::minmax(left.hull, right.hull, has_fewer_facets);
        Group joined{static_cast<int32_t>(leaves + merges_.size()), left.volume + right.volume, left.area + right.area, 0,
                     kernel.unite(large, small.vertices())};
        // A group that is mostly one shell or group is what people take about as often as that.
        for (const Group* part : {&left, &right})
            if (joined.area > 0) joined.score = std::max(joined.score, part->score * part->area / joined.area);
        joined.score = std::max(joined.score, std::numeric_limits<float>::epsilon() + 0.0);
        const double hull_volume = frame.volume_to_caller(joined.hull.volume());
        merges_.push_back({left.cluster, right.cluster, ranked_concavity(hull_volume, joined.volume), 0});
        scores_.push_back(joined.score);
        left.hull = Hull();
        right.hull = Hull();
        groups.push_back(std::move(joined));
    }
    summary_.hull_volume = std::max(frame.volume_to_caller(groups.back().hull.volume()), groups.back().volume);
}

// How the shells were filled, in sentences, unless all were filled exactly.
void Hierarchy::describe_assembly(std::span<const ShellHierarchy> shells) {
    const double size = Box::around(vertices_).diagonal();
    for (const ShellHierarchy& shell : shells)
        summary_.deviation = std::max(summary_.deviation, shell.hierarchy.summary_.deviation *
                                                              Box::around(shell.hierarchy.vertices_).diagonal() / size);
    if (std::ranges::all_of(shell_fills_, [](uint8_t fill) { return fill == PW_FILL_EXACT; })) return;
    FaceCounts counts;
    size_t inner_faces = 0, welded = 0;
    for (const ShellHierarchy& shell : shells) {
        counts.duplicates += shell.duplicates;
        if (shells.size() > 1) counts += shell.hierarchy.face_counts_;  // else they are in the shell's own notes
        inner_faces += shell.inner_faces;
        welded += shell.welded;
    }
    if (shells.size() == 1) {
        notes_ = shells[0].hierarchy.notes_;
    } else {
        notes_ = std::to_string(shells.size()) + " shells: ";
        for (size_t m = 0; m < std::size(method_names); ++m) {
            const auto count = std::ranges::count_if(shell_fills_, [&](uint8_t fill) { return (fill & ~is_proxy) == 1 << m; });
            if (count > 0) notes_ += (notes_.back() == ' ' ? "" : ", ") + std::to_string(count) + " " + method_names[m];
        }
        notes_ += ".";
    }
    if (welded > 0)
        notes_ += (notes_.empty() ? "Repaired: " : " ") + with_commas(welded) +
                    (welded == 1 ? " vertex merged with another." : " vertices merged with others.");
    add_face_notes(counts, notes_);
    if (inner_faces > 0)
        notes_ += (notes_.empty() ? "Double wall: " : " Double wall: ") +
                    counted_faces(inner_faces, "of the inner wall goes", "of the inner wall go") + " with the outer wall.";
}

}  // namespace partwheel
