// Random programs of cuts, probes, graspers, sutures and wires on free bodies, as tests of contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "incise/physics/body/motion_failure.h"
#include "incise/sim/world.h"
#include "incise/topology/geometry.h"
#include "incise/topology/mesh_metrics.h"
#include "support/mesh_families.h"
#include "support/present_energy.h"
#include "support/surfaces.h"

namespace incise::sim {

/// A body of some 5 cm of soft tissue, and tools that come to it, cut it, hold it and let it go.
class TouchingProgram {
  public:
    static constexpr int num_steps = 200;

    explicit TouchingProgram(std::uint64_t seed) : random_(seed), world_(body_of(seed)) {
        size_ = topology::mean_element_length(world_.mesh());
        for (const VertexId n : world_.mesh().nodes()) box_.extend(world_.mesh().rest_position(n));
        add_probe();
        add_grasper();
        add_suture();
        for (int i = 0; i < 2; ++i) add_plane();
        add_wire();
    }

    /// Makes a step of the program.
    const StepReport& step(int i) {
        const double dt = 0.8 * world_.stable_step();
        StepInputs inputs;
        move_probe(dt, inputs);
        move_grasper(i, dt, inputs);
        draw_suture(i, inputs);
        move_wire(i, dt, inputs);
        for (std::size_t k = 0; k < planes_.size(); ++k)
            if (i == cut_at_[k]) inputs.move(planes_[k], Pose()).withdraw(planes_[k]);
        return world_.step(dt, inputs);
    }

    World& world() { return world_; }
    double size() const { return size_; }  ///< of an element, m
    const std::string& name() const { return name_; }

    /// The world that a program begins with, to restore others in.
    static World empty_world(std::uint64_t seed) {
        TouchingProgram program(seed);
        return std::move(program.world_);
    }

  private:
    World body_of(std::uint64_t seed) {
        const auto& families = test::tetrahedral_families();
        const test::MeshFamily& family = *families[seed % families.size()];
        name_ = family.name;
        WorldDef def;
        topology::MeshData data = family.data;
        Box box;
        for (const Vec3& x : data.points) box.extend(x);
        for (Vec3& x : data.points) x = 0.05 / box.sizes().maxCoeff() * (x - box.center());
        def.mesh = std::move(data);
        def.materials = {{1000.0, physics::HyperElasticLinks{physics::NeoHookean{2000.0, 8000.0}}}};
        def.contact.friction = random_.below(2) == 0 ? 0.0 : random_.uniform(0.0, 0.6);
        return World(std::move(def));
    }

    Vec3 point_in_box(double grown) {
        const Vec3 half = grown * 0.5 * box_.sizes();
        return box_.center() + Vec3(random_.uniform(-half.x(), half.x()),
                                    random_.uniform(-half.y(), half.y()),
                                    random_.uniform(-half.z(), half.z()));
    }

    void add_probe() {
        const double radius = random_.uniform(0.004, 0.012);
        cutting::ProbeShape shape = cutting::Sphere{radius};
        const std::size_t kind = random_.below(4);
        if (kind == 1) shape = cutting::Capsule{{0, 0, -0.02}, {0, 0, 0.02}, radius};
        if (kind == 2) shape = cutting::Cuboid{Vec3(2 * radius, radius, 3 * radius)};
        if (kind == 3) shape = cutting::Solid{test::icosphere(Vec3::Zero(), radius, 2)};
        probe_ = world_.add_tool({"probe", cutting::Probe{shape, random_.uniform(0.0, 0.5)}});
        const Vec3 side = random_.vector(1.0).normalized();
        const double away = 0.5 * box_.diagonal().norm() + 0.05;
        probe_pose_.position = box_.center() + away * side;
        probe_pose_.rotation =
            Eigen::AngleAxisd(random_.uniform(0.0, 3.0), random_.vector(1.0).normalized());
        // Comes near, and then goes by.
        probe_velocity_ = random_.uniform(0.1, 0.4) * (point_in_box(0.6) - probe_pose_.position);
        probe_velocity_ *= 0.4 / probe_velocity_.norm();
        world_.place_tool(probe_, probe_pose_);
        skip_approach();
    }

    /// Begins with the probe a little away from the body.
    void skip_approach() {
        const double away = 0.5 * box_.diagonal().norm() + 0.05;
        const double near = 0.5 * box_.diagonal().norm() + 0.022;
        probe_pose_.position += (away - near) * probe_velocity_.normalized();
        world_.place_tool(probe_, probe_pose_);
    }

