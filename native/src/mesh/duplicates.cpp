// Duplicate faces.
#include "mesh/duplicates.h"

#include "base/adjacency.h"
#include "base/corners.h"
#include "base/sorted.h"
#include "mesh/face_assignment.h"
#include "mesh/nearest.h"

namespace partwheel {

namespace {

// A polygon counts as the union of smaller faces, whose diagonals may differ, if no corner is farther from its plane
// than this share of its size.
constexpr double flat = 0.05;

// The middle of a fan counts as in the polygon's plane if it is closer than this share of its size: coordinates may
// have been rounded to floats.
constexpr double rounding = 1e-6;

// Limit of comparisons of faces with polygons in the search for sums: half a second. Real meshes need about ten per
// face; n polygons with three common corners need n^2.
constexpr size_t max_compared_faces = 400000000;

using Edge = std::pair<int32_t, int32_t>;  // the lower vertex first

// Sorts edges and moves one of each that occurs an odd number of times to the front. Returns the number of these.
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

// For each vertex, the first one at the same position. Coincident vertices are consecutive.
std::vector<int32_t> first_coincident(std::span<const Point> vertices) {
    std::vector<int32_t> first;
    for (size_t v = 0; v < vertices.size(); ++v)
        first.push_back(v > 0 && vertices[v] == vertices[v - 1] ? first.back() : static_cast<int32_t>(v));
    return first;
}

// The outline of each face: the edges that an odd number of its triangles have.
class Outlines {
public:
    explicit Outlines(const Surface& source)
        : source_(source), first_(first_coincident(source.vertices)),
          triangles_(source.face_count, [&](const auto& put) {
              for (size_t t = 0; t < source.triangles.size(); ++t)
                  put(idx(source.samples[t].face), static_cast<int32_t>(t));
          }),
          edges_(source.face_count, [&](const auto& put) {
              for (size_t t = 0; t < source.triangles.size(); ++t)
                  for (size_t k = 0; k < 3; ++k) {
                      const Triangle& corners = source.triangles[t];
                      const Edge edge = std::minmax({first_[idx(corners[k])], first_[idx(corners[(k + 1) % 3])]});
                      if (edge.first != edge.second) put(idx(source.samples[t].face), edge);
                  }
          }) {
        for (size_t f = 0; f < source.face_count; ++f) size_.push_back(sum_modulo_two(edges_.row(f)));
        faces_at_ = CsrArray<int32_t>(source.vertices.size(), [&](const auto& put) {
            for (size_t f = 0; f < size_.size(); ++f)
                for (const Edge& edge : of(f)) {
                    put(idx(edge.first), static_cast<int32_t>(f));
                    put(idx(edge.second), static_cast<int32_t>(f));
                }
        });
        order_ = iota(size_.size());
        std::ranges::sort(order_, [&](int32_t a, int32_t b) {
            const auto one = of(idx(a)), other = of(idx(b));
            if (!std::ranges::equal(one, other)) return std::ranges::lexicographical_compare(one, other);
            return a < b;
        });
    }

    std::span<const Edge> of(size_t face) const { return edges_.row(face).first(size_[face]); }

    // Faces with equal outlines become duplicates of the lowest of them.
    void find_equals(std::vector<int32_t>& original) const {
        for (size_t i = 1; i < order_.size(); ++i)
            if (!of(idx(order_[i])).empty() && std::ranges::equal(of(idx(order_[i])), of(idx(order_[i - 1]))))
                original[idx(order_[i])] = original[idx(order_[i - 1])];
    }

