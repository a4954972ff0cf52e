// What the processor at hand can do. Fast kernels are compiled for each kind: see lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace incise::physics {

/// Instruction sets that kernels are compiled for, each with all of the ones before.
enum class Processor { plain, avx2, avx512 };

/// The best that the machine has.
Processor processor();

}  // namespace incise::physics
