// Text files that grow by whole lines: history.csv, edits.jsonl.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "incise/io/files/file_descriptor.h"
#include "incise/io/files/written_bytes.h"

namespace incise::io {

/// Appends lines to a file, each with one call of the system: whoever reads along, and who reads
/// after a kill, sees whole lines. A line that fails is taken back.
/// Every function throws OutputError that names the file, the reason and a remedy.
class LineFile {
  public:
    /// Opens the file, made where it is missing, and keeps the lines with which it begins: those of
    /// a former written(), to go on from there, or none, to begin anew. Fails if there are fewer
    /// bytes; whether they are the same, require_begins_with() tells.
    explicit LineFile(std::filesystem::path path, const BytesWritten& keep = {});

    /// @pre `line` holds no line feed; one is added.
    void append(std::string_view line);

    const BytesWritten& written() const { return written_; }

    /// Waits until all lines are on the disk.
    void sync();

  private:
    std::filesystem::path path_;
    FileDescriptor file_;
    BytesWritten written_;
    std::string buffer_;
};

}  // namespace incise::io
