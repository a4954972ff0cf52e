// Text files that grow by whole lines: history.csv, edits.jsonl.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "io/file_descriptor.h"

namespace incise::io {

/// The lines of a file so far, to know them again.
struct LinesWritten {
    std::uint64_t size = 0;      ///< bytes
    std::uint64_t checksum = 0;  ///< of them
    static void archive(auto& ar, auto& self) { ar(self.size, self.checksum); }
};

/// Throws InputError, naming the file and what has become of it, unless it begins with these lines.
/// Cost: that of reading them.
void require_lines(const std::filesystem::path& path, const LinesWritten& lines);

/// Appends lines to a file, each with one call of the system: whoever reads along, and who reads
/// after a kill, sees whole lines. A line that fails is taken back.
/// Every function throws OutputError that names the file, the reason and a remedy.
class LineFile {
  public:
    /// Opens the file, made where it is missing, and keeps the lines with which it begins: those of
    /// a former written(), to go on from there, or none, to begin anew. Fails if there are fewer
    /// bytes; whether they are the same, require_lines() tells.
    explicit LineFile(std::filesystem::path path, const LinesWritten& keep = {});

    /// @pre `line` holds no line feed; one is added.
    void append(std::string_view line);

    const LinesWritten& written() const { return written_; }

    /// Waits until all lines are on the disk.
    void sync();

  private:
    std::filesystem::path path_;
    FileDescriptor file_;
    LinesWritten written_;
    std::string buffer_;
};

}  // namespace incise::io
