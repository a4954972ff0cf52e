// A file of the operating system, closed when it goes out of scope. For the writers of this
// folder, which need what streams do not tell: the reason of a failure, and that data is on disk.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <utility>

namespace incise::io {

/// Every operation returns false, with errno set, if the system refuses.
class FileDescriptor {
  public:
    FileDescriptor() = default;
    /// Opens with the flags of open(2); ask is_open().
    FileDescriptor(const std::filesystem::path& path, int flags);
    ~FileDescriptor();
    FileDescriptor(FileDescriptor&& other) noexcept
        : descriptor_(std::exchange(other.descriptor_, -1)) {}
    FileDescriptor& operator=(FileDescriptor&& other) noexcept {
        std::swap(descriptor_, other.descriptor_);
        return *this;
    }

    bool is_open() const { return descriptor_ >= 0; }
    int get() const { return descriptor_; }

    /// All bytes, however many calls it takes.
    bool write(std::string_view bytes);
    /// Waits until the data is on the disk; true also for what has no disk, such as a pipe.
    bool sync();
    bool close();

  private:
    int descriptor_ = -1;
};

}  // namespace incise::io
