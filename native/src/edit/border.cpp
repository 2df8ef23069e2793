// Face adjacency with crease costs, the band around a border, and its minimum cut.
#include "edit/border.h"

#include "base/corners.h"
#include "base/error.h"
#include "mesh/crease.h"

namespace partwheel {

namespace {

// Width of the band on both sides, times the square root of the smaller side's area: about the radius of a finger, a
// cylinder three times as long as it is thick.
constexpr double band_reach = 0.2;
// The largest number of faces in the band, nearest to the border: a larger flow is too slow for interaction.
constexpr size_t max_band_faces = 12000;
// Edges at the rim of the band cost this share more than at the border: of two similar creases the nearer one wins,
// and without a crease the border stays.
constexpr double pull = 0.5;
// Relative tolerance of depths.
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
    // The frame of the vertices in use: unused ones must not affect rounding.
    const std::vector<int32_t> used = in_order_of_use(mesh.vertices.size(), mesh.triangles);
    const Frame frame = Frame::around(points_at(mesh.vertices, used));
    own_points_.assign(mesh.vertices.size(), Point{});
    points_ = own_points_;
    if (frame.scale > 0)  // else no face gets an area, and the band is empty
        for (const int32_t v : used) own_points_[idx(v)] = frame.to_working(mesh.vertices[idx(v)]);
    progress.reach(0.2);
    compute_face_geometry(mesh);
    progress.reach(0.3);
    build_adjacency(mesh, progress);
}

Creases::Creases(const Creases& whole, std::span<const int32_t> part)
    : points_(whole.points_), is_inside_out_(whole.is_inside_out_) {
    double part_area = 0;
    for (const int32_t f : part) part_area += whole.area(idx(f));
    outside_area_ = std::accumulate(whole.area_.begin(), whole.area_.end(), 0.0);
    const double reach = 1.5 * band_reach * std::sqrt(std::max(std::min(part_area, outside_area_ - part_area), 0.0));
    // Goes 1.5 times as far as the band reaches, so that the faces beyond the band are connected.
    std::vector<double> depth(whole.count(), infinite);
    std::vector<int32_t> number(whole.count(), -1);
    for (const int32_t f : part) depth[idx(f)] = 0;
    find_shortest_paths(depth, part, [&](int32_t face, double path_length, const auto& relax) {
        if (number[idx(face)] < 0) number[idx(face)] = 0, whole_faces_.push_back(face);
        if (path_length > reach) return true;
        for (const Neighbor& edge : whole.neighbors(idx(face))) {
            if (depth[idx(edge.face)] <= path_length) continue;
            const double step = path_length > 0 ? whole.center_to_edge(idx(face), edge) : 0;  // the band starts at the border
            relax(edge.face, path_length + step + whole.center_to_edge(idx(edge.face), edge));
        }
        return true;
    });
    std::ranges::sort(whole_faces_);
    for (const int32_t f : whole_faces_) {
        number[idx(f)] = static_cast<int32_t>(count());
        center_.push_back(whole.center_[idx(f)]), normal_.push_back(whole.normal_[idx(f)]), area_.push_back(whole.area(idx(f)));
        outside_area_ -= area_.back();
    }
    neighbors_ = CsrArray<Neighbor>(count(), [&](const auto& put) {
        for (size_t i = 0; i < count(); ++i)
            for (const auto& [face, begin, end, is_inconsistent] : whole.neighbors(idx(whole_faces_[i])))
                if (number[idx(face)] >= 0) put(i, Neighbor{number[idx(face)], begin, end, is_inconsistent});
    });
    list_neighbor_faces();
}

double Creases::center_to_edge(size_t face, const Neighbor& edge) const {
    return length(0.5 * (points_[idx(edge.begin)] + points_[idx(edge.end)]) - center_[face]);
}

double Creases::cost(size_t face, const Neighbor& edge) const {
    const Point along = points_[idx(edge.end)] - points_[idx(edge.begin)];
    const Point &n = normal_[face], &m = normal_[idx(edge.face)];
    const double turn = dot(cross(n, m), along);
    // The dihedral angle is undefined at inconsistent and non-manifold edges and at degenerate faces.
    if (edge.is_inconsistent || turn == 0 || dot(n, n) == 0 || dot(m, m) == 0) return length(along);
    return length(along) * crease_weight(n, m, (turn > 0) != is_inside_out_);
}

void Creases::compute_face_geometry(const MeshView& mesh) {
    std::vector<int32_t> triangles(count(), 0);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const size_t face = face_of(mesh, t);
        const auto [i, j, k] = mesh.triangles[t];
        const Point &a = points_[idx(i)], &b = points_[idx(j)], &c = points_[idx(k)];
        const Point normal2 = cross(b - a, c - a);
        normal_[face] = normal_[face] + normal2;
        area_[face] += length(normal2) / 2;
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

void Creases::build_adjacency(const MeshView& mesh, Progress& progress) {
    struct Pair {
        int32_t face_a, face_b;
        Neighbor edge;  // from the first face
    };
    std::vector<Pair> pairs;
    pairs.reserve(3 * mesh.triangles.size() / 2);
    bool is_closed = true;
    for_each_edge(mesh.vertices.size(), mesh.triangles, [&](int32_t low, std::span<const Side> sides) {
        if (low % 4096 == 0) progress.reach(0.3 + 0.4 * low / static_cast<double>(mesh.vertices.size()));
        const bool is_manifold = sides.size() == 2 && sides[0].is_ascending != sides[1].is_ascending;
        is_closed = is_closed && is_manifold;
        for (size_t i = 0; i + 1 < sides.size(); ++i) {  // of more than two, each with the next
            const Side& side = sides[i];
            const auto face_a = static_cast<int32_t>(face_of(mesh, idx(side.number) / 3));
            const auto face_b = static_cast<int32_t>(face_of(mesh, idx(sides[i + 1].number) / 3));
            const auto [begin, end] = side.is_ascending ? std::pair(low, side.high) : std::pair(side.high, low);
            if (face_a != face_b) pairs.push_back({face_a, face_b, {face_b, begin, end, !is_manifold}});
        }
    });
    is_inside_out_ = is_closed && volume_ < 0;
    progress.reach(0.7);

    neighbors_ = CsrArray<Neighbor>(count(), [&](const auto& put) {
        for (const auto& [face_a, face_b, edge] : pairs) {
            put(idx(face_a), edge);
            put(idx(face_b), Neighbor{face_a, edge.end, edge.begin, edge.is_inconsistent});
        }
    });
    list_neighbor_faces();
}

void Creases::list_neighbor_faces() {
    neighbor_faces_ = CsrArray<int32_t>(count(), [&](const auto& put) {
        for (size_t f = 0; f < count(); ++f)
            for (const Neighbor& edge : neighbors(f)) put(f, edge.face);
    });
}

namespace {

// The depth of each face: length of the shortest path from the border on its own side, through centers of faces and
// edges; infinity beyond reach, which is reduced if more than max_band_faces are within it. (surface_distances()
// covers the whole surface: too slow here.)
std::vector<double> compute_depths(const Creases& faces, std::span<const uint8_t> inside, double& reach) {
    std::vector<double> depth(faces.count(), infinite);
    std::vector<int32_t> border;
    for (size_t f = 0; f < faces.count(); ++f) {
        const auto across = [&](int32_t other) { return !inside[f] != !inside[idx(other)]; };
        if (std::ranges::none_of(faces.neighbor_faces(f), across)) continue;
        for (const Creases::Neighbor& edge : faces.neighbors(f))
            if (across(edge.face)) depth[f] = std::min(depth[f], faces.center_to_edge(f, edge));
        border.push_back(static_cast<int32_t>(f));
    }
    find_band(reach, max_band_faces, depth, border, [&](int32_t face, double path_length, const auto& relax) {
        for (const Creases::Neighbor& edge : faces.neighbors(idx(face)))
            if (!inside[idx(face)] == !inside[idx(edge.face)])
                relax(edge.face, path_length + faces.center_to_edge(idx(face), edge) + faces.center_to_edge(idx(edge.face), edge));
    });
    return depth;
}

// The faces beyond the band; of a connected component (of the part, or of the rest) that lies within the band, the
// deeper half.
std::vector<uint8_t> find_deep_faces(const Creases& faces, std::span<const uint8_t> inside, std::span<const double> depth,
                                     double reach) {
    std::vector<uint8_t> is_deep(faces.count(), 0), is_visited(faces.count(), 0);
    std::vector<int32_t> component;  // of the band
    for (int32_t start = 0; idx(start) < faces.count(); ++start) {
        if (depth[idx(start)] == infinite) {
            is_deep[idx(start)] = 1;
            continue;
        }
        if (is_visited[idx(start)]) continue;
        component.assign(1, start);
        is_visited[idx(start)] = 1;
        double deepest = 0;
        for (size_t i = 0; i < component.size(); ++i) {
            deepest = std::max(deepest, depth[idx(component[i])]);
            for (const int32_t next : faces.neighbor_faces(idx(component[i]))) {
                if (!inside[idx(next)] != !inside[idx(start)]) continue;
                if (depth[idx(next)] == infinite) deepest = infinite;
                else if (!is_visited[idx(next)]) is_visited[idx(next)] = 1, component.push_back(next);
            }
        }
        const double min_depth = std::min(reach, deepest / 2) * (1 - same_depth);
        for (const int32_t f : component)
            if (depth[idx(f)] >= min_depth) is_deep[idx(f)] = 1;
    }
    return is_deep;
}

// The faces that stay on their side: the deep ones, and the deepest paths that connect them within their component, by
// Prim's algorithm for a maximum spanning tree.
std::vector<uint8_t> find_staying_faces(const Creases& faces, std::span<const uint8_t> inside,
                                        std::span<const double> depth, double reach) {
    std::vector<uint8_t> stays = find_deep_faces(faces, inside, depth, reach);
    const auto side = [&](int32_t face) { return inside[idx(face)] ? size_t{1} : size_t{0}; };
    size_t unconnected[2] = {0, 0};  // staying faces of the rest and of the part
    for (int32_t face = 0; idx(face) < faces.count(); ++face) unconnected[side(face)] += stays[idx(face)];
    std::vector<int32_t> predecessor(faces.count(), -1), stack;
    for (int32_t start = 0; idx(start) < faces.count(); ++start) {
        size_t& left = unconnected[side(start)];
        if (!stays[idx(start)] || predecessor[idx(start)] >= 0 || left == 0) continue;
        std::priority_queue<std::pair<double, int32_t>> candidates;
        stack.assign(1, start);
        predecessor[idx(start)] = start;
        --left;
        while (left > 0) {
            int32_t face;
            if (!stack.empty()) {
                face = stack.back();
                stack.pop_back();
            } else if (!candidates.empty()) {
                face = candidates.top().second;
                candidates.pop();
            } else {
                break;
            }
            for (const int32_t next : faces.neighbor_faces(idx(face))) {
                if (predecessor[idx(next)] >= 0 || side(next) != side(start)) continue;
                predecessor[idx(next)] = face;
                if (!stays[idx(next)]) {
                    candidates.push({depth[idx(next)], next});
                    continue;
                }
                stack.push_back(next);
                --left;
                for (int32_t step = face; !stays[idx(step)]; step = predecessor[idx(step)]) stays[idx(step)] = 1;
            }
        }
    }
    return stays;
}

}  // namespace

BorderBand build_border_band(const Creases& faces, std::span<const uint8_t> inside) {
    if (std::none_of(inside.begin(), inside.end(), [](uint8_t in) { return in != 0; }))
        throw Error(PW_ERROR_EMPTY, "The part has no faces. Pick another one.");
    double part = 0, rest = faces.outside_area();
    for (size_t f = 0; f < faces.count(); ++f) (inside[f] ? part : rest) += faces.area(f);
    double reach = band_reach * std::sqrt(std::min(part, rest));
    BorderBand band;
    if (!(reach > 0)) return band;
    const std::vector<double> depth = compute_depths(faces, inside, reach);
    const std::vector<uint8_t> stays = find_staying_faces(faces, inside, depth, reach);

    std::vector<int32_t> number(faces.count(), -1);
    for (size_t f = 0; f < faces.count(); ++f) {
        if (stays[f]) continue;
        number[f] = static_cast<int32_t>(band.faces.size());
        band.faces.push_back(static_cast<int32_t>(f));
    }
    band.set_node_count(band.faces.size());
    for (size_t n = 0; n < band.faces.size(); ++n) {
        const size_t f = idx(band.faces[n]);
        for (const Creases::Neighbor& edge : faces.neighbors(f)) {
            const size_t g = idx(edge.face);
            if (number[g] >= 0 && g < f) continue;  // added from the other side
            const bool at_border = !inside[f] != !inside[g];
            const double relative_depth = at_border ? 0 : std::min((depth[f] + depth[g]) / 2 / reach, 1.0);
            const double cost = (1 + pull * relative_depth) * faces.cost(f, edge) / reach;
            band.add_edge(n, number[g], inside[g] != 0, quantize_cost(cost));
        }
    }
    return band;
}

void snap_border(const Creases& creases, std::span<const uint8_t> inside, std::span<uint8_t> result) {
    const BorderBand band = build_border_band(creases, inside);
    const std::vector<uint8_t> side = minimum_cut(band);
    std::transform(inside.begin(), inside.end(), result.begin(), [](uint8_t in) { return in ? 1 : 0; });
    for (size_t n = 0; n < band.faces.size(); ++n) result[idx(band.faces[n])] = side[n];
}

}  // namespace partwheel
