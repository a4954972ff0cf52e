// What a tool does to the tissue that it touches.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "incise/base/archive.h"
#include "incise/contact/contact_solver.h"
#include "incise/contact/surface_tree.h"
#include "incise/contact/tool_contact_point.h"
#include "incise/contact/tool_impulse.h"
#include "incise/physics/body/model.h"

namespace incise::contact {

/// The contact of a tool that is there with the tissue. Each kind of contact adds its points to the
/// solver of a step, and takes their impulses after it.
class ToolContact {
  public:
    virtual ~ToolContact() = default;

    /// Follows the edits of a step.
    virtual void follow(const physics::Model& model) = 0;
    /// Adds the points of contact at the present positions to the solver.
    /// @param surface  triangles of the body
    /// @param dt       s
    virtual void add_points(const physics::Model& model, const TissueSurface& surface, double dt,
                            ContactSolver& solver) = 0;
    /// Takes the impulses of the points that add_points() added, and returns what the tool exerts
    /// by them.
    /// @param dt  s
    virtual ToolImpulse take_impulses(const ContactSolver& solver, double dt) = 0;
    /// Returns what the tool would exert in this step beyond that, if a force is only reported.
    virtual ToolImpulse reported() const { return {}; }
    /// Returns the largest overlap before the last step, m.
    virtual double max_penetration() const { return 0.0; }
    /// Writes what the next step begins with. Each kind has a restore() of its own.
    virtual void save(ArchiveWriter& ar) const = 0;

    /// Returns the points with a force in the last substep of a step. Threads and blades, whose
    /// force is not at points, have none. A restore() leaves none.
    std::span<const ToolContactPoint> points() const { return points_; }

    /// Counts what the tool has exerted in a step.
    void add(const ToolImpulse& done) { sum_ += done; }
    /// Returns what the tool has exerted since the last call.
    ToolImpulse take_sum() { return std::exchange(sum_, {}); }

  protected:
    ToolContact() = default;
    ToolContact(const ToolContact&) = default;
    ToolContact& operator=(const ToolContact&) = default;

    std::vector<ToolContactPoint> points_;

  private:
    ToolImpulse sum_;
};

}  // namespace incise::contact
