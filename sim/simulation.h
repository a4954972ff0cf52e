// The run: a body, its tools, and the loop that moves both.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cutting/element_boxes.h"
#include "physics/integrator.h"
#include "physics/model.h"
#include "sim/ledger.h"
#include "sim/scenario.h"
#include "sim/tool.h"
#include "topology/archive.h"
#include "topology/mesh.h"

namespace incise::sim {

class Simulation;
struct Body;

/// Watches a run. All functions may throw, which ends the run.
class Observer {
  public:
    virtual ~Observer() = default;
    virtual void on_start(const Simulation&) {}  ///< at time 0, before the first frame
    virtual void on_edit(const Simulation&, const EditRecord&) {}
    virtual void on_frame(const Simulation&) {}  ///< when a frame is due, the first at time 0
    virtual void on_step(const Simulation&) {}
    /// Between two steps: all of the one before, its frame too, is done.
    virtual void on_pause(const Simulation&) {}
};

class Simulation {
  public:
    /// Builds what the scenario describes, at time 0.
    /// Throws as build_body, make_model and step_limit: BodyError with all that is at fault;
    /// PhysicsError if that is nothing but a fixed step above the bound.
    explicit Simulation(const Scenario& scenario);
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// Observers must outlive the simulation's last step.
    void add_observer(Observer& observer) { observers_.push_back(&observer); }

    /// See Model::set_num_threads.
    void set_num_threads(int n) { model_.set_num_threads(n); }

    /// One time step; see the implementation for its phases.
    void step();
    bool is_finished() const;
    /// Tells the observers of the state at time 0, before the first step.
    void start();

    /// Everything that a simulation of the same scenario needs to go on from here to the same bits,
    /// called between two steps. Cost: some 100 bytes a node, and as many for each element that
    /// edits have touched.
    void save(topology::ArchiveWriter& ar) const;
    /// Goes on from what another simulation of this scenario saved; on one that has not moved yet.
    /// Throws InputError, saying what is wrong, for data that are not of this body or are damaged;
    /// the simulation is of no use then. Cost: that of the edits so far, made anew, and of
    /// validate().
    void restore(topology::ArchiveReader& ar);
    /// Equal for simulations that begin with the same body: mesh, fibres, surfaces that cut.
    std::uint64_t fingerprint() const { return fingerprint_; }

    const Scenario& scenario() const { return scenario_; }
    const topology::Mesh& mesh() const { return mesh_; }
    const physics::Model& model() const { return model_; }
    const Ledger& ledger() const { return ledger_; }
    double time() const { return time_; }  ///< s
    double time_step() const;              ///< s, of the last step, or of the first
    std::uint64_t num_steps() const { return num_steps_; }
    std::uint64_t num_frames() const { return num_frames_; }
    /// Those of before the start, and what the run has added up to now.
    const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    Simulation(const Scenario& scenario, Body body);

    struct Interval {
        double from, to;  // s
    };
    Interval next_step() const;
    double step_limit() const;
    void cut(Tool& tool, double from, double to);
    void follow(Tool& tool, const cutting::Split& done);
    void warn_of_short_steps(const EditRecord& edit);
    void warn_of_lost_elements();
    void tell_frame();
    void tell_pause();

    Scenario scenario_;
    std::vector<std::string> warnings_;
    topology::Mesh mesh_;
    physics::Model model_;
    std::unique_ptr<physics::Integrator> integrator_;
    Ledger ledger_;
    std::vector<Tool> tools_;
    cutting::ElementBoxes boxes_;
    cutting::Scars scars_;
    std::vector<Observer*> observers_;
    std::uint64_t fingerprint_;
    topology::ArchiveWriter edits_;  // all ChangeSets so far

    double time_ = 0.0;
    double last_step_ = 0.0;
    double warned_step_;  // s, the stable step of the last warning of it, or of the start
    std::uint64_t num_steps_ = 0, num_frames_ = 0;
    std::vector<Vec3> previous_positions_;
    bool has_moved_ = true;  ///< since the last edit
};

}  // namespace incise::sim
