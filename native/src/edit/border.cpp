// A part of a surface -> the same part with its border in the creases nearby: a minimum cut in a band around it.
#include "edit/border.h"

#include "base/error.h"
#include "mesh/crease.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>

namespace partwheel {

namespace {

// The band reaches this far on both sides, times the square root of the smaller side's area: on a finger, a cylinder
// some three times as long as it is thick, that is about its radius.
constexpr double band_reach = 0.2;
// The band ends where it has so many faces, the nearest to the border: a flow through more takes too long for a mouse.
constexpr size_t most_faces = 12000;
// An edge at the rim of the band costs by this share more than the same edge at the border: of two creases that are
// alike the nearer one is taken, and where there is none the border stays.
constexpr double pull = 0.5;
// Depths that differ by less, relatively, are the same.
constexpr double same_depth = 1e-9;
constexpr double infinite = std::numeric_limits<double>::infinity();

size_t face_of(const MeshView& mesh, size_t triangle) {
    return mesh.faces.empty() ? triangle : idx(mesh.faces[triangle]);
}

}  // namespace

Creases::Creases(const MeshView& mesh, Progress& progress) {
    check_arrays(mesh);
    progress.reach(0.1);
    center_.resize(mesh.face_count), normal_.resize(mesh.face_count), area_.resize(mesh.face_count);
    // A frame around the vertices in use, so that others have no say in how these are rounded.
    const std::span<const Point> given = mesh.vertices;
    std::vector<uint8_t> used(given.size(), 0);
    for (const Triangle& t : mesh.triangles)
        for (const int32_t v : t) used[idx(v)] = 1;
    std::vector<Point> in_use;
    in_use.reserve(given.size());
    for (size_t v = 0; v < given.size(); ++v)
        if (used[v]) in_use.push_back(given[v]);
    const Frame frame = Frame::around(in_use);
    points_.assign(given.size(), Point{});
    // Without an extent no face gets an area, and the band is empty.
    for (size_t v = 0; frame.scale > 0 && v < given.size(); ++v)
        if (used[v]) points_[v] = frame.to_working(given[v]);
    progress.reach(0.2);
    measure(mesh);
    progress.reach(0.3);
    join(mesh, progress);
}

double Creases::to_middle(size_t face, const Neighbor& edge) const {
    return length(0.5 * (points_[idx(edge.begin)] + points_[idx(edge.end)]) - center_[face]);
}

double Creases::cost(size_t face, const Neighbor& edge) const {
    const Point along = points_[idx(edge.end)] - points_[idx(edge.begin)];
    const Point &n = normal_[face], &m = normal_[idx(edge.face)];
    const double turn = dot(cross(n, m), along);
    // Nobody knows the angle where faces wind against each other, more than two meet, or one has no area.
    if (edge.against || turn == 0 || dot(n, n) == 0 || dot(m, m) == 0) return length(along);
    return length(along) * crease_weight(n, m, (turn > 0) != inside_out_);
}

void Creases::measure(const MeshView& mesh) {
    std::vector<int32_t> triangles(count(), 0);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const size_t face = face_of(mesh, t);
        const auto [i, j, k] = mesh.triangles[t];
        const Point &a = points_[idx(i)], &b = points_[idx(j)], &c = points_[idx(k)];
        const Point twice = cross(b - a, c - a);
        normal_[face] = normal_[face] + twice;
        area_[face] += length(twice) / 2;
        center_[face] = center_[face] + (1.0 / 3) * (a + b + c);
        volume_ += dot(cross(a, b), c);
        ++triangles[face];
    }
    for (size_t f = 0; f < count(); ++f) {
        if (triangles[f] > 0) center_[f] = (1.0 / triangles[f]) * center_[f];
        const double size = length(normal_[f]);
        normal_[f] = size > 0 ? (1 / size) * normal_[f] : Point{};
    }
}

