// Sets as sorted arrays.
#pragma once

#include "base/geometry.h"

namespace partwheel {

template <class T>
void sort_unique(std::vector<T>& items) {
    std::sort(items.begin(), items.end());
    items.erase(std::unique(items.begin(), items.end()), items.end());
}

// The vertices of some tetrahedra, ascending.
inline std::vector<int32_t> corner_vertices(std::span<const Tetrahedron> tetrahedra) {
    std::vector<int32_t> vertices;
    for (const Tetrahedron& t : tetrahedra) vertices.insert(vertices.end(), t.begin(), t.end());
    sort_unique(vertices);
    return vertices;
}

}  // namespace partwheel
