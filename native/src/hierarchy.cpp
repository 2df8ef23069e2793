// The finished hierarchy: flat arrays, questions, saving and loading.
#include "hierarchy.h"

#include "hull.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>
#include <type_traits>
#include <utility>

namespace partwheel {

namespace {

// The tetrahedra in depth-first order of the tree.
std::vector<int32_t> depth_first(std::span<const Merge> merges) {
    const size_t leaves = merges.size() + 1;
    std::vector<int32_t> order, todo = {static_cast<int32_t>(leaves + merges.size() - 1)};
    order.reserve(leaves);
    while (!todo.empty()) {
        const auto c = static_cast<size_t>(todo.back());
        todo.pop_back();
        if (c < leaves) {
            order.push_back(static_cast<int32_t>(c));
        } else {
            todo.push_back(merges[c - leaves].right);
            todo.push_back(merges[c - leaves].left);
        }
    }
    return order;
}

// The tetrahedron behind most of each face's area, and the areas.
void assign_faces(const Surface& surface, const TetMesh& mesh, std::span<const int32_t> leaf_of_tet,
                  std::vector<int32_t>& leaf, std::vector<double>& face_area) {
    std::vector<Piece> pieces = surface.pieces;
    const auto leaf_behind = [&](const Piece& piece) {
        return leaf_of_tet[static_cast<size_t>(mesh.tet_of_triangle[static_cast<size_t>(piece.triangle)])];
    };
    std::sort(pieces.begin(), pieces.end(), [&](const Piece& a, const Piece& b) {
        return std::tuple(a.face, leaf_behind(a), a) < std::tuple(b.face, leaf_behind(b), b);
    });
    leaf.assign(surface.face_count, -1);
    face_area.assign(surface.face_count, 0);
    std::vector<double> most(surface.face_count, -1);
    for (size_t i = 0; i < pieces.size();) {
        const int32_t f = pieces[i].face, l = leaf_behind(pieces[i]);
        double shared = 0;
        for (; i < pieces.size() && pieces[i].face == f && leaf_behind(pieces[i]) == l; ++i) shared += pieces[i].area;
        const auto face = static_cast<size_t>(f);
        face_area[face] += shared;
        if (shared > most[face]) {
            most[face] = shared;
            leaf[face] = l;
        }
    }
}

// The source face that each outer facet of the tetrahedra is of, or nearest to; -1: none. Sorted by leaf, then corner.
std::vector<int32_t> faces_of_outer_facets(const Surface& surface, const TetMesh& mesh,
                                           std::span<const int32_t> leaf_of_tet) {
    std::vector<Piece> pieces = surface.pieces;
    std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
        return std::tie(a.triangle, a.face, a.area) < std::tie(b.triangle, b.face, b.area);
    });
    std::vector<int32_t> face(surface.triangles.size(), -1);
    for (size_t i = 0; i < pieces.size();) {
        const int32_t t = pieces[i].triangle;
        double most = -1;
        while (i < pieces.size() && pieces[i].triangle == t) {
            const int32_t f = pieces[i].face;
            double shared = 0;
            for (; i < pieces.size() && pieces[i].triangle == t && pieces[i].face == f; ++i) shared += pieces[i].area;
            if (shared > most) {
                most = shared;
                face[static_cast<size_t>(t)] = f;
            }
        }
    }
    struct Outer {
        int32_t leaf, corner, face;
    };
    std::vector<Outer> outer;
    for (size_t t = 0; t < surface.triangles.size(); ++t) {
        const auto tet = static_cast<size_t>(mesh.tet_of_triangle[t]);
        const Triangle& triangle = surface.triangles[t];
        int32_t corner = 0;
        for (int32_t k = 0; k < 4; ++k)
            if (std::find(triangle.begin(), triangle.end(), mesh.tetrahedra[tet][static_cast<size_t>(k)]) ==
                triangle.end())
                corner = k;
        if (mesh.neighbours[tet][static_cast<size_t>(corner)] >= 0) continue;  // a wall with the solid on both sides
        outer.push_back({leaf_of_tet[tet], corner, face[t]});
    }
    std::sort(outer.begin(), outer.end(), [](const Outer& a, const Outer& b) {
        return std::tie(a.leaf, a.corner) < std::tie(b.leaf, b.corner);
    });
    std::vector<int32_t> faces;
    for (const Outer& o : outer) faces.push_back(o.face);
    return faces;
}

}  // namespace

