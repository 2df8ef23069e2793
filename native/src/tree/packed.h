// Packs arrays into bytes and unpacks them: the encoding of the saved form. Little-endian; the last eight bytes are a
// hash of the rest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace partwheel {

class Packer {
public:
    // The value's bytes.
    template <class T>
    void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        put_bytes(&value, sizeof value);
    }
    void put_bytes(const void* from, size_t count);

    // In blocks of 64: the least number of the block, then the differences from it, in as few bits as the largest
    // needs. Short if neighbors in the array differ little.
    void put_integers(std::span<const int32_t> numbers);

    // One bit for each number that says whether it isn't 0; then the others, as floats if all of them are exactly
    // floats.
    void put_doubles(std::span<const double> numbers);

    // All bytes and their hash.
    std::vector<uint8_t> finish();

private:
    std::vector<uint8_t> bytes_;
};

// Throws Error(PW_ERROR_DATA). why: the reason, for the message.
[[noreturn]] void refuse_saved(const char* why);

// Reads what a Packer wrote, in the same order. Throws as above if the hash differs, or the bytes are too few or
// invalid; never allocates more than 64 times their number.
class Unpacker {
public:
    explicit Unpacker(std::span<const uint8_t> finished);

    template <class T>
    T get() {
        static_assert(std::is_trivially_copyable_v<T>);
        T value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    std::string get_text(size_t length);

    // `count` values of T, which is a number or an array of numbers.
    template <class T = int32_t>
    std::vector<T> get_integers(size_t count) {
        return get_numbers<int32_t, T>(count);
    }
    template <class T = double>
    std::vector<T> get_doubles(size_t count) {
        return get_numbers<double, T>(count);
    }
    bool at_end() const { return bytes_.empty(); }

private:
    template <class Number, class T>
    std::vector<T> get_numbers(size_t count) {
        expect(count, sizeof(T));
        std::vector<T> values(count);
        read({reinterpret_cast<Number*>(values.data()), count * (sizeof(T) / sizeof(Number))});
        return values;
    }
    void expect(size_t count, size_t size) const;
    std::span<const uint8_t> take(size_t count);
    void read(std::span<int32_t> numbers);
    void read(std::span<double> numbers);

    std::span<const uint8_t> bytes_;  // what is left, without the hash
};

}  // namespace partwheel
