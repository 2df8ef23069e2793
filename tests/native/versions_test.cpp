// Programs compiled with an older or newer header than the library: structs that are shorter or longer.
#include "support/built.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>

namespace partwheel::test {
namespace {

// As in an older header: without the last members.
struct OlderOptions {
    size_t struct_size;
    double quality;
    uint32_t fill_methods;
    int32_t refuse_sheets;
};
struct OlderSummary {
    size_t struct_size, components, cavities, added_vertices;
    double volume;
};
struct OlderArrays {
    size_t struct_size, face_count, node_count, tetrahedron_count, vertex_count;
    const int32_t *order, *leaf;
};

// As in a newer one.
struct NewerOptions {
    pw_build_options known;
    double finer;
    int32_t deeper, wider;
};
template <class Struct>
struct Newer {
    Struct known{};
    double more[3] = {1, 2, 3};
    Newer() { known.struct_size = sizeof(Newer); }
};

constexpr unsigned char untouched = 0xab;

// A struct between guard bytes.
template <class Struct>
class Fenced {
public:
    Fenced() {
        std::fill(std::begin(bytes_), std::end(bytes_), untouched);
        it = new (bytes_ + fence) Struct{};
        it->struct_size = sizeof(Struct);
    }
    bool intact() const {
        const auto is = [](unsigned char byte) { return byte == untouched; };
        return std::all_of(bytes_, bytes_ + fence, is) && std::all_of(std::end(bytes_) - fence, std::end(bytes_), is);
    }
    Struct* it;

private:
    static constexpr size_t fence = 256;
    alignas(Struct) unsigned char bytes_[fence + sizeof(Struct) + fence];
};

pw_status build_with(const TriMesh& mesh, const void* options, Handle& handle) {
    pw_hierarchy* made = nullptr;
    const pw_mesh_view view = mesh_view(mesh);
    const pw_status status = pw_build(nullptr, &view, static_cast<const pw_build_options*>(options), &made);
    handle.reset(made);
    return status;
}

TEST(Versions, OlderOptionsGetDefaultsForNewFields) {
    const TriMesh mesh = snowman(12, 12);
    // The bytes behind the struct are not read: mode 7 there would be refused.
    struct {
        OlderOptions options{sizeof(OlderOptions), 1.4, PW_FILL_EXACT, 0};
        int32_t threads = -5, mode = 7;
    } older;
    Handle by_older, by_own, by_default;
    ASSERT_EQ(build_with(mesh, &older.options, by_older), PW_OK) << pw_error_message();
    pw_build_options own = PW_BUILD_OPTIONS_INIT;
    own.quality = 1.4;
    own.fill_methods = PW_FILL_EXACT;
    ASSERT_EQ(build_with(mesh, &own, by_own), PW_OK);
    EXPECT_EQ(save(by_older), save(by_own));
    ASSERT_EQ(build_with(mesh, nullptr, by_default), PW_OK);
    EXPECT_NE(save(by_older), save(by_default)) << "what they do know is heard";
    const size_t nothing_but_its_size = sizeof(size_t);
    ASSERT_EQ(build_with(mesh, &nothing_but_its_size, by_older), PW_OK) << pw_error_message();
    EXPECT_EQ(save(by_older), save(by_default));
}

TEST(Versions, UnknownFieldsOfNewerOptionsAreIgnored) {
    const TriMesh mesh = cube();
    Handle handle;
    NewerOptions newer{PW_BUILD_OPTIONS_INIT, 0, 0, 0};
    newer.known.struct_size = sizeof newer;
    newer.known.mode = PW_MODE_PAPER;
    EXPECT_EQ(build_with(mesh, &newer, handle), PW_OK) << pw_error_message();
    newer.wider = 1;  // the very last
    EXPECT_EQ(build_with(mesh, &newer, handle), PW_ERROR_ARGUMENT);
    EXPECT_NE(std::string(pw_error_message()).find("later version"), std::string::npos) << pw_error_message();
    newer.wider = 0;
    newer.finer = 1e-300;
    EXPECT_EQ(build_with(mesh, &newer, handle), PW_ERROR_ARGUMENT);
    EXPECT_EQ(handle, nullptr);
}

TEST(Versions, OlderResultsAreFilledUpToTheirSize) {
    const Handle handle = build(snowman(12, 12));
    Fenced<OlderSummary> s;
    ASSERT_EQ(pw_hierarchy_summary(handle.get(), reinterpret_cast<pw_summary*>(s.it)), PW_OK) << pw_error_message();
    const pw_summary own = summary(handle);
    EXPECT_TRUE(s.intact());
    EXPECT_EQ(s.it->struct_size, sizeof(OlderSummary));
    EXPECT_EQ(s.it->components, own.components);
    EXPECT_EQ(s.it->volume, own.volume);
    Fenced<OlderArrays> a;
    ASSERT_EQ(pw_hierarchy_arrays(handle.get(), reinterpret_cast<pw_arrays*>(a.it)), PW_OK) << pw_error_message();
    EXPECT_TRUE(a.intact());
    EXPECT_EQ(a.it->struct_size, sizeof(OlderArrays));
    EXPECT_EQ(a.it->vertex_count, arrays(handle).vertex_count);
    EXPECT_EQ(a.it->leaf, arrays(handle).leaf);
}

TEST(Versions, UnknownFieldsOfNewerResultsAreZero) {
    const Handle handle = build(cube());
    const auto expect_zeros = [](const auto& newer) {
        for (const double each : newer.more) EXPECT_EQ(each, 0);
    };
    Newer<pw_summary> s;
    ASSERT_EQ(pw_hierarchy_summary(handle.get(), &s.known), PW_OK) << pw_error_message();
    EXPECT_EQ(s.known.struct_size, sizeof s);
    EXPECT_EQ(s.known.volume, summary(handle).volume);
    expect_zeros(s);
    Newer<pw_arrays> a;
    ASSERT_EQ(pw_hierarchy_arrays(handle.get(), &a.known), PW_OK) << pw_error_message();
    EXPECT_EQ(a.known.score, arrays(handle).score);
    expect_zeros(a);
}

// Of an uninitialized struct.
TEST(Versions, InvalidStructSizesAreRefused) {
    const TriMesh mesh = cube();
    const Handle handle = build(mesh);
    for (const size_t size : {size_t{0}, size_t{1}, sizeof(size_t) - 1, sizeof(pw_build_options) - 1,
                              sizeof(pw_build_options) + 1, size_t{1} << 20, std::numeric_limits<size_t>::max() - 7,
                              std::numeric_limits<size_t>::max()}) {
        Handle made;
        pw_build_options options = PW_BUILD_OPTIONS_INIT;
        options.struct_size = size;
        EXPECT_EQ(build_with(mesh, &options, made), PW_ERROR_ARGUMENT) << size;
        EXPECT_NE(std::string(pw_error_message()).find("struct_size"), std::string::npos) << pw_error_message();
        pw_summary s{};
        s.struct_size = size;
        EXPECT_EQ(pw_hierarchy_summary(handle.get(), &s), PW_ERROR_ARGUMENT) << size;
        EXPECT_EQ(s.volume, 0);
        pw_arrays a{};
        a.struct_size = size;
        EXPECT_EQ(pw_hierarchy_arrays(handle.get(), &a), PW_ERROR_ARGUMENT) << size;
        EXPECT_EQ(a.order, nullptr);
    }
}

}  // namespace
}  // namespace partwheel::test
