// Packing: lossless round trips of doubles, refusal of forged bytes.
#include "tree/packed.h"

#include "base/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <random>

using namespace partwheel;

namespace {

constexpr size_t hash_size = 8;

std::vector<uint8_t> packed(const std::vector<double>& numbers) {
    Packer out;
    out.put_doubles(numbers);
    return out.finish();
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
        return std::bit_cast<uint64_t>(x) == std::bit_cast<uint64_t>(y);
    });
}

template <class Function>
pw_status status_of(const Function& function) {
    try {
        function();
        return PW_OK;
    } catch (const Error& error) {
        return error.status();
    }
}

}  // namespace

TEST(Packed, DoublesRoundTrip) {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    const auto round_trip = [](const std::vector<double>& numbers, size_t bytes_each) {
        const std::vector<uint8_t> bytes = packed(numbers);
        Unpacker in(bytes);
        EXPECT_TRUE(same_bits(in.get_doubles(numbers.size()), numbers));
        EXPECT_TRUE(in.at_end());
        const auto zeros = static_cast<size_t>(std::count(numbers.begin(), numbers.end(), 0.0));
        EXPECT_EQ(bytes.size(), hash_size + (numbers.size() + 7) / 8 + 1 + (numbers.size() - zeros) * bytes_each);
    };
    for (const size_t count : {0U, 1U, 7U, 8U, 9U, 500U}) {
        std::vector<double> floats, doubles, sparse;
        for (size_t i = 0; i < count; ++i) {
            floats.push_back(static_cast<double>(static_cast<float>(normal(random))));
            doubles.push_back(normal(random));
            sparse.push_back(random() % 4 ? 0 : normal(random));
        }
        round_trip(floats, 4);
        round_trip(doubles, count ? 8 : 4);
        if (std::any_of(sparse.begin(), sparse.end(), [](double x) { return x != 0; })) round_trip(sparse, 8);
    }
    round_trip({0, 0, 0}, 4);
    round_trip({1e39}, 8);  // beyond the floats
    round_trip({1e-300, 5e-324, -1e300}, 8);
    round_trip({std::numeric_limits<double>::infinity()}, 8);
}

// With a valid hash: a width above 32 bits, an unknown type of numbers.
TEST(Packed, ForgedBytesAreRefused) {
    for (const int width : {33, 64, 255}) {
        Packer out;
        out.put(int32_t{0});
        out.put(static_cast<uint8_t>(width));
        out.put_bytes(std::vector<uint8_t>(4000).data(), 4000);
        const std::vector<uint8_t> bytes = out.finish();
        EXPECT_EQ(status_of([&] { Unpacker(bytes).get_integers(64); }), PW_ERROR_DATA) << width;
    }
    Packer out;
    out.put(uint8_t{255});
    out.put(uint8_t{2});
    out.put_bytes(std::vector<uint8_t>(100).data(), 100);
    const std::vector<uint8_t> bytes = out.finish();
    EXPECT_EQ(status_of([&] { Unpacker(bytes).get_doubles(8); }), PW_ERROR_DATA);
}
