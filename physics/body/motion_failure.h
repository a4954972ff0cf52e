// Why a body could not be moved on.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "incise/base/error.h"
#include "incise/base/types.h"

namespace incise::physics {

class Model;

/// What is most likely to blame.
enum class FailureCause {
    step_above_bound,       ///< an explicit step is longer than is stable at rest
    constraint_too_fast,    ///< a constraint moved the node that is lost
    load_too_large,         ///< the load on that node is larger than the elastic force
    crushed_element,        ///< an element at that node was crushed or inverted
    stiffened_tissue,       ///< strain has stiffened the tissue
    no_implicit_step,       ///< an implicit step was not solved, nor parts of it
    no_equilibrium,         ///< statics found no equilibrium, nor in small increments
    free_component_loaded,  ///< statics: loads move a connected component that nothing holds
};

/// The motion is lost, or there is none. The text says where, when and why. What to do about it is
/// the caller's to say, who knows what the user can change.
struct MotionFailure : PhysicsError {
    MotionFailure(FailureCause why, const std::string& text) : PhysicsError(text), cause(why) {}
    FailureCause cause;
    ElementId element = {};  ///< one at the place of the failure; invalid if not known
    NodeId node = {};        ///< the node that is lost; invalid if there is none
};

/// The failure of an explicit step that began at `time` and took `dt`, s: of a body whose state is
/// no longer finite, or of which a node has moved too far. Cost: O(#nodes).
MotionFailure failure_of_step(const Model& model, double time, double dt);

}  // namespace incise::physics
