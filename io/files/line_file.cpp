// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/files/line_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <utility>

#include "incise/base/error.h"
#include "incise/io/files/atomic_file.h"

namespace incise::io {

LineFile::LineFile(std::filesystem::path path, const BytesWritten& keep)
    : path_(std::move(path)), file_(path_, O_WRONLY | O_CREAT | O_APPEND), written_(keep) {
    struct stat status {};
    if (!file_.is_open() || ::fstat(file_.get(), &status) != 0) throw_output_error(path_, errno);
    if (!S_ISREG(status.st_mode)) return;  // a pipe or a device has no length
    if (static_cast<std::uint64_t>(status.st_size) < keep.size)
        throw OutputError(path_.string() + ": has " + std::to_string(status.st_size) +
                          " bytes, but " + std::to_string(keep.size) +
                          " were written before; it was changed since: begin anew");
    if (::ftruncate(file_.get(), static_cast<off_t>(keep.size)) != 0)
        throw_output_error(path_, errno);
}

void LineFile::append(std::string_view line) {
    assert(line.find('\n') == line.npos);
    buffer_.assign(line);
    buffer_ += '\n';
    if (!file_.write(buffer_)) {
        const int reason = errno;
        // Remove the part of the line that was written. If this fails too, the first error counts.
        if (::ftruncate(file_.get(), static_cast<off_t>(written_.size)) != 0) errno = reason;
        throw_output_error(path_, reason);
    }
    written_.append(buffer_);
}

void LineFile::sync() {
    if (!file_.sync()) throw_output_error(path_, errno);
}

}  // namespace incise::io
