// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/companion.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "incise/base/error.h"

namespace incise::app {

namespace {

/// What the system does to the files of a program before it starts it.
class FileActions {
  public:
    FileActions() { ::posix_spawn_file_actions_init(&actions_); }
    ~FileActions() { ::posix_spawn_file_actions_destroy(&actions_); }
    FileActions(const FileActions&) = delete;
    FileActions& operator=(const FileActions&) = delete;

    /// Lets the descriptor write to the file, if the path is not empty.
    void redirect(int descriptor, const std::filesystem::path& path) {
        constexpr mode_t mode = 0600;
        if (!path.empty())
            ::posix_spawn_file_actions_addopen(&actions_, descriptor, path.c_str(),
                                               O_WRONLY | O_CREAT | O_TRUNC, mode);
    }
    const posix_spawn_file_actions_t* get() const { return &actions_; }

  private:
    posix_spawn_file_actions_t actions_;
};

}  // namespace

int run_companion(const std::string& name, const std::vector<std::string>& arguments,
                  const std::string& remedy, const CompanionOutput& output) {
    const auto beside = std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
    const bool is_beside = ::access(beside.c_str(), X_OK) == 0;
    std::vector<std::string> words = {is_beside ? beside.string() : name};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (auto& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);

    std::cout.flush();
    FileActions files;
    files.redirect(STDOUT_FILENO, output.out);
    files.redirect(STDERR_FILENO, output.err);
    pid_t child = 0;
    // Without a slash in the name this looks in PATH.
    const int error =
        ::posix_spawnp(&child, pointers[0], files.get(), nullptr, pointers.data(), environ);
    if (error != 0)
        throw InputError(name + ": cannot be started, neither from " +
                         beside.parent_path().string() + " nor from PATH (" + std::strerror(error) +
                         "); " + remedy);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) throw std::runtime_error(name + ": " + std::strerror(errno));
    if (WIFEXITED(status)) return WEXITSTATUS(status);
    const int number = WTERMSIG(status);
    if (number == SIGKILL)
        throw MemoryError(name + ": was killed, perhaps for lack of memory; give a larger --size");
    return 128 + number;
}

}  // namespace incise::app
