// The folder of a run: its own as long as it lasts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>

#include "incise/io/files/file_descriptor.h"

namespace incise::io {

/// No two of them are there for one folder, in one process or in several: the system's lock on it
/// goes with the object, or with the process however that ends. Where a file system has no locks,
/// nothing is locked.
class OutputFolder {
  public:
    /// Makes the folder and its parents where they are missing, and removes the hidden files that
    /// killed processes left in it (remove_unfinished_files).
    /// Throws OutputError if files cannot be written there, InputError if the folder is in use.
    explicit OutputFolder(std::filesystem::path path);

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
    FileDescriptor lock_;
};

}  // namespace incise::io
