// The shells of an assembly, their copies and double walls.
#include "prepare/divide.h"

#include "base/adjacency.h"
#include "mesh/duplicates.h"
#include "prepare/double_walls.h"

namespace partwheel {

namespace {

// Limit of the copies of a face that are compared, the lowest ones first.
constexpr size_t max_copies = 8;

// A group of fewer triangles is not examined for double walls.
constexpr size_t min_double_wall_triangles = 24;

class AssemblyDivider {
public:
    AssemblyDivider(const MeshView& mesh, const Shells& shells)
        : mesh_(mesh), shells_(shells), left_out_(mesh.triangles.size(), false) {
        result_.original = iota(mesh.face_count);
    }

    Assembly divide(std::span<const int32_t> inner_walls) {
        leave_out_inner_walls(inner_walls);
        if (shells_.count > 1) leave_out_duplicates();
        split();
        return std::move(result_);
    }

private:
    int32_t face_of(size_t triangle) const {
        return mesh_.faces.empty() ? static_cast<int32_t>(triangle) : mesh_.faces[triangle];
    }

    // Faces whose triangles all belong to an inner wall go with the outer wall.
    void leave_out_inner_walls(std::span<const int32_t> inner_walls) {
        if (inner_walls.empty()) return;
        std::vector<int32_t>& original = result_.original;
        std::vector<bool> is_outer(mesh_.face_count, false);
        for (size_t t = 0; t < inner_walls.size(); ++t)
            if (inner_walls[t] < 0) is_outer[idx(face_of(t))] = true;
        for (size_t t = 0; t < inner_walls.size(); ++t) {
            const int32_t face = face_of(t);
            if (is_outer[idx(face)]) continue;
            left_out_[t] = true;
            if (original[idx(face)] == face) result_.inner_faces.push_back(face);
            original[idx(face)] = face_of(idx(inner_walls[t]));
        }
    }

    // Shells that are copies of another one, or of faces of it: their faces go with the other's.
    void leave_out_duplicates() {
        const std::vector<int32_t> original = find_duplicates(read_mesh(mesh_));
        if (count_duplicates(original) == 0) return;
        std::vector<bool> left_out(shells_.count, false), is_copy(shells_.count, false);
        for (size_t t = 0; t < left_out_.size(); ++t)
            if (left_out_[t]) left_out[idx(shells_.of_triangle[t])] = true;  // not whole
        std::vector<int32_t> shell(mesh_.face_count);
        for (size_t t = 0; t < mesh_.triangles.size(); ++t) shell[idx(face_of(t))] = shells_.of_triangle[t];
        const auto by = [&](size_t keys, const std::vector<int32_t>& key) {
            return CsrArray<int32_t>(keys, [&](const auto& put) {
                for (size_t f = 0; f < key.size(); ++f) put(idx(key[f]), static_cast<int32_t>(f));
            });
        };
        const CsrArray<int32_t> equals = by(mesh_.face_count, original), faces = by(shells_.count, shell);
        for (size_t s = shells_.count; s-- > 0;) {
            std::vector<int32_t> others, common;  // shells that have a copy of each face so far
            for (const int32_t f : faces.row(s)) {
                const bool is_first = f == faces.row(s).front();
                std::vector<int32_t> of_face;
                for (const int32_t g : equals.row(idx(original[idx(f)]))) {
                    if (of_face.size() == max_copies) break;
                    if (const int32_t other = shell[idx(g)]; idx(other) != s && !left_out[idx(other)]) of_face.push_back(other);
                }
                std::ranges::sort(of_face);
                common.clear();
                std::ranges::set_intersection(is_first ? of_face : others, of_face, std::back_inserter(common));
                others.swap(common);
                if (others.empty()) break;
            }
            if (others.empty()) continue;
            left_out[s] = is_copy[s] = true;
            for (const int32_t f : faces.row(s)) {
                const auto is_of_other = [&](int32_t g) { return shell[idx(g)] == others.front(); };
                result_.original[idx(f)] = *std::ranges::find_if(equals.row(idx(original[idx(f)])), is_of_other);
                result_.duplicates.push_back(f);
            }
        }
        for (size_t t = 0; t < left_out_.size(); ++t)
            if (is_copy[idx(shells_.of_triangle[t])]) left_out_[t] = true;
    }