    // Triangles around a vertex in the plane of a polygon that together have its outline become its duplicates.
    void find_fans(std::vector<int32_t>& original) const {
        std::vector<Edge> sum;
        for (size_t v = 0; v < source_.vertices.size(); ++v) {
            sum.clear();
            const auto is_in_fan = [&](int32_t face) { return size_[idx(face)] == 3 && original[idx(face)] == face; };
            double fan_area = 0;
            for (const int32_t face : faces_at_.row(v)) {  // twice each
                if (!is_in_fan(face)) continue;
                sum.insert(sum.end(), of(idx(face)).begin(), of(idx(face)).end());
                fan_area += length(area_vector(idx(face))) / 2;
            }
            // One of each of the three edges of a triangle that it is in twice.
            std::ranges::sort(sum);
            for (size_t i = 0; 2 * i < sum.size(); ++i) sum[i] = sum[2 * i];
            sum.resize(sum.size() / 2);
            sum.resize(sum_modulo_two(sum));
            if (sum.size() < 3) continue;
            const auto polygon = std::ranges::lower_bound(order_, sum, std::ranges::lexicographical_compare,
                                                          [&](int32_t face) { return of(idx(face)); });
            if (polygon == order_.end() || !std::ranges::equal(of(idx(*polygon)), sum) || !is_flat(idx(*polygon), v)) continue;
            const double polygon_area = length(area_vector(idx(*polygon)));
            if (std::fabs(fan_area - polygon_area) > flat * polygon_area) continue;  // they overlap
            for (const int32_t face : faces_at_.row(v))
                if (is_in_fan(face)) original[idx(face)] = *polygon;
        }
    }

    // Faces whose outlines sum up to that of a larger polygon become its duplicates; the smallest polygons first.
    void find_sums(std::vector<int32_t>& original) const {
        std::vector<int32_t> order;
        for (size_t f = 0; f < size_.size(); ++f)
            if (size_[f] > 3) order.push_back(static_cast<int32_t>(f));
        std::ranges::stable_sort(order, {}, [&](int32_t f) { return size_[idx(f)]; });
        std::vector<int32_t> corner_of(source_.vertices.size(), -1), compared_with(size_.size(), -1), parts, corners;
        std::vector<Edge> sum;
        size_t compared = 0;
        for (const int32_t polygon : order) {
            if (original[idx(polygon)] != polygon) continue;
            for (const Edge& edge : of(idx(polygon))) corner_of[idx(edge.first)] = corner_of[idx(edge.second)] = polygon;
            const auto within = [&](int32_t face) {
                return face != polygon && original[idx(face)] == face && size_[idx(face)] < size_[idx(polygon)] &&
                       std::ranges::all_of(of(idx(face)), [&](const Edge& edge) {
                           return corner_of[idx(edge.first)] == polygon && corner_of[idx(edge.second)] == polygon;
                       });
            };
            parts.clear();
            sum.clear();
            // A part has three corners at least, so the two corners with the most faces are skipped: all faces of a fan
            // meet there.
            corners.clear();
            for (const Edge& edge : of(idx(polygon))) corners.insert(corners.end(), {edge.first, edge.second});
            sort_unique(corners);
            std::ranges::stable_sort(corners, {}, [&](int32_t corner) { return faces_at_.row(idx(corner)).size(); });
            for (const int32_t corner : std::span(corners).first(corners.size() - 2)) {
                if (compared += faces_at_.row(idx(corner)).size(); compared > max_compared_faces) return;
                for (const int32_t face : faces_at_.row(idx(corner))) {
                    if (std::exchange(compared_with[idx(face)], polygon) == polygon || !within(face)) continue;
                    parts.push_back(face);
                    sum.insert(sum.end(), of(idx(face)).begin(), of(idx(face)).end());
                }
            }
            sum.resize(sum_modulo_two(sum));
            if (parts.size() < 2 || !std::ranges::equal(sum, of(idx(polygon))) || !is_flat(idx(polygon))) continue;
            for (const int32_t face : parts) original[idx(face)] = polygon;
        }
    }

