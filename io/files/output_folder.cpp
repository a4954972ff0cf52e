// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/files/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <utility>

#include "incise/base/error.h"
#include "incise/io/files/atomic_file.h"

namespace incise::io {

OutputFolder::OutputFolder(std::filesystem::path path) : path_(std::move(path)) {
    make_output_folder(path_);
    lock_ = FileDescriptor(path_, O_RDONLY | O_DIRECTORY);
    while (lock_.is_open() && ::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0) {
        if (errno == EWOULDBLOCK)
            throw InputError(path_.string() +
                             ": another run is writing there; wait for its end or stop it, or "
                             "choose another folder");
        if (errno != EINTR) break;
    }
    remove_unfinished_files(path_);
}

}  // namespace incise::io
