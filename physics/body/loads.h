// Gravity and loads: forces on nodes, on faces of the boundary and on the volume.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "incise/physics/body/cell_set.h"
#include "incise/physics/body/force_term.h"
#include "incise/physics/body/time_curve.h"
#include "incise/physics/body/vertex_set.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// The same force on each selected node of the mesh. Copies of a node share its force in proportion
/// to the masses of the material at them, so that opening a face neither adds force nor pulls the
/// copies apart. A new node between selected nodes has no share, so that the total force and its
/// distribution stay the same.
struct NodalLoad {
    VertexSet nodes = {};
    Vec3 force = Vec3::Zero();        ///< N, on each node of the first selection
    std::vector<double> shares = {};  ///< of the force, by member; maintained by Loads
    static void archive(auto& ar, auto& self) { ar(self.nodes, self.force, self.shares); }
};

/// A force per rest area, in a fixed direction, on faces of the boundary.
struct TractionLoad {
    FaceSet faces = {};
    Vec3 traction = Vec3::Zero();  ///< Pa
    static void archive(auto& ar, auto& self) { ar(self.faces, self.traction); }
};

/// A pressure on faces of the boundary: a force per current area, against the current normal.
struct PressureLoad {
    FaceSet faces = {};
    double pressure = 0.0;  ///< Pa, positive inwards
    static void archive(auto& ar, auto& self) { ar(self.faces, self.pressure); }
};

/// A force per rest volume of elements.
struct BodyLoad {
    CellSet elements = {};
    Vec3 force = Vec3::Zero();  ///< N/m3
    static void archive(auto& ar, auto& self) { ar(self.elements, self.force); }
};

/// A load on a body, with a factor that depends on time.
struct Load {
    std::string name = {};
    std::variant<NodalLoad, TractionLoad, PressureLoad, BodyLoad> kind = {};
    TimeCurve<double> factor = {};  ///< scales the load; empty: 1

    /// Throws InputError if the load acts on nodes, faces or elements that cannot be in the mesh.
    /// It also throws if a nodal load has another number of shares than of nodes.
    void require_fit(const topology::Mesh& mesh) const;
    static void archive(auto& ar, auto& self) { ar(self.name, self.kind, self.factor); }
};

/// The share of one node of the fragments in a load: a number (nodal loads), m2 (tractions) or m3
/// (body forces). The nodal load is the share times the force of the load.
struct NodalContribution {
    std::uint32_t node;
    double share;
};

/// A face of the mesh under pressure. Its normal points outwards. Its corners are combinations of
/// the corners of one fragment.
struct PressedFace {
    std::size_t num_corners = 0;  ///< 3 or 4
    std::array<fragments::EmbeddedPoint, 4> corners = {};

    Vec3 corner(std::size_t p, std::span<const Vec3> positions) const;
    /// Returns the outward area vector, m2; for a quadrilateral that of its bilinear patch.
    Vec3 area_vector(std::span<const Vec3> positions) const;
};

/// A node of the fragments that takes a part of the force on one corner of a face under pressure.
struct PressedNode {
    std::uint32_t node;
    std::uint32_t face;  ///< its number in the load
    double weight;
};

/// Gravity and all loads on a body. Selections are of the mesh: a load acts on the material that is
/// there. The forces go to the nodes of the fragments, with the weights of the positions.
class Loads final : public ForceTerm {
  public:
    /// Takes gravity, m/s2, and the loads of a body. Nodal loads without shares get their shares
    /// from the masses; those of a restored body keep theirs.
    Loads(const Vec3& gravity, std::vector<Load> loads, const BodyView& body);

    const Vec3& gravity() const { return gravity_; }  ///< m/s2

    std::span<const Load> all() const { return loads_; }
    void set_gravity(const Vec3& gravity) { gravity_ = gravity; }
    void add(Load load, const BodyView& body);
    void set(std::size_t i, Load load, const BodyView& body);
    void remove(std::size_t i);
    void set_factor(std::size_t i, TimeCurve<double> factor) {
        loads_[i].factor = std::move(factor);
    }

    /// Computes the shares of the nodes again after edits and changes of the list of loads.
    /// Cost: proportional to the selections; O(1) if nothing has changed.
    void update(const BodyView& body) override;

    /// Adds gravity and the nodal loads. Removed elements, faces of removed elements, and faces
    /// that are no longer on the boundary carry no load.
    /// Cost: proportional to the nodes of the range.
    /// @pre  update() was called since the last edit or change of the list of loads
    void add_forces(const BodyView& body, NodeRange range, std::span<const Vec3> positions,
                    double time, std::span<Vec3> forces) const override;

    /// Passes the tangents of pressure loads. The other loads do not depend on positions.
    /// @pre  as for add_forces()
    void visit_tangents(std::span<const Vec3> positions, double time,
                        TangentSink& sink) const override;

    /// Follows an edit: parts of loaded faces and elements carry the same load as the whole did.
    void apply(const BodyView& body, const BodyEdit& edit) override;

  private:
    static void share_out(Load& load, const BodyView& body);
    /// A load by nodes, in ascending order, so that a step does not need to read the mesh.
    struct AssembledLoad {
        std::vector<NodalContribution> shares;
        std::vector<PressedFace> faces;
        std::vector<PressedNode> pressed;
    };
    static AssembledLoad assemble(const Load& load, const BodyView& body);

    Vec3 gravity_;
    std::vector<Load> loads_;
    std::vector<AssembledLoad> assembled_;  // by load
    bool is_up_to_date_ = false;            // true if assembled_ agrees with loads_ and the mesh
};

}  // namespace incise::physics
