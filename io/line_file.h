// Text files that grow by whole lines: history.csv, edits.jsonl.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "io/file_descriptor.h"

namespace incise::io {

/// Appends lines to a file, each with one call of the system: whoever reads along, and who reads
/// after a kill, sees whole lines. A line that fails is taken back.
/// Every function throws OutputError that names the file, the reason and a remedy.
class LineFile {
  public:
    /// Opens the file, made where it is missing, and keeps its first `keep` bytes: 0 begins anew,
    /// a former size() goes on from there. Fails if there are fewer bytes to keep.
    explicit LineFile(std::filesystem::path path, std::uint64_t keep = 0);

    /// @pre `line` holds no line feed; one is added.
    void append(std::string_view line);

    /// Bytes so far.
    std::uint64_t size() const { return size_; }

    /// Waits until all lines are on the disk.
    void sync();

  private:
    std::filesystem::path path_;
    FileDescriptor file_;
    std::uint64_t size_ = 0;
    std::string buffer_;
};

}  // namespace incise::io
