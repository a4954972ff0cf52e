// The books of a run: what each edit took and left, so that nothing is lost in silence.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "incise/cutting/exact/splitter.h"
#include "incise/physics/body/model.h"
#include "incise/topology/change_set.h"
#include "incise/topology/component_count.h"
#include "incise/topology/mesh.h"

namespace incise::sim {

/// The body at one moment.
struct BodyTotals {
    std::size_t nodes = 0, elements = 0;
    int components = 0;
    physics::Totals totals;
    double stable_step = 0.0;
    double external_work = 0.0, dissipated_energy = 0.0;  ///< J, since the start
    double min_volume_ratio = 0.0;                        ///< of all elements, J
    std::vector<physics::Reaction> reactions;             ///< of each constraint, in the last step
    static void archive(auto& ar, auto& self) {
        ar(self.nodes, self.elements, self.components, self.totals, self.stable_step,
           self.external_work, self.dissipated_energy, self.min_volume_ratio, self.reactions);
    }
};

/// One edit, by one tool.
struct EditRecord {
    double time = 0.0;
    std::uint64_t step = 0;
    std::string tool;
    std::size_t elements_removed = 0;
    std::size_t elements_crossed = 0;  ///< by the surface of a cut that splits
    std::size_t elements_split = 0;    ///< of these, the ones that were divided
    std::size_t elements_added = 0;
    std::size_t faces_opened = 0;      ///< between elements that live on
    std::size_t nodes_added = 0;       ///< of both kinds:
    std::size_t nodes_duplicated = 0;  ///< copies, where nodes were divided
    std::size_t nodes_removed = 0;
    std::size_t nodes_snapped = 0;  ///< that counted as on the cut, though only near it
    double cut_area = 0.0;          ///< of one side of the opened faces, at rest, m2
    double mass_removed = 0.0;      ///< kg: density times rest volume of the removed elements
    /// Least altitude of the elements that were divided and of those that came of it, over the
    /// least of the mesh at the start; not a number if none were.
    double min_altitude_ratio = std::numeric_limits<double>::quiet_NaN();
    BodyTotals before, after;
    static void archive(auto& ar, auto& self) {
        ar(self.time, self.step, self.tool, self.elements_removed, self.elements_crossed,
           self.elements_split, self.elements_added, self.faces_opened, self.nodes_added,
           self.nodes_duplicated, self.nodes_removed, self.nodes_snapped, self.cut_area,
           self.mass_removed, self.min_altitude_ratio, self.before, self.after);
    }
};

/// What came in, what went out, and what there is: adds up over all edits.
class Ledger {
  public:
    explicit Ledger(const physics::Model& model);

    /// The body as the model has it, edits counted up to the last one booked: between an edit of
    /// the mesh and the model's following it, the body of before. Cost: O(#nodes + #elements).
    BodyTotals body_totals() const;
    /// The body after the last edit; at the start if there was none.
    const BodyTotals& last() const { return last_; }
    /// Books an edit; called after the model has followed it. Returns its record.
    EditRecord record(double time, std::uint64_t step, const std::string& tool,
                      const cutting::Split& done, const BodyTotals& before, double mass_removed);

    std::size_t num_edits() const { return num_edits_; }

    const BodyTotals& initial() const { return initial_; }

    /// |mass now + mass removed - mass at the start| over that at the start.
    double mass_error() const;
    /// What is missing between the energy at the start, what came in (work) and what went out
    /// (dissipated, removed with elements) on one side and the present energy on the other, over
    /// the sum of their sizes, or over 1e-8 of the body's stiffness energy if that is more. Of the
    /// order of the step: the integrator's energy swings with it.
    double energy_error() const;

    void save(ArchiveWriter& ar) const { list(ar, *this); }
    /// Goes on from what was saved: on a ledger of the model as it was then.
    void restore(ArchiveReader& ar) { list(ar, *this); }

  private:
    static void list(auto& ar, auto& self) {
        ar(self.initial_min_altitude_, self.initial_, self.last_, self.num_edits_,
           self.mass_removed_, self.energy_removed_);
    }
    struct Counts {
        std::size_t nodes, elements;
    };
    Counts count() const;

    const physics::Model& model_;
    Counts counts_;
    topology::ComponentCount pieces_;
    double initial_min_altitude_;
    BodyTotals initial_, last_;
    std::size_t num_edits_ = 0;
    double mass_removed_ = 0.0, energy_removed_ = 0.0;
};

/// Mass of the elements that `changes` removed, from their rest volumes, kg. To be called while
/// the model still has them: before it follows the edit.
double removed_mass(const physics::Model& model, const topology::ChangeSet& changes);

}  // namespace incise::sim
