// What the processor at hand can do. Fast kernels are compiled for each kind: see lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace incise::physics {

/// Instruction sets that kernels are compiled for, each with all of the ones before.
enum class Processor { plain, avx2, avx512 };

/// The best that the machine has.
Processor processor();

/// The one for the processor of three functions that are compiled from the same text.
template <class Function>
Function* choose(Processor processor, Function* plain, Function* avx2, Function* avx512) {
    switch (processor) {
        case Processor::avx512:
            return avx512;
        case Processor::avx2:
            return avx2;
        default:
            return plain;
    }
}

/// choose() among plain::name, avx2::name and avx512::name, which are functions of type `Function`.
#ifdef INCISE_HAS_AVX
#define INCISE_CHOOSE(processor, Function, name) \
    choose<Function>(processor, plain::name, avx2::name, avx512::name)
#else
#define INCISE_CHOOSE(processor, Function, name) \
    choose<Function>(processor, plain::name, plain::name, plain::name)
#endif

}  // namespace incise::physics
