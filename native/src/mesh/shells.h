// The shells of a mesh: connected components after welding coincident border edges.
//
// An assembly is a mesh of several shells: a body, hair, a belt, a sword. Importers split the vertices of a shell at UV
// seams and hard edges, so its border edges are welded where they coincide. Closed shells that only touch stay apart.
#pragma once

#include "base/adjacency.h"
#include "mesh/surface.h"

namespace partwheel {

struct Shells {
    std::vector<int32_t> of_triangle;  // the shell of each triangle, 0 to count - 1
    std::vector<int32_t> vertex;       // of each vertex, the lowest one that it is welded with; the mesh's own if none are
    size_t count = 0;
    bool is_welded = false;            // whether any vertices are
};

// The shells in an order that depends on positions, not on the order of vertices or triangles. Triangles of one source
// face are in one shell. Border edges are welded if their ends have the same coordinates. O(n log n).
Shells find_shells(const MeshView& mesh);

// for_each_edge() of the welded triangles: side 3 t + k goes from corner k of triangle t to the next.
template <class Visit>
void for_each_welded_edge(const MeshView& mesh, const Shells& shells, const Visit& visit) {
    const auto ends = [&](size_t side) {
        const Triangle& t = mesh.triangles[side / 3];
        return std::pair(shells.vertex[idx(t[side % 3])], shells.vertex[idx(t[(side + 1) % 3])]);
    };
    for_each_edge(mesh.vertices.size(), 3 * mesh.triangles.size(), ends, visit);
}

// The same shells with some joined: of a shell, joined[s] is the shell that it joins, or -1.
Shells join_shells(const MeshView& mesh, const Shells& shells, std::span<const int32_t> joined);

}  // namespace partwheel