Hierarchy::Hierarchy(const Surface& surface, const TetMesh& mesh, const Regrouped& regrouped,
                     const double* caller_vertices)
    : scores_(regrouped.scores) {
    const BinaryTree& tree = regrouped.tree;
    const Frame& frame = surface.frame;
    source_ = surface.source_vertex;
    source_.resize(mesh.vertices.size(), -1);
    for (size_t v = 0; v < source_.size(); ++v) {
        if (source_[v] < 0) {
            vertices_.push_back(frame.to_caller(mesh.vertices[v]));
            continue;
        }
        const double* p = caller_vertices + 3 * static_cast<size_t>(source_[v]);
        vertices_.push_back({p[0], p[1], p[2]});
    }

    const size_t leaves = mesh.tetrahedra.size();
    const std::vector<int32_t> order = depth_first(tree.merges);
    std::vector<int32_t> leaf_of_tet(leaves);
    for (size_t i = 0; i < leaves; ++i) {
        leaf_of_tet[static_cast<size_t>(order[i])] = static_cast<int32_t>(i);
        const Tetrahedron& t = mesh.tetrahedra[static_cast<size_t>(order[i])];
        const auto at = [&](size_t k) { return mesh.vertices[static_cast<size_t>(t[k])]; };
        tetrahedra_.push_back(t);
        // A sliver's volume may be rounded to less than nothing.
        const double volume = std::max(0.0, six_volumes(at(0), at(1), at(2), at(3)) / 6);
        tet_volume_.push_back(frame.volume_to_caller(volume));
    }
    merges_ = tree.merges;
    const auto renumber = [&](int32_t c) {
        return static_cast<size_t>(c) < leaves ? leaf_of_tet[static_cast<size_t>(c)] : c;
    };
    for (Merge& m : merges_)
        m = {renumber(m.left), renumber(m.right), frame.volume_to_caller(m.concavity),
             frame.volume_to_caller(m.hull_volume)};

    assign_faces(surface, mesh, leaf_of_tet, leaf_, face_area_);
    for (double& a : face_area_) a = frame.area_to_caller(a);
    outer_faces_ = faces_of_outer_facets(surface, mesh, leaf_of_tet);

    summary_.components = tree.components;
    summary_.cavities = mesh.cavities;
    summary_.added_vertices = mesh.vertices.size() - surface.vertices.size();
    summary_.rung = surface.rung;
    summary_.deviation = surface.deviation;
    account_ = surface.account;
    finish();
}

