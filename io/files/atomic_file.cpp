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
#include <set>
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

/// The separator between the name of a file and the number of the process that writes it.
constexpr std::string_view temporary_mark = ".tmp";

/// True if the name is one of a TemporaryFile: ".NAME.tmpPROCESS-ATTEMPT".
bool is_temporary(const std::string& name) {
    const auto mark = name.rfind(temporary_mark);
    if (!name.starts_with('.') || mark == name.npos) return false;
    const auto numbers = std::string_view(name).substr(mark + temporary_mark.size());
    const auto dash = numbers.find('-');
    return dash != numbers.npos && parse_number<pid_t>(numbers.substr(0, dash)) &&
           parse_number<int>(numbers.substr(dash + 1));
}

/// An object that blocks SIGINT, SIGTERM and SIGHUP in this thread during its lifetime.
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

/// Waits for the lock of an open file, if the file system has locks. Returns false if the file has
/// been removed meanwhile: remove_if_left() may find it between its creation and its lock.
bool lock(const FileDescriptor& file) {
    while (::flock(file.get(), LOCK_EX) != 0 && errno == EINTR) {
    }
    struct stat status {};
    return ::fstat(file.get(), &status) != 0 || status.st_nlink > 0;
}

/// A new hidden file in a folder. It is removed at the end of its lifetime unless it is renamed.
///
/// The file is locked while it is written. The system releases the lock when the process ends, so
/// that files of killed processes are not locked. The process number in the name does not identify
/// such files, since another process may get the same number later.
class TemporaryFile {
  public:
    /// Throws OutputError about `meant` if the file cannot be made.
    TemporaryFile(const fs::path& folder, const std::string& name, const fs::path& meant) {
        // Files of a killed process with the same number may exist.
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

    /// Returns false, with errno set, if it fails.
    bool rename_to(const fs::path& target) {
        is_kept_ = ::rename(path_.c_str(), target.c_str()) == 0;
        return is_kept_;
    }

  private:
    SignalsPutOff signals_put_off_;  // they would end the process before the file is removed
    fs::path path_;
    FileDescriptor file_;
    bool is_kept_ = false;
};

/// Removes a temporary file unless a process is writing it. Keeps it also if that cannot be
/// determined: if it cannot be opened, or if the file system has no locks.
void remove_if_left(const fs::path& temporary) {
    const FileDescriptor file(temporary, O_WRONLY | O_NONBLOCK);
    if (file.is_open() && ::flock(file.get(), LOCK_EX | LOCK_NB) == 0)
        remove_output_file(temporary);  // while locked: else it could be a new file by now
}

/// Returns the final target of a symbolic link, which need not exist.
fs::path follow_links(fs::path path) {
    constexpr int most_links = 40;  // the limit of the kernel
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
    bool is_device;  ///< true for a device or a pipe, which no file may replace
};

/// Throws OutputError if the path is a folder.
Target target_of(const fs::path& path) {
    struct stat status {};
    const bool is_there = ::stat(path.c_str(), &status) == 0;
    if (is_there && S_ISDIR(status.st_mode)) throw_output_error(path, EISDIR);
    // Links of the system to pipes, such as /dev/stdout, cannot be followed by name.
    if (is_there && !S_ISREG(status.st_mode)) return {path, true};
    Target target{follow_links(path), false};
    if (!target.path.has_filename()) throw_output_error(path, EISDIR);
    return target;
}

/// Waits until a rename in the folder is on the disk. A folder that is writable but not readable
/// cannot be synchronised. This is no error, since the file exists.
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

void write_file(const fs::path& path, std::string_view bytes, OnDisk on_disk) {
    const Target target = target_of(path);
    if (target.is_device) {
        // With O_NONBLOCK, opening a pipe without a reader fails instead of waiting.
        FileDescriptor device(target.path, O_WRONLY | O_NONBLOCK);
        if (!device.is_open() || ::fcntl(device.get(), F_SETFL, 0) != 0 || !device.write(bytes) ||
            !device.close())
            throw_output_error(path, errno);
        return;
    }
    const auto folder = folder_of(target.path);
    TemporaryFile temporary(folder, target.path.filename().string(), path);
    const bool waits = on_disk == OnDisk::now;
    // Closed after the rename, since closing releases the lock.
    if (!temporary.file().write(bytes) || (waits && !temporary.file().sync()) ||
        !temporary.rename_to(target.path) || !temporary.file().close() ||
        (waits && !sync_folder(folder)))
        throw_output_error(path, errno);
}

void sync_files(std::span<const fs::path> paths) {
    std::set<fs::path> folders;
    for (const fs::path& path : paths) {
        FileDescriptor file(path, O_RDONLY);
        if (!file.is_open()) {
            if (errno == ENOENT) continue;
            throw_output_error(path, errno);
        }
        if (!file.sync() || !file.close()) throw_output_error(path, errno);
        folders.insert(folder_of(follow_links(path)));
    }
    for (const fs::path& folder : folders)
        if (!sync_folder(folder)) throw_output_error(folder, errno);
}

void require_writable(const fs::path& path) {
    const Target target = target_of(path);
    if (!target.is_device) {
        const TemporaryFile probe(folder_of(target.path), target.path.filename().string(), path);
    } else if (::access(target.path.c_str(), W_OK) != 0) {  // opening would disturb a reader
        throw_output_error(path, errno);
    }
}

void make_output_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw_output_error(folder, error.value());
    // Permissions are not enough (root, read-only mounts, quotas).
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
    // A folder that cannot be read keeps its temporary files.
    for (const auto& path : temporaries) remove_if_left(path);
}

void remove_output_file(const fs::path& path) {
    if (::unlink(path.c_str()) != 0 && errno != ENOENT) throw_output_error(path, errno);
}

}  // namespace incise::io
