// The body as a frame for viewers.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "incise/io/vtk/frame.h"
#include "incise/physics/body/element_snapshot.h"
#include "incise/physics/body/model.h"
#include "incise/scenario/scenario.h"

namespace incise::runner {

/// Points at their current positions; always rest_position, node_id, element_id and region, the
/// direction of the fibres at rest if a material has any, and the fields asked for. Ids are labels:
/// the numbers of the source, later ones for later nodes.
/// In two parts: the first copies what the model has, which takes little; the second computes what
/// elements do, on any thread, while the model goes on.
class FrameBuilder {
  public:
    /// As physics::ElementSnapshot is destroyed on the thread of the model.
    FrameBuilder(const physics::Model& model, double time, std::span<const scenario::Field> fields);

    /// Hands the frame over: once. Cost: O(#nodes + #elements), like that of the first part.
    io::Frame finish();

  private:
    bool has(scenario::Field field) const;

    std::vector<scenario::Field> fields_;
    std::vector<ElementId> elements_;                   // by row
    std::optional<physics::ElementSnapshot> snapshot_;  // if a field asks for it
    io::Frame frame_;
};

/// Both at once.
inline io::Frame build_frame(const physics::Model& model, double time,
                             std::span<const scenario::Field> fields) {
    return FrameBuilder(model, time, fields).finish();
}

}  // namespace incise::runner
