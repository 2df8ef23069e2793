// The real models that the tests read: OFF files of the directory PARTWHEEL_MESHES.
#pragma once

#include "support/shapes.h"

namespace partwheel::test {

// A model by its file name. Polygons become fans of triangles with one source face. Throws if it can't be read.
TriMesh real_mesh(const std::string& file);

// All OFF files with at most this many faces, by name. Throws if there is no
// such directory.
std::vector<TriMesh> real_meshes(size_t most_faces);

}  // namespace partwheel::test
