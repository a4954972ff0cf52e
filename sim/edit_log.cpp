// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/edit_log.h"

#include "incise/sim/undo_point.h"

namespace incise::sim {

namespace {

/// Returns how much memory a list takes. bytes(value) tells what a value of it has on its own.
template <class T, class Bytes>
std::size_t num_bytes_of(const std::vector<T>& values, Bytes bytes) {
    std::size_t sum = sizeof(T) * values.size();
    for (const T& value : values) sum += bytes(value);
    return sum;
}
template <class T>
std::size_t num_bytes_of(const std::vector<T>& values) {
    return sizeof(T) * values.size();
}

template <class Node, class Element>
std::size_t num_bytes_of(const topology::MeshChanges<Node, Element>& changes) {
    const auto of_corners = [](const auto& record) { return num_bytes_of(record.corners); };
    return num_bytes_of(changes.nodes_added) + num_bytes_of(changes.nodes_removed) +
           num_bytes_of(changes.elements_added, of_corners) +
           num_bytes_of(changes.elements_removed, of_corners) + num_bytes_of(changes.rewired);
}

std::size_t num_bytes_of(const physics::BodyEdit& edit) {
    const auto of_shapes = [](const topology::ShapeChange& change) {
        return change.from.num_bytes() + change.to.num_bytes();
    };
    const topology::ChangeSet& material = edit.material;
    return sizeof(EditLog) + num_bytes_of(material) +
           num_bytes_of(material.shape_changes, of_shapes) + num_bytes_of(material.inside_changes) +
           num_bytes_of(material.faces_opened) + num_bytes_of(material.faces_closed) +
           num_bytes_of(edit.physics.mesh) + num_bytes_of(edit.physics.shares) +
           num_bytes_of(edit.physics.cells) + num_bytes_of(edit.velocities) +
           num_bytes_of(edit.touched_vertices) + num_bytes_of(edit.touched_nodes);
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