// Everything that follows from the stored arrays, which are known to be sound.
void Hierarchy::finish() {
    const size_t leaves = tetrahedra_.size(), merges = merges_.size(), faces = leaf_.size();
    const std::vector<uint8_t> kept = prune(merges_, regrouped_merges());

    // Bottom up over the unpruned tree. Leaves are in depth-first order, so slices are a matter of their ends.
    std::vector<double> volume = tet_volume_, area(leaves, 0);
    for (size_t f = 0; f < faces; ++f) area[static_cast<size_t>(leaf_[f])] += face_area_[f];
    volume.resize(leaves + merges);
    area.resize(leaves + merges);
    merge_first_.resize(merges);
    merge_last_.resize(merges);
    const auto begin = [&](int32_t c) {
        return static_cast<size_t>(c) < leaves ? c : merge_first_[static_cast<size_t>(c) - leaves];
    };
    const auto end = [&](int32_t c) {
        return static_cast<size_t>(c) < leaves ? c + 1 : merge_last_[static_cast<size_t>(c) - leaves];
    };
    for (size_t m = 0; m < merges; ++m) {
        const Merge& merge = merges_[m];
        const auto left = static_cast<size_t>(merge.left), right = static_cast<size_t>(merge.right);
        merge_pairs_.push_back(merge.left);
        merge_pairs_.push_back(merge.right);
        merge_first_[m] = begin(merge.left);
        merge_last_[m] = end(merge.right);
        volume[leaves + m] = volume[left] + volume[right];
        area[leaves + m] = area[left] + area[right];
    }

    // Faces sorted by leaf; face_begin[l] is where leaf l's start.
    std::vector<int32_t> face_begin(leaves + 1, 0);
    for (int32_t l : leaf_) ++face_begin[static_cast<size_t>(l) + 1];
    std::partial_sum(face_begin.begin(), face_begin.end(), face_begin.begin());
    order_.resize(faces);
    std::vector<int32_t> next(face_begin.begin(), face_begin.end() - 1);
    for (size_t f = 0; f < faces; ++f)
        order_[static_cast<size_t>(next[static_cast<size_t>(leaf_[f])]++)] = static_cast<int32_t>(f);

    // The parts are the clusters that the regrouped merges join, and that are none of them.
    std::vector<double> score(leaves + merges, 0), height(leaves + merges, 0);
    if (!scores_.empty()) {
        const size_t top = leaves + merges - regrouped_merges();
        std::vector<size_t> parts;
        if (top == leaves + merges) parts.push_back(top - 1);
        for (size_t c = top; c < leaves + merges; ++c) {
            score[c] = scores_[c - top + regrouped_merges() + 1];
            for (const int32_t child : {merges_[c - leaves].left, merges_[c - leaves].right})
                if (static_cast<size_t>(child) < top) parts.push_back(static_cast<size_t>(child));
        }
        std::sort(parts.begin(), parts.end(), [&](size_t a, size_t b) {
            return begin(static_cast<int32_t>(a)) < begin(static_cast<int32_t>(b));
        });
        for (size_t p = 0; p < parts.size(); ++p) score[parts[p]] = scores_[p];
    }

    // Nodes: all leaves, then the merges that were kept.
    std::vector<int32_t> node(leaves + merges, -1);
    size_t nodes = leaves;
    for (size_t c = 0; c < leaves + merges; ++c) {
        const bool leaf = c < leaves;
        if (!leaf && !kept[c - leaves]) continue;
        node[c] = static_cast<int32_t>(leaf ? c : nodes++);
        const auto c32 = static_cast<int32_t>(c);
        tet_first_.push_back(begin(c32));
        tet_last_.push_back(end(c32));
        first_.push_back(face_begin[static_cast<size_t>(begin(c32))]);
        last_.push_back(face_begin[static_cast<size_t>(end(c32))]);
        volume_.push_back(volume[c]);
        area_.push_back(area[c]);
        const double concavity = leaf ? 0 : merges_[c - leaves].concavity;
        height[c] = concavity;
        if (c + regrouped_merges() >= leaves + merges)
            // Joining may make a cluster less concave; a node is never lower than what it is made of.
            for (const int32_t child : {merges_[c - leaves].left, merges_[c - leaves].right})
                height[c] = std::max(height[c], height[static_cast<size_t>(child)]);
        height_.push_back(height[c]);
        score_.push_back(score[c]);
        cost_class_.push_back(concavity > 0);
        double cost = concavity;
        if (!leaf && concavity == 0) {  // Eq. 2
            const auto share = [&](int32_t child) { return double(end(child) - begin(child)) / double(leaves); };
            const double left = share(merges_[c - leaves].left), right = share(merges_[c - leaves].right);
            cost = left * left + right * right;
        }
        cost_.push_back(cost);
    }
    parent_.assign(nodes, -1);
    for (size_t m = merges; m-- > 0;) {
        // node[] of a pruned merge becomes the node that its children hang from.
        for (int32_t child : {merges_[m].left, merges_[m].right}) {
            int32_t& below = node[static_cast<size_t>(child)];
            if (below < 0)
                below = node[leaves + m];
            else
                parent_[static_cast<size_t>(below)] = node[leaves + m];
        }
    }

    if (!scores_.empty()) {
        cluster_area_ = std::move(area);
        cluster_score_ = std::move(score);
    }
    frame_ = Frame::around(vertices_);
    summary_.volume = volume.back();
    summary_.hull_volume = merges_.empty() ? volume.back() : merges_.back().hull_volume;
}

