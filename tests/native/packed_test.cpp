// Packing: lossless round trips, the documented size, refusal of truncated bytes.
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

// Integers that differ by less than 2^bits.
std::vector<int32_t> some_integers(std::mt19937& random, size_t count, unsigned bits) {
    const int64_t spread = int64_t{1} << bits, lowest = std::numeric_limits<int32_t>::min();
    const int64_t base = lowest + static_cast<int64_t>(random()) % ((int64_t{1} << 32) - spread + 1);
    std::vector<int32_t> numbers(count);
    for (int32_t& n : numbers) n = static_cast<int32_t>(base + static_cast<int64_t>(random()) % spread);
    return numbers;
}

std::vector<uint8_t> packed(const std::vector<int32_t>& numbers) {
    Packer out;
    out.put_integers(numbers);
    return out.finish();
}

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

TEST(Packed, IntegersRoundTrip) {
    std::mt19937 random(1);
    for (const size_t count : {0U, 1U, 2U, 63U, 64U, 65U, 1000U})
        for (unsigned width = 0; width < 33; ++width) {
            const auto numbers = some_integers(random, count, width);
            const std::vector<uint8_t> bytes = packed(numbers);
            Unpacker in(bytes);
            EXPECT_EQ(in.get_integers(count), numbers) << count << " of " << width << " bits";
            EXPECT_TRUE(in.at_end());
            EXPECT_LE(bytes.size(), hash_size + (count + 63) / 64 * 5 + (count * width + 7) / 8);
        }
    const std::vector<int32_t> extremes = {std::numeric_limits<int32_t>::min(), -1, 0, 1,
                                           std::numeric_limits<int32_t>::max()};
    const std::vector<uint8_t> bytes = packed(extremes);
    EXPECT_EQ(Unpacker(bytes).get_integers(extremes.size()), extremes);
}

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

TEST(Packed, ValuesInSequence) {
    Packer out;
    out.put(uint64_t{7});
    out.put_bytes("word", 4);
    out.put_integers(std::vector<int32_t>{5, 4, 3});
    out.put_doubles(std::vector<double>{0.5, 0.1});
    const std::vector<uint8_t> bytes = out.finish();
    Unpacker in(bytes);
    EXPECT_EQ(in.get<uint64_t>(), 7U);
    EXPECT_EQ(in.get_text(4), "word");
    EXPECT_EQ(in.get_integers(3), (std::vector<int32_t>{5, 4, 3}));
    EXPECT_EQ(in.get_doubles(2), (std::vector<double>{0.5, 0.1}));
    EXPECT_TRUE(in.at_end());
}

TEST(Packed, TruncatedBytesAreRefused) {
    const std::vector<uint8_t> integers = packed(std::vector<int32_t>(100, 3));
    const std::vector<uint8_t> doubles = packed(std::vector<double>(100, 0.1));
    EXPECT_EQ(status_of([&] { Unpacker(integers).get_integers(200); }), PW_ERROR_DATA);
    EXPECT_EQ(status_of([&] { Unpacker(doubles).get_doubles(200); }), PW_ERROR_DATA);
    // Refused before allocation.
    for (const size_t count : {size_t{1} << 31, size_t{1} << 40, size_t{1} << 60}) {
        EXPECT_EQ(status_of([&] { Unpacker(integers).get_integers(count); }), PW_ERROR_DATA);
        EXPECT_EQ(status_of([&] { Unpacker(doubles).get_doubles(count); }), PW_ERROR_DATA);
        EXPECT_EQ(status_of([&] { Unpacker(doubles).get_text(count); }), PW_ERROR_DATA);
    }
    for (size_t size = 0; size < integers.size(); ++size)
        EXPECT_EQ(status_of([&] { Unpacker({integers.data(), size}).get_integers(100); }), PW_ERROR_DATA);
}

TEST(Packed, AnyChangedByteIsRefused) {
    const std::vector<uint8_t> bytes = packed(std::vector<double>{1, 2, 0.3, 0, 5});
    for (size_t i = 0; i < bytes.size(); ++i) {
        std::vector<uint8_t> damaged = bytes;
        damaged[i] = static_cast<uint8_t>(damaged[i] ^ 0x10);
        EXPECT_EQ(status_of([&] { Unpacker in(damaged); }), PW_ERROR_DATA) << i;
    }
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
