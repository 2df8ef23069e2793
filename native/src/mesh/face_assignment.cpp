// Assigns each source face to the nearest triangles of another surface.
#include "mesh/face_assignment.h"

#include "mesh/nearest.h"

#include <charconv>

namespace partwheel {

namespace {

// Samples between two checks for cancellation.
constexpr size_t samples_between_polls = 256;

// A smaller distance, relative to the diagonal, counts as 0.
constexpr double rounding = 1e-12;

// A triangle of the source: its longest side goes from `corner` along `u`; `v` goes from `corner` to the opposite
// corner.
struct SampledTriangle {
    Point corner, u, v;
    double length = 0, area;  // length: of u

    SampledTriangle(const Surface& source, size_t triangle) : area(source.samples[triangle].area) {
        for (size_t k = 0; k < 3; ++k) {
            const auto at = [&](size_t i) { return source.vertices[idx(source.triangles[triangle][i % 3])]; };
            const Point side = at(k + 1) - at(k);
            if (k > 0 && partwheel::length(side) <= length) continue;
            corner = at(k);
            u = side;
            v = at(k + 2) - corner;
            length = partwheel::length(side);
        }
    }

    // Calls visit(middle, area) for each piece. No piece is longer or wider than the spacing: the triangle is divided
    // into strips along its longest side, and each strip across.
    template <class Function>
    void for_each_piece(double spacing, const Function& visit) const {
        const auto parts = [&](double extent) { return std::max(1.0, std::ceil(extent / spacing)); };
        const double strips = length > 0 ? parts(2 * area / length) : 1;
        for (double strip = 0; strip < strips; ++strip) {
            const double below = 1 - strip / strips, above = 1 - (strip + 1) / strips;  // lengths, relative to u's
            const double middle = 1 - below + (below + 2 * above) / (below + above) / (3 * strips);
            const double count = parts(below * length);
            for (double i = 0; i < count; ++i)
                visit(corner + ((i + 0.5) / count * (1 - middle)) * u + middle * v,
                      area * (below + above) / strips / count);
        }
    }
};

// With this spacing there are at most `max_samples` more pieces than triangles: a triangle of length l and height h <=
// l has at most (l / s) (h / s / 2 + 1) + h / s + 1 <= area / s^2 + 2 l / s + 1 pieces with spacing s.
double least_spacing(double area, double lengths) {
    return (lengths + std::sqrt(lengths * lengths + area * max_samples)) / max_samples;
}

// For each source triangle the one of the surface with the same corners, or -1.
std::vector<int32_t> find_unchanged(const Surface& source, const Surface& surface) {
    using Corners = std::array<Point, 3>;
    const auto corners = [](const Surface& s, size_t t) {
        Corners sorted = corner_points(s.vertices, s.triangles[t]);
        std::ranges::sort(sorted);
        return sorted;
    };
    std::vector<std::pair<Corners, int32_t>> order;
    for (size_t t = 0; t < surface.triangles.size(); ++t) order.push_back({corners(surface, t), static_cast<int32_t>(t)});
    std::ranges::sort(order);
    std::vector<int32_t> unchanged;
    for (size_t t = 0; t < source.triangles.size(); ++t) {
        const std::pair<Corners, int32_t> lowest{corners(source, t), -1};
        const auto found = std::ranges::lower_bound(order, lowest);
        unchanged.push_back(found != order.end() && found->first == lowest.first ? found->second : -1);
    }
    return unchanged;
}

}  // namespace

Assignment assign_source_faces_by_distance(const Surface& source, Surface& surface, Progress& progress) {
    NearestTriangle nearest(surface.vertices, surface.triangles);
    double area = 0, lengths = 0;
    for (size_t t = 0; t < source.triangles.size(); ++t) {
        const SampledTriangle sampled(source, t);
        area += sampled.area;
        lengths += sampled.length;
    }
    const double size = diagonal(source);
    const double spacing = std::max(size * sample_spacing, least_spacing(area, lengths));
    double farthest = 0, outside = near_enough * size, distance = 0, hidden = 0;
    size_t samples = 0, t = 0;
    // Triangles that are still there are not searched for: each of their points might be in the boxes of many.
    const std::vector<int32_t> unchanged = find_unchanged(source, surface);
    const auto find = [&](const Point& p, int32_t triangle) {
        if (samples++ % samples_between_polls == 0)
            progress.advance(0.9 + 0.1 * static_cast<double>(t) / static_cast<double>(source.triangles.size()));
        const Near near = triangle >= 0 ? Near{triangle, 0, p} : nearest(p);
        distance = std::sqrt(near.squared);
        farthest = std::max(farthest, distance);
        if (distance > outside && nearest.is_outside(p)) outside = distance;
        return near.triangle;
    };

    std::vector<int32_t> triangle_at(source.vertices.size(), -1);
    for (size_t i = 0; i < unchanged.size(); ++i)
        for (const int32_t v : source.triangles[i]) triangle_at[idx(v)] = std::max(triangle_at[idx(v)], unchanged[i]);
    for (size_t v = 0; v < source.vertices.size(); ++v) find(source.vertices[v], triangle_at[v]);
    surface.samples.clear();
    for (; t < source.triangles.size(); ++t)
        SampledTriangle(source, t).for_each_piece(spacing, [&](const Point& p, double piece_area) {
            surface.samples.push_back({source.samples[t].face, find(p, unchanged[t]), piece_area, unchanged[t] >= 0});
            if (distance > hidden_beyond * size) hidden += piece_area;
        });
    surface.face_count = source.face_count;
    surface.deviation = farthest < rounding * size ? 0 : farthest / size;
    return {outside > near_enough * size ? outside / size : 0, area > 0 ? hidden / area : 0};
}

double diagonal(const Surface& source) { return length(Box::around(source.vertices).high); }

std::string with_commas(size_t n) {
    std::string text = std::to_string(n);
    for (size_t end = text.size(); end > 3; end -= 3) text.insert(end - 3, ",");
    return text;
}

std::string counted_faces(size_t n, const char* one, const char* many) {
    return with_commas(n) + (n == 1 ? " face " : " faces ") + (n == 1 ? one : many);
}

std::string percent(double share) {
    char text[32];  // printf would write a comma where the host's locale has one
    char* const end = std::to_chars(text, std::end(text), 100 * share, std::chars_format::general, 2).ptr;
    return std::string(text, end) + " %";
}

std::string at_most_away(double distance) {
    return "The surface used is at most " + percent(distance) + " of the model's size away";
}

}  // namespace partwheel