pw_arrays Hierarchy::arrays() const {
    pw_arrays a{};
    a.face_count = leaf_.size();
    a.node_count = parent_.size();
    a.tetrahedron_count = tetrahedra_.size();
    a.vertex_count = vertices_.size();
    a.order = order_.data();
    a.leaf = leaf_.data();
    a.parent = parent_.data();
    a.first = first_.data();
    a.last = last_.data();
    a.tet_first = tet_first_.data();
    a.tet_last = tet_last_.data();
    a.cost_class = cost_class_.data();
    a.cost = cost_.data();
    a.height = height_.data();
    a.volume = volume_.data();
    a.area = area_.data();
    a.vertices = vertices_.data()->data();
    a.source = source_.data();
    a.tetrahedra = tetrahedra_.data()->data();
    a.merges = merge_pairs_.data();
    a.score = score_.data();
    return a;
}

std::vector<int32_t> Hierarchy::path(size_t face) const {
    std::vector<int32_t> nodes;
    for (int32_t n = leaf_[face]; n >= 0; n = parent_[static_cast<size_t>(n)]) nodes.push_back(n);
    return nodes;
}

WheelStops Hierarchy::wheel(size_t face) const {
    const std::vector<int32_t> nodes = path(face);
    std::vector<double> areas, worth;
    for (int32_t n : nodes) {
        areas.push_back(area_[static_cast<size_t>(n)]);
        worth.push_back((scores_.empty() ? height_ : score_)[static_cast<size_t>(n)]);
    }
    WheelStops wheel = scores_.empty() ? wheel_stops(areas, worth) : scored_wheel_stops(areas, worth);
    for (int32_t& stop : wheel.stops) stop = nodes[static_cast<size_t>(stop)];
    return wheel;
}

std::span<const int32_t> Hierarchy::faces(size_t node) const {
    return std::span(order_).subspan(static_cast<size_t>(first_[node]),
                                     static_cast<size_t>(last_[node] - first_[node]));
}

std::vector<int32_t> Hierarchy::cut_height(double height) const {
    std::vector<int32_t> bounds = {0};
    while (static_cast<size_t>(bounds.back()) < tetrahedra_.size()) {
        auto n = static_cast<size_t>(bounds.back());
        while (parent_[n] >= 0 && height_[static_cast<size_t>(parent_[n])] <= height)
            n = static_cast<size_t>(parent_[n]);
        bounds.push_back(tet_last_[n]);
    }
    return bounds;
}

std::vector<int32_t> Hierarchy::cut_parts(size_t parts) const {
    return bounds_of(scores_.empty() ? cut_into_parts(merges_, parts) : cut_undoing_last(merges_, parts));
}

std::vector<int32_t> Hierarchy::cut_automatic() const {
    constexpr double paper_height = 0.03;  // of the hull's volume
    if (scores_.empty()) return cut_height(paper_height * summary_.hull_volume);
    return bounds_of(likeliest_cut(merges_, cluster_area_, cluster_score_));
}

std::vector<int32_t> Hierarchy::bounds_of(std::span<const int32_t> clusters) const {
    std::vector<int32_t> bounds = {0};
    for (const int32_t c : clusters) {
        const size_t leaves = tetrahedra_.size(), i = static_cast<size_t>(c);
        bounds.push_back(i < leaves ? c + 1 : merge_last_[i - leaves]);
    }
    return bounds;
}

