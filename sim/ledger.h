// The conservation record of a run: what each edit removed, and the totals of the body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "incise/cutting/exact/split.h"
#include "incise/fragments/fragment_changes.h"
#include "incise/physics/body/model.h"
#include "incise/topology/change_set.h"
#include "incise/topology/component_count.h"
#include "incise/topology/mesh.h"

namespace incise::sim {

/// Counts and totals of the body at one time.
struct BodyTotals {
    std::size_t nodes = 0, elements = 0;
    int components = 0;
    physics::Totals totals;
    double stable_step = 0.0;                             ///< bound at rest, s
    double external_work = 0.0, dissipated_energy = 0.0;  ///< J, since the start
    double min_volume_ratio = 0.0;                        ///< least current over rest volume
    std::vector<physics::Reaction> reactions;  ///< by constraint, means over the last step
    static void archive(auto& ar, auto& self) {
        ar(self.nodes, self.elements, self.components, self.totals, self.stable_step,
           self.external_work, self.dissipated_energy, self.min_volume_ratio, self.reactions);
    }
};

/// The record of one edit by one tool.
struct EditRecord {
    double time = 0.0;       ///< s
    std::uint64_t step = 0;  ///< number of the step, from 1
    std::string tool;
    std::size_t elements_removed = 0;
    std::size_t elements_crossed = 0;  ///< elements that the surface of a cut passed through
    std::size_t elements_split = 0;    ///< of these, the elements that were divided
    std::size_t elements_added = 0;
    std::size_t faces_opened = 0;      ///< between elements that were not removed
    std::size_t nodes_added = 0;       ///< new nodes on divided edges, and copies
    std::size_t nodes_duplicated = 0;  ///< of these, the copies of nodes that were divided
    std::size_t nodes_removed = 0;
    std::size_t nodes_snapped = 0;  ///< nodes near the cut that were treated as on it
    double cut_area = 0.0;          ///< m2, at rest, of one side of the opened faces
    double mass_removed = 0.0;      ///< kg: density times rest volume of the removed elements
    /// What the edit did to the elements and nodes of the physics (fragments::FragmentMesh). Copies
    /// change neither momenta nor energies. If volume_joined and volume_released are 0, then
    /// `before` and `after` of an edit that removes nothing are equal to rounding, but for the
    /// elastic energy of divided cells that are no tetrahedra: docs/theory.md, Fragments.
    std::size_t fragments_copied = 0;       ///< new fragments
    std::size_t fragment_nodes_copied = 0;  ///< new nodes of fragments
    double volume_joined = 0.0;    ///< m3, at rest, that fragments took over from light ones
    double volume_released = 0.0;  ///< m3, at rest, that they gave back
    /// The least altitude of the divided elements and of their parts, divided by the least altitude
    /// of the mesh at the start. Not a number if no element was divided.
    double min_altitude_ratio = std::numeric_limits<double>::quiet_NaN();
    BodyTotals before, after;
    static void archive(auto& ar, auto& self) {
        ar(self.time, self.step, self.tool, self.elements_removed, self.elements_crossed,
           self.elements_split, self.elements_added, self.faces_opened, self.nodes_added,
           self.nodes_duplicated, self.nodes_removed, self.nodes_snapped, self.cut_area,
           self.mass_removed, self.fragments_copied, self.fragment_nodes_copied, self.volume_joined,
           self.volume_released, self.min_altitude_ratio, self.before, self.after);
    }
};

/// The balance of mass and energy over all edits.
class Ledger {
  public:
    explicit Ledger(const physics::Model& model);

    /// Returns the totals of the body in the model. The counts are those after the last recorded
    /// edit. Called between an edit of the mesh and Model::apply(), it returns the totals before
    /// the edit. Cost: O(#nodes + #elements).
    BodyTotals body_totals() const;
    /// Returns the totals after the last edit, or those at the start if there was no edit.
    const BodyTotals& last() const { return last_; }
    /// Records an edit and returns its record.
    /// @param fragments     what the edit did to the fragments
    /// @param before        totals of the body before the edit
    /// @param mass_removed  see removed_mass(), kg
    /// @pre  the model has followed the edit
    EditRecord record(double time, std::uint64_t step, const std::string& tool,
                      const cutting::Split& done, const fragments::FragmentChanges& fragments,
                      const BodyTotals& before, double mass_removed);

    std::size_t num_edits() const { return num_edits_; }

    /// Returns the totals at the start.
    const BodyTotals& initial() const { return initial_; }

    /// Returns |mass now + mass removed - mass at the start| / mass at the start.
    double mass_error() const;
    /// Returns the relative error of the energy balance: |energy at the start + external work -
    /// dissipated energy - energy removed by edits - energy now|, divided by a scale.
    /// The scale is the sum of the absolute values of these five terms, but at least 1e-8 of
    /// Structure::stiffness_energy(). The error is of the order of the time step, since the energy
    /// of the integrator oscillates with an amplitude of this order.
    double energy_error() const;

    void save(ArchiveWriter& ar) const { list(ar, *this); }
    /// Restores a ledger that was saved. Cost: O(1).
    /// @pre  the model has the body that the ledger was saved with
    void restore(ArchiveReader& ar);

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
    topology::ComponentCount components_;
    double initial_min_altitude_;
    BodyTotals initial_, last_;
    std::size_t num_edits_ = 0;
    double mass_removed_ = 0.0, energy_removed_ = 0.0;
};

/// Returns the mass of the elements that `changes` removed, kg: density times rest volume.
/// @pre  the model has not followed the edit yet
double removed_mass(const physics::Model& model, const topology::ChangeSet& changes);

}  // namespace incise::sim
