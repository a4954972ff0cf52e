// The books of a run: what each edit took and left, so that nothing is lost in silence.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "cutting/splitter.h"
#include "physics/model.h"
#include "topology/change_set.h"
#include "topology/mesh.h"
#include "topology/piece_count.h"

namespace incise::sim {

/// The body at one moment.
struct Account {
    std::size_t nodes = 0, elements = 0;
    int components = 0;
    physics::Totals totals;
    double stable_step = 0.0;
    static void archive(auto& ar, auto& self) {
        ar(self.nodes, self.elements, self.components, self.totals, self.stable_step);
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
    Account before, after;
    static void archive(auto& ar, auto& self) {
        ar(self.time, self.step, self.tool, self.elements_removed, self.elements_crossed,
           self.elements_split, self.elements_added, self.faces_opened, self.nodes_added,
           self.nodes_duplicated, self.nodes_removed, self.nodes_snapped, self.cut_area,
           self.mass_removed, self.min_altitude_ratio, self.before, self.after);
    }
};

/// What the mesh and the edits of it tell of one of them.
struct EditTrace {
    std::size_t elements_removed, elements_added, nodes_added, nodes_removed;
    double mass_removed;
    std::size_t nodes, elements;  ///< after it
    bool operator==(const EditTrace&) const = default;
};

class Ledger {
  public:
    explicit Ledger(const physics::Model& model);

    /// The body as the model has it, edits counted up to the last one booked: between an edit of
    /// the mesh and the model's following it, the body of before. Cost: O(#nodes + #elements).
    Account account() const;
    /// Books an edit; called after the model has followed it.
    const EditRecord& record(double time, std::uint64_t step, const std::string& tool,
                             const cutting::Split& done, const Account& before,
                             double mass_removed);

    /// What it has booked. The rest it has from the model: it restores after that.
    void save(topology::ArchiveWriter& ar) const { ar(edits_); }
    /// @param traces  of the edits that the model has followed
    /// Throws InputError if the records are not of these.
    void restore(topology::ArchiveReader& ar, const std::vector<EditTrace>& traces);

    const std::vector<EditRecord>& edits() const { return edits_; }
    const Account& initial() const { return initial_; }

    /// |mass now + mass removed - mass at the start| over that at the start.
    double mass_error() const;
    /// What is missing between the energy at the start, what came in (work) and what went out
    /// (dissipated, removed with elements) on one side and the present energy on the other, over
    /// the sum of their sizes, or over 1e-8 of the body's stiffness energy if that is more. Of the
    /// order of the step: the integrator's energy swings with it.
    double energy_error() const;

  private:
    struct Counts {
        std::size_t nodes, elements;
    };
    Counts count() const;
    void add(EditRecord edit);

    const physics::Model& model_;
    Counts counts_;
    topology::PieceCount pieces_;
    double initial_min_altitude_;
    Account initial_;
    std::vector<EditRecord> edits_;
    double mass_removed_ = 0.0, energy_removed_ = 0.0;
};

/// Mass of the elements that `changes` removed, from their rest volumes, kg. To be called while
/// the model still has them: before it follows the edit.
double removed_mass(const physics::Model& model, const topology::ChangeSet& changes);

}  // namespace incise::sim
