// The error that is thrown when a body cannot be moved on, with its likely cause.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "incise/base/error.h"
#include "incise/base/types.h"

namespace incise::physics {

class Model;

/// The most likely cause of a failure. The lost node is MotionFailure::vertex.
enum class FailureCause {
    step_above_bound,       ///< an explicit step was above the stable step
    constraint_too_fast,    ///< a constraint moved the lost node
    load_too_large,         ///< the outer force on the lost node was larger than the elastic force
    crushed_element,        ///< an element at the lost node was crushed or inverted
    stiffened_tissue,       ///< strain has stiffened the tissue
    no_implicit_step,       ///< neither an implicit step nor parts of it were solved
    no_equilibrium,         ///< statics found no equilibrium, even in small increments
    free_component_loaded,  ///< statics: loads move a connected component without constraints
};

/// Thrown if a step fails: the state is no longer finite, a node has moved too far, or a solver
/// finds no solution. The text tells where and when this happened, and the likely cause. The caller
/// adds the remedy.
struct MotionFailure : PhysicsError {
    MotionFailure(FailureCause why, const std::string& text) : PhysicsError(text), cause(why) {}
    FailureCause cause;
    CellId cell = {};      ///< a cell at the failure; invalid if not known
    VertexId vertex = {};  ///< the one that is not finite or moved too far; invalid if none
};

/// Returns the failure of an explicit step after which the state is not finite or a node has moved
/// too far. Cost: O(#nodes).
/// @param model  after the step
/// @param time   the beginning of the step, s
/// @param dt     the length of the step, s
MotionFailure failure_of_step(const Model& model, double time, double dt);

}  // namespace incise::physics
