// A caller's mesh as packed doubles and int32.
#pragma once

#include "mesh/surface.h"

struct pw_mesh_view;

namespace partwheel {

// Reads the caller's own arrays where they are packed doubles and int32; copies any other layout.
class MeshInput {
public:
    // Throws Error(PW_ERROR_ARGUMENT) for null arrays, counts, strides and types that pw_mesh_view doesn't allow, and
    // Error(PW_ERROR_INDEX) for an index that does not fit into int32.
    explicit MeshInput(const pw_mesh_view& mesh);
    MeshInput(const MeshInput&) = delete;
    MeshInput& operator=(const MeshInput&) = delete;

    const MeshView& view() const { return view_; }
    operator const MeshView&() const { return view_; }

private:
    std::vector<Point> vertices_;  // copies; empty where the caller's array is read
    std::vector<Triangle> triangles_;
    std::vector<int32_t> faces_;
    MeshView view_;
};

// Throws Error(PW_ERROR_ARGUMENT) if count exceeds PW_MAX_COUNT.
void require_countable(size_t count, const char* name);

}  // namespace partwheel
