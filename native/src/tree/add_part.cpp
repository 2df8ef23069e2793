// A hierarchy with one more node: a part that was made by hand.
#include "tree/hierarchy.h"

#include "base/error.h"
#include "base/sorted.h"
#include "hull/hull.h"

namespace partwheel {

namespace {

constexpr int32_t none = -1;
constexpr double least_score = std::numeric_limits<float>::epsilon();

// In the order of the merges: those within initial parts, those of the merge policy, those that join shells.
enum class Level : uint8_t { within_part, policy, join };

// A cluster of a tree that changes. New ones are appended, so children may have higher numbers than their parent.
struct Cluster {
    int32_t left = none, right = none, parent = none;
    int32_t rank = 0;  // the number of the cluster that it is or that it is a piece of
    Level level = Level::within_part;
    double concavity = 0, score = 0, area = 0, part_area = 0, volume = 0;  // part_area: of its faces in the part
    size_t faces = 0, part_faces = 0;

    bool is_mixed() const { return part_faces > 0 && part_faces < faces; }
    void add(const Cluster& child) {
        area += child.area;
        part_area += child.part_area;
        volume += child.volume;
        faces += child.faces;
        part_faces += child.part_faces;
    }
};

// Moves a part together: the smallest cluster around it becomes the union of the part and of the rest of that cluster.
// Clusters in between that have some of both are divided into a piece in the part and one outside.
class PartInserter {
public:
    PartInserter(const Hierarchy& hierarchy, Progress& progress)
        : hierarchy_(hierarchy), data_(hierarchy.data()), leaves_(data_.tetrahedra.size()), points_(data_.working_vertices()),
          kernel_(points_, progress), unit_(Frame::around(data_.vertices).volume_to_caller(1)), progress_(progress) {}

    // Throws Error(PW_ERROR_ARGUMENT) if the part has pieces of several shells, or (PW_ERROR_EMPTY) if it has no
    // tetrahedron.
    void insert(std::span<const int32_t> faces) {
        read_leaves(faces);
        read_merges();
        find_smallest_around();
        if (at(around_).level == Level::join)
            for (const Cluster& c : clusters_)
                if (c.level != Level::join && c.is_mixed())
                    throw Error(PW_ERROR_ARGUMENT,
                                "The part has only some faces of a shell, and faces of another. Choose whole shells, or "
                                "faces of one shell.");
        const int32_t part = at(around_).is_mixed() ? divide() : around_;
        // It is scored, so an initial part around it is divided into smaller ones.
        std::vector<int32_t> path;
        for (int32_t c = at(part).parent; c != none && at(c).level == Level::within_part; c = at(c).parent) path.push_back(c);
        for (const int32_t c : path) {
            at(c).level = Level::policy;
            for (const int32_t child : {at(c).left, at(c).right}) score_piece(child, path.back());
        }
        at(part).score = 1;
    }

    // The tree as it is now.
    HierarchyData collect(std::vector<Merge>& merges) const {
        HierarchyData data = data_;
        std::vector<int32_t> cluster = iota(leaves_), number = cluster;  // in the new order; of each cluster in it
        number.resize(clusters_.size());
        size_t policy = 0;
        for (const int32_t c : merges_in_order()) {
            const Cluster& merge = clusters_[idx(c)];
            number[idx(c)] = static_cast<int32_t>(cluster.size());
            cluster.push_back(c);
            merges.push_back({number[idx(merge.left)], number[idx(merge.right)], merge.concavity, 0});
            policy += merge.level != Level::within_part;
        }
        const auto score = [&](int32_t n) { return clusters_[idx(cluster[idx(n)])].score; };
        data.scores.clear();
        for (const int32_t n : cut_undoing_last(merges, policy + 1)) data.scores.push_back(score(n));
        for (size_t n = cluster.size() - policy; n < cluster.size(); ++n) data.scores.push_back(score(static_cast<int32_t>(n)));

        std::vector<size_t> first_outer = {0};  // of each tetrahedron
        for (const std::array<int32_t, 4>& sides : find_neighbors(data_.tetrahedra))
            first_outer.push_back(first_outer.back() + static_cast<size_t>(std::ranges::count(sides, none)));
        data.tetrahedra.clear();
        data.outer_faces.clear();
        data.shell_fills.clear();
        size_t last_shell = data_.shell_fills.size();
        for (const int32_t t : sort_leaves(merges)) {
            number[idx(t)] = static_cast<int32_t>(data.tetrahedra.size());
            data.tetrahedra.push_back(data_.tetrahedra[idx(t)]);
            for (size_t i = first_outer[idx(t)]; i < first_outer[idx(t) + 1]; ++i)
                data.outer_faces.push_back(data_.outer_faces[i]);
            const size_t shell = hierarchy_.shell_of(idx(t));
            if (shell != last_shell) data.shell_fills.push_back(data_.shell_fills[shell]);
            last_shell = shell;
        }
        for (int32_t& l : data.leaf) l = number[idx(l)];
        return data;
    }

private:
    Cluster& at(int32_t c) { return clusters_[idx(c)]; }
    bool is_initial(int32_t c) {
        return at(c).level == Level::within_part && (at(c).parent == none || at(at(c).parent).level != Level::within_part);
    }

