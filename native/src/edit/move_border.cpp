// Tetrahedra of a part whose border was moved.
#include "edit/move_border.h"

#include "base/adjacency.h"
#include "base/corners.h"
#include "edit/border.h"

#include <set>

namespace partwheel {

namespace {

class BorderMover {
public:
    BorderMover(const TetFacets& facets, std::vector<uint8_t> in, std::span<const uint8_t> inside, Progress& progress)
        : facets_(facets), before_(in), in_(std::move(in)), inside_(inside), progress_(progress) {}

    std::vector<uint8_t> move() {
        follow_faces();
        progress_.reach(0.5);
        size_ = changed_.diagonal();
        if (changed_.is_empty() || !(size_ > 0)) return std::move(in_);
        BorderBand band = collect_band();
        add_costs(band);
        progress_.reach(0.55);
        const std::vector<uint8_t> side = minimum_cut(band);
        progress_.reach(0.6);
        for (size_t n = 0; n < band.faces.size(); ++n) in_[idx(band.faces[n])] = side[n];
        restore_components();
        // If tetrahedra are large compared to the change, the old set may fit the faces better.
        const bool is_valid = std::ranges::find(in_, 0) != in_.end() && std::ranges::find(in_, 1) != in_.end();
        return is_valid && wrong_area(in_) < wrong_area(before_) ? std::move(in_) : std::move(before_);
    }

private:
    struct Edge {  // of the surface
        std::pair<int32_t, int32_t> ends;
        int in_part, total;  // number of faces
    };

    bool is_outer(size_t t, size_t corner) const { return facets_.neighbors[t][corner] < 0; }

    const Point& vertex(int32_t v) const { return facets_.vertices[idx(v)]; }

    double area(size_t t, size_t corner) const {
        return partwheel::area(facets_.vertices, facet(facets_.tetrahedra[t], corner));
    }

    std::pair<int32_t, int32_t> ends(size_t t, size_t corner, size_t k) const {
        const Triangle f = facet(facets_.tetrahedra[t], corner);
        return std::minmax(f[k], f[(k + 1) % 3]);
    }

    // Tetrahedra on the surface go with most of their surface area.
    void follow_faces() {
        is_inner_.assign(in_.size(), 1);
        for (size_t t = 0; t < in_.size(); ++t) {
            double balance = 0;  // surface area of the part's faces minus that of the rest
            for (size_t c = 0; c < 4; ++c) {
                if (!is_outer(t, c)) continue;
                is_inner_[t] = 0;
                const int32_t face = facets_.faces[t][c];
                if (face >= 0) balance += inside_[idx(face)] ? area(t, c) : -area(t, c);
            }
            const uint8_t majority = balance > 0 ? 1 : balance < 0 ? 0 : in_[t];
            if (majority == in_[t]) continue;
            in_[t] = majority;
            for (const int32_t v : facets_.tetrahedra[t]) changed_.add(vertex(v));
        }
    }

    // The inner tetrahedra near the change, as the "faces" of a band; and edges_, the surface edges there.
    BorderBand collect_band() {
        BorderBand band;
        const Point reach = filled<3>(size_);
        const Box near{changed_.low - reach, changed_.high + reach};
        number_.assign(in_.size(), -1);
        for (size_t t = 0; t < in_.size(); ++t) {
            if (std::ranges::none_of(facets_.tetrahedra[t], [&](int32_t v) { return near.contains(vertex(v)); })) continue;
            if (is_inner_[t]) {
                number_[t] = static_cast<int32_t>(band.faces.size());
                band.faces.push_back(static_cast<int32_t>(t));
                continue;
            }
            for (size_t c = 0; c < 4; ++c)
                for (size_t k = 0; is_outer(t, c) && k < 3; ++k) edges_.push_back({ends(t, c, k), in_[t], 1});
        }
        std::ranges::sort(edges_, {}, &Edge::ends);
        size_t count = 0;
        for (const Edge& edge : edges_) {
            if (count > 0 && edges_[count - 1].ends == edge.ends)
                edges_[count - 1].in_part += edge.in_part, ++edges_[count - 1].total;
            else
                edges_[count++] = edge;
        }
        edges_.resize(count);
        return band;
    }

