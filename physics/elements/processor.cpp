// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/processor.h"

namespace incise::physics {

Processor processor() {
#ifdef INCISE_HAS_AVX
    if (!__builtin_cpu_supports("fma")) return Processor::plain;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
        return Processor::avx512;
    if (__builtin_cpu_supports("avx2")) return Processor::avx2;
#endif
    return Processor::plain;
}

}  // namespace incise::physics