    void move_probe(double dt, StepInputs& inputs) {
        probe_pose_.position += dt * probe_velocity_;
        // Back from the middle, so that what it can press stays small.
        if ((probe_pose_.position - box_.center()).norm() < 0.35 * box_.sizes().minCoeff() &&
            !is_back_) {
            probe_velocity_ = -probe_velocity_;
            is_back_ = true;
        }
        inputs.move(probe_, probe_pose_);
    }

    void add_grasper() {
        const double max_force =
            random_.below(2) == 0 ? std::numeric_limits<double>::infinity() : 0.05;
        grasper_ =
            world_.add_tool({"grasper", cutting::Grasper{cutting::Sphere{0.008}, max_force}});
        grasper_pose_.position = point_in_box(1.0);
        grasper_velocity_ = random_.vector(0.05);
        world_.place_tool(grasper_, grasper_pose_);
        close_at_ = static_cast<int>(random_.below(100));
        open_at_ = close_at_ + 20 + static_cast<int>(random_.below(150));
    }

    void move_grasper(int i, double dt, StepInputs& inputs) {
        if (i == close_at_) world_.close_tool(grasper_);
        if (i == open_at_) world_.open_tool(grasper_);
        grasper_pose_.position += dt * grasper_velocity_;
        inputs.move(grasper_, grasper_pose_);
    }

    void add_suture() {
        const std::size_t num_points = 2 + random_.below(3);
        cutting::Suture suture;
        for (std::size_t i = 0; i < num_points; ++i) suture.points.push_back(point_in_box(0.9));
        suture.stiffness = std::pow(10.0, random_.uniform(0.0, 4.0));
        if (random_.below(3) == 0) suture.max_force = 0.02;
        suture_ = world_.add_tool({"suture", suture});
        tie_at_ = static_cast<int>(random_.below(200));
    }

    void draw_suture(int i, StepInputs& inputs) {
        if (i == tie_at_) {
            world_.tie_suture(suture_);
            drawn_by_ = random_.uniform(0.05, 0.3) * world_.suture_length(suture_) / 60.0;
        }
        if (i >= tie_at_ && i < tie_at_ + 60)
            inputs.draw(suture_, world_.suture_length(suture_) - drawn_by_);
    }

    /// A wire that cuts its way through a part of the body, with a force that it exerts or only
    /// tells.
    void add_wire() {
        const Vec3 along = random_.vector(1.0).normalized();
        cutting::Blade blade{{-0.05 * along, 0.05 * along}};
        blade.toughness = random_.uniform(0.5, 5.0);
        if (random_.below(2) == 0) blade.cutting_force = cutting::CuttingForce::apply;
        wire_ = world_.add_tool({"wire", blade});
        wire_at_ = static_cast<int>(random_.below(num_steps / 2));
        wire_velocity_ = 0.3 * along.unitOrthogonal();
        wire_pose_.position = point_in_box(0.6) - 0.03 * wire_velocity_.normalized();
    }

    void move_wire(int i, double dt, StepInputs& inputs) {
        if (i == wire_at_) world_.place_tool(wire_, wire_pose_);
        if (i < wire_at_ || i > wire_at_ + 60) return;
        wire_pose_.position += dt * wire_velocity_;
        inputs.move(wire_, wire_pose_);
        if (i == wire_at_ + 60) inputs.withdraw(wire_);
    }

    void add_plane() {
        planes_.push_back(
            world_.add_tool({"plane" + std::to_string(planes_.size()),
                             cutting::PlaneCut{point_in_box(0.5), random_.vector(1.0)}}));
        cut_at_.push_back(static_cast<int>(random_.below(num_steps)));
    }

    test::Random random_;
    std::string name_;
    World world_;
    double size_ = 0.0;
    Box box_;
    ToolId probe_, grasper_, suture_, wire_;
    std::vector<ToolId> planes_;
    std::vector<int> cut_at_;
    Pose probe_pose_, grasper_pose_, wire_pose_;
    Vec3 probe_velocity_, grasper_velocity_, wire_velocity_;
    bool is_back_ = false;
    int close_at_ = 0, open_at_ = 0, tie_at_ = 0, wire_at_ = 0;
    double drawn_by_ = 0.0;
};

}  // namespace incise::sim
