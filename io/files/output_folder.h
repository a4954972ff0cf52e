// The folder of a run, locked against other runs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>

#include "incise/io/files/file_descriptor.h"

namespace incise::io {

/// A folder with a lock of the operating system. At most one OutputFolder exists for a folder, in
/// one process or in several. The lock ends with the object, or with the process. On a file system
/// without locks nothing is locked.
class OutputFolder {
  public:
    /// Makes the folder and its missing parents, and removes the hidden files that killed processes
    /// left in it; see remove_unfinished_files().
    /// Throws OutputError if files cannot be written there, InputError if the folder is in use.
    explicit OutputFolder(std::filesystem::path path);

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
    FileDescriptor lock_;
};

}  // namespace incise::io
