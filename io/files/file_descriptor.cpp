// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/files/file_descriptor.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace incise::io {

FileDescriptor::FileDescriptor(const std::filesystem::path& path, int flags) {
    constexpr mode_t all_that_the_umask_allows = 0666;
    do {
        descriptor_ = ::open(path.c_str(), flags | O_CLOEXEC, all_that_the_umask_allows);
    } while (descriptor_ < 0 && errno == EINTR);
}

FileDescriptor::~FileDescriptor() { close(); }

bool FileDescriptor::write(std::string_view bytes) {
    constexpr std::size_t most_at_once = std::size_t{1} << 30;  // Linux stops short of 2^31
    while (!bytes.empty()) {
        const auto written =
            ::write(descriptor_, bytes.data(), std::min(bytes.size(), most_at_once));
        if (written < 0) {
            if (errno == EINTR) continue;
            return false;
        }
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

bool FileDescriptor::sync() {
    while (::fsync(descriptor_) != 0) {
        if (errno == EINVAL || errno == EROFS) return true;  // the file cannot be synchronised
        if (errno != EINTR) return false;
    }
    return true;
}

bool FileDescriptor::close() {
    if (descriptor_ < 0) return true;
    // Linux closes the file also if it returns EINTR.
    return ::close(std::exchange(descriptor_, -1)) == 0 || errno == EINTR;
}

}  // namespace incise::io
