// The tools of a scenario: leads them along their paths, as the scenario says.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "incise/scenario/tool_build.h"
#include "incise/sim/world.h"

namespace incise::runner {

/// The tools of a scenario with what each does when. They are the first tools of their world.
class ScriptedTools {
  public:
    /// Adds the tools to the world. Throws as World::add_tool().
    /// @pre  the world has no tools
    ScriptedTools(sim::World& world, std::vector<scenario::ScriptedTool> tools);

    std::size_t size() const { return scripts_.size(); }

    /// Leads the tools that act in a step, and withdraws those whose path ends in it. Sutures are
    /// drawn. What has its time at the beginning of the step is done at once: tools that come are
    /// placed, jaws close and open, and sutures are tied.
    /// @param world     the world, before the step
    /// @param from      beginning of the step, s
    /// @param to        end of the step, s
    /// @param inputs    of the step; what the tools do is added
    /// @param warnings  receives warnings of graspers that close on nothing, and of points of
    ///                  sutures without tissue
    void lead(sim::World& world, double from, double to, sim::StepInputs& inputs,
              std::vector<std::string>& warnings);

    /// Warns, once for each tool, of graspers and sutures that have lost their hold in a step.
    void warn_of_lost_holds(const sim::World& world, std::vector<std::string>& warnings);

    static void archive(auto& ar, auto& self) { ar(self.lost_); }

  private:
    /// What a tool does when.
    struct Script {
        scenario::ToolPath path;
        std::optional<double> close, open;  // of a tool that closes, s
        double over;                        // of a suture, s
        std::optional<double> length;       // of a suture, m
    };
    void move_jaws(sim::World& world, sim::ToolId tool, double time,
                   std::vector<std::string>& warnings);
    void draw_suture(sim::World& world, sim::ToolId tool, double from, double to,
                     sim::StepInputs& inputs, std::vector<std::string>& warnings) const;

    std::vector<Script> scripts_;    // by the number of the tool in the world
    std::vector<std::size_t> lost_;  // sutures and graspers that a warning has named
};

}  // namespace incise::runner
