// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/files/memory.h"

#include <unistd.h>

#include <cmath>

#include "incise/base/error.h"
#include "incise/io/files/number_text.h"

namespace incise::io {

namespace {

std::string gigabytes(double bytes) { return shown(std::round(bytes / 1e8) / 10) + " GB"; }

}  // namespace

std::optional<std::string> lack_of_memory(double bytes) {
    const auto pages = ::sysconf(_SC_PHYS_PAGES), page_size = ::sysconf(_SC_PAGESIZE);
    if (pages <= 0 || page_size <= 0) return std::nullopt;  // the memory is not known
    const double memory = static_cast<double>(pages) * static_cast<double>(page_size);
    if (bytes <= memory) return std::nullopt;
    return "takes " + gigabytes(bytes) + " of memory, and this machine has " + gigabytes(memory);
}

void require_memory(double bytes, std::string_view what, std::string_view remedy) {
    if (const auto lack = lack_of_memory(bytes))
        throw InputError(std::string(what) + " " + *lack + "; " + std::string(remedy));
}

}  // namespace incise::io
