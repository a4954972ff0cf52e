// Ids of the things that a program adds to a world, and the table of those that are there.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "incise/base/error.h"

namespace incise::sim {

/// The id of a thing in a world. A default id names nothing.
///
/// It names this thing only: another world refuses it, and so does its own world after the thing
/// was removed, also if another one has its place. Ids may be kept over save() and restore(). Those
/// of what the state has go on naming it, also in another world that is restored to this state.
/// Ids of what a restored world no longer has are refused. A restored world cannot tell from where
/// an id comes that has index and generation of something in the state.
template <class Tag>
struct Handle {
    std::uint32_t index = 0;       ///< of the place in its world; free places are used again
    std::uint32_t world = 0;       ///< number of the world, or of its last restore, from 1
    std::uint32_t generation = 0;  ///< of the thing: each that the world gets has another one
    /// True if both name the same thing of one world, also across its restores.
    bool operator==(const Handle& other) const {
        return index == other.index && generation == other.generation;
    }
    static void archive(auto& ar, auto& self) { ar(self.index, self.generation); }
};

using ToolId = Handle<struct ToolTag>;
using ConstraintId = Handle<struct ConstraintTag>;
using LoadId = Handle<struct LoadTag>;

/// The ids of the things in a list, in the order of the list. Things are added at its end; those
/// behind one that is removed move up.
template <class Id>
class HandleTable {
  public:
    /// @param noun   what the things are called in messages
    /// @param world  number of the world, or of its restore
    /// @param count  how many things the list has at first
    HandleTable(const char* noun, std::uint32_t world, std::size_t count = 0)
        : noun_(noun), world_(world) {
        for (std::size_t i = 0; i < count; ++i) add();
    }

    /// Returns the ids by position in the list.
    std::span<const Id> all() const { return ids_; }

    /// Appends a thing to the list and returns its id.
    Id add() {
        std::uint32_t free = 0;
        for (const auto& [index, position] : positions_) {
            if (index != free) break;
            ++free;
        }
        const Id id{free, world_, next_++};
        positions_[id.index] = ids_.size();
        ids_.push_back(id);
        return id;
    }
    /// Returns the position of a thing in the list. Throws InputError if the world does not have
    /// it.
    std::size_t position_of(const Id& id) const {
        const std::string thing = std::string(noun_) + " " + std::to_string(id.index);
        if (id.world == 0)
            throw InputError("the id with index " + std::to_string(id.index) + " names no " +
                             noun_ + ": take one that the world gave");
        const auto found = positions_.find(id.index);
        const bool is_there =
            found != positions_.end() && ids_[found->second].generation == id.generation;
        if (id.world != world_ && !(is_there && id.generation < first_of_own_))
            throw InputError(thing + " is one of another world, or of this one before it was " +
                             "restored to a state without it");
        if (!is_there) throw InputError(thing + " is no longer there: it was removed");
        return found->second;
    }
    /// Removes the thing from the list. Throws InputError as position_of() does.
    void remove(const Id& id) {
        const std::size_t gone = position_of(id);
        positions_.erase(id.index);
        ids_.erase(ids_.begin() + static_cast<std::ptrdiff_t>(gone));
        for (std::size_t i = gone; i < ids_.size(); ++i) positions_[ids_[i].index] = i;
    }

    static void archive(auto& ar, auto& self) { ar(self.ids_, self.next_); }
    /// Completes a table that was read from an archive.
    /// @param count  how many things the list has
    /// Throws InputError if the ids cannot be those of a list.
    void complete(std::size_t count) {
        // Nobody adds so many things: only other bytes have such numbers.
        constexpr std::uint32_t most = std::numeric_limits<std::uint32_t>::max() / 2;
        bool is_sound = next_ >= 1 && next_ <= most;
        std::set<std::uint32_t> generations;
        positions_.clear();
        for (std::size_t i = 0; i < ids_.size(); ++i) {
            Id& id = ids_[i];
            id.world = world_;
            is_sound = is_sound && id.index <= most && id.generation >= 1 && id.generation < next_;
            positions_[id.index] = i;
            generations.insert(id.generation);
        }
        first_of_own_ = next_;
        if (!is_sound || ids_.size() != count || positions_.size() != count ||
            generations.size() != count)
            throw InputError("its ids are not those of what it has");
    }

  private:
    const char* noun_;
    std::uint32_t world_;
    std::vector<Id> ids_;                             // by position
    std::map<std::uint32_t, std::size_t> positions_;  // by index of ids
    std::uint32_t first_of_own_ = 1;                  // generation; those below came with a state
    std::uint32_t next_ = 1;                          // generation
};

}  // namespace incise::sim
