// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/files/written_bytes.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <system_error>

#include "incise/base/checksum.h"
#include "incise/base/error.h"

namespace incise::io {

namespace {

[[noreturn]] void refuse_file(const std::filesystem::path& path, const char* what_has_happened) {
    throw InputError(path.string() + ": has " + what_has_happened +
                     " since the run was stopped; put the former one back");
}

}  // namespace

void BytesWritten::append(std::string_view bytes) {
    size += bytes.size();
    checksum = incise::checksum(bytes, checksum);
}

void require_begins_with(const std::filesystem::path& path, const BytesWritten& bytes) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) refuse_file(path, "gone");
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw InputError(path.string() +
                         ": cannot be read, and the run goes on from it; check its permissions");
    std::array<char, 1 << 16> part;
    BytesWritten found;
    while (found.size < bytes.size) {
        file.read(part.data(), static_cast<std::streamsize>(
                                   std::min<std::uint64_t>(bytes.size - found.size, part.size())));
        const auto count = static_cast<std::size_t>(file.gcount());
        if (count == 0) refuse_file(path, "become shorter");
        found.append({part.data(), count});
    }
    if (found != bytes) refuse_file(path, "been changed");
}

void require_is(const std::filesystem::path& path, const BytesWritten& bytes) {
    require_begins_with(path, bytes);
    std::error_code error;
    if (std::filesystem::file_size(path, error) != bytes.size) refuse_file(path, "become longer");
}

}  // namespace incise::io
