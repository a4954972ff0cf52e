// Interface of outer forces: forces on the nodes of a body other than those of its elements.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

#include "incise/base/types.h"
#include "incise/physics/body/body_edit.h"
#include "incise/physics/elements/workers.h"

namespace incise::physics {

/// One term of the outer forces, such as the loads.
///
/// The forces depend only on positions and time, so that each solver can compute them at any
/// positions. Their work counts as external work. Statics does not regard a force term as a support
/// of a connected component: only constraints can hold it.
class ForceTerm {
  public:
    virtual ~ForceTerm() = default;

    /// Prepares add_forces() and visit_tangents() for the current body. The model calls it before
    /// these, at least once after each edit and once in each step.
    virtual void update(const BodyView&) {}

    /// Adds the forces at `time`, s, on the nodes of a range.
    /// @param body       the body
    /// @param range      nodes of the fragments
    /// @param positions  current, m, by node of the fragments
    /// @param time       s
    /// @param forces     N, by node of the fragments; added to
    /// @thread Several threads may call it at the same time, for different ranges.
    virtual void add_forces(const BodyView& body, NodeRange range, std::span<const Vec3> positions,
                            double time, std::span<Vec3> forces) const = 0;

    /// Passes the symmetric part of the tangent (minus the derivative of the forces by the
    /// positions) to the sink, for implicit steps and statics. By default, it passes nothing, as is
    /// right for forces that do not depend on positions.
    virtual void visit_tangents(std::span<const Vec3> /*positions*/, double /*time*/,
                                TangentSink&) const {}

    /// Returns the contribution of the term to the bound on the stiffness of a node, N/m, which
    /// gives the stable step. For each component of the node, it must be at least the sum of the
    /// absolute values in that row of the derivative. It may change only with edits.
    virtual double stiffness_bound(NodeId) const { return 0.0; }

    /// Follows an edit that the body has followed.
    /// @param body  the body after the edit
    /// @param edit  the record of the edit
    virtual void apply(const BodyView& body, const BodyEdit& edit) = 0;
};

}  // namespace incise::physics
