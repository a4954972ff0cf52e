// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/edit_log.h"

#include "incise/sim/undo_point.h"

namespace incise::sim {

namespace {

std::size_t num_bytes_of(const physics::BodyEdit& edit) {
    constexpr std::size_t of_record = 200, of_id = 16;  // with what they own, about
    const auto of = [](const auto& changes) {
        return of_record * (changes.nodes_added.size() + changes.nodes_removed.size() +
                            changes.elements_added.size() + changes.elements_removed.size()) +
               of_id * changes.rewired.size();
    };
    return sizeof(EditLog) + of(edit.material) + of(edit.physics.mesh) +
           of_id * (2 * edit.material.faces_opened.size() + 4 * edit.physics.cells.size() +
                    2 * edit.physics.shares.size() + edit.touched_nodes.size()) +
           sizeof(physics::BodyEdit::Velocity) * edit.velocities.size();
}

}  // namespace

std::shared_ptr<EditLog> EditLog::append(const physics::BodyEdit& edit) {
    edit_ = edit;
    next_ = std::make_shared<EditLog>();
    next_->num_bytes_ = num_bytes_ + num_bytes_of(edit);
    return next_;
}

std::size_t UndoPoint::num_bytes_since(const UndoPoint& earlier) const {
    return edits_->num_bytes() - earlier.edits_->num_bytes();
}

}  // namespace incise::sim
