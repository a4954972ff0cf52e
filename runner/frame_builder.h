// Builds frames for viewers from the state of the body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "incise/io/vtk/frame.h"
#include "incise/physics/body/element_snapshot.h"
#include "incise/physics/body/model.h"
#include "incise/scenario/scenario.h"

namespace incise::runner {

/// The forces of contact on the nodes of a mesh, N, at which they are not zero, in ascending order.
using ContactForces = std::vector<std::pair<VertexId, Vec3>>;

/// A builder of one frame. The points of the frame are the current positions. It has the fields
/// rest_position, node_id, element_id, cut_faces and region, and the requested fields. Bit f of
/// cut_faces says that face f of the element, in the order of cell_kind.h, is on a cut. If a
/// material has fibres, it has their directions at rest. node_id and element_id are labels: numbers
/// in the source, and ids for nodes and elements that cuts have added. A frame of a divided body
/// has the carriers at rest, so that it can be read back as that body. With Field::physics it has
/// the arrays of physics::BodyArrays as field data, and the cell array fragment. With
/// Field::tetrahedra all cells are divided: see with_tetrahedra().
///
/// The constructor copies the state of the model, which is fast. finish() then computes the fields
/// of elements.
/// @thread  finish() may run on any thread while the model changes. The object must be created and
///          destroyed on the thread of the model, as physics::ElementSnapshot.
class FrameBuilder {
  public:
    /// @param model   the body
    /// @param time    time of the frame, s
    /// @param fields  the requested fields
    /// @param contact  if not null, the frame has contact_force and contact_pressure
    FrameBuilder(const physics::Model& model, double time, std::span<const scenario::Field> fields,
                 const ContactForces* contact = nullptr);

    /// Returns the frame. Cost: O(#nodes + #elements), as the constructor.
    /// @pre  finish() was not called before
    io::Frame finish();

  private:
    bool has(scenario::Field field) const;
    void add_physics(const physics::Model& model);
    void add_results();
    void add_contact(const physics::Model& model, const std::vector<VertexId>& nodes,
                     const ContactForces& forces);

    std::vector<scenario::Field> fields_;
    std::vector<CellId> cells_;                         // by row
    std::vector<ElementId> fragments_;                  // by row
    std::optional<physics::ElementSnapshot> snapshot_;  // if a field needs it
    io::Frame frame_;
};

/// Builds a frame in one call.
inline io::Frame build_frame(const physics::Model& model, double time,
                             std::span<const scenario::Field> fields,
                             const ContactForces* contact = nullptr) {
    return FrameBuilder(model, time, fields, contact).finish();
}

}  // namespace incise::runner
