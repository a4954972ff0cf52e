// The tags (numbers) of the nodes of a file, and a map from tags to the order of the file.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace incise::io {

/// A map from the tag of a node to its number, from 0, in the order of the file.
class NodeTags {
  public:
    /// Adds the tag of the next node.
    void add(std::int64_t tag) { sorted_.emplace_back(tag, std::ssize(sorted_)); }

    /// Sorts the tags, after all have been added. If two nodes have the same tag, returns the text
    /// of an error message about the lowest such tag.
    std::optional<std::string> sort() {
        return sort([](std::int64_t, std::int64_t) { return false; });
    }

    /// The same for a format in which a node may be given several times. `are_same` tells if two
    /// nodes, by their numbers, are one; find() then returns one of them, always the same.
    template <class AreSame>
    std::optional<std::string> sort(AreSame are_same) {
        std::sort(sorted_.begin(), sorted_.end());
        const auto twin =
            std::adjacent_find(sorted_.begin(), sorted_.end(), [&](const auto& a, const auto& b) {
                return a.first == b.first && !are_same(a.second, b.second);
            });
        if (twin == sorted_.end()) return std::nullopt;
        const auto number = [](const auto& entry) { return std::to_string(entry.second + 1); };
        return std::to_string(twin->first) + " is given to two nodes, the nodes number " +
               number(twin[0]) + " and " + number(twin[1]) +
               " in the order of the file; give each node one of its own";
    }

    /// Returns the number of the node with this tag, if there is one. Cost: constant if the tags
    /// have no gaps and each is given once, else the logarithm of their number.
    /// @pre  sort() has been called
    std::optional<std::int64_t> find(std::int64_t tag) const {
        if (sorted_.empty() || tag < sorted_.front().first || tag > sorted_.back().first)
            return std::nullopt;
        const auto guess =
            static_cast<std::uint64_t>(tag) - static_cast<std::uint64_t>(sorted_.front().first);
        if (guess < sorted_.size() && sorted_[guess].first == tag) return sorted_[guess].second;
        const auto row = std::lower_bound(
            sorted_.begin(), sorted_.end(), tag,
            [](const auto& entry, std::int64_t wanted) { return entry.first < wanted; });
        if (row == sorted_.end() || row->first != tag) return std::nullopt;
        return row->second;
    }

    std::size_t size() const { return sorted_.size(); }

    /// Returns the tags in the order of the file. Returns an empty list if all tags are equal to
    /// the numbers of their nodes.
    std::vector<std::int64_t> in_order() const {
        std::vector<std::int64_t> tags(sorted_.size());
        bool are_numbers = true;
        for (const auto& [tag, number] : sorted_) {
            tags[static_cast<std::size_t>(number)] = tag;
            are_numbers = are_numbers && tag == number;
        }
        if (are_numbers) tags.clear();
        return tags;
    }

  private:
    std::vector<std::pair<std::int64_t, std::int64_t>> sorted_;  ///< tag, number
};

}  // namespace incise::io
