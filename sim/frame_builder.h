// The body as a frame for viewers.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

#include "io/frame.h"
#include "physics/model.h"
#include "sim/scenario.h"

namespace incise::sim {

/// Points at their current positions; always rest_position, node_id, element_id and region, the
/// direction of the fibres at rest if a material has any, and the fields asked for. Ids are labels:
/// the numbers of the source, later ones for later nodes. Cost: O(#nodes + #elements).
io::Frame build_frame(const physics::Model& model, double time, std::span<const Field> fields);

}  // namespace incise::sim
