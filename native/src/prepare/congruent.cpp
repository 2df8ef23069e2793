// Congruent shells: motions that take three points of one to three of the other, checked at every vertex and triangle.
#include "prepare/congruent.h"

namespace partwheel {

namespace {

// Vertices of copies differ by this share of the diagonal of the whole mesh, some eight units in the last place of
// float32.
constexpr double max_difference = 1e-6;

// Strengths of marks are means by length, which rounding changes.
constexpr float max_strength_difference = 1e-5F;

// Limits of the points and motions that are tried for two shells, and of the shells that one is compared with.
constexpr size_t max_tries = 256, max_originals = 8;

// A unit vector to which hardly any direction in a model is perpendicular.
constexpr Point generic_direction = {0.7370, 0.5531, 0.3884};

struct SortedTriangle {
    Triangle corners;  // ascending
    bool is_reversed;  // by sorting them
    int32_t face;

    auto operator<=>(const SortedTriangle&) const = default;
};

SortedTriangle sorted_triangle(Triangle corners, bool is_reversed, int32_t face) {
    const auto sort = [&](size_t i) {
        if (corners[i] < corners[i + 1]) return;
        std::swap(corners[i], corners[i + 1]);
        is_reversed = !is_reversed;
    };
    sort(0);
    sort(1);
    sort(0);
    return {corners, is_reversed, face};
}

// A shell in an order that depends on positions alone.
struct SortedShell {
    explicit SortedShell(const SubMesh& shell) : mesh(shell), order(iota(shell.vertices.size())) {
        const auto height = [&](int32_t v) { return dot(generic_direction, vertex(v)); };
        std::ranges::sort(order, {}, [&](int32_t v) { return std::pair(height(v), vertex(v)); });
        const auto count = static_cast<double>(order.size());
        for (const int32_t v : order) {
            heights.push_back(height(v));
            center = center + 1 / count * vertex(v);
        }
        for (const int32_t v : order) spread += dot(vertex(v) - center, vertex(v) - center) / count;
        spread = std::sqrt(spread);
        for (size_t t = 0; t < mesh.triangles.size(); ++t)
            triangles.push_back(sorted_triangle(mesh.triangles[t], false, mesh.faces[t]));
        std::ranges::sort(triangles);
    }

    const Point& vertex(int32_t v) const { return mesh.vertices[idx(v)]; }

    // A vertex at this point, or -1.
    int32_t find(const Point& p, double tolerance) const {
        const double height = dot(generic_direction, p);
        const auto first = std::ranges::lower_bound(heights, height - tolerance) - heights.begin();
        for (auto i = static_cast<size_t>(first); i < order.size() && heights[i] <= height + tolerance; ++i)
            if (length(vertex(order[i]) - p) <= tolerance) return order[i];
        return -1;
    }

    const SubMesh& mesh;
    std::vector<int32_t> order;   // the vertices along the generic direction
    std::vector<double> heights;  // of these in that direction
    Point center{};
    double spread = 0;  // root mean square of the distances from the center
    std::vector<SortedTriangle> triangles;
};

// Coordinates whose x-axis points from a center to p, and whose y-axis points to the side where q is.
Affine axes(const Point& center, const Point& p, const Point& q, bool is_mirrored) {
    const auto normalized = [](const Point& v) { return 1 / length(v) * v; };
    const Point x = normalized(p - center), normal = normalized(cross(x, q - center)), y = cross(normal, x);
    const Point z = (is_mirrored ? -1 : 1) * normal;
    return {x[0], y[0], z[0], center[0], x[1], y[1], z[1], center[1], x[2], y[2], z[2], center[2]};
}

// Looks for the motion that takes one shell to another one of as many vertices, triangles and faces.
class Matcher {
public:
    Matcher(const SortedShell& from, const SortedShell& to, const Patches& patches, double tolerance)
        : from_(from), to_(to), patches_(patches), tolerance_(tolerance) {}

    // Translations first: most copies are.
    std::optional<Congruence> match() {
        const Point shift = to_.center - from_.center;
        if (fits({1, 0, 0, shift[0], 0, 1, 0, shift[1], 0, 0, 1, shift[2]}, false) || fits_turned(false) || fits_turned(true))
            return std::move(found_);
        return {};
    }

private:
    Point farthest(const auto& distance) const {
        return from_.vertex(*std::ranges::max_element(from_.order, {}, [&](int32_t v) { return distance(from_.vertex(v)); }));
    }

