// Fuzzer of pw_hierarchy_load(): any bytes are refused, or every question about what was loaded has an answer that the
// header documents. The hash at the end of the bytes is not compared (see cmake/fuzzers.cmake), so forged ones get in.
#include "support/built.h"

#include <gtest/gtest.h>

#include <limits>

using namespace partwheel::test;

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    GTEST_FLAG_SET(throw_on_failure, true);  // out of the fuzzer: a crash for libFuzzer
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const Built loaded = try_load({data, data + size});
    if (loaded.status != PW_OK) {
        EXPECT_EQ(loaded.status, PW_ERROR_DATA) << loaded.message;
        EXPECT_TRUE(loaded.message.ends_with('.')) << loaded.message;
        return 0;
    }
    const pw_arrays a = arrays(loaded.handle);
    const pw_summary s = summary(loaded.handle);
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_LT(a.volume[a.node_count - 1], infinity);
    EXPECT_LT(a.area[a.node_count - 1], infinity);
    EXPECT_TRUE(s.rung == PW_RUNG_EXACT || s.rung == PW_RUNG_REPAIRED || s.rung == PW_RUNG_WRAPPED);
    expect_structure(loaded.handle);
    for (size_t t = 0; t < a.tetrahedron_count; t += 1 + a.tetrahedron_count / 20) {
        const HullMesh part = hull(loaded.handle, t, t + 1), rest = hull(loaded.handle, t, a.tetrahedron_count);
        EXPECT_GE(rest.vertices.size(), part.vertices.empty() ? 0U : 1U);
        pw_mesh* solid = nullptr;
        const pw_status status = pw_hierarchy_solid(loaded.handle.get(), t, a.tetrahedron_count, nullptr, 0, &solid);
        EXPECT_TRUE(status == PW_OK || status == PW_ERROR_DATA || status == PW_ERROR_EMPTY) << pw_error_message();
        pw_mesh_free(solid);
    }
    // What is saved loads, and is saved as the same again. (These bytes may have said it at greater length.)
    const std::vector<uint8_t> saved = save(loaded.handle);
    const Built again = try_load(saved);
    EXPECT_EQ(again.status, PW_OK) << again.message;
    EXPECT_EQ(save(again.handle), saved);
    return 0;
}
