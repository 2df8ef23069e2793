// The hierarchies of shells, joined to that of an assembly.
#include "tree/hierarchy.h"

#include "base/error.h"
#include "base/sorted.h"
#include "hull/hull.h"
#include "mesh/duplicates.h"
#include "mesh/face_assignment.h"

#include <queue>

namespace partwheel {

namespace {

constexpr const char* method_names[] = {"filled exactly", "filled after repair", "filled from points", "filled as thin solids"};

// Merges of a shell.
struct MergeRange {
    size_t next, end;
};

// A shell, or shells that were joined.
struct Group {
    int32_t cluster = -1;
    double volume = 0, area = 0, score = 0;
    Hull hull;
};

// Joins hierarchies of shells. The shells are in depth-first order, and so are all arrays by shell.
class Assembler {
public:
    Assembler(std::span<const ShellHierarchy> shells, Progress& progress) : shells_(shells), progress_(progress) {
        for (const ShellHierarchy& shell : shells) whole_area_ += shell.hierarchy.area();
    }

    void add_shells(size_t face_count, std::span<const int32_t> original) {
        data_.leaf.assign(face_count, -1);
        data_.face_area.assign(face_count, 0);
        pw_summary& sum = data_.summary;
        for (const ShellHierarchy& part : shells_) {
            const HierarchyData& shell = part.hierarchy.data();
            const auto tet = static_cast<int32_t>(data_.tetrahedra.size()), vertex = static_cast<int32_t>(data_.vertices.size());
            std::vector<int32_t>& cluster = cluster_.emplace_back(shell.tetrahedra.size());
            std::iota(cluster.begin(), cluster.end(), tet);
            data_.vertices.insert(data_.vertices.end(), shell.vertices.begin(), shell.vertices.end());
            for (const int32_t v : shell.source) data_.source.push_back(v < 0 ? -1 : part.vertices[idx(v)]);
            for (const Tetrahedron& t : shell.tetrahedra)
                data_.tetrahedra.push_back({t[0] + vertex, t[1] + vertex, t[2] + vertex, t[3] + vertex});
            for (size_t f = 0; f < part.faces.size(); ++f) {
                data_.leaf[idx(part.faces[f])] = shell.leaf[f] + tet;
                data_.face_area[idx(part.faces[f])] = shell.face_area[f];
            }
            for (const int32_t f : shell.outer_faces) data_.outer_faces.push_back(f < 0 ? -1 : part.faces[idx(f)]);
            const uint8_t fill = shell.shell_fills.front();
            data_.shell_fills.push_back(part.is_changed() && fill == PW_FILL_EXACT ? uint8_t{PW_FILL_REPAIRED} : fill);
            sum.components += shell.summary.components;
            sum.cavities += shell.summary.cavities;
            sum.added_vertices += shell.summary.added_vertices;
            sum.proxy_triangles += shell.summary.proxy_triangles;
            sum.fill_method = std::max(sum.fill_method, static_cast<pw_fill_method>(data_.shell_fills.back() & ~is_proxy));
        }
        (void)checked_index(data_.tetrahedra.size() + data_.tetrahedra.size());
        for (size_t f = 0; f < original.size(); ++f)
            if (data_.leaf[f] < 0) data_.leaf[f] = data_.leaf[idx(original[f])];
        frame_ = Frame::around(data_.vertices);
    }

    // The merges and scores of all shells: first the merges within initial parts, then those of the policy.
    void add_merges_within_shells() {
        std::vector<MergeRange> within_parts, of_policy;
        for (size_t s = 0; s < shells_.size(); ++s) {
            const std::vector<double>& scores = shells_[s].hierarchy.data().scores;
            const size_t all = shells_[s].hierarchy.merges().size(), policy = shells_[s].hierarchy.data().policy_merge_count();
            within_parts.push_back({0, all - policy});
            of_policy.push_back({all - policy, all});
            data_.scores.insert(data_.scores.end(), scores.begin(), scores.end() - static_cast<std::ptrdiff_t>(policy));
            if (policy == 0 && is_small(s)) data_.scores.back() = 1;
        }
        interleave(std::move(within_parts));
        interleave(std::move(of_policy));
    }

    // order: the numbers that the joins have for the shells.
    void join_shells(std::span<const std::array<int32_t, 2>> joins, std::span<const int32_t> order) {
        const std::vector<Point> points = data_.working_vertices();
        HullKernel kernel(points, progress_);
        std::vector<Group> groups(shells_.size());
        for (size_t s = 0, tet = 0; s < shells_.size(); ++s) {
            const Hierarchy& shell = shells_[s].hierarchy;
            const std::span<const Tetrahedron> tetrahedra = std::span(data_.tetrahedra).subspan(tet, shell.tetrahedron_count());
            groups[idx(order[s])] = {cluster_[s].back(), shell.summary().volume, shell.area(),
                                     is_small(s) ? 1 : shell.data().scores.back(), kernel.build(corner_vertices(tetrahedra))};
            tet += tetrahedra.size();
        }
        for (size_t j = 0; j < joins.size(); ++j) {
            progress_.advance(static_cast<double>(j) / static_cast<double>(joins.size()));
            // Depth-first order has the second one on the left.
            groups.push_back(join(groups[idx(joins[j][1])], groups[idx(joins[j][0])], kernel));
        }
        data_.summary.hull_volume = std::max(frame_.volume_to_caller(groups.back().hull.volume()), groups.back().volume);
    }

