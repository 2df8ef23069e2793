// A coarse copy of the solid, on which the search is quick whatever the model's size.
#pragma once

#include "base/geometry.h"

#include <cstddef>
#include <span>
#include <vector>

namespace partwheel::convex {

// For each point the one that stands for it: one of each occupied cell of a grid, about `wanted` of them in all.
std::vector<int32_t> representatives(std::span<const Point> points, size_t wanted);

// Tetrahedra between representatives, each once. Of those that have become flat, the ones that are no facet or edge of
// another stay, with a corner repeated: thin parts of the solid are still there.
std::vector<Tetrahedron> coarse(std::span<const Tetrahedron> tetrahedra, std::span<const int32_t> representative);

}  // namespace partwheel::convex
