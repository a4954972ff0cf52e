// Ids in a list, or one id that needs no list.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace incise::fragments {

/// A view of the ids of a list, or of one id that the view has itself.
/// @lifetime That of the list. Iterators also need this object: keep no span of a temporary.
template <class Id>
class ListOrOne {
  public:
    explicit ListOrOne(const std::vector<Id>& list) : list_(&list) {}
    /// @param one  the only id; invalid: there is none
    explicit ListOrOne(Id one) : one_(one) {}

    const Id* begin() const { return list_ ? list_->data() : &one_; }
    const Id* end() const { return begin() + size(); }
    std::size_t size() const { return list_ ? list_->size() : one_.is_valid() ? 1 : 0; }
    bool empty() const { return size() == 0; }
    Id front() const { return *begin(); }
    Id operator[](std::size_t i) const { return begin()[i]; }

  private:
    const std::vector<Id>* list_ = nullptr;
    Id one_;
};

}  // namespace incise::fragments
