// What is right and what is a finding when a file is read.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "incise/base/error.h"

namespace incise::fuzz {

/// Stops the program, as fuzzers want it, unless the complaint is empty.
inline void require_none(const std::string& complaint) {
    if (complaint.empty()) return;
    std::fprintf(stderr, "finding: %s\n", complaint.c_str());
    std::abort();
}

/// Calls `read`, which may throw InputError with a message that begins with `file`.
template <class Read>
void read_or_refuse(const std::string& file, const Read& read) {
    try {
        read();
    } catch (const InputError& error) {
        if (!std::string_view(error.what()).starts_with(file))
            require_none(std::string("the refusal does not name the file: ") + error.what());
    }
}

}  // namespace incise::fuzz
