// Conversion of state to bytes and back, bit for bit, as used by checkpoints.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <variant>
#include <vector>

#include "incise/base/error.h"
#include "incise/base/types.h"

namespace incise {

/// A type whose bytes an archive stores as they are.
template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// A type that lists its members once, for both writing and reading:
///     static void archive(auto& ar, auto& self) { ar(self.first, self.second); }
template <class T, class Archive>
concept Archivable = requires(Archive& ar, T& value) {
    T::archive(ar, value);
};

namespace detail {
/// Converts bytes from the machine's order to little-endian order, or back.
template <Number T>
std::array<char, sizeof(T)> little_endian(std::array<char, sizeof(T)> bytes) {
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}
}  // namespace detail

/// Writer that appends values to a string of bytes. It stores no types, names or padding, so that
/// reading needs the same list of types. Equal values give equal bytes, since unordered containers
/// are sorted.
class ArchiveWriter {
  public:
    template <class... T>
    void operator()(const T&... values) {
        (put(values), ...);
    }

    /// Returns what was written so far.
    const std::string& bytes() const {
        flush();
        return bytes_;
    }
    /// Returns what was written so far, without a copy of it. The writer is then empty.
    std::string take() {
        flush();
        return std::exchange(bytes_, {});
    }

  private:
    template <Number T>
    void put(T value) {
        const auto bytes =
            detail::little_endian<T>(std::bit_cast<std::array<char, sizeof(T)>>(value));
        if (num_latest_ + sizeof(T) > latest_.size()) flush();
        std::memcpy(latest_.data() + num_latest_, bytes.data(), sizeof(T));
        num_latest_ += sizeof(T);
    }
    void flush() const {
        bytes_.append(latest_.data(), num_latest_);
        num_latest_ = 0;
    }
    template <class Tag>
    void put(Id<Tag> id) {
        put(id.value);
    }
    void put(const Vec3& v) { (*this)(v.x(), v.y(), v.z()); }
    void put(const Eigen::AlignedBox3d& box) { (*this)(box.min(), box.max()); }
    void put(const std::string& text) {
        put(std::uint64_t{text.size()});
        flush();
        bytes_ += text;
    }
    template <class T, std::size_t size>
    void put(const std::array<T, size>& values) {
        for (const T& value : values) put(value);
    }
    template <class A, class B>
    void put(const std::pair<A, B>& pair) {
        (*this)(pair.first, pair.second);
    }
    template <class T>
    void put(const std::vector<T>& values) {
        put(std::uint64_t{values.size()});
        for (const T& value : values) put(value);
    }
    template <class Key, class T>
    void put(const std::unordered_map<Key, T>& map) {
        std::vector<Key> keys;
        keys.reserve(map.size());
        for (const auto& [key, value] : map) keys.push_back(key);
        std::sort(keys.begin(), keys.end());
        put(std::uint64_t{keys.size()});
        for (const Key& key : keys) (*this)(key, map.at(key));
    }
    template <class Key>
    void put(const std::unordered_set<Key>& set) {
        std::vector<Key> keys(set.begin(), set.end());
        std::sort(keys.begin(), keys.end());
        put(keys);
    }
    template <class Key, class T>
    void put(const std::map<Key, T>& map) {
        put(std::uint64_t{map.size()});
        for (const auto& [key, value] : map) (*this)(key, value);
    }
    template <class T>
    void put(const std::optional<T>& value) {
        put(value.has_value());
        if (value) put(*value);
    }
    template <class... T>
    void put(const std::variant<T...>& value) {
        put(static_cast<std::uint8_t>(value.index()));
        std::visit([&](const auto& held) { put(held); }, value);
    }
    template <Archivable<ArchiveWriter> T>
    void put(const T& value) {
        T::archive(*this, value);
    }

    // To append each number to the bytes would take longer than the number itself: the latest ones
    // are collected.
    mutable std::string bytes_;
    mutable std::array<char, 1024> latest_;
    mutable std::size_t num_latest_ = 0;
};

/// Reader of the bytes of an ArchiveWriter. The types and their order must be those of the writer.
/// Throws InputError if the bytes end too early, or if a variant has no such alternative. All other
/// checks of the values are left to the caller. Memory stays in proportion to the number of bytes.
class ArchiveReader {
  public:
    /// @param bytes  must outlive the reader
    explicit ArchiveReader(std::string_view bytes) : rest_(bytes) {}

    template <class... T>
    void operator()(T&... values) {
        (get(values), ...);
    }
    /// Returns the next value, which must be of type T.
    template <class T>
    T read() {
        T value;
        get(value);
        return value;
    }

    bool is_at_end() const { return rest_.empty(); }

  private:
    std::string_view take(std::uint64_t size) {
        if (size > rest_.size()) throw InputError("the data end too early");
        const std::string_view taken = rest_.substr(0, size);
        rest_.remove_prefix(size);
        return taken;
    }
    template <Number T>
    void get(T& value) {
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), take(sizeof(T)).data(), sizeof(T));
        value = std::bit_cast<T>(detail::little_endian<T>(bytes));
    }
    void get(bool& value) { value = read<std::uint8_t>() != 0; }
    template <class Tag>
    void get(Id<Tag>& id) {
        get(id.value);
    }
    void get(Vec3& v) { (*this)(v.x(), v.y(), v.z()); }
    void get(Eigen::AlignedBox3d& box) { (*this)(box.min(), box.max()); }
    void get(std::string& text) { text = take(read<std::uint64_t>()); }
    template <class T, std::size_t size>
    void get(std::array<T, size>& values) {
        for (T& value : values) get(value);
    }
    template <class A, class B>
    void get(std::pair<A, B>& pair) {
        (*this)(pair.first, pair.second);
    }
    template <class T>
    void get(std::vector<T>& values) {
        values.clear();
        // No reserve: with a wrong count, the bytes must run out before the memory does.
        for (auto i = read<std::uint64_t>(); i > 0; --i) get(values.emplace_back());
    }
    template <class Key, class T>
    void get(std::unordered_map<Key, T>& map) {
        map.clear();
        for (auto i = read<std::uint64_t>(); i > 0; --i) {
            const Key key = read<Key>();
            get(map[key]);
        }
    }
    template <class Key>
    void get(std::unordered_set<Key>& set) {
        const auto keys = read<std::vector<Key>>();
        set = std::unordered_set<Key>(keys.begin(), keys.end());
    }
    template <class Key, class T>
    void get(std::map<Key, T>& map) {
        map.clear();
        for (auto i = read<std::uint64_t>(); i > 0; --i) {
            const Key key = read<Key>();
            get(map[key]);
        }
    }
    template <class T>
    void get(std::optional<T>& value) {
        value.reset();
        if (read<bool>()) get(value.emplace());
    }
    template <class... T>
    void get(std::variant<T...>& value) {
        get_alternative<0>(value, read<std::uint8_t>());
    }
    template <std::size_t i, class... T>
    void get_alternative(std::variant<T...>& value, std::size_t index) {
        if constexpr (i == sizeof...(T)) {
            throw InputError("there is no alternative " + std::to_string(index));
        } else {
            if (index != i) return get_alternative<i + 1>(value, index);
            get(value.template emplace<i>());
        }
    }
    template <Archivable<ArchiveReader> T>
    void get(T& value) {
        T::archive(*this, value);
    }

    std::string_view rest_;
};

}  // namespace incise
