// What a run has written to its files, to know it again when it goes on.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace incise::io {

/// The bytes of a file so far.
struct BytesWritten {
    std::uint64_t size = 0;
    std::uint64_t checksum = 0;  ///< see io::checksum

    void append(std::string_view bytes);
    bool operator==(const BytesWritten&) const = default;
    static void archive(auto& ar, auto& self) { ar(self.size, self.checksum); }
};

/// Throws InputError, naming the file, what has become of it and what to do, unless it begins with
/// these bytes. Cost: that of reading them.
void require_begins_with(const std::filesystem::path& path, const BytesWritten& bytes);

/// The same, unless it has these bytes and no more.
void require_is(const std::filesystem::path& path, const BytesWritten& bytes);

}  // namespace incise::io
