// What follows the edits of a mesh, and in which order.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "incise/base/error.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// Something that keeps values of a mesh and follows its edits, one after the other and none left
/// out: apply(mesh, changes) is called with the mesh as it is after the edit.
template <class T>
concept Follower = requires(T& follower, const Mesh& mesh, const ChangeSet& changes) {
    follower.apply(mesh, changes);
};

/// The edit up to which a follower has come.
class FollowedEpoch {
  public:
    explicit FollowedEpoch(const Mesh& mesh) : epoch_(mesh.epoch()) {}

    std::uint64_t value() const { return epoch_; }

    /// Goes on to the edit, for a follower that reads nothing but the record. Throws InputError,
    /// and stays, if the edit does not begin here.
    /// @param who  names the follower in the message
    void advance(const ChangeSet& changes, const char* who) {
        if (changes.epoch_before != epoch_) refuse(changes, who, "");
        epoch_ = changes.epoch_after;
    }
    /// Goes on to the edit, for a follower that also reads the mesh. Throws InputError, and stays,
    /// if the edit does not begin here or if the mesh is not where it ends.
    void advance(const Mesh& mesh, const ChangeSet& changes, const char* who) {
        if (changes.epoch_before != epoch_ || changes.epoch_after != mesh.epoch())
            refuse(changes, who, " and the mesh at " + std::to_string(mesh.epoch()));
        epoch_ = changes.epoch_after;
    }

  private:
    [[noreturn]] void refuse(const ChangeSet& changes, const char* who,
                             const std::string& mesh) const {
        throw InputError(std::string(who) + ": an edit out of turn: it leads from epoch " +
                         std::to_string(changes.epoch_before) + " to " +
                         std::to_string(changes.epoch_after) + ", the " + who + " is at " +
                         std::to_string(epoch_) + mesh);
    }

    std::uint64_t epoch_;
};

}  // namespace incise::topology