    // Whether a motion fits that takes the center and the two farthest points of one shell to such points of the other.
    bool fits_turned(bool is_mirrored) {
        const Point &center = from_.center, &to_center = to_.center;
        const Point p = farthest([&](const Point& v) { return length(v - center); });
        const Point q = farthest([&](const Point& v) { return length(cross(p - center, v - center)); });
        if (!(length(cross(p - center, q - center)) > tolerance_ * length(p - center))) return false;  // all are on one line
        const auto is_near = [&](const Point& a, double b) { return std::fabs(length(a) - b) <= 2 * tolerance_; };
        const double p_to_center = length(p - center), q_to_center = length(q - center), p_to_q = length(q - p);
        const Affine from_axes = axes(center, p, q, false);
        size_t tries = 0;
        for (const int32_t v : to_.order) {
            const Point& to_p = to_.vertex(v);
            if (!is_near(to_p - to_center, p_to_center)) continue;
            if (++tries > max_tries) return false;
            for (const int32_t w : to_.order) {
                const Point& to_q = to_.vertex(w);
                if (!is_near(to_q - to_center, q_to_center) || !is_near(to_q - to_p, p_to_q)) continue;
                if (++tries > max_tries) return false;
                if (fits(compose_with_inverse(axes(to_center, to_p, to_q, is_mirrored), from_axes), is_mirrored)) return true;
            }
        }
        return false;
    }

    // Whether the motion takes one shell to the other; then that is what was found.
    bool fits(const Affine& motion, bool is_mirrored) {
        found_ = {.original = 0, .motion = motion, .is_mirrored = is_mirrored, .vertices = {}, .faces = {}};
        return match_vertices() && match_triangles() && match_patches();
    }

    bool match_vertices() {
        found_.vertices.assign(from_.order.size(), -1);
        std::vector<bool> is_matched(to_.order.size(), false);
        for (const int32_t v : from_.order) {
            const int32_t image = to_.find(transform_point(found_.motion, from_.vertex(v)), tolerance_);
            if (image < 0 || is_matched[idx(image)]) return false;
            is_matched[idx(image)] = true;
            found_.vertices[idx(v)] = image;
        }
        return true;
    }

    // A motion that mirrors also reverses the triangles, so that their outer sides stay outside.
    bool match_triangles() {
        std::vector<SortedTriangle> images;
        for (const auto& [corners, is_reversed, face] : from_.triangles) {
            Triangle image = corners;
            for (int32_t& v : image) v = found_.vertices[idx(v)];
            images.push_back(sorted_triangle(image, is_reversed != found_.is_mirrored, face));
        }
        std::ranges::sort(images);
        found_.faces.assign(from_.mesh.face_numbers.size(), -1);
        for (size_t t = 0; t < images.size(); ++t) {
            const auto& [corners, is_reversed, face] = to_.triangles[t];
            if (images[t].corners != corners || images[t].is_reversed != is_reversed) return false;
            int32_t& image = found_.faces[idx(images[t].face)];
            if (image >= 0 && image != face) return false;
            image = face;
        }
        return true;
    }

    // The patches are the same, and the marks between them as strong.
    bool match_patches() const {
        if (patches_.of_face.empty()) return true;
        std::map<int32_t, int32_t> images, originals;
        for (size_t f = 0; f < found_.faces.size(); ++f) {
            const int32_t patch = patches_.of_face[idx(from_.mesh.face_numbers[f])];
            const int32_t image = patches_.of_face[idx(to_.mesh.face_numbers[idx(found_.faces[f])])];
            if ((patch < 0) != (image < 0)) return false;
            if (images.try_emplace(patch, image).first->second != image) return false;
            if (originals.try_emplace(image, patch).first->second != patch) return false;
        }
        return std::ranges::all_of(images, [&](const auto& a) {
            return std::ranges::all_of(images, [&](const auto& b) {
                const float one = patches_.strength(a.first, b.first), other = patches_.strength(a.second, b.second);
                return std::fabs(one - other) <= max_strength_difference;
            });
        });
    }

    const SortedShell &from_, &to_;
    const Patches& patches_;
    double tolerance_;
    Congruence found_;
};

}  // namespace

std::vector<std::optional<Congruence>> find_congruent_shells(std::span<const SubMesh> shells, const Patches& patches,
                                                             Progress& progress) {
    Box box;
    std::map<std::array<size_t, 3>, std::vector<size_t>> groups;  // of as many vertices, triangles and faces
    for (size_t s = shells.size(); s-- > 0;) {
        box.add(Box::around(shells[s].vertices));
        groups[{shells[s].vertices.size(), shells[s].triangles.size(), shells[s].face_numbers.size()}].push_back(s);
    }
    const double tolerance = max_difference * box.diagonal();
    std::vector<std::optional<Congruence>> found(shells.size());
    for (const auto& [counts, group] : groups) {
        if (group.size() == 1) continue;
        std::multimap<double, std::pair<size_t, SortedShell>> originals;  // by spread
        for (const size_t s : group) {
            progress.advance_by(0);
            SortedShell shell(shells[s]);
            auto original = originals.lower_bound(shell.spread - 2 * tolerance);
            for (size_t i = 0; i < max_originals && !found[s] && original != originals.end(); ++i, ++original) {
                if (original->first > shell.spread + 2 * tolerance) break;
                found[s] = Matcher(original->second.second, shell, patches, tolerance).match();
                if (found[s]) found[s]->original = original->second.first;
            }
            if (!found[s]) originals.emplace(shell.spread, std::pair(s, std::move(shell)));
        }
    }
    return found;
}

}  // namespace partwheel