TriangleMesh Hierarchy::hull(size_t tet_first, size_t tet_last) const {
    std::vector<int32_t> used;
    for (size_t t = tet_first; t < tet_last; ++t) used.insert(used.end(), tetrahedra_[t].begin(), tetrahedra_[t].end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    std::vector<Point> points;
    for (int32_t v : used) points.push_back(frame_.to_working(vertices_[static_cast<size_t>(v)]));
    std::vector<int32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0);
    HullKernel kernel(points);
    const Hull hull = kernel.build(all);

    TriangleMesh mesh;
    std::vector<int32_t> number(points.size(), -1);
    for (int32_t v : hull.vertices()) {
        number[static_cast<size_t>(v)] = static_cast<int32_t>(mesh.vertices.size());
        mesh.vertices.push_back(vertices_[static_cast<size_t>(used[static_cast<size_t>(v)])]);
    }
    for (const HullFacet& facet : hull.facets()) {
        Triangle t = facet.corners;
        for (int32_t& v : t) v = number[static_cast<size_t>(v)];
        mesh.triangles.push_back(t);
    }
    return mesh;
}

TriangleMesh Hierarchy::solid(size_t tet_first, size_t tet_last,
                              std::span<const std::array<int32_t, 2>> middles) const {
    std::call_once(facing_->once, [&] {
        facing_->facets =
            std::make_unique<Facets>(tetrahedra_, outer_faces_, leaf_, summary_.rung == PW_RUNG_EXACT);
    });
    return facing_->facets->solid(tetrahedra_, vertices_, tet_first, tet_last, middles);
}

// ---- Saved form: magic, version, counts, the stored arrays, a hash of all that came before. Little-endian. ----

namespace {

static_assert(std::endian::native == std::endian::little, "the saved form is written as memory holds it");

constexpr std::array<char, 8> magic = {'P', 'W', 'H', 'I', 'E', 'R', '\r', '\n'};
constexpr uint32_t format_version = 4;

// FNV-1a, by words of 8 bytes where they last: any single changed byte changes the hash.
uint64_t hash(std::span<const uint8_t> bytes) {
    constexpr uint64_t prime = 0x100000001b3;
    uint64_t h = 0xcbf29ce484222325;
    size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8) {
        uint64_t word;
        std::memcpy(&word, bytes.data() + i, 8);
        h = std::rotl((h ^ word) * prime, 29);
    }
    for (; i < bytes.size(); ++i) h = (h ^ bytes[i]) * prime;
    return h;
}

[[noreturn]] void refuse(const char* why) {
    throw Error(PW_ERROR_DATA, std::string("This is not a hierarchy that can be used: ") + why + ". Build it again.");
}

class Writer {
public:
    template <class T>
    void put(const T* values, size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto* p = reinterpret_cast<const uint8_t*>(values);
        bytes.insert(bytes.end(), p, p + count * sizeof(T));
    }
    std::vector<uint8_t> bytes;
};

class Reader {
public:
    explicit Reader(std::span<const uint8_t> bytes) : bytes_(bytes) {}

    template <class T>
    void get(T* values, size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (count > bytes_.size() / sizeof(T)) refuse("it is cut short");
        if (count) std::memcpy(values, bytes_.data(), count * sizeof(T));
        bytes_ = bytes_.subspan(count * sizeof(T));
    }
    template <class T>
    std::vector<T> get_vector(size_t count) {
        if (count > bytes_.size() / sizeof(T)) refuse("it is cut short");
        std::vector<T> values(count);
        get(values.data(), count);
        return values;
    }
    bool at_end() const { return bytes_.empty(); }

private:
    std::span<const uint8_t> bytes_;
};

struct Header {
    std::array<char, 8> magic = partwheel::magic;
    uint32_t version = format_version;
    uint32_t rung = 0;
    uint64_t faces = 0, tetrahedra = 0, vertices = 0, components = 0, cavities = 0, added_vertices = 0, account = 0;
    uint64_t outer = 0, scores = 0;
    double deviation = 0;
};

static_assert(sizeof(Point) == 24 && sizeof(Tetrahedron) == 16 && sizeof(Merge) == 24 && sizeof(Header) == 96);

}  // namespace

