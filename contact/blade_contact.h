// The force that it takes to cut, at the edge of a blade.
// Source: Atkins, Xu, Jeronimidis 2004; Azar, Hayward 2008. Equations: docs/theory.md, Contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "incise/base/archive.h"
#include "incise/contact/contact_solver.h"
#include "incise/contact/surface_tree.h"
#include "incise/contact/tool_contact.h"
#include "incise/cutting/tools/tool.h"
#include "incise/physics/body/model.h"
#include "incise/topology/cell_point.h"
#include "incise/topology/pose.h"

namespace incise::contact {

/// Finds the point of the tissue that is at a position, m; nothing if there is none.
using TissueAt = std::function<std::optional<topology::CellPoint>(const Vec3&)>;

/// Returns why the force of a blade cannot be applied to a body; empty if it can, or if it is only
/// reported. The toughness may be 1.5 times the least Young's modulus at rest of the materials,
/// times the mean length of an element. Above it the tissue at the edge gives way by more than an
/// element before it is cut, and elements are crushed.
/// @param size  mean length of an element at rest, m
std::string fault_of_toughness(const cutting::Blade& blade, const physics::MaterialTable& materials,
                               double size);

/// The force of the tissue on the edge of a blade. A piece of the edge that opens an area takes the
/// toughness times that area. So its force against its way is the toughness times its width, seen
/// along its way: a piece that slides along itself opens nothing.
///
/// If the force is applied, a piece carries the tissue at it along until that takes more than its
/// force; then the tissue slips past the piece, and is cut.
class BladeContact final : public ToolContact {
  public:
    /// @param size  mean length of an element at rest, m: pieces are parts of it
    BladeContact(cutting::Blade blade, double size);

    /// Sets the motion of the blade in the next step, and finds the tissue at its edge.
    void move(const physics::Model& model, const Pose& before, const Pose& after,
              const TissueAt& tissue_at);
    void follow(const physics::Model&) override {}
    /// Adds the points at which the force is applied to the solver, or sums what is reported.
    void add_points(const physics::Model& model, const TissueSurface& surface, double dt,
                    ContactSolver& solver) override;
    ToolImpulse take_impulses(const ContactSolver& solver, double dt) override;
    ToolImpulse reported() const override { return reported_; }

    void save(ArchiveWriter& ar) const override { list(ar, *this); }
    /// Restores what save() wrote. Throws InputError for the data of another blade.
    void restore(ArchiveReader& ar);

  private:
    /// A short part of the edge.
    struct Piece {
        Vec3 middle, along;  ///< in the frame of the blade, m
    };
    /// A piece that cuts in the step.
    struct Cutting {
        std::size_t piece;
        topology::CellPoint tissue;
        Vec3 place, motion;  ///< m
        double width;        ///< across its way, m
    };
    static void list(auto& ar, auto& self) { ar(self.directions_, self.impulses_); }

    cutting::Blade blade_;
    double size_;
    Pose before_;
    std::vector<Piece> pieces_;
    std::vector<Vec3> directions_;  // by piece, in which it last moved; zero before it has
    std::vector<double> impulses_;  // by piece, of the last step, N s
    std::vector<Cutting> cutting_;  // in the present step
    ToolImpulse reported_;
    std::size_t first_point_ = 0;  // in the solver
};

}  // namespace incise::contact
