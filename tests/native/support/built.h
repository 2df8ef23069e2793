// Hierarchies built through the C API, and what holds of their trees and queries.
#pragma once

#include "partwheel_edit.h"
#include "support/mesh_view.h"
#include "support/shapes.h"

#include <memory>
#include <string>
#include <vector>

namespace partwheel::test {

struct FreeHierarchy {
    void operator()(pw_hierarchy* hierarchy) const { pw_hierarchy_free(hierarchy); }
};
using Handle = std::unique_ptr<pw_hierarchy, FreeHierarchy>;

struct Built {
    pw_status status = PW_OK;
    std::string message;  // of the failure
    Handle handle;        // null on failure
};

Built try_build(const TriMesh& mesh, double quality = 0, pw_context* context = nullptr,
                uint32_t fill_methods = PW_FILL_EXACT, int32_t mode = PW_MODE_LEARNED);

inline constexpr pw_mode all_modes[] = {PW_MODE_LEARNED, PW_MODE_PAPER};
inline const char* mode_name(pw_mode mode) {
    return mode == PW_MODE_PAPER ? "paper" : "learned";
}

// By the exact fill method. Throws with the library's message if it can't be built.
Handle build(const TriMesh& mesh, double quality = 0, int32_t mode = PW_MODE_LEARNED);

pw_arrays arrays(const Handle& handle);
pw_summary summary(const Handle& handle);
std::vector<uint8_t> save(const Handle& handle);
Built try_load(const std::vector<uint8_t>& bytes);
std::vector<int32_t> path(const Handle& handle, size_t face);

struct Wheel {
    std::vector<int32_t> stops;
    size_t start = 0;
};
Wheel wheel(const Handle& handle, size_t face, double view = 0);

struct HullMesh {
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;
};
HullMesh hull(const Handle& handle, size_t tet_first, size_t tet_last);

// The invariants of any hierarchy, also one loaded from forged bytes: the tree, and the queries.
void expect_structure(const Handle& handle);

}  // namespace partwheel::test