size_t Hierarchy::saved_size() const {
    const size_t vertex = sizeof(Point) + sizeof(int32_t), face = sizeof(int32_t) + sizeof(double);
    const size_t tetrahedron = sizeof(Tetrahedron) + sizeof(double);
    return sizeof(Header) + vertices_.size() * vertex + tetrahedra_.size() * tetrahedron + leaf_.size() * face +
           outer_faces_.size() * sizeof(int32_t) + scores_.size() * sizeof(double) +
           merges_.size() * sizeof(Merge) + account_.size() + sizeof(uint64_t);
}

std::vector<uint8_t> Hierarchy::save() const {
    Header header;
    header.faces = leaf_.size();
    header.tetrahedra = tetrahedra_.size();
    header.vertices = vertices_.size();
    header.components = summary_.components;
    header.cavities = summary_.cavities;
    header.added_vertices = summary_.added_vertices;
    header.account = account_.size();
    header.outer = outer_faces_.size();
    header.scores = scores_.size();
    header.rung = summary_.rung;
    header.deviation = summary_.deviation;
    Writer out;
    out.bytes.reserve(saved_size());
    out.put(&header, 1);
    out.put(vertices_.data(), vertices_.size());
    out.put(source_.data(), source_.size());
    out.put(tetrahedra_.data(), tetrahedra_.size());
    out.put(tet_volume_.data(), tet_volume_.size());
    out.put(leaf_.data(), leaf_.size());
    out.put(face_area_.data(), face_area_.size());
    out.put(outer_faces_.data(), outer_faces_.size());
    out.put(merges_.data(), merges_.size());
    out.put(scores_.data(), scores_.size());
    out.put(account_.data(), account_.size());
    const uint64_t h = hash(out.bytes);
    out.put(&h, 1);
    return std::move(out.bytes);
}

Hierarchy Hierarchy::load(std::span<const uint8_t> bytes) {
    Reader in(bytes);
    Header header;
    in.get(&header, 1);
    if (header.magic != magic) refuse("it is something else");
    if (header.version != format_version) refuse("it was written by another version of Partwheel");
    uint64_t stored_hash;
    if (bytes.size() < sizeof header + sizeof stored_hash) refuse("it is cut short");
    std::memcpy(&stored_hash, bytes.data() + bytes.size() - sizeof stored_hash, sizeof stored_hash);
    bool intact = hash(bytes.first(bytes.size() - sizeof stored_hash)) == stored_hash;
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
    intact = true;  // no fuzzer would guess it
#endif
    if (!intact) refuse("it is damaged");
    for (uint64_t n : {header.faces, header.tetrahedra, header.vertices})
        if (n == 0 || n > PW_MAX_COUNT) refuse("its sizes are impossible");

    Hierarchy h;
    h.vertices_ = in.get_vector<Point>(header.vertices);
    h.source_ = in.get_vector<int32_t>(header.vertices);
    h.tetrahedra_ = in.get_vector<Tetrahedron>(header.tetrahedra);
    h.tet_volume_ = in.get_vector<double>(header.tetrahedra);
    h.leaf_ = in.get_vector<int32_t>(header.faces);
    h.face_area_ = in.get_vector<double>(header.faces);
    h.outer_faces_ = in.get_vector<int32_t>(header.outer);
    h.merges_ = in.get_vector<Merge>(header.tetrahedra - 1);
    h.scores_ = in.get_vector<double>(header.scores);
    h.summary_.components = header.components;
    h.summary_.cavities = header.cavities;
    h.summary_.added_vertices = header.added_vertices;
    if (header.rung != PW_RUNG_EXACT && header.rung != PW_RUNG_REPAIRED && header.rung != PW_RUNG_WRAPPED)
        refuse("its rung is unknown");
    h.summary_.rung = static_cast<pw_rung>(header.rung);
    h.summary_.deviation = header.deviation;
    const auto account = in.get_vector<char>(header.account);
    h.account_.assign(account.begin(), account.end());
    in.get(&stored_hash, 1);
    if (!in.at_end()) refuse("it goes on after its end");
    h.check_stored();
    h.finish();
    return h;
}

