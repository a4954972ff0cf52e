// Text files that grow by complete lines: history.csv, edits.jsonl.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "incise/io/files/file_descriptor.h"
#include "incise/io/files/written_bytes.h"

namespace incise::io {

/// A file to which lines are appended, each with one call of the system. A reader sees complete
/// lines only, also while the file grows and after a kill. A line that fails is removed again.
/// Every function throws OutputError that names the file, the reason and a remedy.
class LineFile {
  public:
    /// Opens the file, or makes it if it is missing, and truncates it after its first `keep.size`
    /// bytes. To continue a file, `keep` is its former written(). By default the file becomes
    /// empty. Throws OutputError if the file has fewer bytes. Does not compare the contents; see
    /// require_begins_with().
    explicit LineFile(std::filesystem::path path, const BytesWritten& keep = {});

    /// Appends a line and a line feed.
    /// @pre  the line has no line feed
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
