// A moment of a world to which it can go back.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

namespace incise::sim {

class EditLog;
struct FormerMaterials;

/// A moment of a world: see World::undo_point() and World::undo(). A value, which is cheap to copy.
/// It holds what moves: positions, velocities and tools. The mesh is not in it: the world takes
/// back its edits.
class UndoPoint {
  public:
    /// Returns how much memory it takes by itself, bytes.
    std::size_t num_bytes() const { return motion_->size(); }
    /// Returns how much memory the edits between an earlier moment of the same world and this one
    /// take, bytes, about.
    std::size_t num_bytes_since(const UndoPoint& earlier) const;

  private:
    friend class World;
    UndoPoint(std::shared_ptr<EditLog> edits, std::uint64_t epoch,
              std::shared_ptr<FormerMaterials> materials, std::string motion)
        : edits_(std::move(edits)),
          epoch_(epoch),
          materials_(std::move(materials)),
          motion_(std::make_shared<const std::string>(std::move(motion))) {}

    std::shared_ptr<EditLog> edits_;  // since then
    std::uint64_t epoch_;             // of the mesh
    std::shared_ptr<FormerMaterials> materials_;
    std::shared_ptr<const std::string> motion_;
};

}  // namespace incise::sim
