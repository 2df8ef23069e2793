// Finds parts on a proxy, where noise and points inside can't mislead, and transfers them to the solid.
//
// Noise makes every edge a crease and every part less convex; points inside make clusters that end raggedly or lie
// behind others. So the parts of a rough surface, or of one that was filled with points inside, are found on a proxy:
// the same triangles, smoothed, filled without such points. Each tetrahedron of the solid takes the part of the
// triangles in front of it, or of the nearest ones. Below the parts, the solid's own tetrahedra are clustered as in the
// paper.
#pragma once

#include "fill/fill_solid.h"
#include "parts/merge/merge_policy.h"

namespace partwheel {

// The proxy; nothing if the solid needs none, or it can't be made. points_inside: whether the solid has points inside.
std::optional<TetMesh> fill_proxy(const Solid& solid, bool points_inside, Progress& progress);

// The merge tree of the solid with the parts of the proxy as nodes, except parts without a surface. threads: as
// cluster() takes it.
ScoredTree transfer_parts(const TetMesh& proxy, const ScoredTree& parts, const Solid& solid, Progress& progress, size_t threads);

}  // namespace partwheel
