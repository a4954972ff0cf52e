// A file for readers that take a path. Runners set TMPDIR to a folder in memory.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <fstream>
#include <string>
#include <string_view>

#include "tests/support/temporary_folder.h"

namespace incise::fuzz {

class WrittenFile {
  public:
    WrittenFile(const std::string& name, std::string_view bytes) : path_(folder() / name) {
        std::ofstream(path_, std::ios::binary) << bytes;
    }
    const std::filesystem::path& path() const { return path_; }
    std::string name() const { return path_.string(); }

  private:
    /// One for all files of a process: to make and remove it takes longer than to read most files.
    static const support::TemporaryFolder& folder() {
        static const support::TemporaryFolder folder;
        return folder;
    }
    std::filesystem::path path_;
};

}  // namespace incise::fuzz
