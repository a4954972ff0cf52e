// What of a body changes as it moves: positions, velocities and the history of viscosity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "incise/base/archive.h"
#include "incise/base/types.h"
#include "incise/physics/elements/viscous_history.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// Positions, velocities and history by id, with a version that grows whenever any of them changes.
/// What is computed from a state is kept with its version and is up to date while the versions are
/// the same. Slots of dead nodes keep their last values, so that an undone edit finds them again.
class State {
  public:
    /// At rest, in the rest positions.
    /// @param history_size see ViscousHistory
    State(const topology::Mesh& mesh, std::size_t history_size);

    std::span<const Vec3> positions() const { return positions_; }    ///< m, current, by node id
    std::span<const Vec3> velocities() const { return velocities_; }  ///< m/s, by node id
    const ViscousHistory& history() const { return history_; }
    /// Edits leave it as it is, unless they move a node that was there before: who follows them
    /// knows what they touch.
    std::uint64_t version() const { return version_; }

    /// The state itself, to be changed. A new version begins with the call.
    struct Values {
        std::span<Vec3> positions, velocities;
        ViscousHistory& history;
    };
    Values change() {
        ++version_;
        return {positions_, velocities_, history_};
    }

    /// Follows an edit; see Model::apply for what nodes take over.
    /// @param masses lumped, kg, by node id, of before the edit; that of a node that takes in
    ///               another one becomes that of both
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes,
               std::span<double> masses);

    void save(ArchiveWriter& ar) const;
    /// Throws InputError for the state of another body, and for one that is not finite.
    void restore(ArchiveReader& ar);

  private:
    /// What a merge did to the node that went on: undone before anything moves, it gives both
    /// nodes back what they had, to the bit.
    struct Merge {
        NodeId survivor;
        Vec3 position_before, velocity_before, position_after, velocity_after;
        static void archive(auto& ar, auto& self) {
            ar(self.survivor, self.position_before, self.velocity_before, self.position_after,
               self.velocity_after);
        }
    };
    void merge(NodeId absorbed, NodeId survivor, std::span<double> masses);
    bool take_back_merge(NodeId absorbed);
    void take_from_sources(const topology::NodeRecord& record);

    std::vector<Vec3> positions_, velocities_;
    ViscousHistory history_;
    std::map<NodeId, Merge> merges_;  // by the node that was absorbed
    std::uint64_t version_ = 1;
};

}  // namespace incise::physics