void Creases::join(const MeshView& mesh, Progress& progress) {
    struct Pair {
        int32_t one, other;
        Neighbor edge;  // as seen from one
    };
    std::vector<Pair> pairs;
    pairs.reserve(3 * mesh.triangles.size() / 2);
    bool closed = true;
    for_each_edge(mesh.vertices.size(), mesh.triangles, [&](int32_t low, std::span<const Side> sides) {
        if (low % 4096 == 0) progress.reach(0.3 + 0.4 * low / static_cast<double>(mesh.vertices.size()));
        const bool plain = sides.size() == 2 && sides[0].upwards != sides[1].upwards;
        closed = closed && plain;
        for (size_t i = 0; i + 1 < sides.size(); ++i) {  // where more than two meet, each with the next
            const Side& side = sides[i];
            const auto one = static_cast<int32_t>(face_of(mesh, idx(side.number) / 3));
            const auto other = static_cast<int32_t>(face_of(mesh, idx(sides[i + 1].number) / 3));
            if (one != other)
                pairs.push_back({one, other,
                                 {other, side.upwards ? low : side.high, side.upwards ? side.high : low, !plain}});
        }
    });
    inside_out_ = closed && volume_ < 0;
    progress.reach(0.7);

    neighbors_ = CsrArray<Neighbor>(count(), [&](const auto& put) {
        for (const auto& [one, other, edge] : pairs) {
            put(idx(one), edge);
            put(idx(other), Neighbor{one, edge.end, edge.begin, edge.against});
        }
    });
    beside_ = CsrArray<int32_t>(count(), [&](const auto& put) {
        for (size_t f = 0; f < count(); ++f)
            for (const Neighbor& edge : around(f)) put(f, edge.face);
    });
}

namespace {

// How deep each face lies on its side of the border: from the border over middles of edges and centres of faces;
// infinity beyond reach, which is made less where so many faces are within it. (surface_distances() measures all of a
// surface, and vertices: too slow here.)
std::vector<double> depths(const Creases& faces, std::span<const uint8_t> inside, double& reach) {
    std::vector<double> depth(faces.count(), infinite);
    using Reached = std::pair<double, int32_t>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
    const auto come = [&](size_t face, double way) {
        if (way > reach || way >= depth[face]) return;
        depth[face] = way;
        front.push({way, static_cast<int32_t>(face)});
    };
    for (size_t f = 0; f < faces.count(); ++f) {
        const auto across = [&](int32_t other) { return !inside[f] != !inside[idx(other)]; };
        if (std::ranges::none_of(faces.beside(f), across)) continue;
        for (const Creases::Neighbor& edge : faces.around(f))
            if (across(edge.face)) come(f, faces.to_middle(f, edge));
    }
    for (size_t done = 0; !front.empty();) {
        const auto [way, face] = front.top();
        front.pop();
        const size_t f = idx(face);
        if (way > depth[f]) continue;
        if (done++ == most_faces) {
            reach = way;
            for (double& d : depth)
                if (d > reach) d = infinite;
            break;
        }
        for (const Creases::Neighbor& edge : faces.around(f))
            if (!inside[f] == !inside[idx(edge.face)])
                come(idx(edge.face), way + faces.to_middle(f, edge) + faces.to_middle(idx(edge.face), edge));
    }
    return depth;
}

// The faces that stay: of each connected piece of the part and of the rest those beyond the band, or its deeper half if
// it is all in the band; and where these are not connected, the ways between them that keep deepest.
std::vector<uint8_t> staying(const Creases& faces, std::span<const uint8_t> inside, std::span<const double> depth,
                             double reach) {
    std::vector<uint8_t> stays(faces.count(), 0), known(faces.count(), 0);
    size_t waiting[2] = {0, 0};  // of the rest and of the part: faces that stay
    const auto side = [&](int32_t face) { return inside[idx(face)] ? size_t{1} : size_t{0}; };
    const auto stay = [&](int32_t face) { stays[idx(face)] = 1, ++waiting[side(face)]; };
    std::vector<int32_t> piece;  // of the band
    for (int32_t start = 0; idx(start) < faces.count(); ++start) {
        if (depth[idx(start)] == infinite) {
            stay(start);
            continue;
        }
        if (known[idx(start)]) continue;
        piece.assign(1, start);
        known[idx(start)] = 1;
        double deepest = 0;
        for (size_t i = 0; i < piece.size(); ++i) {
            deepest = std::max(deepest, depth[idx(piece[i])]);
            for (const int32_t next : faces.beside(idx(piece[i]))) {
                if (side(next) != side(start)) continue;
                if (depth[idx(next)] == infinite) deepest = infinite;
                else if (!known[idx(next)]) known[idx(next)] = 1, piece.push_back(next);
            }
        }
        const double least = std::min(reach, deepest / 2) * (1 - same_depth);
        for (const int32_t f : piece)
            if (depth[idx(f)] >= least) stay(f);
    }

    // Prim's algorithm, the deepest face first.
    std::vector<int32_t> from(faces.count(), -1), deep;
    for (int32_t start = 0; idx(start) < faces.count(); ++start) {
        size_t& left = waiting[side(start)];
        if (!stays[idx(start)] || from[idx(start)] >= 0 || left == 0) continue;
        std::priority_queue<std::pair<double, int32_t>> others;
        deep.assign(1, start);
        from[idx(start)] = start;
        --left;
        while (left > 0) {
            int32_t face;
            if (!deep.empty()) {
                face = deep.back();
                deep.pop_back();
            } else if (!others.empty()) {
                face = others.top().second;
                others.pop();
            } else {
                break;
            }
            for (const int32_t next : faces.beside(idx(face))) {
                if (from[idx(next)] >= 0 || side(next) != side(start)) continue;
                from[idx(next)] = face;
                if (!stays[idx(next)]) {
                    others.push({depth[idx(next)], next});
                    continue;
                }
                deep.push_back(next);
                --left;
                for (int32_t way = face; !stays[idx(way)]; way = from[idx(way)]) stays[idx(way)] = 1;
            }
        }
    }
    return stays;
}

}  // namespace

