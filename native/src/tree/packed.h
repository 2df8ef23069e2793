// Arrays as bytes, fewer than memory holds them in, and back: the words of the saved form. Little-endian; a hash of all
// that came before is the end.
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
    // As memory holds it.
    template <class T>
    void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        put_bytes(&value, sizeof value);
    }
    void put_bytes(const void* from, size_t count);

    // In blocks of 64: the least of them, and by how much each is more, in as few bits as the largest of these needs.
    // Short where neighbours in the array differ little.
    void put_integers(std::span<const int32_t> numbers);

    // A bit each for whether it is 0; then those that are not, as floats if all of them are floats exactly.
    void put_doubles(std::span<const double> numbers);

    // All of it, and its hash.
    std::vector<uint8_t> finish();

private:
    std::vector<uint8_t> bytes_;
};

// Throws Error(PW_ERROR_DATA). why: the end of a sentence about the bytes.
[[noreturn]] void refuse_saved(const char* why);

// Reads what a Packer wrote, in the same order. Throws as above where the hash is another, or the bytes end too soon or
// can't be such; never makes more than 64 times as many of them.
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

    // So many T, which are numbers or arrays of them.
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
