// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/files/checked_file.h"

#include <cstdint>

#include "incise/base/archive.h"
#include "incise/base/checksum.h"
#include "incise/base/error.h"
#include "incise/io/files/atomic_file.h"
#include "incise/io/files/input_file.h"

namespace incise::io {

namespace {

/// The format number changes with the layout of this file, not with the layout of its contents.
constexpr std::string_view first_line = "incise checkpoint, format 1\n";
constexpr std::size_t checksum_size = sizeof(std::uint64_t);

}  // namespace

void write_checked_file(const std::filesystem::path& path, std::string_view bytes) {
    std::string file(first_line);
    file += bytes;
    ArchiveWriter end;
    end(checksum(file));
    file += end.bytes();
    write_file(path, file);
}

std::string read_checked_file(const std::filesystem::path& path) {
    InputFile file = load_input_file(path);
    const auto refuse = [&](const char* why) { throw InputError(file.name() + ": " + why); };
    if (file.bytes.size() < first_line.size() + checksum_size) refuse("is cut short");
    const std::size_t end = file.bytes.size() - checksum_size;
    const std::string_view all = file.bytes;
    ArchiveReader stored(all.substr(end));
    if (stored.read<std::uint64_t>() != checksum(all.substr(0, end)))
        refuse("is damaged: its checksum is wrong");
    if (!all.starts_with(first_line)) refuse("has a format that this version does not know");
    file.bytes.resize(end);
    file.bytes.erase(0, first_line.size());
    return std::move(file.bytes);
}

}  // namespace incise::io
