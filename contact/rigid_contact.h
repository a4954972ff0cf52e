// Contact between the surface of a body and a rigid tool.
// Source: docs/theory.md, Contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "incise/base/archive.h"
#include "incise/contact/contact_solver.h"
#include "incise/contact/rigid_solid.h"
#include "incise/contact/rigid_touch.h"
#include "incise/contact/surface_contact.h"
#include "incise/contact/tool_contact.h"
#include "incise/cutting/tools/tool.h"
#include "incise/physics/body/model.h"
#include "incise/topology/pose.h"

namespace incise::contact {

/// Points of contact of a rigid tool with the faces of a body. A vertex or an edge of the surface
/// that several triangles share counts once.
class RigidContact final : public ToolContact {
  public:
    /// @param size  mean length of an element at rest, m: distances are parts of it
    RigidContact(cutting::Probe probe, double size);

    /// Sets the motion of the tool in the next step.
    void move(const Pose& before, const Pose& after) {
        before_ = before;
        after_ = after;
    }
    void follow(const physics::Model&) override { room_ = -1.0; }
    /// Finds the points of contact at the present positions, and adds them to the solver.
    /// Cost: that of the triangles near the tool. Now and then, when tool and tissue have moved by
    /// a part of an element, O(n) in the triangles of the surface.
    void add_points(const physics::Model& model, const TissueSurface& surface, double dt,
                    ContactSolver& solver) override;
    /// The next step begins with the impulses of this one.
    ToolImpulse take_impulses(const ContactSolver& solver, double dt) override;
    double max_penetration() const override { return max_penetration_; }

    void save(ArchiveWriter& ar) const override { list(ar, *this); }
    /// Restores what save() wrote. Throws InputError for the data of another body.
    void restore(ArchiveReader& ar, const TissueSurface& surface);

  private:
    /// What tells one point from another.
    struct Feature {
        std::array<VertexId, 3> corners;  ///< of a triangle, that it depends on, in ascending order
        std::int32_t tool_feature;        ///< see RigidTouch
        auto operator<=>(const Feature&) const = default;
        static void archive(auto& ar, auto& self) { ar(self.corners, self.tool_feature); }
    };
    static void list(auto& ar, auto& self) {
        ar(self.triangles_, self.room_, self.last_features_, self.last_impulses_);
    }
    static Feature feature_of(const Triangle& triangle, const RigidTouch& touch);
    Vec3 last_impulse_at(const Feature& feature) const;
    double largest_move() const;
    bool is_beyond_tissue(const RigidTouch& touch, std::uint32_t t, const physics::Model& model,
                          const TissueSurface& surface) const;
    void find_triangles(std::span<const Vec3> positions, const TissueSurface& surface);

    cutting::Probe probe_;
    double size_;
    std::shared_ptr<const RigidSolid> solid_;  // if the shape is one, or a box
    double reach_;                             // of the shape, m
    Pose before_, after_;
    std::vector<std::uint32_t> triangles_;  // near the tool
    double room_ = -1.0;  // how far both may move before triangles_ is out of date, m
    double max_penetration_ = 0.0;
    std::size_t first_point_ = 0;         // in the solver
    std::vector<Vec3> places_;            // of the points from there on, m
    std::vector<Feature> features_;       // of the same, in ascending order
    std::vector<int> regions_;            // of the same
    std::vector<Feature> last_features_;  // of the step before, with its impulses, N s
    std::vector<Vec3> last_impulses_;
    std::vector<RigidTouch> found_;  // scratch
};

}  // namespace incise::contact
