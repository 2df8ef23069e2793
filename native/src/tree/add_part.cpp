// A hierarchy with one more node: a part that was made by hand.
#include "tree/adjacency.h"
#include "tree/hierarchy.h"

#include "base/error.h"
#include "hull/hull.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

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
};

// Moves a part together: the smallest cluster around it becomes the union of the part and of the rest of that cluster. Clusters
// in between that have some of both are divided into a piece in the part and one outside.
class PartInserter {
public:
    PartInserter(std::vector<Cluster> clusters, std::span<const Tetrahedron> tetrahedra, std::vector<Point> points, double unit,
                 Progress& progress)
        : clusters_(std::move(clusters)), tetrahedra_(tetrahedra), points_(std::move(points)), kernel_(points_, progress), unit_(unit), progress_(progress) {}

    // Throws Error(PW_ERROR_ARGUMENT) if the part has pieces of several shells, or (PW_ERROR_EMPTY) if it has no tetrahedron.
    void insert();
    // The tetrahedra in depth-first order.
    std::vector<int32_t> leaves() const;
    // The merges from the first to the last.
    std::vector<int32_t> merges() const;
    // The roots of the initial parts in depth-first order.
    std::vector<int32_t> initial_parts() const;
    const Cluster& operator[](int32_t c) const { return clusters_[idx(c)]; }

private:
    Cluster& at(int32_t c) { return clusters_[idx(c)]; }
    bool is_initial(int32_t c) const {
        const Cluster& cluster = clusters_[idx(c)];
        return cluster.level == Level::within_part &&
               (cluster.parent == none || clusters_[idx(cluster.parent)].level != Level::within_part);
    }
    int32_t root() const { return static_cast<int32_t>(2 * tetrahedra_.size() - 2); }
    int32_t smallest_around() const;
    int32_t divide(int32_t around);
    void score_piece(int32_t piece, int32_t original);
    int32_t join(int32_t a, int32_t b, int32_t original);
    void measure_hull(int32_t c);
    Hull take_hull(int32_t c);
    template <class IsEnd>
    std::vector<int32_t> depth_first(const IsEnd& is_end) const;

    std::vector<Cluster> clusters_;
    std::span<const Tetrahedron> tetrahedra_;
    std::vector<Point> points_;
    HullKernel kernel_;
    double unit_;  // working volumes times this are the caller's
    Progress& progress_;
    std::map<int32_t, Hull> hulls_;  // of new clusters
};

void PartInserter::insert() {
    const int32_t around = smallest_around();
    const bool is_cluster = !clusters_[idx(around)].is_mixed();
    if (clusters_[idx(around)].level == Level::join)
        for (const Cluster& c : clusters_)
            if (c.level != Level::join && c.is_mixed())
                throw Error(PW_ERROR_ARGUMENT,
                            "The part has a piece of one shell and something of another. Choose whole shells, or faces of one.");
    const int32_t part = is_cluster ? around : divide(around);
    // It is scored, so an initial part around it is divided into smaller ones.
    std::vector<int32_t> path;
    for (int32_t c = at(part).parent; c != none && at(c).level == Level::within_part; c = at(c).parent) path.push_back(c);
    for (const int32_t c : path) {
        at(c).level = Level::policy;
        for (const int32_t child : {at(c).left, at(c).right}) score_piece(child, path.back());
    }
    at(part).score = 1;
}

int32_t PartInserter::smallest_around() const {
    const size_t leaves = tetrahedra_.size(), whole = clusters_[idx(root())].part_faces;
    size_t first = 0;
    while (first < leaves && clusters_[first].part_faces == 0) ++first;
    if (first == leaves)
        throw Error(PW_ERROR_EMPTY, "The part is smaller than the tetrahedra behind it. Choose more faces.");
    int32_t c = static_cast<int32_t>(first);
    while (clusters_[idx(c)].part_faces < whole) c = clusters_[idx(c)].parent;
    return c;
}

