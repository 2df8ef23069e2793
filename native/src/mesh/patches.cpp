// Connected components of the faces after cutting marked edges and creases.
#include "mesh/patches.h"

#include "base/adjacency.h"
#include "base/corners.h"
#include "mesh/creases.h"
#include "mesh/face_assignment.h"

namespace partwheel {

namespace {

// A kind of marks that nobody chose is ignored if the mean patch that it makes, weighted by area, has less than this
// share of its connected component.
constexpr double min_mean_patch = 0.02;
// A patch with less than this share of the surface joins the neighbor with which its border is longest.
constexpr double min_patch = 0.0005;
// Strength between patches that are not adjacent, but connected without a hard mark.
constexpr float remote_strength = 0.75F;
// Strength of creases: weaker than borders of materials.
constexpr float crease_strength = 0.85F;

class PatchFinder {
public:
    PatchFinder(const MeshView& mesh, const Shells& shells) : shells_(shells), face_area_(mesh.face_count, 0) {
        const auto face_of = [&](size_t triangle) { return mesh.faces.empty() ? triangle : idx(mesh.faces[triangle]); };
        for (size_t t = 0; t < mesh.triangles.size(); ++t) face_area_[face_of(t)] += area(mesh.vertices, mesh.triangles[t]);
        for_each_welded_edge(mesh, shells, [&](int32_t low, std::span<const Side> sides) {
            const double size = length(mesh.vertices[idx(sides[0].high)] - mesh.vertices[idx(low)]);
            for (size_t i = 1; i < sides.size(); ++i) {
                const size_t f = face_of(idx(sides[i - 1].number / 3)), g = face_of(idx(sides[i].number / 3));
                if (f != g) edges_.push_back({{low, sides[0].high}, f, g, size, 0});
            }
        });
        components_ = connect(2);
    }

    // Raises the strengths of the edges that these marks name. Returns how many edges are marked.
    size_t add(const EdgeMarks& marks) {
        std::vector<std::pair<std::array<int32_t, 2>, float>> sorted;
        for (size_t i = 0; i < marks.edges.size(); ++i) {
            const auto [low, high] =
                std::minmax(shells_.vertex[idx(marks.edges[i][0])], shells_.vertex[idx(marks.edges[i][1])]);
            sorted.emplace_back(std::array{low, high}, marks.strengths.empty() ? hard_mark_strength : marks.strengths[i]);
        }
        std::ranges::sort(sorted);
        size_t count = 0;
        for (Edge& edge : edges_) {
            const auto end = std::ranges::upper_bound(sorted, edge.ends, {}, [](const auto& mark) { return mark.first; });
            if (end == sorted.begin() || std::prev(end)->first != edge.ends) continue;
            edge.strength = std::max(edge.strength, std::prev(end)->second);
            count += edge.strength >= min_mark_strength;
        }
        return count;
    }

    // Creases (ascending) count in components without marks, or with weak ones such as noisy colors. Where all marks are
    // stronger, such as materials, these name the parts already.
    void add_creases(std::span<const std::array<int32_t, 2>> creases) {
        weakest_.assign(face_area_.size(), 0);
        for (const Edge& edge : edges_) {
            if (edge.strength < min_mark_strength) continue;
            float& strength = weakest_[components_.find(edge.f)];
            strength = strength > 0 ? std::min(strength, edge.strength) : edge.strength;
        }
        for (Edge& edge : edges_)
            if (weakest_[components_.find(edge.f)] <= crease_strength && std::ranges::binary_search(creases, edge.ends))
                edge.strength = std::max(edge.strength, crease_strength);
    }

    void clear() {
        for (Edge& edge : edges_) edge.strength = 0;
    }

    // The patches of all components that marks divide, and the area-weighted mean of a patch's share of its component.
    struct Division {
        size_t patches = 0;
        double mean_share = 1;
    };
    Division measure() {
        UnionFind patches = connect(min_mark_strength);
        const std::vector<size_t> count = count_patches(patches);
        const std::vector<double> patch = areas(patches), component = areas(components_);
        Division result;
        double sum = 0, whole = 0;
        for (size_t f = 0; f < face_area_.size(); ++f) {
            const size_t c = components_.find(f);
            if (patches.find(f) != f || count[c] < 2) continue;
            ++result.patches;
            whole += patch[f];
            if (component[c] > 0) sum += patch[f] * (patch[f] / component[c]);
        }
        if (whole > 0) result.mean_share = sum / whole;
        return result;
    }