    void read_leaves(std::span<const int32_t> faces) {
        clusters_.resize(leaves_);
        std::vector<uint8_t> is_inside(data_.leaf.size(), 0);
        for (const int32_t f : faces) is_inside[idx(f)] = 1;
        for (size_t f = 0; f < data_.leaf.size(); ++f) {
            const double area = data_.face_area[f];
            Cluster face;
            face.area = area;
            face.faces = 1;
            if (is_inside[f]) face.part_area = area, face.part_faces = 1;
            at(data_.leaf[f]).add(face);
        }
        const double* volume = hierarchy_.arrays().volume;
        for (size_t t = 0; t < leaves_; ++t) {  // a tetrahedron goes with most of its area
            Cluster& leaf = clusters_[t];
            leaf.rank = static_cast<int32_t>(t);
            leaf.volume = volume[t];
            const bool goes = leaf.area > 0 ? 2 * leaf.part_area > leaf.area : 2 * leaf.part_faces > leaf.faces;
            leaf.part_faces = goes ? leaf.faces : 0;
            leaf.part_area = goes ? leaf.area : 0;
        }
    }

    void read_merges() {
        size_t left = hierarchy_.merges().size();  // merges, with this one
        for (const Merge& merge : hierarchy_.merges()) {
            const auto c = static_cast<int32_t>(clusters_.size());
            Cluster cluster;
            cluster.left = merge.left;
            cluster.right = merge.right;
            cluster.rank = c;
            cluster.concavity = merge.concavity;
            if (left <= data_.policy_merge_count()) cluster.level = left < data_.shell_fills.size() ? Level::join : Level::policy;
            for (const int32_t child : {merge.left, merge.right}) {
                at(child).parent = c;
                cluster.add(at(child));
            }
            clusters_.push_back(cluster);
            --left;
        }
        const std::vector<double> scores = hierarchy_.cluster_scores();
        for (size_t c = 0; c < scores.size(); ++c) clusters_[c].score = scores[c];
    }

    void find_smallest_around() {
        const size_t whole = clusters_.back().part_faces;
        if (whole == 0) throw Error(PW_ERROR_EMPTY, "The part is smaller than the tetrahedra behind it. Choose more faces.");
        const auto has_faces = [](const Cluster& c) { return c.part_faces > 0; };
        around_ = std::ranges::find_if(clusters_, has_faces)->rank;
        while (at(around_).part_faces < whole) around_ = at(around_).parent;
    }