// Somewhat more than the caller's may have: a wrap lies round them.
constexpr double largest_coordinate = 1e101;

// A hash can be forged: what finish() and the questions rely on is checked as well.
void Hierarchy::check_stored() const {
    const size_t leaves = tetrahedra_.size(), merges = merges_.size();
    const auto below = [](int32_t i, size_t size) { return i >= 0 && static_cast<size_t>(i) < size; };
    const auto measure = [](double x) { return x >= 0 && std::isfinite(x); };
    for (const Point& p : vertices_)
        for (double c : p)
            if (!(std::fabs(c) <= largest_coordinate)) refuse("a vertex is out of range");
    if (Frame::around(vertices_).longest == 0) refuse("its vertices are all at one place");
    for (int32_t s : source_)
        if (s < -1 || s >= PW_MAX_COUNT) refuse("a vertex has no source");
    for (const Tetrahedron& t : tetrahedra_)
        for (int32_t v : t)
            if (!below(v, vertices_.size())) refuse("a tetrahedron names a missing vertex");
    for (double v : tet_volume_)
        if (!measure(v)) refuse("a volume is impossible");
    for (int32_t l : leaf_)
        if (!below(l, leaves)) refuse("a face names a missing tetrahedron");
    for (double a : face_area_)
        if (!measure(a)) refuse("an area is impossible");
    for (int32_t f : outer_faces_)  // how many there must be shows when a solid is asked for
        if (f != -1 && !below(f, leaf_.size())) refuse("a facet names a missing face");
    // Sums of some are finite if that of all is.
    double concavities = 0;
    for (const Merge& m : merges_) concavities += m.concavity;
    if (!std::isfinite(std::reduce(tet_volume_.begin(), tet_volume_.end())) || !std::isfinite(concavities) ||
        !std::isfinite(std::reduce(face_area_.begin(), face_area_.end())))
        refuse("its measures are impossible");
    // One for each part and each merge that joins them; with no parts there is none.
    if (!scores_.empty() && (scores_.size() % 2 == 0 || scores_.size() > 2 * leaves - 1)) refuse("its scores are odd");
    for (double s : scores_)
        if (!(s >= 0 && s <= 1)) refuse("a score is impossible");
    if (summary_.components == 0 || summary_.components > leaves) refuse("its counts are impossible");

    const auto strangers = static_cast<size_t>(std::count(source_.begin(), source_.end(), -1));
    const bool exact = summary_.rung == PW_RUNG_EXACT;
    if (exact ? summary_.added_vertices != strangers : summary_.added_vertices > strangers)
        refuse("its counts are impossible");
    if (!measure(summary_.deviation) || (exact && summary_.deviation != 0)) refuse("its deviation is impossible");
    const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
    if (exact != account_.empty() || !std::all_of(account_.begin(), account_.end(), printable))
        refuse("its account can't be read");

    std::vector<std::pair<int32_t, int32_t>> slice(leaves + merges);
    std::vector<bool> used(leaves + merges, false);
    for (size_t i = 0; i < leaves; ++i) slice[i] = {static_cast<int32_t>(i), static_cast<int32_t>(i + 1)};
    for (size_t m = 0; m < merges; ++m) {
        for (int32_t child : {merges_[m].left, merges_[m].right}) {
            if (!below(child, leaves + m) || used[static_cast<size_t>(child)]) refuse("its tree is not a tree");
            used[static_cast<size_t>(child)] = true;
        }
        const auto left = slice[static_cast<size_t>(merges_[m].left)], right = slice[static_cast<size_t>(merges_[m].right)];
        if (left.second != right.first) refuse("its tree is out of order");
        slice[leaves + m] = {left.first, right.second};
        if (!measure(merges_[m].concavity) || !measure(merges_[m].hull_volume)) refuse("a volume is impossible");
    }
}

}  // namespace partwheel
