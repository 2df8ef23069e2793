// Which shells of an assembly touch or are near each other, and a tree that joins them.
#pragma once

#include "base/geometry.h"
#include "base/progress.h"

namespace partwheel {

// Joins of n shells, bottom up: join j makes number n + j of two earlier numbers; the last join makes the whole.
using ShellJoins = std::vector<std::array<int32_t, 2>>;

// Shells with a vertex in the same place are joined first, since Blender's merge by distance makes them one. Then, as
// within these, the smallest group of shells is joined with the group that it has most contact with for its area, until
// one is left: so strands of hair form hair before they join the head, and a buckle the belt before the body. Contact
// is measured on grids: the cells that both occupy, at sizes from 1/128 of the diagonal up, finer ones counting more.
// No union is computed, so shells may intersect, touch, contain or duplicate each other. of_triangle: the shell of each
// triangle. O(n log^2 n).
ShellJoins join_by_contact(std::span<const Point> vertices, std::span<const Triangle> triangles,
                           std::span<const int32_t> of_triangle, size_t shell_count, Progress& progress);

// The share of the border edges' length that is near a border edge of another shell: within about `border_tolerance` of
// the diagonal. Of the patches of one surface it is nearly 1, of separate sheets such as leaves nearly 0. O(n log n).
inline constexpr double border_tolerance = 1.0 / 400;
double matched_border_share(std::span<const Point> vertices, std::span<const Triangle> triangles,
                            std::span<const int32_t> of_triangle);

}  // namespace partwheel