    // Returns the part. Clusters without faces go with their sibling, or with the larger piece of it.
    int32_t divide() {
        std::vector<std::array<int32_t, 2>> pieces(idx(around_) + 1, {none, none});  // outside, inside; of mixed clusters
        const auto pieces_of = [&](int32_t c, int32_t sibling) -> std::array<int32_t, 2> {
            if (at(c).is_mixed()) return pieces[idx(c)];
            const bool is_inside = at(c).faces > 0 ? at(c).part_faces > 0 : 2 * at(sibling).part_area > at(sibling).area;
            return is_inside ? std::array{none, c} : std::array{c, none};
        };
        for (int32_t c = 0; c <= around_; ++c) {  // children first
            if (!at(c).is_mixed()) continue;
            progress_.reach(0.8 * c / around_);
            const int32_t left = at(c).left, right = at(c).right;
            const std::array<int32_t, 2> from_left = pieces_of(left, right), from_right = pieces_of(right, left);
            for (size_t side = 0; side < 2; ++side) pieces[idx(c)][side] = join(from_left[side], from_right[side], c);
            if (is_initial(c))
                for (const int32_t piece : pieces[idx(c)]) score_piece(piece, c);
        }
        const auto [outside, inside] = pieces[idx(around_)];
        at(around_).left = outside;
        at(around_).right = inside;
        at(outside).parent = at(inside).parent = around_;
        hulls_.clear();
        return inside;
    }

    // A piece scores less than the original, by its share of the area.
    void score_piece(int32_t piece, int32_t original) {
        if (piece == original) return;
        const double share = at(original).area > 0 ? at(piece).area / at(original).area : 0;
        // Not 0, which marks merges that are no nodes.
        if (at(original).score > 0) at(piece).score = std::max(at(original).score * share, least_score);
    }

    // The union of two pieces, one of which may be missing.
    int32_t join(int32_t a, int32_t b, int32_t original) {
        if (a == none || b == none) return a == none ? b : a;
        const auto joined = static_cast<int32_t>(clusters_.size());
        Cluster c;
        c.left = a;
        c.right = b;
        c.rank = original;
        c.level = at(original).level;
        for (const int32_t child : {a, b}) {
            at(child).parent = joined;
            c.add(at(child));
        }
        const Hull hull_a = take_hull(a), hull_b = take_hull(b);
        Hull hull = kernel_.unite(hull_a, hull_b);
        c.concavity = ranked_concavity(hull.volume() * unit_, c.volume);
        hulls_.emplace(joined, std::move(hull));
        clusters_.push_back(c);
        if (c.level != Level::within_part) score_piece(joined, original);
        return joined;
    }

    // Clusters that are not new are slices of the tetrahedra.
    Hull take_hull(int32_t c) {
        if (const auto known = hulls_.find(c); known != hulls_.end()) return std::move(hulls_.extract(known).mapped());
        size_t first = idx(c), last = idx(c);
        while (first >= leaves_) first = idx(clusters_[first].left);
        while (last >= leaves_) last = idx(clusters_[last].right);
        return kernel_.build(corner_vertices(std::span(data_.tetrahedra).subspan(first, last - first + 1)));
    }

    // A piece comes before the cluster of the same rank, which is their union. Clusters that were divided are gone.
    std::vector<int32_t> merges_in_order() const {
        std::vector<int32_t> order;
        for (auto c = static_cast<int32_t>(leaves_); idx(c) < clusters_.size(); ++c)
            if (c >= around_ || !clusters_[idx(c)].is_mixed()) order.push_back(c);
        std::ranges::sort(order, {}, [&](int32_t c) {
            const Cluster& cluster = clusters_[idx(c)];
            return std::tuple(cluster.level, cluster.rank, cluster.rank == c, c);
        });
        return order;
    }

    const Hierarchy& hierarchy_;
    const HierarchyData& data_;
    const size_t leaves_;
    const std::vector<Point> points_;
    HullKernel kernel_;
    const double unit_;  // working volumes times this are the caller's
    Progress& progress_;
    std::vector<Cluster> clusters_;
    int32_t around_ = none;          // the smallest cluster around the part
    std::map<int32_t, Hull> hulls_;  // of new clusters
};

}  // namespace

Hierarchy Hierarchy::with_part(std::span<const int32_t> faces, Progress& progress) const {
    if (data_.scores.empty())
        throw Error(PW_ERROR_ARGUMENT, "Parts made by hand need a hierarchy that was built in the default mode.");
    PartInserter tree(*this, progress);
    tree.insert(faces);
    progress.reach(0.8);
    std::vector<Merge> merges;
    HierarchyData data = tree.collect(merges);
    return {std::move(data), std::move(merges)};
}

}  // namespace partwheel
