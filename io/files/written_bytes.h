// Size and checksum of what a run has written to a file, to check the file when the run is resumed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace incise::io {

/// The size and checksum of the bytes of a file so far.
struct BytesWritten {
    std::uint64_t size = 0;
    std::uint64_t checksum = 0;  ///< see checksum

    void append(std::string_view bytes);
    bool operator==(const BytesWritten&) const = default;
    static void archive(auto& ar, auto& self) { ar(self.size, self.checksum); }
};

/// Checks that a file begins with these bytes. Throws InputError that names the file, how it
/// differs and a remedy. Cost: that of reading these bytes.
void require_begins_with(const std::filesystem::path& path, const BytesWritten& bytes);

/// Checks that a file has exactly these bytes. Throws as require_begins_with() does.
void require_is(const std::filesystem::path& path, const BytesWritten& bytes);

}  // namespace incise::io
