// A file descriptor of the operating system. Streams do not report why an operation failed or
// whether the data is on the disk.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <utility>

namespace incise::io {

/// A file descriptor that is closed at the end of its lifetime. Every operation returns false, with
/// errno set, if it fails.
class FileDescriptor {
  public:
    FileDescriptor() = default;
    /// Opens a file with the flags of open(2). is_open() tells whether that succeeded.
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

    /// Writes all bytes, with as many calls of the system as needed.
    bool write(std::string_view bytes);
    /// Waits until the data is on the disk. Returns true also for a file without a disk, such as a
    /// pipe.
    bool sync();
    bool close();

  private:
    int descriptor_ = -1;
};

}  // namespace incise::io
