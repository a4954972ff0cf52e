// A scenario that hands take part in: it advances tick by tick, and between two ticks tools are
// taken, led and put away.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "incise/live/order.h"
#include "incise/runner/simulation.h"
#include "incise/scenario/hand_tool.h"
#include "incise/scenario/scenario.h"
#include "incise/sim/tool_player.h"
#include "incise/sim/world.h"

namespace incise::live {

/// The time of a tick if nothing else is said, s.
inline constexpr double usual_tick = 1.0 / 60.0;

/// A tool that a hand has taken.
struct LedTool {
    std::string name, kind;
    scenario::Value definition;
    sim::ToolId id;
    Pose pose;               ///< where it is to be at the end of the next tick
    double length = 0.0;     ///< of a thread at the end of the next tick, m
    bool is_in_hand = true;  ///< until it has been withdrawn
    bool is_to_be_withdrawn = false;
};

/// A scenario that advances tick by tick. A tick is made of the steps that the body needs. Tools
/// of the scenario follow their paths, and those of hands go evenly to the poses that orders say.
///
/// The same orders between the same ticks give the same bits, on any number of threads: that is
/// what a recording is (recording.h).
///
/// A session can go back to a moment that it was in: undo_point(), undo(), reset().
class Session {
  public:
    /// Builds the body. Throws as runner::Simulation.
    /// @param scenario   its end time does not count, nor do load steps of statics
    /// @param tick       s, above 0
    /// @param num_ticks  after so many the session is finished
    /// @param tell       is called with what is done next while the body is built
    explicit Session(scenario::Scenario scenario, double tick = usual_tick,
                     std::uint64_t num_ticks = std::numeric_limits<std::uint64_t>::max(),
                     const std::function<void(const std::string&)>& tell = {});

    /// Executes an order at the present time. Returns warnings. Throws InputError, and changes
    /// nothing, if it is refused: a name that is taken or not known, an invalid definition or pose.
    std::vector<std::string> execute(const Order& order);
    /// Returns the kind of a tool, such as "blade". Throws InputError if execute() would refuse to
    /// add it. Changes nothing.
    std::string check(const AddTool& order) const { return checked(order).kind; }
    /// Advances by one tick. Throws as runner::Simulation::step(). The session must then be
    /// restored.
    /// @param is_to_stop  asked after each step: if it returns true, the tick is given up
    /// Returns false if the tick was given up. The session must then be restored too.
    bool tick(const std::function<bool()>& is_to_stop = {});

    std::uint64_t num_ticks() const { return num_ticks_; }
    double tick_length() const { return tick_; }  ///< s
    /// Returns the mean length of an element at the start, m.
    double element_size() const { return element_size_; }
    /// True if tools can touch tissue.
    bool has_contact() const { return why_no_contact_.empty(); }
    bool is_finished() const { return num_ticks_ >= last_tick_; }
    const runner::Simulation& simulation() const { return simulation_; }
    runner::Simulation& simulation() { return simulation_; }
    sim::World& world() { return simulation_.world(); }
    const sim::World& world() const { return simulation_.world(); }
    /// Returns the orders that were executed before the last tick, since the tick before it.
    std::span<const Order> orders_of_last_tick() const { return last_orders_; }
    /// Returns all tools that hands have taken so far.
    std::span<const LedTool> tools() const { return tools_; }
    /// Returns a tool by name, or null.
    const LedTool* find(const std::string& name) const;
    /// Returns what tissue exerted on the tools, those of the scenario too, over the last tick.
    const sim::ToolForces& tool_forces() const { return player_.forces(); }

    /// A moment between two ticks.
    struct UndoPoint {
        std::uint64_t num_ticks;
        runner::Simulation::UndoPoint state;
        std::vector<LedTool> tools;
        std::vector<Order> orders;  ///< executed since the last tick
    };
    /// Returns the present moment. Cost: as World::undo_point().
    UndoPoint undo_point() const;
    /// Goes back to a moment of this session; those after it are lost. The same bits go on.
    /// Throws InputError, and changes nothing, for a lost moment. Cost: as World::undo().
    void undo(const UndoPoint& point);
    /// Goes back to the start. All moments are lost. Cost: as World::restore().
    void reset();

    /// Returns a number that depends on all bits of positions and velocities. Cost: O(#nodes).
    std::uint64_t checksum() const;

  private:
    scenario::HandTool checked(const AddTool& order) const;
    std::vector<std::string> add(const AddTool& order);
    void move(const MoveTool& order);
    void require_within_reach(const Pose& pose) const;
    void require_sensible(double length) const;
    void require_sensible(const scenario::Value& definition) const;
    LedTool& tool(const std::string& name);
    LedTool& tool_in_hand(const std::string& name);
    void require_near(const cutting::ToolShape& shape, const Pose& from, const Pose& to) const;
    void set_targets();

    double tick_;
    std::uint64_t last_tick_;
    runner::Simulation simulation_;
    std::string start_;  // state of the simulation
    std::string why_no_contact_;
    double element_size_;
    Eigen::AlignedBox3d box_;  // of the body at the start
    std::vector<LedTool> tools_;
    sim::ToolPlayer player_;                   // of a tick
    std::vector<Order> orders_, last_orders_;  // since the last tick, and those before it
    std::uint64_t num_ticks_ = 0;
};

}  // namespace incise::live
