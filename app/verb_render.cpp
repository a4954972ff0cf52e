// incise render: starts incise-render, a separate program that needs the rendering of VTK.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>

#include "incise/app/verbs.h"
#include "incise/base/error.h"

namespace incise::app {

int render(const RenderOptions& options) {
    const auto program =
        std::filesystem::read_symlink("/proc/self/exe").parent_path() / "incise-render";
    std::vector<std::string> words = {program.string()};
    words.insert(words.end(), options.arguments.begin(), options.arguments.end());
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (auto& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::cout.flush();
    ::execv(program.c_str(), arguments.data());
    throw InputError(program.string() + ": cannot be started (" + std::strerror(errno) +
                     "); it is built and installed together with incise: build again");
}

}  // namespace incise::app
