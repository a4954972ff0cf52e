// The pull of a thread through the tissue.
// Source: docs/theory.md, Contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
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

/// A thread that passes through points of the tissue without friction. It pulls them together as
/// soon as its way is longer than it is itself.
class SutureContact final : public ToolContact {
  public:
    /// @param size  mean length of an element at rest, m
    SutureContact(cutting::Suture suture, double size) : suture_(std::move(suture)), size_(size) {}

    /// Passes the thread through the tissue. It is then as long as its way. A point without tissue
    /// in reach is left out. Cost: O(n) for each point.
    void tie(const physics::Model& model);
    /// Sets the length at the end of the next step, m.
    void draw(double length) { length_ = length; }
    /// Returns the length of the thread without tension, m.
    double length() const { return length_; }
    /// Returns through how many points the thread passes. It pulls if there are two or more.
    std::size_t num_gripped() const { return stitches_.size(); }
    /// Follows an edit. A point that an edit has removed is left out from then on.
    void follow(const physics::Model& model) override;
    /// Adds the thread to the solver.
    void add_points(const physics::Model& model, const TissueSurface& surface, double dt,
                    ContactSolver& solver) override;
    /// Returns the pull of the thread on its first point. A thread that has borne its largest force
    /// tears.
    ToolImpulse take_impulses(const ContactSolver& solver, double dt) override;

    void save(ArchiveWriter& ar) const override { list(ar, *this); }
    /// Restores what save() wrote. Throws InputError for the data of another body.
    void restore(ArchiveReader& ar, const physics::Model& model);

  private:
    /// Where the thread passes through the tissue.
    struct Stitch {
        Vec3 rest;  ///< m
        topology::CellPoint at;
        Vec3 force = Vec3::Zero();  ///< of the segment to the next one in the last step, N
        static void archive(auto& ar, auto& self) { ar(self.rest, self.at, self.force); }
    };
    static void list(auto& ar, auto& self) { ar(self.stitches_, self.length_, self.tension_); }
    std::vector<Vec3> way(const physics::Model& model) const;

    cutting::Suture suture_;
    double size_;
    std::vector<Stitch> stitches_;
    double length_ = 0.0;   // m
    double tension_ = 0.0;  // of the last step, N
    bool is_in_solver_ = false;
    std::size_t thread_ = 0, first_segment_ = 0;  // in the solver
};

}  // namespace incise::contact
