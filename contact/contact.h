// Contact as a part of an explicit step.
// Source: docs/theory.md, Contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "incise/contact/contact_solver.h"
#include "incise/contact/surface_contact.h"
#include "incise/contact/tool_contact.h"
#include "incise/physics/solve/integrator.h"
#include "incise/topology/boundary_surface.h"

namespace incise::contact {

/// Contact in the steps of a body: of its surface with itself, and with rigid tools. Its impulses
/// keep linear momentum to rounding. They take energy, and give none but the work of the tools, to
/// the order of the step.
class Contact final : public physics::VelocityProjection {
  public:
    /// @param size  mean length of an element at rest, m
    Contact(const ContactSettings& settings, double size) : tissue_(settings, size) {}

    /// Follows the edits of a step, or begins.
    /// @param surface  of the body
    void follow(const physics::Model& model, const topology::BoundarySurface& surface) {
        tissue_.follow(model, surface);
    }
    /// Begins the list of the tools that touch the tissue in the next step.
    void begin_tools() { tools_.clear(); }
    /// Adds a tool to the list. It must live until that step is over.
    void add_tool(ToolContact& tool) { tools_.push_back(&tool); }
    /// Counts the work of the impulses of the last step: that of the tools as external, the rest as
    /// dissipated. Call it after each step.
    void book_work(physics::Model& model);

    bool prepare(const physics::Model& model, double time, double dt) override;
    void project(physics::Model& model, physics::ExplicitStep& step, double time,
                 double dt) override;

    /// Returns the triangles of the body.
    TissueSurface surface() const { return tissue_.surface(); }
    const ContactSettings& settings() const { return tissue_.settings(); }
    double size() const { return tissue_.size(); }
    /// Returns the number of points of contact with an impulse in the last step.
    std::size_t num_points() const { return num_points_; }
    /// Returns the largest overlap before the last step, m.
    double max_penetration() const { return max_penetration_; }
    /// Returns the energy that contact has taken since the start, J.
    double dissipation() const { return dissipation_; }
    /// Returns the energy that it has taken to cut since the start, as far as blades have a
    /// toughness, J. It is part of the balance of energy if the force of cutting is applied.
    double fracture_energy() const { return fracture_energy_; }
    /// Returns what the points of contact exerted in the last step, N, at the nodes of the mesh at
    /// which it is not zero, in ascending order of the nodes. Cost: O(n log n) in the points.
    std::vector<std::pair<VertexId, Vec3>> node_forces() const;
    const ContactSolver& solver() const { return solver_; }

    void save(ArchiveWriter& ar) const;
    /// Restores what save() wrote.
    /// @pre  model and surface are those of the saved state
    void restore(ArchiveReader& ar, const physics::Model& model,
                 const topology::BoundarySurface& surface);

  private:
    void take_impulses(double dt);
    double normal_work(const physics::Model& model) const;
    SurfaceContact tissue_;
    std::vector<ToolContact*> tools_;  // of a step
    ContactSolver solver_{tissue_.size()};
    std::size_t num_points_ = 0;
    double max_penetration_ = 0.0;  // m
    double tool_work_ = 0.0;        // of the last step, J
    double fracture_ = 0.0;         // of the last step, within the balance, J
    double dissipation_ = 0.0;      // J
    double fracture_energy_ = 0.0;  // J
    double last_dt_ = 0.0;          // s; 0 after a restore
    /// What normal impulses have taken of late, less what they have given, J. While it is below 0,
    /// overlaps stay. So pushing them out cannot keep the body in motion.
    double spare_energy_ = 0.0;
    std::vector<Vec3> start_velocities_;                      // of a step, by number in the solver
    std::vector<std::pair<VertexId, Vec3>> restored_forces_;  // as node_forces() then returns them
    std::vector<Vec3> inverse_masses_, impulses_;             // scratch, by node of the fragments
};

}  // namespace incise::contact
