// Packs arrays into bytes and unpacks them: the encoding of the saved form. Little-endian; the last eight bytes are a
// hash of all others.
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
    // Writes the bytes of a value.
    template <class T>
    void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        put_bytes(&value, sizeof value);
    }
    void put_bytes(const void* from, size_t count);

    // Writes blocks of 64 numbers: the block's minimum, then the differences from it, all with as many bits as the
    // largest difference needs. So arrays whose neighbors differ little become short.
    void put_integers(std::span<const int32_t> numbers);

    // Writes one bit per number, 1 if it isn't 0; then the numbers that aren't 0, as floats if that is exact for all
    // of them.
    void put_doubles(std::span<const double> numbers);

    // Returns all bytes, with the hash.
    std::vector<uint8_t> finish();

private:
    std::vector<uint8_t> bytes_;
};

// Throws Error(PW_ERROR_DATA) with the reason in its message.
[[noreturn]] void refuse_saved(const char* why);

// Reads what a Packer wrote, in the same order. Throws Error(PW_ERROR_DATA) if the hash differs, or if bytes are
// missing or invalid. Allocates at most 64 bytes for each byte that it reads.
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

    // Reads `count` values of T, which is a number or an array of numbers.
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
