// The nodes at the corners of a cell, by value.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"

namespace incise::fragments {

/// The nodes at the corners of a cell, in their order, as a range.
class CornerNodes {
  public:
    void push_back(NodeId n) { nodes_[size_++] = n; }

    const NodeId* begin() const { return nodes_.data(); }
    const NodeId* end() const { return begin() + size_; }
    std::size_t size() const { return size_; }
    NodeId operator[](std::size_t k) const { return nodes_[k]; }

  private:
    std::array<NodeId, topology::max_corners> nodes_;
    std::size_t size_ = 0;
};

}  // namespace incise::fragments
