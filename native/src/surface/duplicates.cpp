// Faces that are there several times.
#include "surface/duplicates.h"

#include "base/groups.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace partwheel {

namespace {

// A polygon is taken for the same as smaller faces, whose diagonals may be others, if none of its corners is further from
// their plane than this share of their distance: a solid between them would be thinner.
constexpr double flat = 0.05;

using Edge = std::pair<int32_t, int32_t>;  // the lower vertex first

// Sorts edges, and leaves one of each that is there an odd number of times. How many are left, at the beginning.
size_t sum_modulo_two(std::span<Edge> edges) {
    std::ranges::sort(edges);
    size_t count = 0;
    for (const Edge& edge : edges) {
        if (count > 0 && edges[count - 1] == edge)
            --count;
        else
            edges[count++] = edge;
    }
    return count;
}

// Of each vertex the first one at the same place: these follow each other.
std::vector<int32_t> first_at_place(std::span<const Point> vertices) {
    std::vector<int32_t> first;
    for (size_t v = 0; v < vertices.size(); ++v)
        first.push_back(v > 0 && vertices[v] == vertices[v - 1] ? first.back() : static_cast<int32_t>(v));
    return first;
}

class Outlines {
public:
    explicit Outlines(const Surface& source)
        : source_(source), first_(first_at_place(source.vertices)),
          triangles_(source.face_count, [&](const auto& put) {
              for (size_t t = 0; t < source.triangles.size(); ++t)
                  put(at(source.pieces[t].face), static_cast<int32_t>(t));
          }),
          edges_(source.face_count, [&](const auto& put) {
              for (size_t t = 0; t < source.triangles.size(); ++t)
                  for (size_t k = 0; k < 3; ++k) {
                      const Triangle& corners = source.triangles[t];
                      const Edge edge = std::minmax({first_[at(corners[k])], first_[at(corners[(k + 1) % 3])]});
                      if (edge.first != edge.second) put(at(source.pieces[t].face), edge);
                  }
          }) {
        for (size_t f = 0; f < source.face_count; ++f) size_.push_back(sum_modulo_two(edges_.with(f)));
    }

    std::span<const Edge> of(size_t face) const { return edges_.with(face).first(size_[face]); }

    // Of equals the lowest.
    void find_equals(std::vector<int32_t>& original) const {
        std::vector<int32_t> order(size_.size());
        std::iota(order.begin(), order.end(), 0);
        std::ranges::sort(order, [&](int32_t a, int32_t b) {
            const auto one = of(at(a)), other = of(at(b));
            if (!std::ranges::equal(one, other)) return std::ranges::lexicographical_compare(one, other);
            return a < b;
        });
        for (size_t i = 1; i < order.size(); ++i)
            if (!of(at(order[i])).empty() && std::ranges::equal(of(at(order[i])), of(at(order[i - 1]))))
                original[at(order[i])] = original[at(order[i - 1])];
    }

    // Polygons, the smallest first, that are the sum of smaller faces.
    void find_sums(std::vector<int32_t>& original) const {
        const Grouped<int32_t> faces_at(source_.vertices.size(), [&](const auto& put) {
            for (size_t f = 0; f < size_.size(); ++f)
                for (const Edge& edge : of(f)) {
                    put(at(edge.first), static_cast<int32_t>(f));
                    put(at(edge.second), static_cast<int32_t>(f));
                }
        });
        std::vector<int32_t> order;
        for (size_t f = 0; f < size_.size(); ++f)
            if (size_[f] > 3) order.push_back(static_cast<int32_t>(f));
        std::ranges::stable_sort(order, {}, [&](int32_t f) { return size_[at(f)]; });
        std::vector<int32_t> corner_of(source_.vertices.size(), -1), asked_by(size_.size(), -1), parts;
        std::vector<Edge> sum;
        for (const int32_t polygon : order) {
            if (original[at(polygon)] != polygon) continue;
            for (const Edge& edge : of(at(polygon))) corner_of[at(edge.first)] = corner_of[at(edge.second)] = polygon;
            const auto within = [&](int32_t face) {
                return face != polygon && original[at(face)] == face && size_[at(face)] < size_[at(polygon)] &&
                       std::ranges::all_of(of(at(face)), [&](const Edge& edge) {
                           return corner_of[at(edge.first)] == polygon && corner_of[at(edge.second)] == polygon;
                       });
            };
            parts.clear();
            sum.clear();
            for (const Edge& edge : of(at(polygon)))
                for (const int32_t corner : {edge.first, edge.second})
                    for (const int32_t face : faces_at.with(at(corner))) {
                        if (std::exchange(asked_by[at(face)], polygon) == polygon || !within(face)) continue;
                        parts.push_back(face);
                        sum.insert(sum.end(), of(at(face)).begin(), of(at(face)).end());
                    }
            sum.resize(sum_modulo_two(sum));
            if (parts.size() < 2 || !std::ranges::equal(sum, of(at(polygon))) || !is_flat(at(polygon))) continue;
            for (const int32_t face : parts) original[at(face)] = polygon;
        }
    }

private:
    bool is_flat(size_t face) const {
        const auto point = [&](int32_t v) -> const Point& { return source_.vertices[at(v)]; };
        Point normal{};
        for (const int32_t t : triangles_.with(face)) {
            const auto& [a, b, c] = source_.triangles[at(t)];
            normal = normal + cross(point(b) - point(a), point(c) - point(a));
        }
        const Point& from = point(of(face)[0].first);
        double farthest = 0, highest = 0;
        for (const Edge& edge : of(face))
            for (const int32_t v : {edge.first, edge.second}) {
                farthest = std::max(farthest, length(point(v) - from));
                highest = std::max(highest, std::fabs(dot(normal, point(v) - from)));
            }
        return highest <= flat * farthest * length(normal);
    }

