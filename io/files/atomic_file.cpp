// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/files/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <csignal>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "incise/base/error.h"
#include "incise/io/files/file_descriptor.h"
#include "incise/io/files/number_text.h"

namespace incise::io {

namespace fs = std::filesystem;

namespace {

const char* remedy(int error_number) {
    switch (error_number) {
        case ENOSPC:
        case EDQUOT:
            return "make room there, or write to another disk";
        case EFBIG:
            return "raise the limit on the size of files (ulimit -f), or write less";
        case EACCES:
        case EPERM:
        case EROFS:
            return "choose a folder that you may write to";
        case ENOENT:
            return "make the folder first";
        case ENOTDIR:
        case EEXIST:
            return "a file is in the place of a folder; choose another path";
        case EISDIR:
            return "name a file in that folder, or remove the folder";
        case ENAMETOOLONG:
            return "choose a shorter name";
        case EMFILE:
        case ENFILE:
            return "raise the limit on open files (ulimit -n)";
        default:
            return "check the disk, or write to another one";
    }
}

/// Between the name of a file and the process that is writing it.
constexpr std::string_view temporary_mark = ".tmp";

/// Whether it is a name that a TemporaryFile takes: ".NAME.tmpPROCESS-ATTEMPT".
bool is_temporary(const std::string& name) {
    const auto mark = name.rfind(temporary_mark);
    if (!name.starts_with('.') || mark == name.npos) return false;
    const auto numbers = std::string_view(name).substr(mark + temporary_mark.size());
    const auto dash = numbers.find('-');
    return dash != numbers.npos && parse_number<pid_t>(numbers.substr(0, dash)) &&
           parse_number<int>(numbers.substr(dash + 1));
}

/// Puts off what would end the process, as far as this thread may, until it goes.
class SignalsPutOff {
  public:
    SignalsPutOff() {
        sigset_t signals;
        ::sigemptyset(&signals);
        for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaddset(&signals, signal);
        ::pthread_sigmask(SIG_BLOCK, &signals, &former_);
    }
    ~SignalsPutOff() { ::pthread_sigmask(SIG_SETMASK, &former_, nullptr); }
    SignalsPutOff(const SignalsPutOff&) = delete;
    SignalsPutOff& operator=(const SignalsPutOff&) = delete;