    // How the shells were filled, in sentences, unless all were filled exactly.
    void describe() {
        std::string& notes = data_.notes;
        double& deviation = data_.summary.deviation;
        const double size = Box::around(data_.vertices).diagonal();
        for (const auto& [shell, faces, vertices, duplicates, inner_faces, welded] : shells_)
            deviation = std::max(deviation, shell.summary().deviation * Box::around(shell.vertices()).diagonal() / size);
        if (std::ranges::all_of(data_.shell_fills, [](uint8_t fill) { return fill == PW_FILL_EXACT; })) return;
        FaceCounts counts;
        size_t inner_faces = 0, welded = 0;
        for (const ShellHierarchy& shell : shells_) {
            counts.duplicates += shell.duplicates;
            if (shells_.size() > 1) counts += shell.hierarchy.data().face_counts;  // else they are in the shell's own notes
            inner_faces += shell.inner_faces;
            welded += shell.welded;
        }
        if (shells_.size() == 1) {
            notes = shells_[0].hierarchy.notes();
        } else {
            notes = std::to_string(shells_.size()) + " shells: ";
            for (size_t m = 0; m < std::size(method_names); ++m) {
                const auto is_filled_so = [&](uint8_t fill) { return (fill & ~is_proxy) == 1 << m; };
                const auto count = std::ranges::count_if(data_.shell_fills, is_filled_so);
                if (count > 0) notes += (notes.back() == ' ' ? "" : ", ") + std::to_string(count) + " " + method_names[m];
            }
            notes += ".";
        }
        if (welded > 0)
            notes += (notes.empty() ? "Repaired: " : " ") + with_commas(welded) +
                     (welded == 1 ? " vertex merged with another." : " vertices merged with others.");
        add_face_notes(counts, notes);
        if (inner_faces > 0)
            notes += (notes.empty() ? "Double wall: " : " Double wall: ") +
                     counted_faces(inner_faces, "of the inner wall goes", "of the inner wall go") + " with the outer wall.";
    }

    Hierarchy finish() { return {std::move(data_), std::move(merges_)}; }

private:
    bool is_small(size_t s) const { return shells_[s].hierarchy.area() < small_shell * whole_area_; }
    int32_t next_cluster() const { return static_cast<int32_t>(data_.tetrahedra.size() + merges_.size()); }

    // Adds the merges of shells: each shell's in their order, and of the shells' next ones that with the least concavity
    // first, so that undoing the last merges undoes the most concave ones.
    void interleave(std::vector<MergeRange> ranges) {
        using Entry = std::tuple<double, size_t>;  // least first: concavity so far, shell
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        std::vector<double> highest(ranges.size(), 0);
        const auto enter = [&](size_t s) {
            if (ranges[s].next == ranges[s].end) return;
            highest[s] = std::max(highest[s], shells_[s].hierarchy.merges()[ranges[s].next].concavity);
            queue.emplace(highest[s], s);
        };
        for (size_t s = 0; s < ranges.size(); ++s) enter(s);
        while (!queue.empty()) {
            const size_t s = std::get<1>(queue.top());
            queue.pop();
            add_merge(s, ranges[s].next++);
            enter(s);
        }
    }

    void add_merge(size_t s, size_t m) {
        const Hierarchy& shell = shells_[s].hierarchy;
        const std::vector<double>& scores = shell.data().scores;
        const Merge& merge = shell.merges()[m];
        const size_t left = shell.merges().size() - m;  // merges, with this one
        const int32_t cluster = next_cluster();
        merges_.push_back({cluster_[s][idx(merge.left)], cluster_[s][idx(merge.right)], merge.concavity, 0});
        cluster_[s].push_back(cluster);
        if (left <= shell.data().policy_merge_count())
            data_.scores.push_back(left == 1 && is_small(s) ? 1 : scores[scores.size() - left]);
    }

    Group join(Group& left, Group& right, HullKernel& kernel) {
        Group joined{next_cluster(), left.volume + right.volume, left.area + right.area, 0, kernel.unite(left.hull, right.hull)};
        // A group that consists mostly of one shell or group is chosen about as often as that one.
        for (const Group* part : {&left, &right})
            if (joined.area > 0) joined.score = std::max(joined.score, part->score * part->area / joined.area);
        joined.score = std::max(joined.score, std::numeric_limits<float>::epsilon() + 0.0);
        const double hull_volume = frame_.volume_to_caller(joined.hull.volume());
        merges_.push_back({left.cluster, right.cluster, ranked_concavity(hull_volume, joined.volume), 0});
        data_.scores.push_back(joined.score);
        left.hull = Hull();
        right.hull = Hull();
        return joined;
    }

    std::span<const ShellHierarchy> shells_;
    Progress& progress_;
    double whole_area_ = 0;
    HierarchyData data_;
    std::vector<Merge> merges_;
    Frame frame_;
    std::vector<std::vector<int32_t>> cluster_;  // of each of a shell's clusters
};

}  // namespace

Hierarchy Hierarchy::assemble(std::vector<ShellHierarchy> shells, std::span<const std::array<int32_t, 2>> joins,
                              size_t face_count, std::span<const int32_t> original, Progress& progress) {
    std::vector<Merge> tree;  // depth-first order has the second one on the left
    for (const auto& [right, left] : joins) tree.push_back({left, right});
    const std::vector<int32_t> order = cut_undoing_last(tree, shells.size());
    std::vector<ShellHierarchy> sorted;
    for (const int32_t s : order) sorted.push_back(std::move(shells[idx(s)]));
    Assembler assembler(sorted, progress);
    assembler.add_shells(face_count, original);
    assembler.add_merges_within_shells();
    assembler.join_shells(joins, order);
    assembler.describe();
    return assembler.finish();
}

}  // namespace partwheel
