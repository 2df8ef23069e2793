// The limits of int32_t indices.
#include "base/checked_index.h"

#include <gtest/gtest.h>

namespace partwheel::test {
namespace {

template <class Call>
void expect_too_many(const Call& call) {
    try {
        call();
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.status(), PW_ERROR_MEMORY);
        EXPECT_NE(std::string(error.what()).find("Decimate"), std::string::npos);
    }
}

TEST(CheckedIndex, AcceptsValuesUpToTheInt32Limit) {
    EXPECT_EQ(checked_index(0), 0);
    EXPECT_EQ(checked_index(2147483647), 2147483647);
    for (const size_t n : {size_t{2147483648}, size_t{4294967296}, ~size_t{0}}) expect_too_many([&] { (void)checked_index(n); });
}

// Four indices per tetrahedron plus a reserve stay below 2^31.
TEST(CheckedIndex, TetrahedronLimitIsTheDocumentedOne) {
    constexpr size_t most = 536870896;
    static_assert(most == (size_t{1} << 29) - 16 && 4 * most + 63 == 2147483647);
    EXPECT_NO_THROW(check_tetrahedron_count(most));
    expect_too_many([] { check_tetrahedron_count(most + 1); });
    expect_too_many([] { check_tetrahedron_count(2147483647); });  // the largest count of TetGen
}

}  // namespace
}  // namespace partwheel::test
