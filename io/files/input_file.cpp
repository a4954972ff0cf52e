// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/files/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "incise/base/error.h"

namespace incise::io {

namespace {

/// Throws InputError if the file is a pointer of Git LFS. The definition of the format limits
/// pointers to 1024 bytes.
void refuse_lfs_pointer(const InputFile& file) {
    constexpr std::string_view mark = "version https://git-lfs.github.com/spec/v1";
    constexpr std::size_t longest = 1024;
    if (!file.bytes.starts_with(mark) || file.bytes.size() > longest) return;
    throw InputError(file.name() +
                     ": is a pointer of Git LFS, a text that stands for the file, and not the file "
                     "itself; get the file with 'git lfs pull' in its repository");
}

}  // namespace

std::size_t InputFile::line_of(std::size_t offset) const {
    const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(std::min(offset, bytes.size()));
    return 1 + static_cast<std::size_t>(std::count(bytes.begin(), end, '\n'));
}

InputFile load_input_file(const std::filesystem::path& path) {
    InputFile file{path, {}};
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) {
        const bool is_missing = status.type() == std::filesystem::file_type::not_found;
        throw InputError(file.name() + ": " +
                         (is_missing ? "no such file; check the path" : error.message()));
    }
    if (std::filesystem::is_directory(status))
        throw InputError(file.name() + ": is a directory; name a file in it");
    if (!std::filesystem::is_regular_file(status))
        throw InputError(file.name() + ": is not a regular file; copy its contents into one");

    const auto size = std::filesystem::file_size(path, error);
    if (error) throw InputError(file.name() + ": " + error.message());
    if (size == 0) throw InputError(file.name() + ": the file is empty");

    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        throw InputError(file.name() + ": cannot be opened (" + std::strerror(errno) +
                         "); check its permissions");
    file.bytes.resize(size);
    stream.read(file.bytes.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(stream.gcount()) != size)
        throw InputError(file.name() + ": only " + std::to_string(stream.gcount()) + " of " +
                         std::to_string(size) +
                         " bytes could be read; it changed or the disk failed");
    if (file.bytes.starts_with("\xEF\xBB\xBF")) file.bytes.erase(0, 3);
    refuse_lfs_pointer(file);
    return file;
}

std::string printable(std::string_view text) {
    std::string result;
    for (const char c : text) result += (c >= ' ' && c <= '~') ? c : '?';
    return result;
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t longest = 40;
    std::string result = "'";
    result += printable(text.substr(0, longest));
    if (text.size() > longest) result += "...";
    return result += '\'';
}

}  // namespace incise::io
