// Meshes as the C API takes them.
#pragma once

#include "partwheel.h"

#include <cstddef>
#include <cstdint>

namespace partwheel::test {

// Of packed doubles and int32. Without faces every triangle is one.
inline pw_mesh_view mesh_view(const double* vertices, size_t vertex_count, const int32_t* triangles,
                              size_t triangle_count, const int32_t* faces = nullptr, size_t face_count = 0) {
    pw_mesh_view mesh = PW_MESH_VIEW_INIT;
    mesh.vertices = vertices;
    mesh.vertex_count = vertex_count;
    mesh.triangles = triangles;
    mesh.triangle_count = triangle_count;
    mesh.faces = faces;
    mesh.face_count = face_count;
    return mesh;
}

// Of anything with vertices, triangles and faces; empty arrays are null.
template <class Mesh>
pw_mesh_view mesh_view(const Mesh& mesh) {
    return mesh_view(mesh.vertices.empty() ? nullptr : mesh.vertices.data()->data(), mesh.vertices.size(),
                     mesh.triangles.empty() ? nullptr : mesh.triangles.data()->data(), mesh.triangles.size(),
                     mesh.faces.empty() ? nullptr : mesh.faces.data(), mesh.face_count);
}

}  // namespace partwheel::test