    const Surface& source_;
    std::vector<int32_t> first_;
    Grouped<int32_t> triangles_;
    Grouped<Edge> edges_;       // of each face's outline first, as many as its
    std::vector<size_t> size_;
};

}  // namespace

std::vector<int32_t> find_duplicates(const Surface& source) {
    std::vector<int32_t> original(source.face_count);
    std::iota(original.begin(), original.end(), 0);
    const Outlines outlines(source);
    outlines.find_equals(original);
    outlines.find_sums(original);
    for (int32_t& face : original)
        while (original[at(face)] != face) face = original[at(face)];
    return original;
}

size_t count_duplicates(std::span<const int32_t> original) {
    size_t count = 0;
    for (size_t f = 0; f < original.size(); ++f) count += original[f] != static_cast<int32_t>(f);
    return count;
}

Surface without_duplicates(const Surface& source, std::span<const int32_t> original) {
    const std::vector<int32_t> first = first_at_place(source.vertices);
    std::map<std::pair<int32_t, int32_t>, int32_t> corner;  // of an original at a place: its vertex
    const auto is_original = [&](size_t t) { return original[at(source.pieces[t].face)] == source.pieces[t].face; };
    std::vector<bool> has_duplicate(source.face_count, false);
    for (size_t f = 0; f < original.size(); ++f)
        if (original[f] != static_cast<int32_t>(f)) has_duplicate[at(original[f])] = true;
    for (size_t t = 0; t < source.triangles.size(); ++t)
        if (has_duplicate[at(source.pieces[t].face)])
            for (const int32_t v : source.triangles[t]) corner.emplace(std::pair(source.pieces[t].face, first[at(v)]), v);
    Joined joined(source.vertices.size());
    for (size_t t = 0; t < source.triangles.size(); ++t)
        if (!is_original(t))
            for (const int32_t v : source.triangles[t]) {
                const auto same = corner.find({original[at(source.pieces[t].face)], first[at(v)]});
                if (same != corner.end()) joined.join(at(v), at(same->second));
            }

    std::vector<Point> vertices;
    std::vector<int32_t> source_vertex, number(source.vertices.size(), -1), faces;
    std::vector<Triangle> triangles;
    for (size_t t = 0; t < source.triangles.size(); ++t) {
        if (!is_original(t)) continue;
        Triangle& triangle = triangles.emplace_back(source.triangles[t]);
        faces.push_back(source.pieces[t].face);
        for (int32_t& v : triangle) {
            const size_t kept = joined.find(at(v));
            if (number[kept] < 0) {
                number[kept] = static_cast<int32_t>(vertices.size());
                vertices.push_back(source.vertices[kept]);
                source_vertex.push_back(source.source_vertex[kept]);
            }
            v = number[kept];
        }
    }
    Surface surface = canonical(source.frame, vertices, source_vertex, triangles);
    for (Piece& piece : surface.pieces) piece.face = faces[at(piece.face)];
    surface.face_count = source.face_count;
    return surface;
}

}  // namespace partwheel