    void split() {
        std::vector<SubMesh>& parts = result_.shells;
        parts.resize(shells_.count);
        std::vector<int32_t> shell_of_vertex(mesh_.vertices.size(), -1), shell_of_face(mesh_.face_count, -1);
        for (size_t t = 0; t < mesh_.triangles.size(); ++t) {
            const int32_t shell = shells_.of_triangle[t];
            if (left_out_[t]) continue;
            shell_of_face[idx(face_of(t))] = shell;
            for (const int32_t v : mesh_.triangles[t]) shell_of_vertex[idx(shells_.vertex[idx(v)])] = shell;
        }
        for (size_t v = 0; v < shells_.vertex.size(); ++v) {
            const int32_t merged = shells_.vertex[v];
            const int32_t shell = shell_of_vertex[idx(merged)];
            if (merged != static_cast<int32_t>(v) && shell >= 0) ++parts[idx(shell)].welded;
        }
        const auto number = [&](std::span<const int32_t> shell, auto numbers) {
            std::vector<int32_t> local(shell.size(), -1);
            for (size_t i = 0; i < shell.size(); ++i) {
                if (shell[i] < 0) continue;
                std::vector<int32_t>& of_part = parts[idx(shell[i])].*numbers;
                local[i] = static_cast<int32_t>(of_part.size());
                of_part.push_back(static_cast<int32_t>(i));
            }
            return local;
        };
        const std::vector<int32_t> vertex = number(shell_of_vertex, &SubMesh::vertex_numbers);
        const std::vector<int32_t> face = number(shell_of_face, &SubMesh::face_numbers);
        for (SubMesh& part : parts)
            for (const int32_t v : part.vertex_numbers) part.vertices.push_back(mesh_.vertices[idx(v)]);
        for (size_t t = 0; t < mesh_.triangles.size(); ++t) {
            if (left_out_[t]) continue;
            SubMesh& part = parts[idx(shells_.of_triangle[t])];
            Triangle corners = mesh_.triangles[t];
            for (int32_t& v : corners) v = vertex[idx(shells_.vertex[idx(v)])];
            part.triangles.push_back(corners);
            part.faces.push_back(face[idx(face_of(t))]);
            part.area += area(part.vertices[idx(corners[0])], part.vertices[idx(corners[1])], part.vertices[idx(corners[2])]);
        }
        std::erase_if(parts, [](const SubMesh& part) { return part.triangles.empty(); });
    }

    const MeshView& mesh_;
    const Shells& shells_;
    std::vector<bool> left_out_;  // of each triangle: its face goes with another
    Assembly result_;
};

}  // namespace

void SubMesh::append(const SubMesh& other) {
    const auto vertex = static_cast<int32_t>(vertices.size()), face = static_cast<int32_t>(face_numbers.size());
    const auto add_all = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    add_all(vertices, other.vertices);
    add_all(vertex_numbers, other.vertex_numbers);
    add_all(face_numbers, other.face_numbers);
    for (const Triangle& t : other.triangles) triangles.push_back({t[0] + vertex, t[1] + vertex, t[2] + vertex});
    for (const int32_t f : other.faces) faces.push_back(f + face);
    area += other.area;
    welded += other.welded;
}

std::vector<int32_t> find_inner_walls(const MeshView& mesh, const Shells& shells, std::span<const int32_t> enclosing,
                                      Progress& progress) {
    std::vector<int32_t> outermost(shells.count), inner_walls;
    for (size_t s = 0; s < shells.count; ++s) {
        outermost[s] = static_cast<int32_t>(s);
        while (enclosing[idx(outermost[s])] >= 0) outermost[s] = enclosing[idx(outermost[s])];
    }
    const CsrArray<int32_t> groups(shells.count, [&](const auto& put) {
        for (size_t t = 0; t < mesh.triangles.size(); ++t)
            put(idx(outermost[idx(shells.of_triangle[t])]), static_cast<int32_t>(t));
    });
    std::vector<int32_t> number(mesh.vertices.size(), -1);  // of each vertex in its group
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;
    for (size_t s = 0; s < shells.count; ++s) {
        const std::span<const int32_t> group = groups.row(s);
        if (group.size() < min_double_wall_triangles) continue;
        vertices.clear();
        triangles.clear();
        for (const int32_t t : group) {
            Triangle corners = mesh.triangles[idx(t)];
            for (int32_t& v : corners) {
                int32_t& n = number[idx(shells.vertex[idx(v)])];
                if (n < 0) {
                    n = static_cast<int32_t>(vertices.size());
                    vertices.push_back(mesh.vertices[idx(v)]);
                }
                v = n;
            }
            triangles.push_back(corners);
        }
        const std::vector<int32_t> outer = find_double_wall(vertices, triangles, progress);
        if (outer.empty()) continue;
        inner_walls.resize(mesh.triangles.size(), -1);
        for (size_t i = 0; i < outer.size(); ++i)
            if (outer[i] >= 0) inner_walls[idx(group[i])] = group[idx(outer[i])];
    }
    return inner_walls;
}

Assembly divide_into_shells(const MeshView& mesh, const Shells& shells, std::span<const int32_t> inner_walls) {
    return AssemblyDivider(mesh, shells).divide(inner_walls);
}

}  // namespace partwheel