    // Two flat patches of faces with one outline cover the same region. The faces of all such patches but the one with
    // the fewest faces become duplicates of the nearest faces of that one.
    void find_tessellations(std::vector<int32_t>& original) const {
        const CsrArray<int32_t> patches = flat_patches(original);
        std::vector<std::vector<Edge>> outlines(size_.size());
        std::vector<int32_t> order;
        std::vector<char> is_on_outline(source_.vertices.size(), false);  // of a patch of several faces
        const auto consider = [&](size_t p) {
            for (const int32_t face : patches.row(p)) std::ranges::copy(of(idx(face)), std::back_inserter(outlines[p]));
            outlines[p].resize(sum_modulo_two(outlines[p]));
            if (!outlines[p].empty()) order.push_back(static_cast<int32_t>(p));
        };
        for (size_t p = 0; p < size_.size(); ++p)
            if (patches.row(p).size() > 1) {
                consider(p);
                for (const auto& [from, to] : outlines[p]) is_on_outline[idx(from)] = is_on_outline[idx(to)] = true;
            }
        // Single faces have different outlines; one may have that of a patch.
        for (size_t p = 0; p < size_.size(); ++p)
            if (patches.row(p).size() == 1 &&
                std::ranges::all_of(of(p), [&](const Edge& e) { return is_on_outline[idx(e.first)]; }))
                consider(p);
        std::ranges::sort(order, [&](int32_t p, int32_t q) {
            if (outlines[idx(p)] != outlines[idx(q)]) return outlines[idx(p)] < outlines[idx(q)];
            return std::pair(patches.row(idx(p)).size(), p) < std::pair(patches.row(idx(q)).size(), q);
        });
        for (size_t first = 0, i = 1; i < order.size(); ++i) {
            const auto one = patches.row(idx(order[first])), other = patches.row(idx(order[i]));
            if (outlines[idx(order[first])] != outlines[idx(order[i])])
                first = i;
            else if (const double size = area(one); std::fabs(size - area(other)) <= rounding * size)
                assign_to_nearest(other, one, original);
        }
    }

private:
    // The faces that are no duplicates, by patch: faces are in one patch if they are connected by edges at which
    // exactly two of them meet, in one plane, on opposite sides of the edge.
    CsrArray<int32_t> flat_patches(std::span<const int32_t> original) const {
        std::vector<std::pair<Edge, int32_t>> sides;
        for (size_t f = 0; f < size_.size(); ++f)
            if (original[f] == static_cast<int32_t>(f))
                for (const Edge& edge : of(f)) sides.push_back({edge, static_cast<int32_t>(f)});
        std::ranges::sort(sides);
        UnionFind patches(size_.size());
        for (size_t i = 0, end = 0; i < sides.size(); i = end) {
            while (end < sides.size() && sides[end].first == sides[i].first) ++end;
            if (end != i + 2) continue;
            const Point from = source_.vertices[idx(sides[i].first.first)];
            const Point along = source_.vertices[idx(sides[i].first.second)] - from;
            const auto across = [&](int32_t face) {
                const Point diagonal = centroid(idx(face)) - from;
                return diagonal - dot(diagonal, along) / dot(along, along) * along;
            };
            const Point one = across(sides[i].second), other = across(sides[i + 1].second);
            if (dot(one, other) < 0 && length(cross(one, other)) <= rounding * length(one) * length(other))
                patches.unite(idx(sides[i].second), idx(sides[i + 1].second));
        }
        return {size_.size(), [&](const auto& put) {
                    for (size_t f = 0; f < size_.size(); ++f)
                        if (original[f] == static_cast<int32_t>(f)) put(patches.find(f), static_cast<int32_t>(f));
                }};
    }

    void assign_to_nearest(std::span<const int32_t> copies, std::span<const int32_t> faces,
                           std::vector<int32_t>& original) const {
        std::vector<Triangle> triangles;
        std::vector<int32_t> face_of;
        for (const int32_t face : faces)
            for (const int32_t t : triangles_.row(idx(face))) {
                triangles.push_back(source_.triangles[idx(t)]);
                face_of.push_back(face);
            }
        NearestTriangle nearest(source_.vertices, triangles);
        for (const int32_t copy : copies) original[idx(copy)] = face_of[idx(nearest(centroid(idx(copy))).triangle)];
    }

    double area(std::span<const int32_t> faces) const {
        double sum = 0;
        for (const int32_t face : faces) sum += length(area_vector(idx(face)));
        return sum;
    }

    // The mean of the corners.
    Point centroid(size_t face) const {
        Point sum{};
        for (const Edge& edge : of(face)) sum = sum + source_.vertices[idx(edge.first)] + source_.vertices[idx(edge.second)];
        return 0.5 / static_cast<double>(size_[face]) * sum;
    }

    // A vector along the normal, whose length is the area of the face.
    Point area_vector(size_t face) const {
        Point sum{};
        for (const int32_t t : triangles_.row(face)) {
            const auto [a, b, c] = corner_points(source_.vertices, source_.triangles[idx(t)]);
            sum = sum + 0.5 * cross(b - a, c - a);
        }
        return sum;
    }

