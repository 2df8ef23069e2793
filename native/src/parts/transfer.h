// Parts carried over: found where noise and points inside can't mislead, and given to the solid as it is.
//
// What people take for a part is a matter of its shape. Noise makes every edge a crease and every part less convex;
// points inside make clusters that end raggedly or lie behind others. So the parts of a rough surface, or of one that
// was filled with points inside, are found in another filling of the same triangles: smooth, and without such points.
// Each tetrahedron of the solid goes with the part of the triangles that it lies behind, or else is nearest to. Below
// the parts the clusters are the paper's, of the tetrahedra that there are.
#pragma once

#include "fill/fill_solid.h"
#include "parts/merge/merge_policy.h"

#include <optional>

namespace partwheel {

// The surface's triangles smooth and filled without points inside; nothing if the solid is that as it is, or it can't
// be made. points_inside: whether they were asked for.
std::optional<TetMesh> fill_proxy(const Solid& solid, bool points_inside, Progress& progress);

// The tree of the solid with the parts of plain, a filling of the same triangles; of parts without a surface none.
// threads: as cluster() takes it.
ScoredTree transfer_parts(const TetMesh& plain, const ScoredTree& parts, const Solid& solid, Progress& progress, size_t threads);

}  // namespace partwheel
