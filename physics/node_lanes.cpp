// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/node_lanes.h"

namespace incise::physics {

namespace plain {
MoveFreeNodes move_free_nodes;
}
#ifdef INCISE_HAS_AVX
namespace avx2 {
MoveFreeNodes move_free_nodes;
}
namespace avx512 {
MoveFreeNodes move_free_nodes;
}
#endif

MoveFreeNodes* free_node_moves_for([[maybe_unused]] Processor processor) {
#ifdef INCISE_HAS_AVX
    if (processor == Processor::avx512) return avx512::move_free_nodes;
    if (processor == Processor::avx2) return avx2::move_free_nodes;
#endif
    return plain::move_free_nodes;
}

StepSums move_free_nodes(const FreeNodes& nodes, std::size_t num_nodes, double dt, double slowing) {
    static MoveFreeNodes* const move = free_node_moves_for(processor());
    return move(nodes, num_nodes, dt, slowing);
}

}  // namespace incise::physics