// Returns the part. Clusters without faces go with their sibling, or with the larger piece of it.
int32_t PartInserter::divide(int32_t around) {
    std::vector<std::array<int32_t, 2>> pieces(idx(around) + 1, {none, none});  // outside, inside; of mixed clusters
    const auto pieces_of = [&](int32_t c) -> std::array<int32_t, 2> {
        if (at(c).is_mixed()) return pieces[idx(c)];
        return at(c).part_faces > 0 ? std::array{none, c} : std::array{c, none};
    };
    std::vector<int32_t> mixed;  // children first
    for (std::vector<int32_t> todo = {around}; !todo.empty();) {
        const int32_t c = todo.back();
        todo.pop_back();
        mixed.push_back(c);
        for (const int32_t child : {at(c).left, at(c).right})
            if (at(child).is_mixed()) todo.push_back(child);
    }
    std::ranges::sort(mixed);
    for (size_t i = 0; i < mixed.size(); ++i) {
        const int32_t c = mixed[i];
        progress_.reach(0.8 * static_cast<double>(i) / static_cast<double>(mixed.size()));
        std::array<int32_t, 2> left = pieces_of(at(c).left), right = pieces_of(at(c).right);
        const auto follow = [&](std::array<int32_t, 2>& child, int32_t cluster, int32_t sibling) {
            if (at(cluster).faces > 0) return;
            const bool is_inside = 2 * at(sibling).part_area > at(sibling).area;
            child = is_inside ? std::array{none, cluster} : std::array{cluster, none};
        };
        follow(left, at(c).left, at(c).right);
        follow(right, at(c).right, at(c).left);
        std::array<int32_t, 2>& both = pieces[idx(c)];
        for (size_t side = 0; side < 2; ++side) both[side] = join(left[side], right[side], c);
        if (is_initial(c))
            for (const int32_t piece : both) score_piece(piece, c);
    }
    at(around).left = pieces[idx(around)][0];
    at(around).right = pieces[idx(around)][1];
    for (const int32_t piece : pieces[idx(around)]) at(piece).parent = around;
    hulls_.clear();
    return at(around).right;
}

// A piece scores less than the original, by its share of the area.
void PartInserter::score_piece(int32_t piece, int32_t original) {
    if (piece == original) return;
    const double share = at(original).area > 0 ? at(piece).area / at(original).area : 0;
    // Not 0, which marks merges that are no nodes.
    if (at(original).score > 0) at(piece).score = std::max(at(original).score * share, least_score);
}

// The union of two pieces, one of which may be missing.
int32_t PartInserter::join(int32_t a, int32_t b, int32_t original) {
    if (a == none || b == none) return a == none ? b : a;
    const auto joined = static_cast<int32_t>(clusters_.size());
    Cluster c;
    c.left = a;
    c.right = b;
    c.rank = original;
    c.level = at(original).level;
    c.area = at(a).area + at(b).area;
    c.volume = at(a).volume + at(b).volume;
    at(a).parent = at(b).parent = joined;
    clusters_.push_back(c);
    if (c.level != Level::within_part) score_piece(joined, original);
    measure_hull(joined);
    return joined;
}

void PartInserter::measure_hull(int32_t c) {
    Hull a = take_hull(at(c).left), b = take_hull(at(c).right);
    const auto [small, large] = std::minmax(a, b, has_fewer_facets);
    Hull hull = kernel_.unite(large, small.vertices());
    at(c).concavity = ranked_concavity(hull.volume() * unit_, at(c).volume);
    hulls_.emplace(c, std::move(hull));
}

Hull PartInserter::take_hull(int32_t c) {
    if (const auto known = hulls_.find(c); known != hulls_.end()) return std::move(hulls_.extract(known).mapped());
    std::vector<int32_t> corners;
    for (std::vector<int32_t> todo = {c}; !todo.empty();) {
        const int32_t next = todo.back();
        todo.pop_back();
        if (idx(next) < tetrahedra_.size())
            corners.insert(corners.end(), tetrahedra_[idx(next)].begin(), tetrahedra_[idx(next)].end());
        else
            todo.insert(todo.end(), {at(next).left, at(next).right});
    }
    std::ranges::sort(corners);
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    return kernel_.build(corners);
}

template <class IsEnd>
std::vector<int32_t> PartInserter::depth_first(const IsEnd& is_end) const {
    std::vector<int32_t> result;
    for (std::vector<int32_t> todo = {root()}; !todo.empty();) {
        const int32_t c = todo.back();
        todo.pop_back();
        if (is_end(c))
            result.push_back(c);
        else
            todo.insert(todo.end(), {clusters_[idx(c)].right, clusters_[idx(c)].left});
    }
    return result;
}

std::vector<int32_t> PartInserter::leaves() const {
    return depth_first([&](int32_t c) { return idx(c) < tetrahedra_.size(); });
}

std::vector<int32_t> PartInserter::initial_parts() const {
    return depth_first([&](int32_t c) { return clusters_[idx(c)].level == Level::within_part; });
}

// A piece comes before the cluster of the same rank, which is their union.
std::vector<int32_t> PartInserter::merges() const {
    std::vector<int32_t> result;
    for (std::vector<int32_t> todo = {root()}; !todo.empty();) {
        const int32_t c = todo.back();
        todo.pop_back();
        if (idx(c) < tetrahedra_.size()) continue;
        result.push_back(c);
        todo.insert(todo.end(), {clusters_[idx(c)].right, clusters_[idx(c)].left});
    }
    std::ranges::sort(result, {}, [&](int32_t c) {
        const Cluster& cluster = clusters_[idx(c)];
        return std::tuple(cluster.level, cluster.rank, cluster.rank == c, c);
    });
    return result;
}

}  // namespace

