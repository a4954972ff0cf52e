// Number types of binary arrays, and conversion to the types in memory.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

namespace incise::io {

enum class ScalarType : std::uint8_t {
    int8,
    uint8,
    int16,
    uint16,
    int32,
    uint32,
    int64,
    uint64,
    float32,
    float64
};

constexpr std::size_t size_of(ScalarType type) {
    constexpr std::array<std::size_t, 10> sizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

constexpr bool is_integer(ScalarType type) {
    return type != ScalarType::float32 && type != ScalarType::float64;
}

/// Returns the value that starts at `bytes`. `swap` is true if its byte order is not that of this
/// machine.
template <class T>
T load_scalar(const char* bytes, bool swap) {
    std::array<char, sizeof(T)> buffer;
    std::memcpy(buffer.data(), bytes, sizeof(T));
    if (swap) std::reverse(buffer.begin(), buffer.end());
    T value;
    std::memcpy(&value, buffer.data(), sizeof(T));
    return value;
}

/// Returns all values of the bytes, converted to Target as by static_cast. Target is double or
/// std::int64_t. A uint64 above the range of int64 becomes negative.
/// @pre  bytes.size() is a multiple of size_of(type)
/// @pre  Target is double, or the type is an integer type
template <class Target>
std::vector<Target> convert_scalars(std::string_view bytes, ScalarType type, bool swap) {
    std::vector<Target> values(bytes.size() / size_of(type));
    const auto convert = [&]<class Source>(Source) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            const char* at = bytes.data() + i * sizeof(Source);
            // NOLINTNEXTLINE(bugprone-signed-char-misuse): int8 is a number here
            values[i] = static_cast<Target>(load_scalar<Source>(at, swap));
        }
    };
    switch (type) {
        case ScalarType::int8:
            convert(std::int8_t{});
            break;
        case ScalarType::uint8:
            convert(std::uint8_t{});
            break;
        case ScalarType::int16:
            convert(std::int16_t{});
            break;
        case ScalarType::uint16:
            convert(std::uint16_t{});
            break;
        case ScalarType::int32:
            convert(std::int32_t{});
            break;
        case ScalarType::uint32:
            convert(std::uint32_t{});
            break;
        case ScalarType::int64:
            convert(std::int64_t{});
            break;
        case ScalarType::uint64:
            convert(std::uint64_t{});
            break;
        // NOLINTNEXTLINE(bugprone-branch-clone): alike only where Target is an integer
        case ScalarType::float32:
            if constexpr (!std::integral<Target>) convert(float{});
            break;
        case ScalarType::float64:
            if constexpr (!std::integral<Target>) convert(double{});
            break;
    }
    return values;
}

}  // namespace incise::io