    void add_costs(BorderBand& band) const {
        band.set_node_count(band.faces.size());
        for (size_t n = 0; n < band.faces.size(); ++n) {
            const size_t t = idx(band.faces[n]);
            for (size_t c = 0; c < 4; ++c) {
                const size_t other = idx(facets_.neighbors[t][c]);
                if (number_[other] >= 0 && other < t) continue;
                const double cost = area(t, c) / size_ / size_ + edge_cost(t, c);
                band.add_edge(n, number_[other], in_[other] != 0, quantize_cost(cost));
            }
        }
    }

    // Extra cost of a cap through a surface edge between two faces of the same side.
    double edge_cost(size_t t, size_t corner) const {
        double sum = 0;
        for (size_t k = 0; k < 3; ++k) {
            const auto found = std::ranges::lower_bound(edges_, ends(t, corner, k), {}, &Edge::ends);
            if (found == edges_.end() || found->ends != ends(t, corner, k)) continue;
            if (found->total < 2 || (found->in_part > 0 && found->in_part < found->total)) continue;
            sum += length(vertex(found->ends.first) - vertex(found->ends.second));
        }
        return sum / size_;
    }

    // The connected component, across facets and on one side, of each tetrahedron: its lowest tetrahedron.
    std::vector<int32_t> components(std::span<const uint8_t> in) const {
        UnionFind sets(in.size());
        for (size_t t = 0; t < in.size(); ++t)
            for (const int32_t n : facets_.neighbors[t])
                if (n >= 0 && in[idx(n)] == in[t]) sets.unite(t, idx(n));
        std::vector<int32_t> component;
        for (size_t t = 0; t < in.size(); ++t) component.push_back(static_cast<int32_t>(sets.find(t)));
        return component;
    }

    // Moves components that were connected to others before back to their old side.
    void restore_components() {
        const std::vector<int32_t> old = components(before_);
        for (const bool side : {true, false}) {  // one side's components may separate the other's
            const std::vector<int32_t> current = components(in_);
            // The component with the most tetrahedra of an old one is its successor.
            std::map<std::pair<int32_t, int32_t>, size_t> common;
            for (size_t t = 0; t < in_.size(); ++t)
                if (in_[t] == before_[t]) ++common[{old[t], current[t]}];
            std::map<int32_t, std::pair<size_t, int32_t>> successor;  // (common tetrahedra, component)
            for (const auto& [pair, count] : common)
                if (count > successor[pair.first].first) successor[pair.first] = {count, pair.second};
            std::set<int32_t> successors;
            for (const auto& [component, best] : successor) successors.insert(best.second);
            for (size_t t = 0; t < in_.size(); ++t)
                if ((in_[t] != 0) == side && !successors.contains(current[t])) in_[t] = !in_[t];
        }
    }

    // The area of source faces that are on the wrong side.
    double wrong_area(std::span<const uint8_t> in) const {
        double sum = 0;
        for (size_t t = 0; t < in.size(); ++t)
            for (size_t c = 0; !is_inner_[t] && c < 4; ++c)
                if (is_outer(t, c) && facets_.faces[t][c] >= 0 && !inside_[idx(facets_.faces[t][c])] != !in[t])
                    sum += area(t, c);
        return sum;
    }

    const TetFacets& facets_;
    std::vector<uint8_t> before_, in_;  // of each tetrahedron
    std::span<const uint8_t> inside_;   // of each source face
    Progress& progress_;
    std::vector<uint8_t> is_inner_;  // of each tetrahedron, whether it has no surface
    Box changed_;                    // around the tetrahedra that change sides
    double size_ = 0;                // its diagonal
    std::vector<int32_t> number_;    // of each tetrahedron in the band, or -1
    std::vector<Edge> edges_;        // of the surface near the change, sorted by their ends
};

}  // namespace

std::vector<uint8_t> move_border(const TetFacets& facets, std::vector<uint8_t> in, std::span<const uint8_t> inside,
                                 Progress& progress) {
    return BorderMover(facets, std::move(in), inside, progress).move();
}

}  // namespace partwheel