Hierarchy Hierarchy::with_part(std::span<const int32_t> faces, Progress& progress) const {
    if (scores_.empty())
        throw Error(PW_ERROR_ARGUMENT, "The paper's tree takes no parts made by hand. Build the hierarchy in the default mode.");
    const size_t leaves = tetrahedra_.size(), count = leaves + merges_.size(), policy = policy_merge_count();
    std::vector<Cluster> clusters(count);
    std::vector<uint8_t> is_inside(leaf_.size(), 0);
    for (const int32_t f : faces) is_inside[idx(f)] = 1;
    for (size_t f = 0; f < leaf_.size(); ++f) {
        Cluster& leaf = clusters[idx(leaf_[f])];
        leaf.area += face_area_[f];
        ++leaf.faces;
        if (!is_inside[f]) continue;
        leaf.part_area += face_area_[f];
        ++leaf.part_faces;
    }
    for (size_t t = 0; t < leaves; ++t) {  // a tetrahedron goes with most of its area
        Cluster& leaf = clusters[t];
        leaf.volume = volume_[t];
        const bool goes = leaf.area > 0 ? 2 * leaf.part_area > leaf.area : 2 * leaf.part_faces > leaf.faces;
        leaf.part_faces = goes ? leaf.faces : 0;
        leaf.part_area = goes ? leaf.area : 0;
    }
    for (size_t c = 0; c < count; ++c) {
        clusters[c].rank = static_cast<int32_t>(c);
        if (c < leaves) continue;
        const Merge& merge = merges_[c - leaves];
        Cluster& cluster = clusters[c];
        cluster.left = merge.left;
        cluster.right = merge.right;
        cluster.concavity = merge.concavity;
        if (c + policy >= count) cluster.level = c + shell_fills_.size() > count ? Level::join : Level::policy;
        for (const int32_t child : {merge.left, merge.right}) {
            Cluster& part = clusters[idx(child)];
            part.parent = static_cast<int32_t>(c);
            cluster.area += part.area;
            cluster.part_area += part.part_area;
            cluster.volume += part.volume;
            cluster.faces += part.faces;
            cluster.part_faces += part.part_faces;
        }
    }
    auto score = scores_.begin();
    for (const int32_t c : cut_undoing_last(merges_, policy + 1)) clusters[idx(c)].score = *score++;
    for (size_t c = count - policy; c < count; ++c) clusters[c].score = *score++;

    std::vector<Point> points;
    for (const Point& p : vertices_) points.push_back(frame_.to_working(p));
    PartInserter tree(std::move(clusters), tetrahedra_, std::move(points), frame_.volume_to_caller(1), progress);
    tree.insert();
    progress.reach(0.8);

    Hierarchy h;
    h.vertices_ = vertices_;
    h.source_ = source_;
    h.face_area_ = face_area_;
    h.summary_ = summary_;
    h.notes_ = notes_;
    h.face_counts_ = face_counts_;
    std::vector<int32_t> number(2 * count, none);  // of each cluster in h
    std::vector<size_t> first_outer = {0};         // of each tetrahedron
    for (const std::array<int32_t, 4>& sides : find_neighbors(tetrahedra_))
        first_outer.push_back(first_outer.back() + static_cast<size_t>(std::ranges::count(sides, none)));
    size_t last_shell = shell_fills_.size();
    for (const int32_t t : tree.leaves()) {
        number[idx(t)] = static_cast<int32_t>(h.tetrahedra_.size());
        h.tetrahedra_.push_back(tetrahedra_[idx(t)]);
        const auto begin = outer_faces_.begin();
        h.outer_faces_.insert(h.outer_faces_.end(), begin + static_cast<std::ptrdiff_t>(first_outer[idx(t)]),
                              begin + static_cast<std::ptrdiff_t>(first_outer[idx(t) + 1]));
        if (const size_t shell = shell_of(idx(t)); shell != last_shell) h.shell_fills_.push_back(shell_fills_[shell]);
        last_shell = shell_of(idx(t));
    }
    for (const int32_t l : leaf_) h.leaf_.push_back(number[idx(l)]);
    for (const int32_t c : tree.initial_parts()) h.scores_.push_back(tree[c].score);
    for (const int32_t c : tree.merges()) {
        number[idx(c)] = static_cast<int32_t>(leaves + h.merges_.size());
        h.merges_.push_back({number[idx(tree[c].left)], number[idx(tree[c].right)], tree[c].concavity, 0});
        if (tree[c].level != Level::within_part) h.scores_.push_back(tree[c].score);
    }
    h.derive();
    return h;
}

}  // namespace partwheel
