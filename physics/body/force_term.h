// Forces on the nodes of a body other than those of its own elements: what acts from outside.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

#include "incise/physics/elements/element_store.h"
#include "incise/physics/elements/state.h"
#include "incise/physics/elements/workers.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// What a term of the forces may read of the body.
struct BodyView {
    const topology::Mesh& mesh;
    const ElementStore& elements;
    std::span<const double> masses;  ///< lumped, kg, by node id
};

/// One term of the forces from outside, such as the loads. Its work counts as external work. It is
/// a function of positions and time alone, so that each solver can ask for it anywhere. Statics
/// does not take it for what holds a piece of the body: constraints must do that.
class ForceTerm {
  public:
    virtual ~ForceTerm() = default;

    /// Prepares for add_forces() and visit_tangents() on the body as it is; called before these
    /// after each edit, and before each step.
    virtual void update(const BodyView&) {}

    /// Adds the forces, N, at `time`, s, on the nodes of a range.
    /// @param positions current, m, by node id
    /// @param forces    N, by node id
    /// @thread different ranges at the same time
    virtual void add_forces(const BodyView& body, NodeRange range, std::span<const Vec3> positions,
                            double time, std::span<Vec3> forces) const = 0;

    /// Hands over the symmetric part of minus the derivative of the forces by the positions; for
    /// implicit steps and statics. Nothing if the forces do not depend on positions.
    virtual void visit_tangents(std::span<const Vec3> /*positions*/, double /*time*/,
                                TangentSink&) const {}

    /// What the term adds to the bound on the stiffness of a node, N/m, of which the stable step of
    /// explicit steps is found: at least the sum of a row of absolute values of the derivative. It
    /// may change with edits only.
    virtual double stiffness_bound(NodeId) const { return 0.0; }

    /// Follows an edit that the body has followed.
    /// @param touched nodes whose mass may have changed, in ascending order
    virtual void apply(const BodyView& body, const topology::ChangeSet& changes,
                       std::span<const NodeId> touched) = 0;
};

}  // namespace incise::physics
