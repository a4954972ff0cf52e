// The program, run in a folder of its own as a shell would.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "support/temporary_folder.h"

namespace incise::test {

struct Outcome {
    int status = -1;
    std::string out, err;
};

class InFolder : public testing::Test {
  protected:
    void write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name) << text;
    }

    /// Runs the program in the folder; the arguments are words of a shell.
    /// @param environment  such as "PATH=bin"
    Outcome run(const std::string& arguments, const std::string& program = INCISE_PROGRAM,
                const std::string& environment = "") {
        const auto out = folder_ / "stdout", err = folder_ / "stderr";
        const std::string line = "cd '" + folder_.path().string() + "' && " + environment + " '" +
                                 program + "' " + arguments + " >'" + out.string() + "' 2>'" +
                                 err.string() + "'";
        const int result = std::system(line.c_str());
        return {WIFEXITED(result) ? WEXITSTATUS(result) : -1, support::read_text(out),
                support::read_text(err)};
    }

    support::TemporaryFolder folder_;
};

}  // namespace incise::test
