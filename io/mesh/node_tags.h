// From the names that a file gives its nodes to their numbers in the file's order.
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

class NodeTags {
  public:
    /// Names the next node.
    void add(std::int64_t tag) { sorted_.emplace_back(tag, std::ssize(sorted_)); }

    /// To be called when all are added. What is wrong with the lowest tag given twice, if any is.
    std::optional<std::string> sort() {
        std::sort(sorted_.begin(), sorted_.end());
        const auto twin =
            std::adjacent_find(sorted_.begin(), sorted_.end(),
                               [](const auto& a, const auto& b) { return a.first == b.first; });
        if (twin == sorted_.end()) return std::nullopt;
        const auto number = [](const auto& entry) { return std::to_string(entry.second + 1); };
        return std::to_string(twin->first) + " is given to two nodes, the nodes number " +
               number(twin[0]) + " and " + number(twin[1]) +
               " in the order of the file; give each node one of its own";
    }

    /// The number of the node with this tag, if there is one. Cost: constant if tags have no
    /// gaps, else the logarithm of their number.
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

    /// The tags in the file's order; none if they are the numbers.
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