  private:
    sigset_t former_;
};

/// Waits for the lock of a file that is open, where there are locks. Returns false if the file has
/// been removed meanwhile, as by one who looked whether it was locked before it was.
bool lock(const FileDescriptor& file) {
    while (::flock(file.get(), LOCK_EX) != 0 && errno == EINTR) {
    }
    struct stat status {};
    return ::fstat(file.get(), &status) != 0 || status.st_nlink > 0;
}

/// A hidden file of its own in `folder`, to be renamed to `name`; removed again unless kept. It is
/// locked as long as it is being written, and the system unlocks it however the writer ends: that
/// tells it from what a killed process has left, where its number does not (another process may
/// have that by now).
class TemporaryFile {
  public:
    /// Throws OutputError about `meant` if there can be none.
    TemporaryFile(const fs::path& folder, const std::string& name, const fs::path& meant) {
        // Stale files of a killed process may have our process number: count on past them.
        constexpr std::size_t longest_stem = 200;  // of the 255 that file systems allow
        auto stem = name.substr(0, longest_stem);
        stem.insert(stem.begin(), '.');
        stem += std::string(temporary_mark) + std::to_string(::getpid());
        for (int attempt = 0; attempt < 1000; ++attempt) {
            path_ = folder / (stem + "-" + std::to_string(attempt));
            file_ = FileDescriptor(path_, O_WRONLY | O_CREAT | O_EXCL);
            if (file_.is_open() ? lock(file_) : errno != EEXIST) break;
        }
        if (!file_.is_open()) throw_output_error(meant, errno);
    }
    ~TemporaryFile() {
        if (!is_kept_) ::unlink(path_.c_str());
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    FileDescriptor& file() { return file_; }

    /// Returns false, with errno set, if the system refuses.
    bool rename_to(const fs::path& target) {
        is_kept_ = ::rename(path_.c_str(), target.c_str()) == 0;
        return is_kept_;
    }

  private:
    SignalsPutOff signals_put_off_;  // or they would leave the file behind
    fs::path path_;
    FileDescriptor file_;
    bool is_kept_ = false;
};

/// Removes the temporary file unless another one is writing it. It stays too if that cannot be
/// told: where it may not be opened, or there are no locks.
void remove_if_left(const fs::path& temporary) {
    const FileDescriptor file(temporary, O_WRONLY | O_NONBLOCK);
    if (file.is_open() && ::flock(file.get(), LOCK_EX | LOCK_NB) == 0)
        remove_output_file(temporary);  // while it is locked, or it could be a new one by now
}

/// What a link finally leads to, even if that is not there yet.
fs::path follow_links(fs::path path) {
    constexpr int most_links = 40;  // the kernel's own limit
    std::error_code error;
    for (int i = 0; i < most_links && fs::is_symlink(path, error); ++i) {
        const auto link = fs::read_symlink(path, error);
        if (error) throw_output_error(path, error.value());
        path = path.parent_path() / link;
    }
    return path;
}

fs::path folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

struct Target {
    fs::path path;
    bool is_device;  ///< or a pipe: never to be replaced by a file
};

/// Throws OutputError if it is a folder.
Target target_of(const fs::path& path) {
    struct stat status {};
    const bool is_there = ::stat(path.c_str(), &status) == 0;
    if (is_there && S_ISDIR(status.st_mode)) throw_output_error(path, EISDIR);
    // Links of the system to pipes, as /dev/stdout, cannot be followed by name.
    if (is_there && !S_ISREG(status.st_mode)) return {path, true};
    const Target target{follow_links(path), false};
    if (!target.path.has_filename()) throw_output_error(path, EISDIR);
    return target;
}

/// Makes a rename in the folder last. A folder that may be written to but not read, as for
/// handing in, cannot be synchronised: the file is there all the same.
bool sync_folder(const fs::path& folder) {
    FileDescriptor descriptor(folder, O_RDONLY | O_DIRECTORY);
    return !descriptor.is_open() || descriptor.sync();
}

}  // namespace

void throw_output_error(const fs::path& path, int error_number) {
    if (error_number == ENOMEM) throw std::bad_alloc();
    auto reason = std::generic_category().message(error_number);
    if (!reason.empty())
        reason[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(reason[0])));
    throw OutputError(path.string() + ": cannot be written: " + reason + "; " +
                      remedy(error_number));
}

void write_file(const fs::path& path, std::string_view bytes) {
    const Target target = target_of(path);
    if (target.is_device) {
        // A pipe that nobody reads is refused here, not waited for.
        FileDescriptor device(target.path, O_WRONLY | O_NONBLOCK);
        if (!device.is_open() || ::fcntl(device.get(), F_SETFL, 0) != 0 || !device.write(bytes) ||
            !device.close())
            throw_output_error(path, errno);
        return;
    }
    const auto folder = folder_of(target.path);
    TemporaryFile temporary(folder, target.path.filename().string(), path);
    // Closed last, since that unlocks it.
    if (!temporary.file().write(bytes) || !temporary.file().sync() ||
        !temporary.rename_to(target.path) || !temporary.file().close() || !sync_folder(folder))
        throw_output_error(path, errno);
}

void require_writable(const fs::path& path) {
    const Target target = target_of(path);
    if (!target.is_device) {
        const TemporaryFile probe(folder_of(target.path), target.path.filename().string(), path);
    } else if (::access(target.path.c_str(), W_OK) != 0) {  // not opened: a reader would notice
        throw_output_error(path, errno);
    }
}

void make_output_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw_output_error(folder, error.value());
    // Permissions alone do not tell (root, read-only mounts, quotas): try it.
    const TemporaryFile probe(folder, "probe", folder);
}

void require_output_folder(const fs::path& folder) {
    struct stat status {};
    fs::path nearest = folder;
    while (::stat(nearest.c_str(), &status) != 0) {
        if (errno != ENOENT && errno != ENOTDIR) throw_output_error(folder, errno);
        nearest = folder_of(nearest);
    }
    if (!S_ISDIR(status.st_mode)) throw_output_error(folder, ENOTDIR);
    if (::access(nearest.c_str(), W_OK | X_OK) != 0) throw_output_error(folder, errno);
}

void remove_unfinished_files(const fs::path& folder) {
    std::vector<fs::path> temporaries;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error))
        if (is_temporary(entry->path().filename().string())) temporaries.push_back(entry->path());
    // A folder that may be written to but not read keeps them.
    for (const auto& path : temporaries) remove_if_left(path);
}

void remove_output_file(const fs::path& path) {
    if (::unlink(path.c_str()) != 0 && errno != ENOENT) throw_output_error(path, errno);
}

}  // namespace incise::io
