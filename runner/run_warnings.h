// What runs and worlds of programs warn of while they are stepped.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "incise/scenario/scenario.h"
#include "incise/sim/ledger.h"
#include "incise/sim/world.h"

namespace incise::runner {

/// Finds what has gone wrong in a world though each step succeeded: edits and strain that make
/// steps short, surfaces that overlap, and elements that were crushed or wound up.
class RunWarnings {
  public:
    /// @param world  at its start
    RunWarnings(const sim::World& world, const scenario::DynamicsSpec& dynamics);

    /// Looks at the last step. Warns of each edit after which the stable step is below a tenth of
    /// that at the start or at the last such warning. Warns once if strain has made the stable step
    /// shorter than a hundredth of that at rest.
    /// Cost: O(#elements) in the step of the second warning.
    void add_step(const sim::World& world, std::vector<std::string>& warnings);
    /// Warns of lost elements, and of the largest overlap so far, at the end of a run.
    /// Cost: O(#elements).
    void add_end(const sim::World& world, std::vector<std::string>& warnings);
    /// The same while the world goes on: each is told once. It looks for lost elements only every
    /// 256 steps, so that its cost does not count.
    void add_meanwhile(const sim::World& world, std::vector<std::string>& warnings);

    /// Notes that materials were changed, and with them the stable step.
    void follow_material(const sim::World& world) { warned_step_ = world.rest_stable_step(); }

    static void archive(auto& ar, auto& self) {
        ar(self.overlap_, self.warned_step_, self.next_look_, self.has_told_loss_,
           self.has_told_overlap_, self.has_told_stiffening_);
    }

  private:
    void add_short_step(const sim::World& world, const sim::EditRecord& edit,
                        std::vector<std::string>& warnings);
    void add_stiffening(const sim::World& world, std::vector<std::string>& warnings);
    bool has_large_overlap() const;
    void add_overlap(std::vector<std::string>& warnings);
    bool add_loss(const sim::World& world, const std::string& when,
                  std::vector<std::string>& warnings);

    /// The largest overlap of surfaces so far.
    struct Overlap {
        double depth = 0.0, time = 0.0;  // m, s
        static void archive(auto& ar, auto& self) { ar(self.depth, self.time); }
    };
    Overlap overlap_;
    bool has_stable_step_;
    double warned_step_;  // s, stable step at the last warning about it, or at the start
    double size_;         // m, mean length of an element at the start
    std::uint64_t next_look_ = 0;
    bool has_told_loss_ = false, has_told_overlap_ = false, has_told_stiffening_ = false;
};

}  // namespace incise::runner
