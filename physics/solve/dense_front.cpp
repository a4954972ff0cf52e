// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/dense_front.h"

namespace incise::physics {

using GetKernels = const FrontKernels&();
namespace plain {
GetKernels front_kernels;
}
namespace avx2 {
GetKernels front_kernels;
}
namespace avx512 {
GetKernels front_kernels;
}

const FrontKernels& front_kernels_for(Processor processor) {
    return INCISE_CHOOSE(processor, GetKernels, front_kernels)();
}

}  // namespace incise::physics
