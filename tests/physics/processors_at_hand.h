// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/physics/elements/processor.h"

namespace incise::physics {

/// The kinds of processor, each with its own kernels, that the machine can stand for.
inline std::vector<Processor> processors_at_hand() {
    std::vector<Processor> all{Processor::plain, Processor::avx2, Processor::avx512};
    while (all.back() > processor()) all.pop_back();
    return all;
}

}  // namespace incise::physics
