// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/node_lanes.h"

namespace incise::physics {

namespace plain {
MoveFreeNodes move_free_nodes;
}
namespace avx2 {
MoveFreeNodes move_free_nodes;
}
namespace avx512 {
MoveFreeNodes move_free_nodes;
}

MoveFreeNodes* free_node_moves_for(Processor processor) {
    return INCISE_CHOOSE(processor, MoveFreeNodes, move_free_nodes);
}

StepSums move_free_nodes(const FreeNodes& nodes, std::size_t num_nodes, double dt, double slowing) {
    static MoveFreeNodes* const move = free_node_moves_for(processor());
    return move(nodes, num_nodes, dt, slowing);
}

}  // namespace incise::physics
