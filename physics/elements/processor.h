// The instruction set of the processor. SIMD kernels are compiled for each one: physics/simd.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace incise::physics {

/// The instruction sets for which kernels are compiled. Each one includes those before it.
enum class Processor { plain, avx2, avx512 };

/// Returns the largest instruction set of this machine.
Processor processor();

/// Returns the one of three functions, compiled from the same source, that suits the processor.
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
