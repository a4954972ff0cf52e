// A world with what leads its tools: the paths of its scenario, or poses that a program sets.
// This file knows nothing of Python.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "incise/runner/run_warnings.h"
#include "incise/runner/scripted_tools.h"
#include "incise/scenario/body.h"
#include "incise/scenario/document.h"
#include "incise/scenario/scenario.h"
#include "incise/sim/step_inputs.h"
#include "incise/sim/tool_player.h"
#include "incise/sim/undo_point.h"
#include "incise/sim/world.h"
#include "incise/topology/pose.h"

namespace incise::python {

/// A moment of a driver to which it can go back: see sim::UndoPoint.
struct UndoPoint {
    sim::UndoPoint world;
    std::string driver;  ///< what the driver remembers beside the world
    double time = 0.0;   ///< s
};

/// The tools that tissue exerts a known force on, in the order of World::tools().
struct FeelingTools {
    std::vector<sim::ToolId> ids;
    std::vector<std::string> names;
};

/// What one call of step() or run_until() did.
struct Report {
    double from = 0.0, to = 0.0;  ///< s
    std::size_t num_steps = 0;
    std::size_t num_substeps = 0;  ///< explicit steps that these steps were divided into
    std::vector<sim::EditRecord> edits;
    std::shared_ptr<const FeelingTools> tools;  ///< those at the end
    std::vector<Vec3> forces, torques;          ///< by tool, means over the call, N and N m
    sim::ContactState contact;                  ///< in the last step
    double max_penetration = 0.0;               ///< largest of the call, m
};

/// A world, its scenario, and what leads its tools.
///
/// Tools that a program leads move straight, and turn the shortest way, from where they are to
/// their target during one call of step() or run_until(), however many steps it makes.
class WorldDriver {
  public:
    /// Builds the world of a scenario at time 0. Throws as runner::Simulation.
    explicit WorldDriver(const scenario::Scenario& scenario);

    sim::World& world() { return world_; }
    const sim::World& world() const { return world_; }
    const scenario::Scenario& scenario() const { return scenario_; }

    /// Returns the warnings so far, of the body and of the steps.
    const std::vector<std::string>& warnings() const { return warnings_; }
    /// Adds warnings, such as those of a tool that a program adds.
    void add_warnings(const std::vector<std::string>& warnings) {
        warnings_.insert(warnings_.end(), warnings.begin(), warnings.end());
    }

    /// Called between steps of a long call, about ten times a second. What it throws ends the call.
    using Poll = std::function<void()>;

    /// Makes n steps.
    /// @param dt    length of each, s; without it that of the scenario: the fixed step, or the
    /// stable
    ///              step times the safety
    /// Throws InputError as World::step(), and PhysicsError with the remedies of the program.
    Report step(std::optional<double> dt, std::uint64_t n, const Poll& poll);
    /// Steps to `time`, s, evenly as a run does between two frames. Throws as step(), and
    /// InputError for a time that has passed.
    Report run_until(double time, const Poll& poll);

    /// Returns the length of the next step without a given one, s.
    double next_step() const;
    /// Returns the length of the last step, s; 0 before the first.
    double last_step() const { return last_step_; }
    const std::vector<sim::EditRecord>& edits() const { return edits_; }
    /// Returns a number that differs after each edit, restore() and undo().
    std::uint64_t topology_version() const { return version_base_ + world_.mesh().epoch(); }

    bool is_scripted(sim::ToolId tool) const { return tool.index < scripts_.size(); }
    /// Adds a tool that the program leads. Throws InputError for a name that is taken or not
    /// allowed, and as scenario::build_hand_tool().
    sim::ToolId add_tool(const std::string& name, const scenario::Value& definition,
                         const std::optional<Pose>& pose);
    /// Returns the pose that the tool has at the end of the next call, or now, if none is set.
    /// Nothing if the tool is not there.
    std::optional<Pose> tool_pose(sim::ToolId tool) const;
    /// These throw InputError for a tool of the scenario that is led by its path.
    void set_tool_target(sim::ToolId tool, const Pose& pose);
    void place_tool(sim::ToolId tool, const Pose& pose);
    void withdraw_tool(sim::ToolId tool);
    std::size_t close(sim::ToolId tool);
    void open(sim::ToolId tool);
    std::size_t tie(sim::ToolId tool);
    void untie(sim::ToolId tool);
    void set_suture_target(sim::ToolId tool, double length);
    /// Returns what tissue exerted on the tools over the last call.
    const sim::ToolForces& tool_forces() const { return player_.forces(); }
    /// True if the tool divides elements and its cut ended in one in the last step.
    bool is_in_tissue(sim::ToolId tool) const;

    // What a program gives to the body and takes from it, by definitions with the keys of their
    // sections. These throw InputError for a wrong definition, and for a name that is taken or not
    // known.
    void add_constraint(const std::string& name, const scenario::Value& definition);
    void set_constraint(const std::string& name, const scenario::Value& definition);
    void add_load(const std::string& name, const scenario::Value& definition);
    void set_load(const std::string& name, const scenario::Value& definition);
    void remove_load(const std::string& name);
    void set_material(const scenario::Value& definition);

    /// Returns the constraint with this name; throws InputError if there is none.
    sim::ConstraintId constraint(const std::string& name) const;
    /// Grasps nodes at their present positions. Throws InputError for a name that is taken.
    void grasp(const std::string& name, std::vector<VertexId> nodes, const Pose& pose);
    void set_grasp_target(const std::string& name, const Pose& pose);
    /// Returns the pose that a grasp has at the end of the next call, or now, if none is set;
    /// nothing for another constraint.
    std::optional<Pose> grasp_pose(const std::string& name) const;
    void release(const std::string& name);

    /// Returns the load with this name; throws InputError if there is none.
    sim::LoadId load(const std::string& name) const;
    /// Returns by what a load is multiplied at present.
    double load_factor(const std::string& name) const;
    void set_load_factor(const std::string& name, double factor);

    UndoPoint undo_point() const;
    /// Throws InputError, and changes nothing, as World::undo() does.
    void undo(const UndoPoint& point);

    std::string save() const;
    /// Throws InputError, and changes nothing, for other bytes than those of save() in a world of
    /// the same materials, solver and scenario tools.
    void restore(std::string_view bytes);

  private:
    WorldDriver(scenario::Scenario scenario, scenario::Body body);

    void save_rest(ArchiveWriter& ar) const;
    void restore_rest(ArchiveReader& ar, const std::function<void()>& restore_world);
    sim::ToolId present(sim::ToolId tool) const;
    void require_new_constraint(const std::string& what, const std::string& name) const;
    void warn_of_jump(const physics::Constraint& constraint);
    void require_led(sim::ToolId tool) const;
    void require_posable(sim::ToolId tool, const Pose& pose) const;
    void make_step(double end, double part, bool is_last, Report& report);
    void note(Report& report);
    void finish(Report& report) const;
    void note_tools();
    template <class NextEnd>
    Report call(NextEnd next_end, const Poll& poll);

    scenario::Scenario scenario_;
    std::vector<std::string> warnings_;
    sim::World world_;
    runner::RunWarnings run_warnings_;
    runner::ScriptedTools scripts_;
    sim::StepInputs inputs_;  // of the present step
    sim::ToolPlayer player_;  // of a call
    std::vector<sim::EditRecord> edits_;
    std::shared_ptr<const FeelingTools> feeling_;
    double last_step_ = 0.0;
    std::uint64_t version_base_ = 0;
};

}  // namespace incise::python
