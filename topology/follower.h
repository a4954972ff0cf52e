// Objects that follow the edits of a mesh, and the check of the order of edits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <concepts>
#include <cstdint>
#include <string>

#include "incise/base/error.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// A mesh with edits that can be followed: Mesh, or FragmentMesh.
template <class T>
concept EditedMesh = requires(const T& mesh) {
    { mesh.epoch() } -> std::same_as<std::uint64_t>;
};

/// A type that keeps values of a mesh and follows its edits. apply(mesh, changes) is called for
/// every edit, in order, with the mesh after the edit.
template <class T>
concept Follower = requires(T& follower, const Mesh& mesh, const ChangeSet& changes) {
    follower.apply(mesh, changes);
};

/// The epoch of the last edit that a follower has followed.
class FollowedEpoch {
  public:
    explicit FollowedEpoch(const EditedMesh auto& mesh) : epoch_(mesh.epoch()) {}
    explicit FollowedEpoch(std::uint64_t epoch) : epoch_(epoch) {}

    std::uint64_t value() const { return epoch_; }
    bool operator==(const FollowedEpoch&) const = default;

    /// Advances to the end of an edit, for a follower that reads only the record. Throws
    /// InputError, and changes nothing, if the edit does not begin at the present epoch.
    /// @param changes  the edit
    /// @param who      the name of the follower in the message
    template <class Node, class Element>
    void advance(const MeshChanges<Node, Element>& changes, const char* who) {
        if (changes.epoch_before != epoch_)
            refuse(changes.epoch_before, changes.epoch_after, who, "");
        epoch_ = changes.epoch_after;
    }
    /// Advances to the end of an edit, for a follower that also reads the mesh. Throws InputError,
    /// and changes nothing, if the edit does not begin at the present epoch, or if `mesh` is not at
    /// the epoch at which the edit ends.
    template <class Node, class Element>
    void advance(const EditedMesh auto& mesh, const MeshChanges<Node, Element>& changes,
                 const char* who) {
        if (changes.epoch_before != epoch_ || changes.epoch_after != mesh.epoch())
            refuse(changes.epoch_before, changes.epoch_after, who,
                   " and the mesh at " + std::to_string(mesh.epoch()));
        epoch_ = changes.epoch_after;
    }

  private:
    [[noreturn]] void refuse(std::uint64_t before, std::uint64_t after, const char* who,
                             const std::string& mesh) const {
        throw InputError(std::string(who) + ": an edit out of turn: it leads from epoch " +
                         std::to_string(before) + " to " + std::to_string(after) + ", the " + who +
                         " is at " + std::to_string(epoch_) + mesh);
    }

    std::uint64_t epoch_;
};

}  // namespace incise::topology
