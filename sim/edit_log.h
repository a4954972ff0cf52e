// The edits of a world since the moments that somebody may go back to.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "incise/physics/body/body_edit.h"

namespace incise::sim {

/// A list of edits, of which each link owns the next one. A world holds its end, and a moment the
/// link at which the list ended then. So the edits since the oldest moment are kept, and no others.
class EditLog {
  public:
    EditLog() = default;
    EditLog(const EditLog&) = delete;
    EditLog& operator=(const EditLog&) = delete;
    // A long list must not be destroyed by recursion.
    ~EditLog() {
        while (next_ && next_.use_count() == 1) next_ = std::exchange(next_->next_, nullptr);
    }

    /// Appends an edit to a list that ends here, and returns the new end.
    std::shared_ptr<EditLog> append(const physics::BodyEdit& edit);
    /// Returns the edits from here to `end`, in their order; nothing if the list does not lead
    /// there.
    std::optional<std::vector<const physics::BodyEdit*>> edits_until(const EditLog& end) const {
        std::vector<const physics::BodyEdit*> edits;
        const EditLog* at = this;
        for (; at && at != &end; at = at->next_.get()) edits.push_back(&at->edit_);
        if (!at) return std::nullopt;
        return edits;
    }
    /// Forgets what follows: the list ends here again.
    void cut_off() {
        edit_ = {};
        next_.reset();
    }
    /// Returns how much memory all edits that the list ever had before here took, bytes, about.
    std::size_t num_bytes() const { return num_bytes_; }

  private:
    physics::BodyEdit edit_;
    std::shared_ptr<EditLog> next_;
    std::size_t num_bytes_ = 0;
};

}  // namespace incise::sim
