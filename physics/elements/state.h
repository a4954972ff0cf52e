// The state of a body, which changes with its motion: positions, velocities and viscous history.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "incise/base/archive.h"
#include "incise/base/types.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/physics/elements/viscous_history.h"
#include "incise/topology/change_set.h"

namespace incise::physics {

/// Positions, velocities and history by id, with a version that grows when any of them changes.
///
/// Results that are computed from a state are stored with its version. They are up to date as long
/// as the versions are equal. Dead nodes keep their last values, so that an edit can be undone.
class State {
  public:
    /// Sets all nodes to their rest positions, without velocity. For `history_size` see
    /// ViscousHistory.
    State(const fragments::FragmentMesh& fragments, std::size_t history_size);

    std::span<const Vec3> positions() const { return positions_; }    ///< m, current, by node id
    std::span<const Vec3> velocities() const { return velocities_; }  ///< m/s, by node id
    const ViscousHistory& history() const { return history_; }
    /// Returns the largest distance that a node moved in the last step, m. If the step had several
    /// parts, it is the sum over the parts.
    double largest_move() const { return largest_move_; }
    void set_largest_move(double distance) { largest_move_ = distance; }
    /// Returns the version. An edit changes it only if the edit moves a node that existed before:
    /// by a merge, or by the undo of one. Other results must follow the edit themselves.
    std::uint64_t version() const { return version_; }

    /// Writable views of the state.
    struct Values {
        std::span<Vec3> positions, velocities;
        ViscousHistory& history;
    };
    /// Increases the version and returns the state for changes.
    Values change() {
        ++version_;
        return {positions_, velocities_, history_};
    }

    /// Follows an edit; for the values of new and merged nodes see Model::apply.
    /// @param fragments  after the edit
    /// @param changes    the record of the edit
    /// @param masses     lumped, kg, by node id, before the edit
    void apply(const fragments::FragmentMesh& fragments,
               const fragments::FragmentMeshChanges& changes, std::span<const double> masses);

    /// Sets the velocity of a node, m/s, as a part of an edit. The version stays: results that
    /// depend on velocities must follow the edit themselves.
    void set_velocity(NodeId n, const Vec3& velocity) { velocities_[n.index()] = velocity; }

    void save(ArchiveWriter& ar) const;
    /// Reads a saved state. Throws InputError, and changes nothing, for the state of another body
    /// and for a state that is not finite.
    void restore(ArchiveReader& ar);

  private:
    /// The record of a merge. With it, an undo before any motion restores the states of both nodes
    /// bit for bit.
    struct Merge {
        NodeId survivor;
        Vec3 position_before, velocity_before, position_after, velocity_after;
        static void archive(auto& ar, auto& self) {
            ar(self.survivor, self.position_before, self.velocity_before, self.position_after,
               self.velocity_after);
        }
    };
    void merge(NodeId absorbed, NodeId survivor, double weight);
    void merge_all(std::span<const fragments::NodeRecord> removed, std::span<const double> masses);
    bool take_back_merge(NodeId absorbed);
    void take_from_sources(const fragments::NodeRecord& record);

    std::vector<Vec3> positions_, velocities_;
    ViscousHistory history_;
    std::map<NodeId, Merge> merges_;  // by the absorbed node
    double largest_move_ = 0.0;
    std::uint64_t version_ = 1;
};

}  // namespace incise::physics
