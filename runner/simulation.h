// The run of a scenario: a script that drives a world.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "incise/base/archive.h"
#include "incise/scenario/scenario.h"
#include "incise/scenario/tool_build.h"
#include "incise/sim/ledger.h"
#include "incise/sim/world.h"
#include "incise/topology/mesh.h"

namespace incise::scenario {
struct Body;
}

namespace incise::runner {

class Simulation;

/// Watches a run. All functions may throw, which ends the run.
class Observer {
  public:
    virtual ~Observer() = default;
    virtual void on_start(const Simulation&) {}  ///< at time 0, before the first frame
    /// After the step in which the edit was made, in the order of the edits.
    virtual void on_edit(const Simulation&, const sim::EditRecord&) {}
    virtual void on_frame(const Simulation&) {}  ///< when a frame is due, the first at time 0
    virtual void on_step(const Simulation&) {}
    /// Between two steps: all of the one before, its frame too, is done.
    virtual void on_pause(const Simulation&) {}
};

/// Plays a scenario: chooses the steps, moves the tools along their paths, and tells the observers.
class Simulation {
  public:
    /// Builds what the scenario describes, at time 0.
    /// Throws as build_body, World and step_limit: BodyError with all that is at fault;
    /// PhysicsError if that is nothing but a fixed step above the bound.
    explicit Simulation(const scenario::Scenario& scenario);
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// Observers must outlive the simulation's last step.
    void add_observer(Observer& observer) { observers_.push_back(&observer); }

    /// See Model::set_num_threads.
    void set_num_threads(int n) { world_.set_num_threads(n); }

    /// One time step: World::step_to has its phases.
    void step();
    bool is_finished() const;
    /// Tells the observers of the state at time 0, before the first step.
    void start();

    /// Everything that a simulation of the same scenario needs to go on from here to the same bits,
    /// called between two steps. Cost: that of World::save.
    void save(ArchiveWriter& ar) const;
    /// Goes on from what another simulation of this scenario saved; on one that has not moved yet.
    /// Throws InputError, saying what is wrong, for data that are not of this body or are damaged;
    /// the simulation is of no use then. Cost: that of World::restore.
    void restore(ArchiveReader& ar);
    /// Equal for simulations that begin with the same body: mesh, fibres, surfaces that cut.
    std::uint64_t fingerprint() const { return fingerprint_; }

    const scenario::Scenario& scenario() const { return scenario_; }
    const sim::World& world() const { return world_; }
    const topology::Mesh& mesh() const { return world_.mesh(); }
    const physics::Model& model() const { return world_.model(); }
    const sim::Ledger& ledger() const { return world_.ledger(); }
    /// Of all edits so far.
    const std::vector<sim::EditRecord>& edits() const { return edits_; }
    double time() const { return world_.time(); }  ///< s
    double time_step() const;                      ///< s, of the last step, or of the first
    std::uint64_t num_steps() const { return world_.num_steps(); }
    std::uint64_t num_frames() const { return num_frames_; }
    /// Those of before the start, and what the run has added up to now.
    const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    Simulation(const scenario::Scenario& scenario, scenario::Body body);

    struct Interval {
        double from, to;  // s
    };
    Interval next_step() const;
    double step_limit() const;
    void move_tools(Interval step);
    void tell_edits();
    void warn_of_short_steps(const sim::EditRecord& edit);
    void warn_of_lost_elements();
    void tell_frame();
    void tell_pause();

    scenario::Scenario scenario_;
    std::vector<std::string> warnings_;
    sim::World world_;
    std::vector<scenario::ToolPath> paths_;  // of the world's tools
    std::vector<Observer*> observers_;
    std::uint64_t fingerprint_;
    std::vector<sim::EditRecord> edits_;
    double last_step_ = 0.0;
    double warned_step_;  // s, the stable step of the last warning of it, or of the start
    std::uint64_t num_frames_ = 0;
};

}  // namespace incise::runner
