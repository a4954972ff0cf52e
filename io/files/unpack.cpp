// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/files/unpack.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>
#include <span>

#include "incise/io/files/compression.h"

namespace incise::io {

namespace {

constexpr std::size_t longest_piece = std::size_t{1} << 30;  // zlib counts in 32 bits

/// A stream of zlib that unpacks a zlib or gzip stream part by part.
class Inflater {
  public:
    explicit Inflater(std::string_view packed) : rest_(packed) {
        constexpr int zlib_or_gzip = 15 + 32;
        if (inflateInit2(&stream_, zlib_or_gzip) != Z_OK) throw std::bad_alloc();
    }
    ~Inflater() { inflateEnd(&stream_); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    /// Unpacks until `out` is full, or the stream ends or fails. Returns the number of bytes.
    std::size_t take(std::span<char> out) {
        std::size_t num_taken = 0;
        while (num_taken < out.size() && !is_finished_ && !has_failed_) {
            const auto free = std::min(out.size() - num_taken, longest_piece);
            const auto given = std::min(rest_.size(), longest_piece);
            stream_.next_out = reinterpret_cast<Bytef*>(out.data() + num_taken);
            stream_.avail_out = static_cast<uInt>(free);
            stream_.next_in =
                reinterpret_cast<Bytef*>(const_cast<char*>(rest_.data()));  // only read
            stream_.avail_in = static_cast<uInt>(given);
            const int status = inflate(&stream_, Z_NO_FLUSH);
            num_taken += free - stream_.avail_out;
            rest_.remove_prefix(given - stream_.avail_in);
            if (status == Z_STREAM_END) {
                is_finished_ = !begins_as_gzip(rest_);
                if (!is_finished_) has_failed_ = inflateReset(&stream_) != Z_OK;
            } else if (status == Z_MEM_ERROR) {
                throw std::bad_alloc();
            } else if (status != Z_OK) {
                has_failed_ = true;  // damaged or cut short
            }
        }
        return num_taken;
    }
    bool is_finished() const { return is_finished_; }
    bool has_failed() const { return has_failed_; }

  private:
    z_stream stream_{};
    std::string_view rest_;
    bool is_finished_ = false, has_failed_ = false;
};

}  // namespace

bool begins_as_gzip(std::string_view bytes) { return bytes.starts_with("\x1F\x8B"); }

std::string unpacked_prefix(std::string_view packed, std::size_t most) {
    std::string bytes(most, '\0');
    bytes.resize(Inflater(packed).take(bytes));
    return bytes;
}

std::size_t max_unpacked(std::size_t num_packed) {
    return num_packed * max_expansion(Compressor::zlib);
}

std::optional<Unpacked> unpacked(std::string_view packed, std::size_t begin, std::size_t size) {
    Inflater inflater(packed);
    std::array<char, 65536> ignored;
    while (begin > 0) {
        const auto num_taken =
            inflater.take(std::span(ignored).first(std::min(begin, ignored.size())));
        if (num_taken == 0) return std::nullopt;
        begin -= num_taken;
    }
    Unpacked part{std::string(size, '\0')};
    if (inflater.take(part.bytes) != size) return std::nullopt;
    // To the end, where zlib verifies the checksum.
    while (!inflater.is_finished() && !inflater.has_failed())
        part.num_behind += inflater.take(ignored);
    if (inflater.has_failed()) return std::nullopt;
    return part;
}

}  // namespace incise::io
