// Forces from outside: on nodes, on faces of the surface, on the volume.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "incise/physics/body/element_set.h"
#include "incise/physics/body/force_term.h"
#include "incise/physics/body/node_set.h"
#include "incise/physics/body/time_curve.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// The same force, N, on each selected node. Copies of a node share its force by mass, so that
/// opening a face neither adds force nor tears the copies apart. A node born between selected ones
/// has no share: the force stays what it was, and where it was.
struct NodalLoad {
    NodeSet nodes = {};
    Vec3 force = Vec3::Zero();
    std::vector<double> shares = {};  ///< of the nodes' members; Loads keeps it
    static void archive(auto& ar, auto& self) { ar(self.nodes, self.force, self.shares); }
};

/// Force per rest area, Pa, in a fixed direction, on faces of the boundary.
struct TractionLoad {
    FaceSet faces = {};
    Vec3 traction = Vec3::Zero();
    static void archive(auto& ar, auto& self) { ar(self.faces, self.traction); }
};

/// Pressure, Pa, positive inwards, on the current area along the current normal.
struct PressureLoad {
    FaceSet faces = {};
    double pressure = 0.0;
    static void archive(auto& ar, auto& self) { ar(self.faces, self.pressure); }
};

/// Force per rest volume, N/m3.
struct BodyLoad {
    ElementSet elements = {};
    Vec3 force = Vec3::Zero();
    static void archive(auto& ar, auto& self) { ar(self.elements, self.force); }
};

struct Load {
    std::string name = {};
    std::variant<NodalLoad, TractionLoad, PressureLoad, BodyLoad> kind = {};
    TimeCurve<double> factor = {};  ///< scales the load in time; empty: 1

    /// Throws InputError if it acts on what cannot be in the mesh.
    void require_fit(const topology::Mesh& mesh) const;
    static void archive(auto& ar, auto& self) { ar(self.name, self.kind, self.factor); }
};

/// What one node has of all that a load acts on: a part of the members (nodal forces), m2
/// (traction) or m3 (body forces).
struct NodalContribution {
    std::uint32_t node;
    double share;
};

/// A corner of a face under pressure, with all of the face's corners.
struct PressedCorner {
    std::uint32_t node;
    std::uint32_t num_corners;  ///< 3 or 4
    std::array<std::uint32_t, 4> corners;
};

/// Gravity and all loads on a body.
class Loads final : public ForceTerm {
  public:
    /// Nodal loads that have shares keep them: those of a body that goes on.
    /// @param gravity m/s2
    Loads(const Vec3& gravity, std::vector<Load> loads, const BodyView& body);

    const Vec3& gravity() const { return gravity_; }  ///< m/s2

    std::span<const Load> all() const { return loads_; }
    void add(Load load, const BodyView& body);
    void remove(std::size_t i);
    void set_factor(std::size_t i, TimeCurve<double> factor) {
        loads_[i].factor = std::move(factor);
    }

    /// Finds what nodes bear, if there were edits.
    /// Cost: nothing without edits, else in proportion to the selections.
    void update(const BodyView& body) override;

    /// Faces and elements that are gone, and faces that have come to lie inside, carry nothing.
    /// Cost: proportional to the nodes of the range.
    void add_forces(const BodyView& body, NodeRange range, std::span<const Vec3> positions,
                    double time, std::span<Vec3> forces) const override;

    /// Of pressure, as the others do not depend on positions.
    void visit_tangents(std::span<const Vec3> positions, double time,
                        TangentSink& sink) const override;

    /// Carries the selections through an edit: parts of loaded faces and elements are loaded as
    /// these were.
    void apply(const BodyView& body, const topology::ChangeSet& changes,
               std::span<const NodeId> touched) override;

  private:
    static void share_out(Load& load, const BodyView& body);
    /// What nodes bear of a load, in ascending order of these: a step does not look into the mesh.
    struct AssembledLoad {
        std::vector<NodalContribution> shares;
        std::vector<PressedCorner> pressed;
    };
    static AssembledLoad assemble(const Load& load, const BodyView& body);

    Vec3 gravity_;
    std::vector<Load> loads_;
    std::vector<AssembledLoad> assembled_;  // of each load
    bool is_up_to_date_ = false;            // the burdens, with the mesh
};

}  // namespace incise::physics
