// A map from ids to values, for some of many ids.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace incise::topology {

/// Values of some ids, found as fast as in an array. A reference to a value holds until the value
/// is erased. Memory: 4 bytes for each id up to the highest one, beside the values.
template <class Id, class T>
class IdMap {
  public:
    std::size_t size() const { return values_.size() - unused_.size(); }
    bool contains(Id id) const { return id.index() < place_.size() && place_[id.index()] != none; }

    /// @pre  contains(id)
    const T& at(Id id) const {
        assert(contains(id));
        return values_[place_[id.index()]];
    }
    T& at(Id id) {
        assert(contains(id));
        return values_[place_[id.index()]];
    }
    /// Returns the value of an id, which is made if there was none.
    T& operator[](Id id) {
        if (contains(id)) return at(id);
        if (id.index() >= place_.size()) place_.resize(id.index() + 1, none);
        if (unused_.empty()) {
            place_[id.index()] = static_cast<std::uint32_t>(values_.size());
            return values_.emplace_back();
        }
        place_[id.index()] = unused_.back();
        unused_.pop_back();
        return at(id);
    }
    /// Erases the value of an id, if there is one.
    void erase(Id id) {
        if (!contains(id)) return;
        at(id) = T{};
        unused_.push_back(place_[id.index()]);
        place_[id.index()] = none;
    }
    /// Passes each id with its value, in ascending order.
    template <class Visit>
    void for_each(Visit visit) const {
        for (std::size_t i = 0; i < place_.size(); ++i)
            if (place_[i] != none) visit(Id(i), values_[place_[i]]);
    }

  private:
    static constexpr std::uint32_t none = 0xffffffff;
    std::vector<std::uint32_t> place_;  // by id, in `values_`
    std::deque<T> values_;
    std::vector<std::uint32_t> unused_;  // places
};

}  // namespace incise::topology