    Patches find() {
        UnionFind patches = connect(min_mark_strength), groups = connect(hard_mark_strength);
        join_small(patches);
        const std::vector<size_t> count = count_patches(patches);
        Patches result;
        std::vector<int32_t> number(face_area_.size(), -1), group_number(face_area_.size(), -1);
        for (size_t f = 0; f < face_area_.size(); ++f) {
            const size_t p = patches.find(f), g = groups.find(f);
            if (p == f && count[components_.find(f)] > 1) {
                number[f] = static_cast<int32_t>(result.group.size());
                if (group_number[g] < 0) group_number[g] = number[f];
                result.group.push_back(group_number[g]);
                result.has_hints.push_back(weakest_[components_.find(f)] > 0);
            }
            result.of_face.push_back(number[p]);
        }
        for (const auto& [pair, sum] : borders(patches))
            result.borders.push_back({number[pair.first], number[pair.second], sum.length,
                                      static_cast<float>(sum.length > 0 ? sum.marked / sum.length : 1)});
        if (result.group.empty()) result.of_face.clear();
        return result;
    }

private:
    // Between two faces.
    struct Edge {
        std::array<int32_t, 2> ends;  // welded, ascending
        size_t f, g;
        double length;
        float strength;
    };
    struct BorderSum {
        double length = 0, marked = 0;
        bool is_soft = false;  // whether any edge is
    };

    // Faces connected by edges that are weaker.
    UnionFind connect(float strength) const {
        UnionFind sets(face_area_.size());
        for (const Edge& edge : edges_)
            if (edge.strength < strength) sets.unite(edge.f, edge.g);
        return sets;
    }

    // The area of each set, at the index of its representative.
    std::vector<double> areas(UnionFind& sets) const {
        std::vector<double> result(face_area_.size(), 0);
        for (size_t f = 0; f < face_area_.size(); ++f) result[sets.find(f)] += face_area_[f];
        return result;
    }

    std::vector<size_t> count_patches(UnionFind& patches) {
        std::vector<size_t> count(face_area_.size(), 0);
        for (size_t f = 0; f < face_area_.size(); ++f) count[components_.find(f)] += patches.find(f) == f;
        return count;
    }

    // The border between two patches, by their representatives, ascending.
    std::map<std::pair<size_t, size_t>, BorderSum> borders(UnionFind& patches) const {
        std::map<std::pair<size_t, size_t>, BorderSum> result;
        for (const Edge& edge : edges_) {
            const std::pair<size_t, size_t> pair = std::minmax(patches.find(edge.f), patches.find(edge.g));
            if (pair.first == pair.second) continue;
            BorderSum& sum = result[pair];
            sum.length += edge.length;
            sum.marked += edge.length * double{edge.strength};
            sum.is_soft |= edge.strength < hard_mark_strength;
        }
        return result;
    }

    void join_small(UnionFind& patches) const {
        double whole = 0;
        for (const double a : face_area_) whole += a;
        for (bool is_done = false; !is_done;) {
            is_done = true;
            const std::vector<double> area = areas(patches);
            std::map<size_t, std::pair<double, size_t>> longest;  // of each small patch: length and neighbor
            for (const auto& [pair, sum] : borders(patches)) {
                if (!sum.is_soft) continue;
                for (const auto& [from, to] : {pair, std::pair(pair.second, pair.first)})
                    if (area[from] < min_patch * whole)
                        longest[from] = std::max(longest[from], std::pair(sum.length, to));
            }
            for (const auto& [patch, neighbor] : longest) {
                patches.unite(patch, neighbor.second);
                is_done = false;
            }
        }
    }

    const Shells& shells_;
    std::vector<double> face_area_;
    std::vector<Edge> edges_;
    UnionFind components_{0};  // without marks
    std::vector<float> weakest_;  // mark of each component, creases not included
};

}  // namespace

float Patches::strength(int32_t a, int32_t b) const {
    if (a == b || a < 0 || b < 0) return 0;
    if (group[idx(a)] != group[idx(b)]) return hard_mark_strength;
    const std::pair<int32_t, int32_t> pair = std::minmax(a, b);
    const auto border =
        std::ranges::lower_bound(borders, pair, {}, [](const Border& x) { return std::pair(x.a, x.b); });
    const bool is_found = border != borders.end() && border->a == pair.first && border->b == pair.second;
    return is_found ? border->strength : remote_strength;
}

Patches find_patches(const MeshView& mesh, const Shells& shells, std::span<const EdgeMarks> marks) {
    const std::vector<std::array<int32_t, 2>> creases = find_creases(mesh, shells);
    if (marks.empty() && creases.empty()) return {};
    PatchFinder finder(mesh, shells);
    std::string notes;
    std::vector<const EdgeMarks*> used;
    for (const EdgeMarks& kind : marks) {
        finder.clear();
        const size_t edges = finder.add(kind);
        const auto [patches, mean_share] = finder.measure();
        const bool is_ignored = !kind.is_chosen && mean_share < min_mean_patch;
        if (patches > 0 && !is_ignored) used.push_back(&kind);
        notes += (notes.empty() ? "" : " ") + std::string("Marks: the ") + kind.name;
        if (patches == 0)
            notes += " divide nothing.";
        else if (is_ignored)
            notes += " are ignored, because they cut the surface into " + with_commas(patches) + " small pieces.";
        else
            notes += " divide the surface into " + with_commas(patches) + " patches, along " + with_commas(edges) + " edges.";
    }
    finder.clear();
    for (const EdgeMarks* kind : used) finder.add(*kind);
    finder.add_creases(creases);
    Patches patches = finder.find();
    patches.notes = std::move(notes);
    return patches;
}

}  // namespace partwheel