    // Whether no corner is far from the face's plane, nor `middle` farther than the corners.
    bool is_flat(size_t face, std::optional<size_t> middle = {}) const {
        const auto point = [&](int32_t v) -> const Point& { return source_.vertices[idx(v)]; };
        const Point normal = area_vector(face);
        const Point& from = point(of(face)[0].first);
        double farthest = 0, highest = 0, middle_height = 0;
        for (const Edge& edge : of(face))
            for (const int32_t v : {edge.first, edge.second}) {
                farthest = std::max(farthest, length(point(v) - from));
                highest = std::max(highest, std::fabs(dot(normal, point(v) - from)));
            }
        if (middle) middle_height = std::fabs(dot(normal, source_.vertices[*middle] - from));
        return highest <= flat * farthest * length(normal) && middle_height <= highest + rounding * farthest * length(normal);
    }

    const Surface& source_;
    std::vector<int32_t> first_;
    CsrArray<int32_t> triangles_;
    CsrArray<Edge> edges_;       // of each face, its outline first
    std::vector<size_t> size_;
    CsrArray<int32_t> faces_at_;  // by corner: twice each
    std::vector<int32_t> order_;  // faces sorted by outline
};

}  // namespace

std::vector<int32_t> find_duplicates(const Surface& source) {
    std::vector<int32_t> original = iota(source.face_count);
    const Outlines outlines(source);
    outlines.find_equals(original);
    outlines.find_sums(original);
    outlines.find_fans(original);
    outlines.find_tessellations(original);
    for (int32_t& face : original)
        while (original[idx(face)] != face) face = original[idx(face)];
    return original;
}

size_t count_duplicates(std::span<const int32_t> original) {
    size_t count = 0;
    for (size_t f = 0; f < original.size(); ++f) count += original[f] != static_cast<int32_t>(f);
    return count;
}

void add_face_notes(const FaceCounts& counts, std::string& notes) {
    const auto add = [&](size_t count, const char* one, const char* many, const char* end) {
        if (count > 0) notes += (notes.empty() ? "Repaired: " : " ") + counted_faces(count, one, many) + end;
    };
    add(counts.walls, "is a wall", "are walls", " inside the solid, which was cut apart there.");
    add(counts.left_out, "encloses nothing, and was", "enclose nothing, and were", " left out of the solid.");
    add(counts.duplicates, "is a duplicate of another, and was", "are duplicates of others, and were", " counted once.");
}

Surface without_duplicates(const Surface& source, std::span<const int32_t> original) {
    const std::vector<int32_t> first = first_coincident(source.vertices);
    std::map<std::pair<int32_t, int32_t>, int32_t> corner;  // (original face, first coincident vertex) -> vertex of that face
    const auto is_original = [&](size_t t) { return original[idx(source.samples[t].face)] == source.samples[t].face; };
    std::vector<bool> has_duplicate(source.face_count, false);
    for (size_t f = 0; f < original.size(); ++f)
        if (original[f] != static_cast<int32_t>(f)) has_duplicate[idx(original[f])] = true;
    for (size_t t = 0; t < source.triangles.size(); ++t)
        if (has_duplicate[idx(source.samples[t].face)])
            for (const int32_t v : source.triangles[t]) corner.emplace(std::pair(source.samples[t].face, first[idx(v)]), v);
    UnionFind joined(source.vertices.size());
    for (size_t t = 0; t < source.triangles.size(); ++t)
        if (!is_original(t))
            for (const int32_t v : source.triangles[t]) {
                const auto same = corner.find({original[idx(source.samples[t].face)], first[idx(v)]});
                if (same != corner.end()) joined.unite(idx(v), idx(same->second));
            }

    std::vector<int32_t> faces;
    std::vector<Triangle> triangles;
    for (size_t t = 0; t < source.triangles.size(); ++t) {
        if (!is_original(t)) continue;
        faces.push_back(source.samples[t].face);
        for (int32_t& v : triangles.emplace_back(source.triangles[t])) v = static_cast<int32_t>(joined.find(idx(v)));
    }
    const std::vector<int32_t> used = in_order_of_use(source.vertices.size(), triangles);
    Surface surface = canonical(source.frame, source.vertices, source.source_vertex, std::move(triangles), used);
    for (FaceSample& sample : surface.samples) sample.face = faces[idx(sample.face)];
    surface.face_count = source.face_count;
    return surface;
}

}  // namespace partwheel
