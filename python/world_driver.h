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

#include "incise/runner/scripted_tools.h"
#include "incise/scenario/body.h"
#include "incise/scenario/document.h"
#include "incise/scenario/scenario.h"
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
    std::size_t num_parts = 0;  ///< explicit steps that these steps were divided into
    std::vector<sim::EditRecord> edits;
    std::shared_ptr<const FeelingTools> tools;  ///< those at the end
    std::vector<Vec3> forces, torques;          ///< by tool, means over the call, N and N m
    sim::ContactState contact;                  ///< in the last step
    double max_penetration = 0.0;               ///< largest of the call, m
};

/// A constraint by its name. Grasps have a pose.
struct NamedConstraint {
    std::string name;
    sim::ConstraintId id;
    std::optional<Pose> pose;       ///< of a grasp, after the last step
    std::optional<Pose> target;     ///< of a grasp, at the end of the next call
    std::optional<Pose> from = {};  ///< of a grasp with a target, at the beginning of the call
    static void archive(auto& ar, auto& self) { ar(self.name, self.pose, self.target); }
};

/// A world, its scenario, and what leads its tools.
///
/// Tools that a program leads move straight, and turn the shortest way, from where they are to
/// their target during one call of step() or run_until(), however many steps it makes.
class WorldDriver {
  public:
    /// Builds the world of a scenario at time 0. Throws as runner::Simulation.
    /// @param is_endless  the end time of the scenario means nothing
    WorldDriver(const scenario::Scenario& scenario, bool is_endless);

    sim::World& world() { return world_; }
    const sim::World& world() const { return world_; }
    const scenario::Scenario& scenario() const { return scenario_; }
    bool is_endless() const { return is_endless_; }

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
    /// allowed, and as scenario::build_held_tool().
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
    /// Returns what the tissue exerted on the tool in the last step.
    sim::ToolState tool_state(sim::ToolId tool) const;

    const std::vector<NamedConstraint>& constraints() const { return constraints_; }
    /// Grasps nodes at their present positions. Throws InputError for a name that is taken.
    void grasp(const std::string& name, std::vector<VertexId> nodes, const Pose& pose);
    void set_grasp_target(const std::string& name, const Pose& pose);
    void release(const std::string& name);

    /// Returns the load with this name; throws InputError if there is none.
    const physics::Load& load(const std::string& name) const;
    void set_load_factor(const std::string& name, double factor);

    UndoPoint undo_point() const;
    /// Throws InputError, and changes nothing, as World::undo() does.
    void undo(const UndoPoint& point);

    std::string save() const;
    /// Throws InputError, and changes nothing, for other bytes than those of save() in a world of
    /// the same materials, solver and scenario tools.
    void restore(std::string_view bytes);

  private:
    WorldDriver(scenario::Scenario scenario, scenario::Body body, bool is_endless);

    /// What a tool that the program leads is to do in the next call.
    struct Led {
        std::optional<Pose> from, target;
        bool leaves = false;
        std::optional<double> length_from, length_target;  // of a suture, m
        static void archive(auto& ar, auto& self) {
            ar(self.from, self.target, self.leaves, self.length_from, self.length_target);
        }
    };
    void save_rest(ArchiveWriter& ar) const;
    void restore_rest(ArchiveReader& ar, const std::function<void()>& restore_world);
    void require_led(sim::ToolId tool) const;
    void require_posable(sim::ToolId tool, const Pose& pose) const;
    void begin_call();
    void lead(double part, bool is_last);
    void end_call();
    void make_step(double end, double part, bool is_last, Report& report);
    void note(Report& report);
    void finish(Report& report) const;
    void note_tools();
    template <class NextEnd>
    Report call(NextEnd next_end, const Poll& poll);

    scenario::Scenario scenario_;
    bool is_endless_;
    std::vector<std::string> warnings_;
    sim::World world_;
    runner::ScriptedTools scripts_;
    std::vector<Led> led_;                      // by tool, in the order of World::tools()
    std::vector<NamedConstraint> constraints_;  // in the order of World::constraints()
    std::vector<std::string> loads_;            // names, in the order of World::loads()
    std::vector<sim::EditRecord> edits_;
    std::shared_ptr<const FeelingTools> feeling_;
    double last_step_ = 0.0;
    std::uint64_t version_base_ = 0;
};

}  // namespace incise::python
