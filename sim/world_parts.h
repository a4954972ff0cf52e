// The parts of a world. Internal to sim.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "incise/base/archive.h"
#include "incise/contact/contact.h"
#include "incise/cutting/cutter.h"
#include "incise/physics/solve/integrator.h"
#include "incise/sim/edit_log.h"
#include "incise/sim/handles.h"
#include "incise/sim/tools/tool_actor.h"
#include "incise/sim/world.h"

namespace incise::sim {

/// Returns the number of a new world, or of a restore. Ids have it, so that a world refuses those
/// of another one, and those of what it has forgotten.
std::uint32_t next_number();

std::unique_ptr<physics::Integrator> make_integrator(Solver solver, contact::Contact* contact);

/// When the stable step is computed anew: docs/theory.md, Stable step. The computation takes about
/// as long as two steps. In calm motion it adds 2 %.
struct BoundInterval {
    static constexpr int most_steps = 96;
    /// The distance that a node may have moved, over the mean length of an element. Strain may have
    /// changed by as much.
    static constexpr double motion = 0.25;
    static constexpr int least_steps = 4;  ///< but not before so many steps

    /// The stable step rises only after so many steps, and then to its least value in them. Each
    /// change of the step changes the energy that the method keeps by a little.
    static constexpr int held_steps = 2048;
    /// It rises earlier if it can rise by this factor: tissue has come to rest.
    static constexpr int least_held_steps = 384;
    static constexpr double large_rise = 1.5;

    double element_length = 0.0;  ///< m
    int num_steps = 0;            ///< since the stable step was computed
    double moved = 0.0;           ///< sum of the largest moves since then, m
    int num_held = 0;             ///< steps since the stable step fell or rose
    double least = std::numeric_limits<double>::infinity();  ///< bound in these steps, s

    bool is_over() const {
        return num_steps >= most_steps ||
               (num_steps >= least_steps && moved > motion * element_length);
    }
    /// True if the stable step, s, may rise to `least`.
    bool may_rise(double stable_step) const {
        return num_steps == 0 && (num_held >= held_steps || (num_held >= least_held_steps &&
                                                             least > large_rise * stable_step));
    }
    static void archive(auto& ar, auto& self) {
        ar(self.element_length, self.num_steps, self.moved, self.num_held, self.least);
    }
};

/// Relative rounding of a step that is an exact fraction of an interval.
inline constexpr double rounding_of_steps = 1e-8;

/// Materials that moments to go back to refer to. Empty while the world has them.
struct FormerMaterials {
    std::optional<physics::MaterialTable> table;  // its fibres are by id of fragments
};

// The parts of a world. Their order matters: later ones refer to earlier ones.
struct World::Parts {
    /// The present pose of the frame of a grasp, and its pose at the end of the step.
    struct Grasp {
        explicit Grasp(const Pose& at = {}) : pose(at), target(at) {}
        Pose pose, target;
        static void archive(ArchiveWriter& ar, const Grasp& self) { ar(self.pose); }
        static void archive(ArchiveReader& ar, Grasp& self) { self = Grasp(ar.read<Pose>()); }
    };

    explicit Parts(WorldDef def);
    /// Restores what save() wrote of a world that was built with the materials and the solver of
    /// `former`.
    Parts(const Parts& former, ArchiveReader& ar);
    void save(ArchiveWriter& ar) const;
    /// Takes back edits, from the last one on, and restores what save_motion() wrote before them.
    /// @param with  the materials of then
    void go_back(std::span<const physics::BodyEdit* const> edits,
                 const std::shared_ptr<FormerMaterials>& with, ArchiveReader& ar);
    void save_motion(ArchiveWriter& ar) const;
    /// True if somebody has a moment to go back to.
    bool is_undo_wanted() const { return log_end.use_count() > 1; }
    void require_sound_grasps() const;
    /// Writes and reads what follows mesh and model in an archive.
    void save_rest(ArchiveWriter& ar) const;
    void restore_rest(ArchiveReader& ar);

    /// Steps to the time `end`, after checks. `dt` is the length that was asked for: far from time
    /// 0 the difference of the times is another one.
    const StepReport& checked_step(double end, double dt, const StepInputs& inputs);
    void require_possible(const StepInputs& inputs) const;
    void take(const StepInputs& inputs);
    void step_to(double end);
    /// Moves the body to the time `end`, in report.num_substeps equal parts.
    void move_to(double end);
    /// Returns the bound on steps for the present strain and motion, s.
    double present_bound() const;
    /// Follows a step with the stable step.
    void update_stable_step();
    /// Sets the stable step anew, after a change from outside.
    void renew_stable_step();
    /// Returns in how many parts, none above the stable step, a step of `dt`, s, is made. Throws
    /// InputError if they would be too many.
    std::size_t num_substeps(double dt, const StepInputs& inputs) const;
    /// Tells the contact which tools touch in a part of a step, from one share of it to another.
    /// @param moved  how far the tissue may have moved in the step so far, m
    void touch_with_tools(double from, double to, double moved);
    std::unique_ptr<contact::Contact> make_contact(const contact::ContactSettings& settings,
                                                   Solver with);
    void report_contact();
    void report_tool(ToolId id);
    void cut_with(ToolId id, double end);
    void follow(ToolId id, const cutting::Split& done, double end);
    /// Lets contact and tools follow the edits of a step.
    void follow_with_contact();
    ToolActor& tool_of(ToolId id) const { return *tools[tool_ids.position_of(id)]; }
    physics::MaterialTable materials_with_fibres() const;
    Tissue tissue() { return {mesh, model, built_cutter(), contact.get()}; }
    cutting::Cutter& built_cutter();
    topology::BoundarySurface& built_surface();

    std::uint32_t number;  // see next_number()
    topology::Mesh mesh;
    double time = 0.0;
    physics::Model model;
    std::optional<topology::BoundarySurface> surface;
    std::unique_ptr<contact::Contact> contact;  // only with the explicit solver
    std::unique_ptr<physics::Integrator> integrator;
    Solver solver;
    Ledger ledger;
    std::optional<cutting::Cutter> cutter;  // from the first tool on
    HandleTable<ToolId> tool_ids{"tool", number};
    // By index of their ids, too, as none is removed.
    std::vector<std::unique_ptr<ToolActor>> tools;
    HandleTable<ConstraintId> constraints{"constraint", number};
    std::vector<std::optional<Grasp>> grasps;  // by constraint, of those that are one
    HandleTable<LoadId> loads{"load", number};
    bool loads_have_changed = false;  // since the forces were computed
    std::shared_ptr<EditLog> log_end = std::make_shared<EditLog>();
    std::shared_ptr<FormerMaterials> materials = std::make_shared<FormerMaterials>();
    StepReport report;
    std::uint64_t num_steps = 0;
    double stable_step = 0.0;      // as last computed, s
    BoundInterval bound_interval;  // since then
    bool has_moved = true;         // since the last edit
    bool has_failed = false;

    std::vector<physics::Reaction> reactions;  // scratch of move_to(), by constraint
};

}  // namespace incise::sim