BorderBand border_band(const Creases& faces, std::span<const uint8_t> inside) {
    if (std::none_of(inside.begin(), inside.end(), [](uint8_t in) { return in != 0; }))
        throw Error(PW_ERROR_EMPTY, "The part has no faces: pick one that has some.");
    double part = 0, rest = 0;
    for (size_t f = 0; f < faces.count(); ++f) (inside[f] ? part : rest) += faces.area(f);
    double reach = band_reach * std::sqrt(std::min(part, rest));
    BorderBand band;
    if (!(reach > 0)) return band;
    const std::vector<double> depth = depths(faces, inside, reach);
    const std::vector<uint8_t> stays = staying(faces, inside, depth, reach);

    std::vector<int32_t> number(faces.count(), -1);
    for (size_t f = 0; f < faces.count(); ++f) {
        if (stays[f]) continue;
        number[f] = static_cast<int32_t>(band.faces.size());
        band.faces.push_back(static_cast<int32_t>(f));
    }
    band.to_part.assign(band.faces.size(), 0);
    band.to_rest.assign(band.faces.size(), 0);
    for (size_t n = 0; n < band.faces.size(); ++n) {
        const size_t f = idx(band.faces[n]);
        for (const Creases::Neighbor& edge : faces.around(f)) {
            const size_t g = idx(edge.face);
            if (number[g] >= 0 && g < f) continue;  // added from the other side
            const bool at_border = !inside[f] != !inside[g];
            const double away = at_border ? 0 : std::min((depth[f] + depth[g]) / 2 / reach, 1.0);
            const int64_t cost = quantize_cost((1 + pull * away) * faces.cost(f, edge) / reach);
            if (number[g] >= 0)
                band.edges.push_back({static_cast<int32_t>(n), number[g], cost});
            else
                (inside[g] ? band.to_part : band.to_rest)[n] += cost;
        }
    }
    return band;
}

void snapped_border(const Creases& creases, std::span<const uint8_t> inside, std::span<uint8_t> result) {
    const BorderBand band = border_band(creases, inside);
    const std::vector<uint8_t> side = minimum_cut(band);
    std::transform(inside.begin(), inside.end(), result.begin(), [](uint8_t in) { return in ? 1 : 0; });
    for (size_t n = 0; n < band.faces.size(); ++n) result[idx(band.faces[n])] = side[n];
}

}  // namespace partwheel
