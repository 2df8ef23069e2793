// Arrays as bytes and back.
#include "tree/packed.h"

#include "base/error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace partwheel {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as memory holds them");

constexpr size_t block = 64;
constexpr size_t most_growth = 64;  // a double that is 0 takes one bit

size_t bytes_for(size_t bits) { return (bits + 7) / 8; }

bool is_float(double x) {
    return std::fabs(x) <= std::numeric_limits<float>::max() && static_cast<double>(static_cast<float>(x)) == x;
}

// FNV-1a, by words of 8 bytes where they last: any single changed byte changes the hash.
uint64_t hash(std::span<const uint8_t> bytes) {
    constexpr uint64_t prime = 0x100000001b3;
    uint64_t h = 0xcbf29ce484222325;
    size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8) {
        uint64_t word;
        std::memcpy(&word, bytes.data() + i, 8);
        h = std::rotl((h ^ word) * prime, 29);
    }
    for (; i < bytes.size(); ++i) h = (h ^ bytes[i]) * prime;
    return h;
}

}  // namespace

void refuse_saved(const char* why) {
    throw Error(PW_ERROR_DATA, std::string("This hierarchy can't be used: ") + why + ". Build it again.");
}

std::vector<uint8_t> Packer::finish() {
    put(hash(bytes_));
    return std::move(bytes_);
}

Unpacker::Unpacker(std::span<const uint8_t> finished) {
    uint64_t stored;
    if (finished.size() < sizeof stored) refuse_saved("it is truncated");
    bytes_ = finished.first(finished.size() - sizeof stored);
    std::memcpy(&stored, finished.data() + bytes_.size(), sizeof stored);
    bool intact = hash(bytes_) == stored;
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
    intact = true;  // no fuzzer would guess it
#endif
    if (!intact) refuse_saved("it is damaged");
}

void Packer::put_bytes(const void* from, size_t count) {
    const auto* p = static_cast<const uint8_t*>(from);
    bytes_.insert(bytes_.end(), p, p + count);
}

void Packer::put_integers(std::span<const int32_t> numbers) {
    for (size_t begin = 0; begin < numbers.size(); begin += block) {
        const std::span part = numbers.subspan(begin, std::min(block, numbers.size() - begin));
        const auto [least, most] = std::minmax_element(part.begin(), part.end());
        const auto base = static_cast<uint32_t>(*least);
        const auto width = static_cast<size_t>(std::bit_width(static_cast<uint32_t>(*most) - base));
        put(*least);
        put(static_cast<uint8_t>(width));
        uint64_t pending = 0;  // bits that are no whole byte yet
        size_t count = 0;
        for (const int32_t number : part) {
            pending |= static_cast<uint64_t>(static_cast<uint32_t>(number) - base) << count;
            for (count += width; count >= 8; count -= 8, pending >>= 8) bytes_.push_back(static_cast<uint8_t>(pending));
        }
        if (count > 0) bytes_.push_back(static_cast<uint8_t>(pending));
    }
}

void Unpacker::read(std::span<int32_t> numbers) {
    for (size_t begin = 0; begin < numbers.size(); begin += block) {
        const std::span part = numbers.subspan(begin, std::min(block, numbers.size() - begin));
        const auto base = static_cast<uint32_t>(get<int32_t>());
        const size_t width = get<uint8_t>();
        if (width > 32) refuse_saved("its numbers are too large");
        const uint8_t* from = take(bytes_for(part.size() * width)).data();
        const uint64_t mask = (uint64_t{1} << width) - 1;
        for (size_t i = 0, bit = 0; i < part.size(); ++i, bit += width) {
            uint64_t word;  // reaches into what follows, in the end the hash
            std::memcpy(&word, from + bit / 8, sizeof word);
            part[i] = static_cast<int32_t>(base + static_cast<uint32_t>(word >> bit % 8 & mask));
        }
    }
}

void Packer::put_doubles(std::span<const double> numbers) {
    const size_t bits = bytes_.size();
    bytes_.resize(bits + bytes_for(numbers.size()), 0);
    bool floats = true;
    for (size_t i = 0; i < numbers.size(); ++i) {
        if (numbers[i] != 0) bytes_[bits + i / 8] = static_cast<uint8_t>(bytes_[bits + i / 8] | 1 << i % 8);
        floats = floats && is_float(numbers[i]);
    }
    put(static_cast<uint8_t>(floats));
    for (const double number : numbers) {
        if (number == 0) continue;
        if (floats)
            put(static_cast<float>(number));
        else
            put(number);
    }
}

void Unpacker::read(std::span<double> numbers) {
    const std::span<const uint8_t> bits = take(bytes_for(numbers.size()));
    const auto floats = get<uint8_t>();
    if (floats > 1) refuse_saved("the type of its numbers is unknown");
    size_t count = 0;
    for (size_t i = 0; i < numbers.size(); ++i) count += bits[i / 8] >> i % 8 & 1;
    const uint8_t* from = take(count * (floats ? sizeof(float) : sizeof(double))).data();
    for (size_t i = 0; i < numbers.size(); ++i) {
        if (!(bits[i / 8] >> i % 8 & 1)) {
            numbers[i] = 0;
        } else if (floats) {
            float number;
            std::memcpy(&number, from, sizeof number);
            numbers[i] = static_cast<double>(number);
            from += sizeof number;
        } else {
            std::memcpy(&numbers[i], from, sizeof numbers[i]);
            from += sizeof numbers[i];
        }
    }
}

std::string Unpacker::get_text(size_t length) {
    const std::span<const uint8_t> text = take(length);
    return {text.begin(), text.end()};
}

void Unpacker::expect(size_t count, size_t size) const {
    if (count > bytes_.size() * most_growth / size) refuse_saved("it is truncated");
}

std::span<const uint8_t> Unpacker::take(size_t count) {
    if (count > bytes_.size()) refuse_saved("it is truncated");
    const std::span<const uint8_t> taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
}

}  // namespace partwheel
