// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/companion.h"

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

int run_companion(const std::string& name, const std::vector<std::string>& arguments,
                  const std::string& remedy) {
    const auto beside = std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
    const bool is_beside = ::access(beside.c_str(), X_OK) == 0;
    std::vector<std::string> words = {is_beside ? beside.string() : name};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (auto& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);

    std::cout.flush();
    pid_t child = 0;
    // Without a slash in the name this looks in PATH.
    const int error =
        ::posix_spawnp(&child, pointers[0], nullptr, nullptr, pointers.data(), environ);
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
