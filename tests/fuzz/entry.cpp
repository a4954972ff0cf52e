// What libFuzzer calls. Compiled once a target, which INCISE_FUZZ_TARGET names.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    incise::fuzz::INCISE_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
    return 0;
}
