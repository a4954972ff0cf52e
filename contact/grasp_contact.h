// A grasp of the surface of a body by the jaws of a tool.
// Source: docs/theory.md, Contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
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
#include "incise/topology/pose.h"

namespace incise::contact {

/// Points of the surface that jaws hold. Each moves with the jaws, as long as that takes no more
/// than its share of the largest force. Above it the point slips, and one that leaves the jaws is
/// let go.
class GraspContact final : public ToolContact {
  public:
    /// @param size  mean length of an element at rest, m
    GraspContact(cutting::Grasper grasper, double size)
        : grasper_(std::move(grasper)), size_(size) {}

    /// Sets the motion of the jaws in the next step.
    void move(const Pose& before, const Pose& after) {
        before_ = before;
        after_ = after;
    }
    /// Takes hold of the nodes of a surface that are in the jaws; without any, of the points of its
    /// triangles that are deepest in them, or in the middle of what is in a box. Cost: O(n) in the
    /// triangles.
    void close(const physics::Model& model, const TissueSurface& surface, const Pose& pose);
    void open() {
        gripped_.clear();
        points_.clear();
    }
    std::size_t num_gripped() const { return gripped_.size(); }
    /// Lets go what an edit has removed.
    void follow(const physics::Model& model) override;
    /// The points are those that are gripped.
    void add_points(const physics::Model& model, const TissueSurface& surface, double dt,
                    ContactSolver& solver) override;
    ToolImpulse take_impulses(const ContactSolver& solver, double dt) override;

    void save(ArchiveWriter& ar) const override { list(ar, *this); }
    /// Restores what save() wrote. Throws InputError for the data of another body.
    void restore(ArchiveReader& ar, const physics::Model& model);

  private:
    /// A point of the surface.
    struct Gripped {
        std::array<VertexId, 3> nodes;  ///< of the mesh
        Vec3 weights;                   ///< of them; a node has the weight 1
        Vec3 place;                     ///< in the frame of the jaws, m
        int region;                     ///< of the tissue
        Vec3 impulse = Vec3::Zero();    ///< of the last step, N s
        static void archive(auto& ar, auto& self) {
            ar(self.nodes, self.weights, self.place, self.region, self.impulse);
        }
    };
    static void list(auto& ar, auto& self) { ar(self.gripped_); }
    Vec3 position_of(const Gripped& gripped, std::span<const Vec3> positions) const;

    cutting::Grasper grasper_;
    double size_;
    Pose before_, after_;
    std::vector<Gripped> gripped_;
    std::size_t first_point_ = 0;  // in the solver
};

}  // namespace incise::contact
