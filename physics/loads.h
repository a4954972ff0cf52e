// Forces from outside: on nodes, on faces of the surface, on the volume.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <variant>
#include <vector>

#include "physics/element_set.h"
#include "physics/element_store.h"
#include "physics/node_set.h"
#include "physics/time_curve.h"
#include "topology/mesh.h"

namespace incise::physics {

/// The same force, N, on each selected node. Copies of a node share its force by mass, so that
/// opening a face neither adds force nor tears the copies apart. A node born between selected ones
/// has no share: the force stays what it was, and where it was.
struct NodalLoad {
    NodeSet nodes;
    Vec3 force;
    std::vector<double> shares;  ///< of the nodes' members; Loads keeps it
};

/// Force per rest area, Pa, in a fixed direction, on faces of the boundary.
struct TractionLoad {
    FaceSet faces;
    Vec3 traction;
};

/// Pressure, Pa, positive inwards, on the current area along the current normal.
struct PressureLoad {
    FaceSet faces;
    double pressure;
};

/// Force per rest volume, N/m3.
struct BodyLoad {
    ElementSet elements;
    Vec3 force;
};

struct Load {
    std::string name;
    std::variant<NodalLoad, TractionLoad, PressureLoad, BodyLoad> kind;
    TimeCurve<double> factor;  ///< scales the load in time; empty: 1
};

/// What the loads need to know of the body.
struct LoadedBody {
    const topology::Mesh& mesh;
    const ElementStore& elements;
    std::span<const Vec3> positions;  ///< current, m, by node id
    std::span<const double> masses;   ///< lumped, kg, by node id
};

/// All loads on a body.
class Loads {
  public:
    Loads(std::vector<Load> loads, const LoadedBody& body);

    /// Adds the nodal forces (N, by node id) at `time`. Faces and elements that are gone, and
    /// faces that have come to lie inside, carry nothing. Cost: proportional to the selections.
    void add(const LoadedBody& body, double time, std::span<Vec3> forces) const;

    /// Hands over the symmetric part of minus the derivative of the forces by the positions: of
    /// pressure, as the others do not depend on these.
    void visit_tangents(const LoadedBody& body, double time, TangentSink& sink) const;

    /// Carries the selections through an edit that the body has followed: parts of loaded faces and
    /// elements are loaded as these were.
    /// @param touched nodes whose mass may have changed
    void apply(const topology::ChangeSet& changes, const LoadedBody& body,
               std::span<const topology::NodeId> touched);

  private:
    std::vector<Load> loads_;
};

}  // namespace incise::physics
