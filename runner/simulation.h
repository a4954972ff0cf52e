// The run of a scenario: it steps a world and moves its tools as the scenario says.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "incise/base/archive.h"
#include "incise/runner/run_warnings.h"
#include "incise/runner/scripted_tools.h"
#include "incise/runner/step_policy.h"
#include "incise/scenario/scenario.h"
#include "incise/sim/ledger.h"
#include "incise/sim/step_inputs.h"
#include "incise/sim/tool_forces.h"
#include "incise/sim/undo_point.h"
#include "incise/sim/world.h"
#include "incise/topology/mesh.h"

namespace incise::scenario {
struct Body;
}

namespace incise::runner {

class Simulation;

/// An interface for classes that observe a run. An exception from any function ends the run.
class Observer {
  public:
    virtual ~Observer() = default;
    virtual void on_start(const Simulation&) {}  ///< called at time 0, before the first frame
    /// Called for each edit after the step that made it, in the order of the edits.
    virtual void on_edit(const Simulation&, const sim::EditRecord&) {}
    virtual void on_frame(const Simulation&) {}  ///< called when a frame is due, first at time 0
    virtual void on_step(const Simulation&) {}   ///< called after each step
    /// Called between two steps, after on_frame(). The step is then complete.
    virtual void on_pause(const Simulation&) {}
};

/// The run of a scenario. It chooses the steps, moves the tools along their paths and calls the
/// observers.
class Simulation {
  public:
    /// Builds the world of the scenario at time 0.
    /// Throws as build_body(), World and step_limit(): BodyError with all problems, or PhysicsError
    /// if the only problem is a fixed step above the stable step.
    /// @param scenario  the scenario
    /// @param policy    the choice of steps
    explicit Simulation(const scenario::Scenario& scenario, StepPolicy policy = even_steps);
    /// The same, with what scenario::build_body() has made of the scenario.
    Simulation(const scenario::Scenario& scenario, scenario::Body body, StepPolicy policy);
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// Adds an observer.
    /// @lifetime  the observer must live until the last step
    void add_observer(Observer& observer) { observers_.push_back(&observer); }

    /// Sets the number of threads; see Model::set_num_threads().
    void set_num_threads(int n) { world_.set_num_threads(n); }

    /// The time that a step takes, s.
    struct Interval {
        double from, to;
    };
    /// Returns the next step, if it must not go beyond `stop`, s.
    /// @pre  `stop` is after time()
    Interval next_step(double stop) const;
    /// Makes a step that next_step() has returned, then calls the observers.
    /// @param inputs  of tools and grasps beside those of the scenario
    /// Throws PhysicsError if the motion is lost, and InputError if a tool meets something that it
    /// cannot cut. The edits of the failed step are then passed to the observers first.
    void step(Interval step, const sim::StepInputs& inputs = {});
    /// Makes the next step, which ends at the next frame at the latest.
    void step() { step(next_step(next_stop())); }
    bool is_finished() const;
    /// Calls the observers for the state at time 0.
    /// @pre  no step was made
    void start();

    /// Saves the state. A simulation of the same scenario that restores it gives the same results
    /// bit for bit. Cost: as World::save().
    /// @pre  the simulation is between two steps
    void save(ArchiveWriter& ar) const;
    /// Restores a state that a simulation of the same scenario has saved.
    /// Throws InputError if the data are damaged or not of this body. The simulation is then
    /// unusable. Cost: as World::restore().
    void restore(ArchiveReader& ar);
    /// A moment between two steps: see sim::UndoPoint.
    struct UndoPoint {
        sim::UndoPoint world;
        std::string run;  ///< what the run remembers beside the world
    };
    /// Returns the present moment. Cost: O(#nodes), and what records of the edits take.
    UndoPoint undo_point() const;
    /// Goes back to a moment of this run: see World::undo().
    void undo(const UndoPoint& point);
    /// Returns a checksum of the body at the start: mesh, fibres, and the files of surfaces of
    /// cuts.
    std::uint64_t fingerprint() const { return fingerprint_; }

    const scenario::Scenario& scenario() const { return scenario_; }
    const sim::World& world() const { return world_; }
    /// The same, for tools, constraints and loads beside those of the scenario. Between two steps
    /// they may be added and moved. The world must not be stepped or restored by itself.
    sim::World& world() { return world_; }
    const topology::Mesh& mesh() const { return world_.mesh(); }
    const physics::Model& model() const { return world_.model(); }
    const sim::Ledger& ledger() const { return world_.ledger(); }
    /// Returns what tissue exerted on the tools since the last row of the history before this
    /// moment. Rows are written at the start, after steps with edits, and with frames.
    const sim::ToolForces& tool_forces() const { return forces_; }
    /// Returns the records of all edits so far.
    const std::vector<sim::EditRecord>& edits() const { return edits_; }
    double time() const { return world_.time(); }  ///< s
    double time_step() const;  ///< s, of the last step; before it, of the first step
    std::uint64_t num_steps() const { return world_.num_steps(); }
    std::uint64_t num_frames() const { return num_frames_; }
    /// Returns the warnings of the body, then those that the run has added so far.
    const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    double next_stop() const;
    void save_run(ArchiveWriter& ar) const;
    void restore_run(ArchiveReader& ar);
    void report_edits();
    void report_frame();
    void report_pause();

    scenario::Scenario scenario_;
    StepPolicy policy_;
    std::vector<std::string> warnings_;
    sim::World world_;
    ScriptedTools tools_;
    sim::StepInputs inputs_;  // of the present step
    sim::ToolForces forces_;
    bool begins_row_ = false;  // the next step is the first of another row of the history
    std::vector<Observer*> observers_;
    std::uint64_t fingerprint_;
    std::vector<sim::EditRecord> edits_;
    double last_step_ = 0.0;
    RunWarnings run_warnings_;
    std::size_t num_body_warnings_;  // in warnings_, before those of the run
    std::uint64_t num_frames_ = 0;
};

}  // namespace incise::runner
